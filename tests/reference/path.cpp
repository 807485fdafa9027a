#include "path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "camera.h"
#include "free_flight.h"
#include "phase.h"
#include "reference_light_cache.h"
#include "reference_surfaces.h"
#include "shaders/shared/constants.h"
#include "transmittance.h"

namespace reference {

using vkvol::Rgb;

Rgb transmittance(const World& world, const Ray& ray, Rng& rng) {
    const Method& method = world.method;
    // A lamp's body, which is where the ray ends, hides nothing of it.
    if (nearest_surface(world.scene.surfaces, {ray.origin, ray.direction, ray.reach * (1.0 - 1e-9)}))
        return Rgb(0.0);
    if (!world.medium)
        return Rgb(1.0);
    Rgb T = estimate_transmittance(*world.medium, method.transmittance, ray, method.march, rng);
    for (const Medium& medium : world.others)
        T *= estimate_transmittance(medium, method.transmittance, ray, method.march, rng);
    return T;
}

Rgb direct_light(const World& world, const Medium& medium, const glm::dvec3& p, const glm::dvec3& travel, Rng& rng) {
    Rgb Ld(0.0);
    for (const vkvol::Light& light : world.scene.lights) {
        const bool has_extent = std::holds_alternative<vkvol::SunLight>(light) || vkvol::is_lamp(light);
        const Draw draw = has_extent ? rng.next() : Draw{};
        const auto found = towards(light, p, draw.x(), draw.y());
        if (!found)
            continue;
        // Light travels along -direction and leaves along -travel: their cosine is dot(direction, travel).
        const double mu = glm::dot(found->ray.direction, travel);
        const Rgb T = transmittance(world, found->ray, rng);
        Ld += phase_eval(medium, mu) * T * found->light;
    }
    if (world.sky && world.method.scattering == SCATTERING_SINGLE) { // no flight goes on to meet it
        const Draw draw = rng.next();
        const glm::dvec3 direction = turned({0.0, 1.0, 0.0}, 1.0 - 2.0 * draw.x(), draw.y());
        const Rgb T = transmittance(world, {p, direction}, rng);
        Ld += 4.0 * std::numbers::pi * phase_eval(medium, glm::dot(direction, travel)) * T *
              world.sky->radiance(direction);
    }
    return Ld;
}

Rgb lamps_seen(const World& world, const Ray& ray, Rng& rng) {
    Rgb L(0.0);
    for (const vkvol::Light& light : world.scene.lights) {
        const std::optional<double> distance = lamp_distance(light, ray);
        if (!distance || (world.medium && world.method.nee == NEE_NONE))
            continue;
        const Ray seen{ray.origin, ray.direction, *distance};
        L += lamp_radiance(light) * transmittance(world, seen, rng);
    }
    return L;
}

Rgb light_from_beyond(const World& world, const glm::dvec3& direction, bool at_camera) {
    Rgb L = world.scene.background;
    if (world.sky)
        L += world.sky->radiance(direction);
    if (at_camera || world.method.nee == NEE_NONE)
        for (const vkvol::Light& light : world.scene.lights)
            L += disc_radiance(light, direction);
    return L;
}

World make_world(const vkvol::Scene& scene, Medium medium) {
    if (!medium.unbounded())
        medium.periodic = scene.periodic;
    World world{scene, std::move(medium), {}, load_sky(scene.lights)};
    world.medium->majorant_scale = scene.settings.majorant_scale;
    world.method = resolve_method(scene, *world.medium);
    return world;
}

namespace {

// With estimators that serve in a race: delta tracking and ratio tracking.
World load_several(const vkvol::Scene& scene) {
    World world{scene, std::nullopt, {}, load_sky(scene.lights)};
    for (const vkvol::Volume& volume : scene.volumes) {
        Medium medium = load(preset_volume(scene.settings.integrator, volume), scene.settings.filter);
        medium.majorant_scale = scene.settings.majorant_scale;
        if (!medium.unbounded()) // which is the same everywhere along its layers
            medium.periodic = scene.periodic;
        if (!medium.grey())
            throw std::runtime_error("the reference's race is for grey extinction");
        if (medium.largest() > 0.0 && !(medium.grid() && medium.grid()->empty()))
            world.others.push_back(std::move(medium));
    }
    if (!world.others.empty()) {
        world.medium = std::move(world.others.back());
        world.others.pop_back();
    }
    Medium varying;
    varying.noise = vkvol::Noise{};
    world.method = resolve_method(scene, varying);
    if (world.method.transmittance == TRANSMITTANCE_ANALYTIC)
        world.method.transmittance = TRANSMITTANCE_RATIO;
    return world;
}

} // namespace

World load_world(const vkvol::Scene& scene) {
    if (scene.volumes.size() > 1 || !scene.surfaces.empty())
        return load_several(scene);
    if (scene.volumes.empty()) {
        Medium nothing;
        return {scene, std::nullopt, resolve_method(scene, nothing), load_sky(scene.lights)};
    }
    Medium medium = load(preset_volume(scene.settings.integrator, scene.volumes.front()), scene.settings.filter);
    if (medium.grid() && medium.grid()->empty()) { // no voxels, no medium
        Medium nothing;
        return {scene, std::nullopt, resolve_method(scene, nothing), load_sky(scene.lights)};
    }
    if (auto* grid = std::get_if<Grid>(&medium.shape); grid && scene.settings.majorant_cell > 0)
        build_majorants(*grid, scene.settings.majorant_cell);
    return make_world(scene, std::move(medium));
}

namespace {

// One free flight of a path of throughput beta; what it gathers on its way is added to L.
Flight gathering_flight(const World& world, const Ray& ray, double exponential, double select, const Rgb& beta,
                        bool lit, Rng& rng, Rgb& L) {
    const Medium& medium = *world.medium;
    const DensityAlong density(medium, ray);
    FlightEvents events;
    if (world.method.emission == EMISSION_AT_STEPS)
        events.piece = [&](double t0, double t1, const Rgb& weight) {
            const double t = t0 + rng.next().x() * (t1 - t0);
            const Rgb emitted =
                medium.sigma_t * density(t) * (1.0 - medium.albedo_at(ray.at(t))) * medium.emission_at(ray.at(t));
            L += weight * (t1 - t0) * emitted;
        };
    if (world.method.nee == NEE_TENTATIVE && lit)
        events.tentative = [&](double t, const Rgb& weight) {
            L += weight * medium.albedo_at(ray.at(t)) * direct_light(world, medium, ray.at(t), ray.direction, rng);
        };
    return fly(medium, world.method.free_flight, ray, exponential, select, beta, world.method.march, rng, events);
}

} // namespace

Rgb radiance(const World& world, Ray ray, double exponential, double select, Rng& rng) {
    if (!world.others.empty() || !world.scene.surfaces.empty())
        return radiance_by_race(world, ray, rng);
    if (!world.medium)
        return world.scene.holds_out ? Rgb(0.0) : light_from_beyond(world, ray.direction, true);
    if (marches_through(world.method))
        return march_through(world, ray, rng);
    const Medium& medium = *world.medium;
    const Method& method = world.method;
    const vkvol::RenderSettings& settings = world.scene.settings;
    Rgb L(0.0), beta(1.0); // radiance so far, throughput
    for (std::uint32_t depth = 0;; ++depth) {
        const bool last = method.scattering == SCATTERING_NONE || (settings.max_depth && depth == *settings.max_depth);
        const Flight flight = gathering_flight(world, ray, exponential, select, beta, !last, rng, L);
        beta = flight.beta;
        if (!flight.t && depth == 0 && world.scene.holds_out)
            return L;
        if (!flight.t)
            return L + beta * light_from_beyond(world, ray.direction, depth == 0);
        ray.origin = ray.at(*flight.t);
        const Rgb albedo = medium.albedo_at(ray.origin);
        if (method.emission == EMISSION_AT_COLLISIONS)
            L += beta * (1.0 - albedo) * medium.emission_at(ray.origin);
        if (last)
            return L;
        beta *= albedo;
        // Its own cache knows one sun; of other lights there is no need for one.
        const bool cached = method.nee == NEE_CACHED && vkvol::only_directional(world.scene.lights);
        if (method.nee == NEE_COLLISIONS || (method.nee == NEE_CACHED && !cached))
            L += beta * direct_light(world, medium, ray.origin, ray.direction, rng);
        if (cached)
            L += beta * cached_light(world, ray.origin, ray.direction, beta, rng);
        if (method.scattering == SCATTERING_SINGLE)
            return L;

        const Draw draw = rng.next();
        const double m = std::max({std::abs(beta.x), std::abs(beta.y), std::abs(beta.z)});
        if (m == 0.0)
            return L;
        if (m < settings.roulette_threshold) {
            if (!(draw.w() * settings.roulette_threshold < m))
                return L;
            beta *= settings.roulette_threshold / m;
        }
        const glm::dvec3 before = ray.direction;
        ray.direction = phase_sample(medium, before, draw.y(), draw.z());
        const bool next_is_lit = !settings.max_depth || depth + 1 < *settings.max_depth;
        if (cached && next_is_lit)
            L -= beta * foreseen_light(world, ray.origin, before, ray.direction);
        exponential = draw.exponential(0);
        select = draw.select();
    }
}

namespace {

// A sensor of flux: directions are drawn evenly, and weighted; lamps, suns and the sky are met by chance alone, and
// only lights without extent are asked.
Rgb flux(const World& world, int x, int y, const Draw& draw, Rng& rng) {
    const vkvol::Camera& camera = world.scene.camera;
    const bool is_rectangle = camera.projection == vkvol::Projection::irradiance;
    const Draw toward = rng.next();
    const glm::dvec3 direction = turned({0.0, 0.0, 1.0}, 1.0 - 2.0 * toward.x(), toward.y());
    glm::dvec3 from, normal(0.0);
    if (is_rectangle) {
        const glm::dvec2 aside = in_pixel(world.scene.settings, draw.x(), draw.y());
        const Ray middle = rectangle_point(camera, world.scene.picture, x + 0.5 + aside.x, y + 0.5 + aside.y);
        from = middle.origin;
        normal = middle.direction;
    } else {
        from = camera.points[std::size_t(y) * std::size_t(world.scene.picture.width) + std::size_t(x)];
    }
    const auto response = [&](const glm::dvec3& d) { return is_rectangle ? std::max(0.0, glm::dot(d, normal)) : 1.0; };
    Rgb reading(0.0);
    for (const vkvol::Light& light : world.scene.lights) {
        const bool has_extent = vkvol::is_met_by_chance(light) || vkvol::is_lamp(light);
        const auto found = has_extent || world.method.nee == NEE_NONE ? std::nullopt : towards(light, from, 0.0, 0.0);
        if (found && response(found->ray.direction) > 0.0)
            reading += response(found->ray.direction) * found->light * transmittance(world, found->ray, rng);
    }
    const double weight = 4.0 * std::numbers::pi * response(direction);
    if (weight == 0.0)
        return reading;
    const Ray ray{from, direction};
    const Rgb lamps = lamps_seen(world, ray, rng);
    return reading + weight * (lamps + radiance(world, ray, draw.exponential(2), draw.select(), rng));
}

} // namespace

Rgb trace_path(const World& world, int x, int y, std::uint32_t sample, std::uint32_t seed) {
    Rng rng{static_cast<std::uint32_t>(x) | static_cast<std::uint32_t>(y) << 16, sample, seed};
    const Draw draw = rng.next();
    if (vkvol::reads_flux(world.scene.camera))
        return flux(world, x, y, draw, rng);
    const glm::dvec2 aside = in_pixel(world.scene.settings, draw.x(), draw.y());
    const Draw lens = world.scene.camera.lens.radius > 0.0 ? rng.next() : Draw{};
    const Ray ray =
        camera_ray(world.scene.camera, world.scene.picture, x + 0.5 + aside.x, y + 0.5 + aside.y, lens.x(), lens.y());
    const Rgb lamps = lamps_seen(world, ray, rng);
    return (world.scene.holds_out ? Rgb(0.0) : lamps) + radiance(world, ray, draw.exponential(2), draw.select(), rng);
}

} // namespace reference
