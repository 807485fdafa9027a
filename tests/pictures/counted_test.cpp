// Particles that pass sensors of flux, against closed forms and against paths that set out from the sensor.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <numbers>

#include "camera_view.h"
#include "method.h"
#include "preset.h"
#include "reading_grid.h"
#include "scene_hash.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/test_device.h"
#include "support/thorough.h"
#include "tests/reference/reference.h"
#include "tests/reference/transport.h"

using namespace vkvol;
using Catch::Contains;
using std::numbers::pi;

namespace {

// A sensor of `across` by `across` pixels.
Scene sensor(glm::dvec3 middle, glm::dvec3 facing, glm::dvec2 size, int across, std::uint32_t spp) {
    Scene scene;
    scene.camera.projection = Projection::irradiance;
    scene.camera.position = middle;
    look_along(scene.camera, facing, is_parallel(facing, up_y) ? glm::dvec3(0.0, 0.0, 1.0) : up_y);
    scene.camera.size = size;
    scene.picture = {across, across, 0.0, 0.0, double(across), double(across)};
    scene.settings.spp = spp;
    return scene;
}

Scene absorption(glm::dvec3 middle, glm::dvec3 edges, glm::ivec3 cells, std::uint32_t spp) {
    Scene scene;
    scene.camera.projection = Projection::absorption;
    scene.camera.position = middle;
    scene.camera.edges = edges;
    scene.camera.cells = cells;
    const int rows = cells.y * cells.z;
    scene.picture = {cells.x, rows, 0.0, 0.0, double(cells.x), double(rows)};
    scene.settings.spp = spp;
    return scene;
}

// Against rays from the sensor, which the reference follows; but it knows no surfaces that repeat.
void check_counts(const Scene& scene, const std::string& name) {
    INFO(name);
    const Scene rays = by(scene, "ratioTracking");
    const bool repeats = scene.periodic && !scene.surfaces.empty();
    CHECK_AGREEMENT(agree(render_here(by(scene, "lightTracing"), 1).film,
                          repeats ? render_here(rays, 2).film : render_reference(rays, 2), name));
}

// A slab in a domain [-0.5, 0.5]^2, from 0 down.
Scene repeated_slab(double tau, double albedo, double height, bool from_above) {
    Scene scene = sensor({0.1, height, -0.2}, from_above ? up_y : -up_y, {1.0, 0.7}, 4, 512);
    scene.volumes = {medium(Box{{0.0, -0.5, 0.0}, glm::dvec3(1.0)}, tau, albedo)};
    scene.periodic = Periodic{{-0.5, 0.0, -0.5}, {0.5, 0.0, 0.5}};
    return scene;
}

Surface ball_of(MaterialKind kind, double roughness) {
    Surface surface;
    surface.shape = BallSurface{{-0.7, -0.6, 0.9}, 0.6};
    surface.material.kind = kind;
    surface.material.color = {0.8, 0.7, 0.6};
    surface.material.roughness = roughness;
    return surface;
}

struct CountedCase {
    const char* name;
    Scene scene;
};

Scene among(const Volume& volume, std::vector<Light> lights) {
    Scene scene = sensor({0.2, -0.5, 0.3}, {0.3, 1.0, 0.2}, {2.0, 1.5}, 2, 4096);
    scene.volumes = {volume};
    scene.lights = std::move(lights);
    return scene;
}

std::vector<CountedCase> counted_cases() {
    const auto [point, spot, lamp, disk, rectangle, sun, beam] = LightsAbout{};
    std::vector<CountedCase> all;
    all.push_back(
        {"a ball of fog, point and spot", among(medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 1.5, 0.95, -0.4), {point, spot})});
    all.push_back({"smoke, far lights", among(smoke(), {sun, beam, write_sky(sunset_map())})});
    all.push_back({"smoke, lamps", among(smoke(), {lamp, disk, rectangle})});
    Volume colourful = medium(write_grid(cloud_grid()), 1.0, 0.9, 0.6);
    const Rgb sigma_t = {0.4, 0.8, 1.0};
    colourful.sigma_s = Rgb{0.9, 0.8, 0.95} * sigma_t;
    colourful.sigma_a = sigma_t - colourful.sigma_s;
    all.push_back({"a chromatic cloud", among(colourful, {beam})});
    Volume ember = smoke();
    ember.Le = {1.0, 0.5, 0.2};
    all.push_back({"what glows", among(ember, {})});
    all.push_back({"a background", among(smoke(), {})});
    all.back().scene.background = {0.3, 0.2, 0.1};
    Scene several = among(smoke(), {point});
    several.volumes.push_back(medium(Box{{-0.9, -0.5, -0.5}, {1.4, 0.6, 0.7}}, 2.0, 0.9));
    all.push_back({"several media", several});
    Scene filtered = among(smoke(), {lamp});
    filtered.settings.pixel_filter = PixelFilter::tent;
    filtered.settings.pixel_filter_radius = 0.9;
    all.push_back({"a tent about each pixel", filtered});
    // Turned away, from the other side, and larger than all that there is to be lit.
    Scene large = among(smoke(), {sun, point});
    look_along(large.camera, {0.1, -1.0, 0.0}, {0.0, 0.0, 1.0});
    large.camera.position.y = 1.0;
    large.camera.size = {9.0, 7.0};
    all.push_back({"a large sensor", large});
    Scene surfaces = among(smoke(), {lamp, point});
    surfaces.surfaces = {ball_of(MaterialKind::conductor, 0.4), ball_of(MaterialKind::diffuse, 0.0)};
    surfaces.surfaces[0].material.eta = {0.143, 0.375, 1.442};
    surfaces.surfaces[0].material.k = {3.983, 2.386, 1.603};
    surfaces.surfaces[1].shape = RectangleSurface{{0.0, -1.3, 0.0}, {2.5, 0.0, 0.0}, {0.0, 0.0, -2.5}};
    all.push_back({"surfaces", surfaces});
    return all;
}

// From above clouds that repeat, or from below.
Scene about_clouds(bool below, std::vector<Light> lights) {
    Scene scene = sensor({1.0, below ? -6.0 : 6.0, 2.0}, below ? up_y : -up_y, {9.0, 10.0}, 2, 4096);
    scene.volumes = {thin_cloud()};
    scene.lights = std::move(lights);
    scene.periodic = Periodic{{-5.0, 0.0, -5.0}, {5.0, 0.0, 5.0}};
    return scene;
}

std::vector<CountedCase> domains() {
    const DirectionalLight beam = LightsAbout{}.beam;
    const DirectionalLight from_below{glm::normalize(glm::dvec3(1.0, -1.0, 0.5)), {1.0, 0.5, 0.2}};
    const SunLight sun{glm::normalize(glm::dvec3(-0.3, 0.9, 0.2)), {3.0, 2.8, 2.0}, 10.0};
    std::vector<CountedCase> all;
    all.push_back({"above clouds in a beam aslant", about_clouds(false, {beam})});
    all.push_back({"below clouds in beams from both sides", about_clouds(true, {beam, from_below})});
    all.push_back({"below clouds under a sun and a background", about_clouds(true, {sun})});
    all.back().scene.background = {0.1, 0.2, 0.4};
    all.push_back({"amid clouds under a map of the sky", about_clouds(true, {write_sky(sunset_map())})});
    all.back().scene.camera.position.y = 0.7;
    Scene turned = about_clouds(false, {beam});
    turned.camera.size = {5.0, 3.0};
    turned.camera.position = {4.0, 1.0, -4.5}; // beyond the domain's edges
    look_along(turned.camera, -up_y, {0.6, 0.0, 0.8});
    all.push_back({"a sensor turned, across seams", turned});
    Scene grounded = about_clouds(true, {beam});
    grounded.surfaces.emplace_back().shape = PlaneSurface{{0.0, -7.0, 0.0}, up_y};
    grounded.surfaces.back().material.color = {0.5, 0.3, 0.2};
    grounded.surfaces.push_back(ball_of(MaterialKind::diffuse, 0.0));
    grounded.surfaces.back().shape = BallSurface{{-3.0, 0.0, 2.0}, 1.5};
    all.push_back({"clouds over a ground", grounded});
    return all;
}

} // namespace

TEST_CASE("particles counted are the flux that rays from the sensor read", "[gpu][counted]") {
    for (const CountedCase& c : in_turn(counted_cases(), 0))
        check_counts(c.scene, c.name);
}

// A third of the irradiance of 1 from above comes from beyond the sensor and all else that there is.
TEST_CASE("far light is counted where a filter alone has it", "[gpu][counted]") {
    Scene scene = sensor({0.0, 0.0, 0.0}, up_y, {1.0, 1.0}, 1, 1 << 18);
    scene.volumes = {medium(Sphere{{0.0, 0.0, 0.0}, 0.1}, 1e-6, 1.0)};
    scene.lights = {DirectionalLight{up_y, Rgb(1.0)}};
    scene.settings.pixel_filter = PixelFilter::gaussian;
    scene.settings.pixel_filter_radius = 1.5;
    check_means(by(scene, "lightTracing"), 1.0, "a gaussian under far light");
}

TEST_CASE("particles counted in domains that repeat", "[gpu][counted]") {
    for (const CountedCase& c : in_turn(domains(), 1))
        check_counts(c.scene, c.name);
}

// Where channels fly as far as each other, and each weighs what it lost.
TEST_CASE("colours of particles counted in fog that is known in closed form", "[gpu][counted]") {
    const LightsAbout lights;
    const Rgb sigma_t = {0.4, 0.8, 1.0};
    Volume fog = medium(Box{{0.0, 0.0, 0.0}, glm::dvec3(3.0)}, 1.0, 0.9);
    fog.sigma_s = Rgb{0.9, 0.8, 0.95} * sigma_t;
    fog.sigma_a = sigma_t - fog.sigma_s;
    Scene scene = among(fog, {lights.beam});
    scene.settings.spp = 32768; // of a particle's weight hardly anything is left: without the weights red lacks a third
    check_counts(scene, "chromatic fog");
}

TEST_CASE("particles of clouds that glow, of which a domain cuts some off", "[gpu][counted]") {
    Scene embers = about_clouds(false, {});
    embers.volumes.front().Le = {1.0, 0.5, 0.2};
    embers.periodic = Periodic{{-4.0, 0.0, -4.2}, {4.5, 0.0, 4.0}};
    embers.camera.size = {8.0, 8.0};
    check_counts(embers, "clouds that glow");
}

// Each of a sweep's particles passes or does not: through the whole of a domain all do, at all heights.
TEST_CASE("particles that pass an empty domain are all counted", "[gpu][counted]") {
    for (const double height : {0.3, -0.25, -2.0}) {
        Scene scene = by(repeated_slab(1e-9, 0.0, height, true), "lightTracing");
        scene.camera.size = {1.0, 1.0};
        scene.lights = {DirectionalLight{{0.6, 0.8, 0.0}, Rgb(2.0)}};
        const Film film = render_here(scene, 1).film;
        double sum = 0.0;
        for (const glm::vec3& pixel : film.mean)
            sum += pixel.x / double(film.mean.size());
        CHECK(sum == Approx(2.0 * 0.8).epsilon(2e-6));
    }
}

TEST_CASE("particles counted above, below and amid slabs", "[gpu][counted]") {
    const double tau = 2.0, albedo = GENERATE(1.0, 0.6), mu0 = GENERATE(1.0, 0.3);
    const reference::SlabSolution beam = reference::slab_in_beam(albedo, tau, mu0, 800);
    for (const bool below : {false, true}) {
        Scene scene = by(repeated_slab(tau, albedo, below ? -1.5 : 0.0, below), "lightTracing"); // at its very top
        scene.lights = {DirectionalLight{{std::sqrt(1.0 - mu0 * mu0), mu0, 0.0}, Rgb(1.0)}};
        check_means(scene, below ? beam.transmitted : beam.reflected,
                    fmt::format("slab of {}, {}, {}", albedo, mu0, below));
    }
    Scene absorbing = by(repeated_slab(tau, 0.0, -0.5, true), "lightTracing");
    absorbing.lights = {DirectionalLight{{std::sqrt(1.0 - mu0 * mu0), mu0, 0.0}, Rgb(1.0)}};
    check_means(absorbing, mu0 * std::exp(-0.5 * tau / mu0), "what is left amid");
}

// Also what comes to it again and again. Rays from just above it read as much.
TEST_CASE("a sensor in the plane of the ground counts what comes to the ground", "[gpu][counted]") {
    const double tau = 1.0, ground = 0.6;
    const reference::SlabSolution beam = reference::slab_in_beam(0.9, tau, 1.0, 400);
    const reference::SlabSolution even = reference::slab_in_half_sky(0.9, tau, 400);
    for (const double height : {-1.5, 0.0, 7.0}) { // of the whole
        Scene scene = by(repeated_slab(tau, 0.9, -1.2, true), "lightTracing");
        scene.surfaces.emplace_back().shape = PlaneSurface{{0.0, height - 1.2, 0.0}, up_y};
        scene.surfaces.back().material.color = Rgb(ground);
        scene.camera.position.y += height;
        std::get<Box>(scene.volumes.front().shape).center.y += height;
        scene.lights = {DirectionalLight{up_y, Rgb(1.0)}};
        check_means(scene, beam.transmitted / (1.0 - ground * even.reflected / pi),
                    fmt::format("ground at {}", height));
    }
}

// What no looks find: through a ball of glass, into its caustic.
TEST_CASE("particles are counted behind glass", "[gpu][counted]") {
    Scene scene = sensor({0.0, -2.0, 0.0}, up_y, {6.0, 6.0}, 1, 1 << 12);
    scene.surfaces = {ball_of(MaterialKind::dielectric, 0.0)};
    scene.surfaces.front().shape = BallSurface{{0.0, 0.0, 0.0}, 0.7};
    scene.surfaces.front().material.color = Rgb(1.0);
    scene.surfaces.front().material.eta = Rgb(1.5);
    scene.background = Rgb(1.0);
    check_means(by(scene, "lightTracing"), pi, "glass in an even sky");
    scene.background = Rgb(0.0);
    scene.lights = {DirectionalLight{up_y, Rgb(1.0)}};
    CHECK(choose_method(with_preset(by(scene, "lightTracing"))).biased.empty());
    CHECK_THAT(choose_method(with_preset(by(scene, "ratioTracking"))).biased, Contains("integrator lightTracing does"));
}

TEST_CASE("what a slab absorbs, layer by layer", "[gpu][counted]") {
    constexpr int cells = 8, fine = 800;
    const double tau = 2.0, albedo = GENERATE(0.0, 0.6, 0.95), mu0 = GENERATE(1.0, 0.3);
    const reference::SlabSolution beam = reference::slab_in_beam(albedo, tau, mu0, fine);
    Scene scene = absorption({0.1, -0.5, -0.2}, glm::dvec3(1.0), {2, cells, 3}, 2048);
    scene.volumes = {medium(Box{{0.0, -0.5, 0.0}, glm::dvec3(1.0)}, tau, albedo)};
    scene.periodic = Periodic{{-0.5, 0.0, -0.5}, {0.5, 0.0, 0.5}};
    scene.lights = {DirectionalLight{{std::sqrt(1.0 - mu0 * mu0), mu0, 0.0}, Rgb(1.0)}};
    std::vector<Rgb> means;
    double sum = 0.0;
    for (int y = 0; y < 3 * cells; ++y) { // the uppermost first
        double fluence = 0.0;
        for (int i = 0; i < fine / cells; ++i)
            fluence += beam.fluence[std::size_t(y % cells * fine / cells + i)] * cells / fine;
        means.insert(means.end(), 2, Rgb(tau * (1.0 - albedo) * fluence));
        sum += means.back().x / (3.0 * cells);
    }
    CHECK(beam.reflected + beam.transmitted + sum == Approx(mu0).epsilon(2e-4)); // of the solution
    CHECK_AGREEMENT(agree_with_means(render_here(scene, 1).film, means, fmt::format("slab of {}, {}", albedo, mu0)));
}

// In a furnace as much as is emitted: radiance 1 from everywhere. So each cell reads the grid's own voxel.
TEST_CASE("what voxels absorb in a furnace, and the grid of it", "[gpu][counted]") {
    const glm::ivec3 dims(5, 3, 4);
    GridRecipe recipe;
    recipe.first = {0, 0, 0};
    recipe.last = dims - 1;
    recipe.linear = glm::dmat3(0.5);
    recipe.value = [](glm::ivec3 v) { return 0.2f + 0.1f * float(v.x) + 0.5f * float(v.y == 1) + 0.3f * float(v.z); };
    const bool chromatic = GENERATE(false, true);
    Volume volume = medium(write_grid(recipe), 1.0, 0.5);
    volume.sigma_a = chromatic ? Rgb(0.3, 0.5, 0.6) : Rgb(0.5);
    volume.sigma_s = chromatic ? Rgb(0.4, 0.4, 0.2) : Rgb(0.5);
    volume.Le = Rgb(1.0);
    const glm::dvec3 edges = 0.5 * glm::dvec3(dims);
    Scene scene = absorption(0.5 * edges - 0.25, edges, dims, 1 << 13);
    scene.volumes = {volume};
    scene.background = Rgb(1.0);
    scene.settings.filter = Filter::nearest;
    std::vector<Rgb> means;
    for (int y = 0; y < dims.y * dims.z; ++y)
        for (int x = 0; x < dims.x; ++x)
            means.push_back(4.0 * pi * volume.sigma_a * double(recipe.value({x, dims.y - 1 - y % dims.y, y / dims.y})));
    const Film film = render_here(scene, 1).film;
    CHECK_AGREEMENT(agree_with_means(film, means, fmt::format("furnace, {}", chromatic)));
    const std::string bytes = reading_grid(film, scene.camera);
    if (!chromatic) {
        const std::filesystem::path file = std::filesystem::path(write_text("")).replace_extension(".nvdb");
        std::ofstream(file, std::ios::binary) << bytes;
        const reference::Grid grid = reference::load_grid(file, "absorbed");
        const glm::dvec3 place = grid.linear * glm::dvec3(3.0, 2.0, 1.0) + grid.translation;
        CHECK(glm::distance(place, scene.camera.cell_low({3, 2, 1}) + 0.25) < 1e-12);
        CHECK(grid.voxel({3, 2, 1}) == film.mean[std::size_t(1 * dims.y + 0) * 5 + 3].x);
        CHECK(grid.voxel({4, 0, 3}) == film.mean[std::size_t(3 * dims.y + 2) * 5 + 4].x);
    }
}

// Fluxes out of the top and the ground, and what is absorbed between, each by its own render.
TEST_CASE("what comes into a domain leaves it, or stays", "[gpu][counted]") {
    const LightsAbout lights;
    Scene scene = about_clouds(false, {lights.beam, lights.sun});
    scene.volumes.front().sigma_s *= Rgb(1.0, 0.9, 0.8); // of an extinction that differs between the channels
    scene.volumes.push_back(medium(Sphere{{2.0, -1.0, 0.0}, 2.0}, 0.8, 0.5, -0.3));
    scene.camera.size = {10.0, 10.0};
    scene.camera.position = {0.0, 6.0, 0.0};
    scene.settings.spp = 16384;
    Scene below = scene;
    look_along(below.camera, up_y, {0.0, 0.0, 1.0});
    below.camera.position.y = -6.0;
    Scene amid = absorption({0.0, 0.0, 0.0}, {10.0, 12.0, 10.0}, {2, 2, 1}, 16384);
    amid.volumes = scene.volumes;
    amid.lights = scene.lights;
    amid.periodic = scene.periodic;
    glm::dvec3 power(0.0), variance(0.0);
    std::uint32_t seed = 1; // of particles of their own
    for (const auto& [part, of] : {std::pair(scene, 1.0), std::pair(below, 1.0), std::pair(amid, 12.0)}) { // per area
        const ImageMean mean = image_mean(render_here(by(part, "lightTracing"), seed++).film);
        power += of * mean.value;
        variance += of * of * *mean.standard_error * *mean.standard_error;
    }
    const Rgb in = lights.beam.irradiance * lights.beam.direction.y + lights.sun.irradiance * lights.sun.direction.y;
    for (int channel = 0; channel < 3; ++channel) {
        CAPTURE(channel, power[channel], in[channel], std::sqrt(variance[channel]));
        CHECK(std::abs(power[channel] - in[channel]) < 4.0 * std::sqrt(variance[channel]));
        CHECK(std::sqrt(variance[channel]) < 0.01 * in[channel]);
    }
}

TEST_CASE("absorption amid several media with surfaces, beneath lights of all kinds", "[gpu][counted]") {
    const LightsAbout lights;
    Scene scene = absorption({0.0, 0.0, 0.0}, glm::dvec3(1.2), {8, 8, 8}, 1024);
    scene.volumes = {medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 0.5, 0.6, 0.3),
                     medium(Box{{0.0, 0.0, 0.0}, glm::dvec3(1.2)}, 1.0, 0.8)};
    scene.surfaces = {ball_of(MaterialKind::diffuse, 0.0)};
    scene.lights = {lights.point, lights.beam, lights.rectangle, lights.sun};
    const ImageMean in_all = image_mean(render_here(scene, 1).film);
    // As much as the fluence of points all over the box says, times both media's sigma_a.
    scene.camera.projection = Projection::fluence;
    for (int i = 0; i < 4096; ++i) // of a lattice of rank 1, whose error is far below the noise
        scene.camera.points.push_back(
            1.2 * (glm::fract(glm::dvec3(i, 1183.0 * i, 1969.0 * i) / 4096.0 + 0.5 / 4096.0) - 0.5));
    scene.picture = {64, 64, 0.0, 0.0, 64.0, 64.0};
    scene.settings.spp = 64;
    const Film fluence = render_here(by(scene, "ratioTracking"), 2).film;
    for (int channel = 0; channel < 3; ++channel) {
        double sum = 0.0, variance = 0.0;
        const double read = in_all.value[channel], spread = (*in_all.standard_error)[channel];
        for (std::size_t i = 0; i < 4096; ++i) {
            sum += fluence.mean[i][channel] / 4096.0;
            variance += fluence.variance[i][channel] / (4096.0 * 4096.0);
        }
        const double sigma_a = 0.5 * 0.4 + 1.0 * 0.2;
        const double error = std::sqrt(sigma_a * sigma_a * variance + spread * spread);
        CAPTURE(channel, sigma_a * sum, read, error);
        CHECK(std::abs(sigma_a * sum - read) < 4.0 * error);
        CHECK(error < 0.02 * sigma_a * sum);
    }
}

// Whatever the unit of length, and however little of a particle a collision takes.
TEST_CASE("the error of absorbed power is known where little is absorbed", "[gpu][counted]") {
    std::vector<double> relative;
    for (const double unit : {1e-6, 1.0, 1e4}) {
        Scene scene = absorption({0.0, 0.0, 0.0}, glm::dvec3(unit), {1, 5, 1}, 2048);
        scene.volumes = {medium(Box{{0.0, 0.0, 0.0}, glm::dvec3(unit)}, 2.0 / unit, 1.0 - 1e-5)};
        scene.periodic = Periodic{{-0.5 * unit, 0.0, -0.5 * unit}, {0.5 * unit, 0.0, 0.5 * unit}};
        scene.lights = {DirectionalLight{up_y, Rgb(1.0)}};
        const Film film = render_here(scene, 1).film;
        const ImageMean mean = image_mean(film);
        REQUIRE(mean.standard_error);
        CAPTURE(unit, mean.value.x, mean.standard_error->x);
        CHECK(mean.value.x * unit > 1e-5);
        CHECK(mean.value.x * unit < 4e-5);
        relative.push_back(mean.standard_error->x / mean.value.x);
    }
    for (const double error : relative) { // as of any other unit, to what 2048 samples tell of it
        CHECK(error > 1e-4);
        CHECK(std::abs(error / relative.front() - 1.0) < 0.25);
    }
}

TEST_CASE("what is absorbed is known to all digits", "[gpu][counted]") {
    const auto absorbed = [](double share) { // of what collides, by nearly the same paths
        Scene scene = absorption({0.0, 0.0, 0.0}, glm::dvec3(1.0), {1, 1, 1}, 2048);
        scene.volumes = {medium(Box{{0.0, 0.0, 0.0}, glm::dvec3(1.0)}, 2.0, 1.0 - share)};
        scene.periodic = Periodic{{-0.5, 0.0, -0.5}, {0.5, 0.0, 0.5}};
        scene.lights = {DirectionalLight{up_y, Rgb(1.0)}};
        return image_mean(render_here(scene, 1).film).value.x / share;
    };
    const double usual = absorbed(1e-4);
    for (const double share : {1e-6, 1e-8})
        CHECK(absorbed(share) == Approx(usual).epsilon(2e-3));
    // Likewise where the albedo varies from place to place.
    const auto of_layers = [](double share) {
        const std::string layer = fmt::format(R"(sigma_t="2" albedo="{:.17g}"/>)", 1.0 - share);
        const Scene scene = parse_scene(
            R"(<options><periodic x="-.5 .5" z="-.5 .5"/><box width="1" height="1" depth="1"/><layers><layer height="-.5" )" +
                layer + R"(<layer height=".5" )" + layer +
                R"(</layers><light y="1" r="1" g="1" b="1"/><absorption width="1" height="1" depth="1"/>
                <rayPerPixelCount>2048</rayPerPixelCount></options>)",
            "s.xml");
        return image_mean(render_here(scene, 1).film).value.x / share;
    };
    const double usual_layers = of_layers(1e-4);
    CHECK(usual_layers == Approx(usual).epsilon(0.05)); // by other paths
    for (const double share : {1e-6, 1e-8})
        CHECK(of_layers(share) == Approx(usual_layers).epsilon(2e-3));
}

TEST_CASE("a sensor that looks up at the sun reads it, however high", "[gpu][counted]") {
    for (const bool has_ground : {true, false})
        for (const double height : {3.0, 1000.0}) {
            Scene scene = parse_scene(
                fmt::format(
                    R"(<options><box y=".5" width="1" height="1" depth="1"/><sigma_s>1</sigma_s><sigma_a>0</sigma_a>
                    <periodic x="-.5 .5" z="-.5 .5"/>{}<light y="1" r="1" g="1" b="1"/>
                    <irradiance y="{}" lookAt="0 {} 0"/><rayPerPixelCount>256</rayPerPixelCount></options>)",
                    has_ground ? "<surfaces><plane/></surfaces>" : "", height, height + 1.0),
                "up.xml");
            REQUIRE(choose_method(with_preset(scene)).paths == PATHS_LIGHT);
            CAPTURE(has_ground, height);
            CHECK(image_mean(render_here(scene, 1).film).value.x == Approx(1.0).epsilon(1e-4));
        }
}

TEST_CASE("boxes in which absorption is read, in scene files", "[cpu][counted]") {
    const auto parse = [](const std::string& elements) {
        return parse_scene("<options><sphere/><sigma_a>1</sigma_a>" + elements + "</options>", "s.xml");
    };
    const Scene scene = parse(R"(<absorption x="1" width="4" height="3" depth="2" cells="8 3 5"/>)");
    CHECK(scene.camera.edges == glm::dvec3(4.0, 3.0, 2.0));
    CHECK(scene.picture.width == 8);
    CHECK(scene.picture.height == 15);
    CHECK(scene.camera.cell_of_pixel(2, 4) == glm::ivec3(2, 1, 1));
    CHECK(glm::distance(scene.camera.cell_low({7, 0, 0}), glm::dvec3(2.5, -1.5, -1.0)) < 1e-12);
    CHECK(choose_method(with_preset(scene)).paths == PATHS_LIGHT);
    CHECK_THROWS_WITH(choose_method(with_preset(by(scene, "ratioTracking"))), Contains("take integrator lightTracing"));
    CHECK(scene_hash(scene) !=
          scene_hash(parse(R"(<absorption x="1" width="4" height="3" depth="2.5" cells="8 3 5"/>)")));
    CHECK_THROWS_WITH(parse(R"(<absorption cells="1 2"/>)"), Contains("three numbers"));
    CHECK_THROWS_WITH(parse(R"(<absorption cells="1 2 2.5"/>)"), Contains("three whole numbers"));
    CHECK_THROWS_WITH(parse(R"(<absorption cells="1 1000 1000"/>)"), Contains("at most"));
    CHECK_THROWS_WITH(parse(R"(<absorption/><width>3</width>)"),
                      Contains("<width>: <absorption> has a pixel for each"));
    CHECK_THROWS_WITH(parse(R"(<absorption/><camera/>)"), Contains("<absorption> beside the <camera>"));
    Scene resized = scene;
    CHECK_THROWS_WITH(resize_picture(resized, 9, std::nullopt), Contains("each of its cells"));
    CHECK_THROWS_WITH(check_grid_file("a.nvdb", Camera{}), Contains("take .exr"));
}

TEST_CASE("particles counted have the same bits however they are worked on", "[gpu][counted]") {
    for (Scene scene : {counted_cases()[2].scene, domains()[5].scene}) {
        scene.settings.spp = 40;
        scene = by(scene, "lightTracing");
        const Film whole = render_here(scene, 1).film;
        for (const Schedule schedule : {Schedule::fused, Schedule::staged}) {
            RenderJob job;
            job.plan.schedule = schedule;
            job.plan.slots = 64;
            job.plan.lanes = 64;
            job.plan.budget = 17;
            job.plan.most_batch = 7;
            CHECK(same_bits(render_here(scene, 1, job).film, whole));
        }
    }
}

TEST_CASE("which particles no sensor counts", "[counted]") {
    const auto refusal = [](const Scene& scene, const char* integrator = "lightTracing") -> std::string {
        try {
            choose_method(with_preset(by(scene, integrator)));
        } catch (const std::exception& error) {
            return error.what();
        }
        return "";
    };
    Scene scene = domains().front().scene;
    CHECK(refusal(scene).empty());
    CHECK_THAT(refusal(scene, "bidirectional"), Contains("no weights"));
    CHECK(choose_method(with_preset(by(scene, "lightTracing"))).nee == NEE_NONE);
    CHECK(scene_hash(by(scene, "lightTracing")) == scene_hash(by(scene, "ratioTracking")));
    Scene other = scene;
    other.lights = {DirectionalLight{up_y, Rgb(1.0)}};
    CHECK(scene_hash(by(other, "lightTracing")) != scene_hash(by(scene, "lightTracing")));
    SECTION("at points") {
        scene.camera.projection = Projection::fluence;
        CHECK_THAT(refusal(scene), Contains("no particle passes a point"));
    }
    SECTION("by cameras") {
        scene.camera.projection = Projection::perspective;
        CHECK_THAT(refusal(scene), Contains("a camera sees all domains"));
    }
    SECTION("aslant") {
        look_along(scene.camera, {0.1, -1.0, 0.0}, {0.0, 0.0, 1.0});
        CHECK_THAT(refusal(scene), Contains("along all axes"));
    }
    SECTION("too wide") {
        scene.camera.size.x = 10.1;
        CHECK_THAT(refusal(scene), Contains("wider than a domain"));
        scene.camera.size = {8.0, 8.0};
        CHECK(refusal(scene).empty());
        look_along(scene.camera, -up_y, {1.0, 0.0, 1.0});
        CHECK_THAT(refusal(scene), Contains("wider than a domain"));
    }
    SECTION("where a domain repeats along one axis") {
        scene.periodic->low.z = scene.periodic->high.z = 0.0;
        CHECK_THAT(refusal(scene), Contains("along two axes"));
        scene.lights.clear();
        scene.volumes.front().Le = Rgb(1.0);
        CHECK(refusal(scene).empty());
    }
}
