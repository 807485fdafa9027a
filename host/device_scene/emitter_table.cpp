#include "emitter_table.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <limits>
#include <numbers>
#include <span>

#include "alias_table.h"
#include "camera_rays.h"
#include "kept_apart.h"
#include "phase_params.h"
#include "scene_facts.h"

namespace vkvol {

namespace {

using std::numbers::pi;

// From medium space to render space.
glm::dmat4 to_render(const shared::MediumParams& medium) {
    glm::dmat4 map(1.0);
    for (int i = 0; i < 3; ++i)
        map = glm::row(map, i, glm::dvec4(medium.to_medium[i]));
    return glm::inverse(map);
}

class Emitters {
public:
    explicit Emitters(EmitterTable& table) : table_(table) {}

    void add(std::uint32_t source, double power) {
        if (!(power > 0.0) || !std::isfinite(power))
            return;
        table_.rows.push_back({{}, 0.0f, source});
        powers_.push_back(power);
        sum_ += power;
    }

    void add_primitive(const shared::SurfacePrimitive& piece, const shared::SurfaceRow& surface, std::uint32_t i) {
        add(AT_SURFACE | i, surface.sides * pi * area_of(piece) * channel_mean(surface.emission));
    }

    double power() const { return sum_; }

    void finish() {
        const std::size_t first = table_.params.first_emitter;
        if (powers_.empty()) { // a black background
            table_.rows.push_back({{}, 0.0f, SOURCE_BACKGROUND});
            powers_.push_back(sum_ = 1.0);
        }
        const std::vector<double> chances = defensive_chances(powers_);
        const std::vector<shared::AliasEntry> alias = make_alias_table(chances);
        for (std::size_t i = 0; i < chances.size(); ++i) {
            table_.rows[first + i].chance = static_cast<float>(chances[i]);
            table_.rows[first + i].alias = alias[i];
        }
        table_.params.emitters = static_cast<std::uint32_t>(chances.size());
        table_.params.power = static_cast<float>(sum_);
    }

private:
    EmitterTable& table_;
    std::vector<double> powers_;
    double sum_ = 0.0;
};

// A medium's box, in render space.
struct GlowBox {
    glm::dvec3 corner;
    glm::dmat3 edges;

    double volume() const { return std::abs(glm::determinant(edges)); }
    double area() const {
        return 2.0 * (glm::length(glm::cross(edges[0], edges[1])) + glm::length(glm::cross(edges[1], edges[2])) +
                      glm::length(glm::cross(edges[2], edges[0])));
    }
    glm::dvec3 at(int i) const { return corner + edges * glm::dvec3(i & 1, i >> 1 & 1, i >> 2); }
};

GlowBox box_of(const shared::MediumParams& medium) {
    const glm::dmat4 map = to_render(medium);
    const glm::dvec3 size = glm::dvec3(medium.bounds_max) - glm::dvec3(medium.bounds_min);
    GlowBox box{glm::dvec3(map * glm::dvec4(medium.bounds_min, 1.0)), glm::dmat3(map)};
    for (int i = 0; i < 3; ++i)
        box.edges[i] *= size[i];
    return box;
}

// Along the axes, about all of them.
GlowBox box_about(std::span<const GlowBox> boxes) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const GlowBox& box : boxes)
        for (int i = 0; i < 8; ++i) {
            low = glm::min(low, box.at(i));
            high = glm::max(high, box.at(i));
        }
    const glm::dvec3 size = high - low;
    return {low, glm::dmat3(glm::dvec3(size.x, 0.0, 0.0), glm::dvec3(0.0, size.y, 0.0), glm::dvec3(0.0, 0.0, size.z))};
}

// Places the faces that a domain which repeats along two axes has across the third. Returns a face's area in world
// units^2; 0 for other domains.
double place_faces(const shared::PeriodParams& period, shared::ParticleParams& params) {
    double area = 1.0;
    int open = 0;
    for (int axis = 0; axis < 3; ++axis) {
        params.open[axis] = period.size[axis] > 0.0f ? 0.0f : 1.0f;
        open += period.size[axis] > 0.0f ? 0 : 1;
        area *= period.size[axis] > 0.0f ? double(period.size[axis]) : 1.0;
        if (params.open[axis] != 0.0f) {
            params.below = std::min(period.range_low[axis], period.range_high[axis]);
            params.above = std::max(period.range_low[axis], period.range_high[axis]);
        }
    }
    return open == 1 ? area : 0.0;
}

// World units^2: its area; of a box world units^3, its volume. Light comes from beyond it, and from beyond where it is
// kept off what it lies in: by at most 2 SURFACE_SPARE of how far there is anything, of which the domain's range has
// more.
double place_sensor(const Scene& scene, glm::dvec3 origin, shared::ParticleParams& params) {
    const SensorBox box = sensor_box(scene.camera, scene.picture);
    const glm::dvec3 low = box.low - origin, high = box.high - origin;
    params.sensor_low = low;
    const glm::dvec3 open = params.open;
    const double height = std::max(std::abs(glm::dot(open, low)), std::abs(glm::dot(open, high)));
    const double margin =
        std::max({1e-5 * std::max(double(params.above) - params.below, glm::length(high - low)), 0x1p-20 * height});
    params.below = static_cast<float>(std::min(double(params.below), glm::dot(open, low) - margin));
    params.above = static_cast<float>(std::max(double(params.above), glm::dot(open, high) + margin));
    if (scene.camera.projection == Projection::absorption)
        return scene.camera.edges.x * scene.camera.edges.y * scene.camera.edges.z;
    const CameraRays rays = camera_rays(scene.camera, scene.picture);
    return glm::length(glm::cross(rays.right, rays.down)) * scene.picture.width * scene.picture.height;
}

// In which splats count: a power of two some 2^34 below a pixel's value, so that sums of 64 bits hold what is 2^25
// above it; and of what is seen itself, `brightest`, 2^54 below.
double unit_of_splats(double power, double across, double brightest) {
    const double usual = std::max(power / across, brightest / double(1 << 20));
    return std::exp2(std::floor(std::log2(usual)) - 34.0);
}

// Part of what a light with a place sends out that may come to a ball about the origin, at most.
double part_that_comes(const shared::LightRow& light, double radius) {
    const double distance = glm::length(glm::dvec3(light.position));
    if (!(light.kind & LIGHT_PLACED) || distance <= radius)
        return 1.0;
    const double seen = radius * radius / (distance * distance); // over pi, the ball's solid angle
    if (light.kind == LIGHT_SPOT)
        return std::min(1.0, 0.5 * seen / light.none_beyond);
    return light.kind & LIGHT_FLAT ? seen : 0.25 * seen; // by the cosine, or alike into all directions
}

// The most, roughly, that a particle brings which leaves a lamp or surface of those the sensor sees: its part of all
// that is sent out, over the patch that a pixel has there, and over all pixels. `eye`: render space.
double brightest_in_view(const Scene& scene, const LightTable& lights, const SurfaceTable& surfaces, glm::dvec3 eye,
                         double power, double pixels) {
    constexpr double toward_edges = 8.0; // of the view pixels have smaller patches, and lamps' pieces are nearer
    double nearest = std::numeric_limits<double>::infinity();
    const auto take = [&](const glm::dvec3& middle, double extent) {
        nearest = std::min(nearest, std::max(glm::distance(middle, eye) - extent, std::ldexp(extent, -10)));
    };
    for (const shared::LightRow& light : lights.rows)
        if (light.kind & LIGHT_SHAPED)
            take(light.position, extent_of(light));
    for (std::size_t i = 0; i < surfaces.met; ++i) {
        const shared::SurfacePrimitive& p = surfaces.primitives[i];
        if (surfaces.rows[p.surface].emission == glm::vec3(0.0f) || p.shape == SURFACE_PLANE)
            continue;
        const bool is_triangle = p.shape == SURFACE_TRIANGLES;
        const glm::vec3 middle = is_triangle ? (p.a + p.b + p.c) / 3.0f : p.a;
        take(middle, is_triangle ? std::max({glm::distance(p.a, middle), glm::distance(p.b, middle),
                                             glm::distance(p.c, middle)})
                                 : p.c.x);
    }
    if (!std::isfinite(nearest))
        return 0.0;
    const double pixel = camera_rays(scene.camera, scene.picture).pixel_at(nearest);
    return pixel > 0.0 ? toward_edges * power / (pi * pixel * pixel * pixels) : 0.0;
}

// Where nothing bounds the scene: how far its lights are from the eye, or else the first plane; or a unit of length.
double usual_length(const LightTable& lights, const SurfaceTable& surfaces, glm::dvec3 eye) {
    double farthest = 0.0;
    for (const shared::LightRow& light : lights.rows)
        if ((light.kind & LIGHT_PLACED) && light.kind != LIGHT_SURFACE) // which is where its pieces are
            farthest = std::max(farthest, glm::distance(glm::dvec3(light.position), eye));
    for (std::size_t i = 0; i < surfaces.planes && farthest == 0.0; ++i)
        farthest = std::abs(glm::dot(glm::dvec3(surfaces.primitives[i].b), glm::dvec3(surfaces.primitives[i].a) - eye));
    return farthest > 0.0 ? farthest : 1.0;
}

// The most, roughly, that facets turn light into a direction [1 / sr]: metal's, or glass', which refracts into fewer
// the nearer its index is to 1.
double facet_peak(const shared::SurfaceRow& surface) {
    const double by_facets = 1.0 / (4.0 * pi * double(surface.roughness) * surface.roughness);
    if (surface.material == MATERIAL_ROUGH_CONDUCTOR)
        return by_facets;
    if (surface.material != MATERIAL_ROUGH_DIELECTRIC)
        return 0.0;
    const double index = std::max(double(surface.eta.x), 1.0 / surface.eta.x);
    return by_facets * std::max(1.0, 4.0 * index * index / ((index - 1.0) * (index - 1.0)));
}

// The brightest value that a pixel may get: of sources seen themselves, or mirrored; what media and facets scatter of a
// light without extent; and of points, which light what is near them without bound, as from a thirty-thousandth of
// `reach`, so that what is lit from all of it has 24 bits. `bounded`: whether something bounds the scene, about the
// origin.
double brightest_of(const Scene& scene, Media loaded, const LightTable& lights, const SurfaceTable& surfaces,
                    const Glow& glow, const SkyMap* sky, double reach, bool bounded) {
    double peak = 1.0, brightest = std::max(channel_mean(scene.background), glow.most);
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        peak = std::max(peak, phase_peak(scene.volumes[i], loaded[i].phase_nodes));
    for (const shared::SurfaceRow& surface : surfaces.rows)
        peak = std::max(peak, facet_peak(surface));
    for (const shared::LightRow& light : lights.rows) {
        double factor =
            light.kind == LIGHT_DIRECTIONAL || light.kind == LIGHT_POINT || light.kind == LIGHT_SPOT ? peak : 1.0;
        if (light.kind == LIGHT_POINT || light.kind == LIGHT_SPOT) {
            const double beyond = bounded ? double(glm::length(light.position)) - reach : 0.0;
            const double nearest = std::max(beyond, std::ldexp(reach, -15));
            factor /= nearest * nearest;
        }
        brightest = std::max(brightest, factor * channel_mean(light.radiance));
    }
    for (const glm::vec4& texel : sky ? std::span<const glm::vec4>(sky->texels) : std::span<const glm::vec4>())
        brightest = std::max(brightest, channel_mean(Rgb(texel)));
    for (const shared::SurfaceRow& surface : surfaces.rows)
        brightest = std::max(brightest, channel_mean(surface.emission));
    return brightest;
}

} // namespace

Glow glow_of(const Scene& scene, Media loaded, std::span<const shared::MediumParams> rows) {
    Glow glow;
    std::vector<GlowBox> boxes;
    const std::size_t volumes = emits(scene) ? scene.volumes.size() : 0;
    for (std::size_t i = 0; i < volumes; ++i) {
        if (rows[i].kinds.shape == SHAPE_NONE)
            continue;
        const shared::EmissionParams& emission = rows[i].emission;
        const double even = channel_mean(emission.constant) + channel_mean(most_map_emission(scene.volumes[i]));
        // A grid's values are of any size; usual are those of a tenth of its largest. Of these matter sends out the
        // share that it does not scatter.
        const double color = channel_mean(scene.volumes[i].temperature.color);
        const double most =
            color > 0.0 ? hottest_radiance(scene.volumes[i], loaded[i]) * channel_mean(emission.color) / color : 0.0;
        const double usual = even + 0.1 * most;
        if (!(usual > 0.0))
            continue;
        boxes.push_back(box_of(rows[i]));
        const double power = 4.0 * pi * boxes.back().volume() * rows[i].usual_sigma_t * usual;
        glow.power += power;
        glow.hidden += std::max(power - pi * boxes.back().area() * usual, 0.0);
        glow.most = std::max(glow.most, even + most);
    }
    if (boxes.empty())
        return glow;
    const GlowBox about = boxes.size() == 1 ? boxes.front() : box_about(boxes);
    glow.corner = about.corner;
    glow.edges = about.edges;
    return glow;
}

EmitterTable make_emitter_table(const Scene& scene, Media loaded, const Method& method, const LightTable& lights,
                                const SurfaceTable& surfaces, const Glow& glow, const SkyMap* sky,
                                const shared::PeriodParams& period, double radius, glm::dvec3 origin, double pixels) {
    EmitterTable table{lights.pieces, {}};
    table.params.first_emitter = static_cast<std::uint32_t>(table.rows.size());
    const bool bounded = std::isfinite(radius);
    table.params.radius = bounded ? static_cast<float>(radius * 1.0001) : 0.0f;
    const bool counts = reads_flux(scene.camera);
    const double face = scene.periodic ? place_faces(period, table.params) : 0.0;
    const double sensor = counts ? place_sensor(scene, origin, table.params) : 0.0;
    const double across = scene.periodic ? face : bounded ? pi * radius * radius : 0.0; // what comes from afar
    Emitters emitters(table);
    for (std::size_t i = 0; i < lights.rows.size(); ++i)
        emitters.add(static_cast<std::uint32_t>(i), lights.powers[i] * (i < lights.lamp_first ? across : 1.0));
    if (method.paths == PATHS_LIGHT) { // else paths from the camera find these
        emitters.add(SOURCE_BACKGROUND, 4.0 * pi * channel_mean(scene.background) * across);
        for (std::size_t i = 0; i < surfaces.primitives.size(); ++i)
            if (const auto& piece = surfaces.primitives[i]; i < surfaces.met)
                emitters.add_primitive(piece, surfaces.rows[piece.surface], static_cast<std::uint32_t>(i));
        table.params.glow_corner = glow.corner;
        for (int i = 0; i < 3; ++i)
            table.params.glow_edges[i] = glow.edges[i];
        table.params.glow_volume = static_cast<float>(std::abs(glm::determinant(glow.edges)));
        emitters.add(SOURCE_GLOW, glow.power);
    }
    emitters.finish();
    const glm::dvec3 eye = scene.camera.position - origin;
    const double reach = bounded && radius > 0.0 ? radius : usual_length(lights, surfaces, eye);
    // What a sensor counts is absorbed, too; a camera sees what leaves.
    double shown = emitters.power() - (method.paths == PATHS_LIGHT && !counts ? glow.hidden : 0.0);
    // Where paths share with particles nothing is much brighter than what may come of far lights.
    for (std::size_t i = 0; i < lights.rows.size() && bounded && method.paths == PATHS_BOTH; ++i)
        shown -= lights.powers[i] * (1.0 - part_that_comes(lights.rows[i], reach));
    // But a particle brings its part of all that its light sends out, and numbers have to hold that.
    shown = std::max(shown, emitters.power() * 0x1p-20);
    // A sensor counts particles, and sees nothing itself.
    double brightest = counts ? 0.0 : brightest_of(scene, loaded, lights, surfaces, glow, sky, reach, bounded);
    if (!counts && method.paths == PATHS_LIGHT)
        brightest = std::max(brightest, brightest_in_view(scene, lights, surfaces, eye, emitters.power(), pixels));
    table.params.unit =
        static_cast<float>(unit_of_splats(shown, counts ? sensor : 4.0 * pi * pi * reach * reach, brightest));
    return table;
}

} // namespace vkvol
