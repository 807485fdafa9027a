#include "emitter_table.h"

#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <numbers>

#include "alias_table.h"

namespace vkvol {

namespace {

constexpr double pi = std::numbers::pi;

double mean(const glm::dvec3& color) {
    return (color.x + color.y + color.z) / 3.0;
}

// From medium space to render space.
glm::dmat4 to_render(const shared::MediumParams& medium) {
    glm::dmat4 map(1.0);
    for (int i = 0; i < 3; ++i)
        map = glm::row(map, i, glm::dvec4(medium.to_medium[i]));
    return glm::inverse(map);
}

// Per unit of extinction, of what is constant. What grids and maps hold is not known here.
double glow_of(const shared::MediumParams& medium) {
    return mean(medium.emission.constant) + mean(medium.emission.color);
}

class Emitters {
public:
    Emitters(EmitterTable& table, double radius) : table_(table), across_(pi * radius * radius) {}

    void add(std::uint32_t source, double power) {
        if (!(power > 0.0) || !std::isfinite(power))
            return;
        table_.rows.push_back({{}, 0.0f, source});
        powers_.push_back(power);
        sum_ += power;
    }

    void add_primitive(const shared::SurfacePrimitive& piece, const shared::SurfaceRow& surface, std::uint32_t i) {
        const double radius = piece.c.x;
        const double area = piece.shape == SURFACE_TRIANGLES
                                ? 0.5 * glm::length(glm::cross(glm::dvec3(piece.b) - glm::dvec3(piece.a),
                                                               glm::dvec3(piece.c) - glm::dvec3(piece.a)))
                                : (piece.shape == SURFACE_SPHERE ? 4.0 : 1.0) * pi * radius * radius;
        add(AT_SURFACE | i, surface.sides * pi * area * mean(surface.emission));
    }

    double across() const { return across_; }

    void finish() {
        if (table_.rows.empty()) { // a black background
            table_.rows.push_back({{}, 0.0f, SOURCE_BACKGROUND});
            powers_.push_back(sum_ = 1.0);
        }
        const std::vector<double> chances = defensive_chances(powers_);
        const std::vector<shared::AliasEntry> alias = make_alias_table(chances);
        for (std::size_t i = 0; i < chances.size(); ++i) {
            table_.rows[i].chance = static_cast<float>(chances[i]);
            table_.rows[i].alias = alias[i];
        }
        table_.params.emitters = static_cast<std::uint32_t>(chances.size());
        table_.params.power = static_cast<float>(sum_);
    }

private:
    EmitterTable& table_;
    double across_; // the ball
    std::vector<double> powers_;
    double sum_ = 0.0;
};

void place_glow(const shared::MediumParams& medium, shared::ParticleParams& params) {
    const glm::dmat4 map = to_render(medium);
    const glm::dvec3 size = glm::dvec3(medium.bounds_max) - glm::dvec3(medium.bounds_min);
    params.glow_corner = glm::vec3(map * glm::dvec4(medium.bounds_min, 1.0));
    glm::dmat3 edges(map);
    for (int i = 0; i < 3; ++i) {
        edges[i] *= size[i];
        params.glow_edges[i] = edges[i];
    }
    params.glow_volume = static_cast<float>(std::abs(glm::determinant(edges)));
}

} // namespace

EmitterTable make_emitter_table(const Scene& scene, const Method& method, const LightTable& lights,
                                const SurfaceTable& surfaces, const shared::MediumParams& medium,
                                std::span<const shared::MediumParams> media, double radius) {
    EmitterTable table;
    const bool bounded = std::isfinite(radius);
    table.params.radius = bounded ? static_cast<float>(radius * 1.0001) : 0.0f;
    Emitters emitters(table, bounded ? radius : 0.0);
    for (std::size_t i = 0; i < lights.rows.size(); ++i)
        emitters.add(static_cast<std::uint32_t>(i),
                     lights.powers[i] * (i < lights.lamp_first ? emitters.across() : 1.0));
    if (method.paths == PATHS_LIGHT) { // else paths from the camera find these
        emitters.add(SOURCE_BACKGROUND, 4.0 * pi * mean(scene.background) * emitters.across());
        for (std::size_t i = 0; i < surfaces.primitives.size(); ++i)
            if (const auto& piece = surfaces.primitives[i]; i < surfaces.met)
                emitters.add_primitive(piece, surfaces.rows[piece.surface], static_cast<std::uint32_t>(i));
        if (emits(scene)) {
            place_glow(medium, table.params);
            double glow = media.empty() ? glow_of(medium) : 0.0;
            for (const shared::MediumParams& one : media)
                glow += glow_of(one);
            emitters.add(SOURCE_GLOW,
                         std::max(4.0 * pi * table.params.glow_volume * medium.usual_sigma_t * glow, 1e-30));
        }
    }
    emitters.finish();
    // A power of two some 2^34 below a pixel's value, so that sums of 64 bits hold what is 2^25 above it; and 2^14
    // below that of a light that is seen.
    const double reach = bounded && radius > 0.0 ? radius : 1.0;
    double usual = table.params.power / (4.0 * pi * pi * reach * reach);
    for (const shared::LightRow& light : lights.rows)
        usual = std::max(usual, mean(light.radiance) / double(1 << 20));
    table.params.unit = static_cast<float>(std::exp2(std::floor(std::log2(usual)) - 34.0));
    return table;
}

} // namespace vkvol
