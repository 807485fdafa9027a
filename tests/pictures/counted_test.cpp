// Particles that pass sensors of flux, against closed forms and against paths that set out from the sensor.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "camera_view.h"
#include "method.h"
#include "preset.h"
#include "scene_hash.h"
#include "session.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/surface_scenes.h"
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
    surfaces.surfaces = {surface_of(left_ball, MaterialKind::conductor, 0.4),
                         surface_of(left_ball, MaterialKind::diffuse, 0.0)};
    surfaces.surfaces[1].shape = floor_piece;
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
    grounded.surfaces.push_back(surface_of(left_ball, MaterialKind::diffuse, 0.0));
    grounded.surfaces.back().shape = BallSurface{{-3.0, 0.0, 2.0}, 1.5};
    all.push_back({"clouds over a ground", grounded});
    return all;
}

} // namespace

TEST_CASE("particles counted are the flux that rays from the sensor read", "[gpu][counted][long]") {
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
TEST_CASE("a sensor in the plane of the ground counts what comes to the ground", "[gpu][counted][long]") {
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
// Where it ends is known to no better than ulps of its length: those of 1000 are more than a sensor is off its surface.
TEST_CASE("a sensor in the plane of the ground counts what comes from far away", "[gpu][counted]") {
    Scene scene = by(sensor({0.0, 0.0, 0.0}, up_y, {1.0, 1.0}, 8, 16384), "lightTracing");
    scene.surfaces.emplace_back().shape = PlaneSurface{{0.0, 0.0, 0.0}, up_y};
    const glm::dvec3 from(1000.0, 1000.0, 0.0);
    scene.lights = {SpotLight{from, -glm::normalize(from), Rgb(2e6), 0.2, 0.0}};
    const ImageMean mean = image_mean(render_here(scene, 1).film);
    const double expected = 2e6 * std::sqrt(0.5) / 2e6; // over the sensor to 1e-3 the same
    CAPTURE(mean.value.x, mean.standard_error->x);
    CHECK(mean.standard_error->x < 0.02 * expected);
    CHECK(std::abs(mean.value.x - expected) < 4.0 * mean.standard_error->x + 1e-3 * expected);
}

// A piece of ground 10,000 wide to each side keeps rays off itself by 0.08, of which a sensor of 1000 in it knows
// nothing.
TEST_CASE("a sensor in wide ground counts what begins above it", "[gpu][counted][long]") {
    const Scene scene = parse("<periodic x='-1e4 1e4' z='-1e4 1e4'/><surfaces><rectangle lookAt='0 1 0' width='2e4' "
                              "height='2e4'/></surfaces><light y='1' r='1' g='1' b='1'/><irradiance lookAt='0 1 0' "
                              "width='1000' height='1000'/><integrator>lightTracing</integrator><width>8</width>"
                              "<height>8</height><rayPerPixelCount>16384</rayPerPixelCount>");
    const ImageMean mean = image_mean(render_here(scene, 1).film);
    CAPTURE(mean.value.x, mean.standard_error->x);
    CHECK(mean.standard_error->x < 0.03); // one of 400 particles comes to it
    CHECK(std::abs(mean.value.x - 1.0) < 4.0 * mean.standard_error->x);
}

TEST_CASE("particles are counted behind glass", "[gpu][counted][long]") {
    Scene scene = sensor({0.0, -2.0, 0.0}, up_y, {6.0, 6.0}, 1, 1 << 12);
    scene.surfaces = {surface_of(left_ball, MaterialKind::dielectric, 0.0)};
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

// Fluxes out of the top and the ground, and what is absorbed between, each by its own render.
TEST_CASE("what comes into a domain leaves it, or stays", "[gpu][counted][long]") {
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

TEST_CASE("particles counted have the same bits however they are worked on", "[gpu][counted][long]") {
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
