// Domains that repeat: against closed forms, domains that hold the same several times, and the reference, which unfolds
// them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "camera_view.h"
#include "error.h"
#include "loaded_medium.h"
#include "method.h"
#include "period.h"
#include "render_limits.h"
#include "scene_hash.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/test_device.h"
#include "support/test_meshes.h"
#include "support/thorough.h"
#include "tests/reference/reference.h"
#include "tests/reference/transport.h"

using namespace vkvol;
using Catch::Contains;

namespace {

// From above, aslant, so that rays pass several domains of ten across.
Scene above(const Volume& volume, double half = 5.0) {
    Scene scene = scene_of(volume, 30.0, 16, 40.0, glm::dvec3(0.0), {-25.0, 30.0, 0.0});
    scene.background = {0.1, 0.2, 0.4};
    scene.lights = {DirectionalLight{glm::normalize(glm::dvec3(0.8, 0.5, -0.3)), {1.5, 1.2, 1.0}}};
    scene.settings.integrator = "ratioTracking";
    scene.settings.spp = 128;
    scene.periodic = Periodic{{-half, 0.0, -half}, {half, 0.0, half}};
    return scene;
}

Scene flux_through(double height, bool from_above, glm::dvec2 size, int across, std::uint32_t spp) {
    Scene scene;
    scene.camera.projection = Projection::irradiance;
    scene.camera.position = {0.0, height, 0.0};
    look_along(scene.camera, from_above ? up_y : -up_y, {0.0, 0.0, 1.0});
    scene.camera.size = size;
    scene.picture = {across, across, 0.0, 0.0, double(across), double(across)};
    scene.settings.spp = spp;
    return scene;
}

// Along x and z, as many times as `copies` says; what was there is there again in each.
Scene repeated(Scene scene, glm::ivec2 copies) {
    const Scene one = scene;
    const glm::dvec3 size = one.periodic->size();
    for (int i = 0; i < copies.x; ++i)
        for (int k = 0; k < copies.y; ++k) {
            if (i == 0 && k == 0)
                continue;
            const glm::dvec3 shift = size * glm::dvec3(i, 0, k);
            for (Volume volume : one.volumes) {
                volume.transform = glm::translate(glm::dmat4(1.0), shift) * volume.transform;
                scene.volumes.push_back(volume);
            }
            for (Surface surface : one.surfaces)
                if (auto* ball = std::get_if<BallSurface>(&surface.shape)) {
                    ball->center += shift;
                    scene.surfaces.push_back(surface);
                }
        }
    scene.periodic->high += size * glm::dvec3(copies.x - 1, 0, copies.y - 1);
    return scene;
}

} // namespace

TEST_CASE("a box that fills a domain that repeats is an infinite slab", "[gpu][image][periodic]") {
    const double tau = GENERATE(1.0, 5.0), mu0 = GENERATE(1.0, 0.5);
    const reference::SlabSolution beam = reference::slab_in_beam(1.0, tau, mu0, tau < 2.0 ? 400 : 800);
    for (const bool below : {false, true}) {
        Scene scene = flux_through(below ? -2.0 : 1.0, below, {0.7, 0.7}, 8, 1024);
        scene.volumes = {medium(Box{{0.0, -0.5, 0.0}, glm::dvec3(1.0)}, tau, 1.0)};
        scene.periodic = Periodic{{-0.5, 0.0, -0.5}, {0.5, 0.0, 0.5}};
        scene.settings.integrator = "ratioTracking";
        scene.lights = {DirectionalLight{{std::sqrt(1.0 - mu0 * mu0), mu0, 0.0}, Rgb(1.0)}};
        check_means(scene, below ? beam.transmitted : beam.reflected, fmt::format("slab {}, {}, {}", tau, mu0, below));
    }
}

TEST_CASE("a ray through a domain that repeats passes as much as its slant says", "[gpu][image][periodic]") {
    for (const double pitch : {-90.0, -30.0, -4.0}) {
        Scene scene;
        scene.volumes = {medium(Box{{0.0, 0.0, 0.0}, glm::dvec3(2.0)}, 0.05, 0.0)};
        scene.periodic = Periodic{{-1.0, 0.0, -1.0}, {1.0, 0.0, 1.0}};
        scene.camera.projection = Projection::orthographic;
        scene.camera.view_height = 1e-2;
        scene.camera.position = {17.0, 9.0, -5.0};
        scene.camera.pitch = pitch;
        scene.camera.yaw = 35.0;
        scene.picture = {4, 4, 0.0, 0.0, 4.0, 4.0};
        scene.background = Rgb(1.0);
        scene.settings.spp = 2000;
        const double depth = 0.05 * 2.0 / std::sin(glm::radians(-pitch));
        for (const int flight : {FREE_FLIGHT_ANALYTIC, FREE_FLIGHT_DELTA}) {
            scene.settings.integrator = "deltaTracking";
            scene.settings.choices.free_flight = flight;
            const std::vector<double> p(16, std::exp(-depth));
            CHECK_AGREEMENT(agree_with_escapes(render_here(scene, 1).film, p, Rgb(1.0), Rgb(0.0), "slant"));
        }
    }
}

// Along an axis that does not repeat a mesh is as high as it is.
TEST_CASE("meshes in a domain that repeats are whole", "[gpu][image][periodic][mesh]") {
    const MeshFiles tower = write_mesh(make_box({-2.0, -5.0, -3.0}, {4.0, 5.0, 1.0}, 1));
    Scene scene;
    scene.volumes = {medium(tower, 0.2, 0.0)};
    scene.periodic = Periodic{{-10.0, 0.0, -10.0}, {10.0, 0.0, 10.0}};
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = 1e-2;
    scene.camera.position = {21.0, 50.0, -20.5}; // above another domain's
    scene.camera.pitch = -90.0;
    scene.picture = {4, 4, 0.0, 0.0, 4.0, 4.0};
    scene.background = Rgb(1.0);
    scene.settings.spp = 2000;
    const Film seen = render_here(by(scene, "deltaTracking"), 1).film;
    CHECK_AGREEMENT(agree_with_escapes(seen, std::vector<double>(16, std::exp(-2.0)), Rgb(1.0), Rgb(0.0), "tower"));
    // Light upon the ground below it, by particles.
    Scene ground = flux_through(-6.0, true, {2.0, 2.0}, 2, 4096);
    ground.volumes = scene.volumes;
    ground.periodic = scene.periodic;
    ground.camera.position.x = 1.0;
    ground.camera.position.z = -1.0;
    ground.lights = {DirectionalLight{up_y, Rgb(1.0)}};
    check_means(by(ground, "lightTracing"), std::exp(-2.0), "below a tower");
}

TEST_CASE("a plane that was turned lies along a domain that repeats", "[cpu][method][periodic]") {
    const Scene scene =
        parse(R"(<periodic x="-5 5" z="-5 5"/><surfaces><plane y="3"><transform><rotate x="1" angle="180"/>
        </transform></plane></surfaces><backgroundColor r="1"/>)");
    CHECK_NOTHROW(check_scene_limits(scene));
}

// Far away over the horizon, and after a thousand domains.
TEST_CASE("how often a ray is moved across costs it an ulp each time", "[gpu][image][periodic]") {
    Scene scene;
    scene.volumes = {medium(Box{{0.0, 0.0, 0.0}, {0.5, 2.0, 2.0}}, 0.004, 0.0)};
    scene.periodic = Periodic{{-1.0, 0.0, -1.0}, {1.0, 0.0, 1.0}};
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = 1e-3;
    scene.camera.position = {0.0, 1.0, 0.0};
    scene.camera.pitch = -0.05; // 2300 to the bottom
    scene.camera.yaw = -90.0;   // along x
    scene.picture = {4, 4, 0.0, 0.0, 4.0, 4.0};
    scene.background = Rgb(1.0);
    scene.settings.spp = 1;
    scene.settings.integrator = "densitySampling"; // its transmittance is exact
    const double length = 2.0 / std::sin(glm::radians(0.05)), depth = 0.004 * 0.25 * length;
    // The ray's slope, 9e-4, is known to 6e-8, its height to 6e-8 of 1; all 1146 domains but the last are whole.
    for (const glm::vec3& pixel : render_here(scene, 1).film.mean)
        CHECK(pixel.x == Approx(std::exp(-depth)).epsilon(0.004 * 0.5 + 3e-4));
}

TEST_CASE("domains that repeat equal the reference's, unfolded", "[gpu][image][periodic][long]") {
    std::vector<std::pair<std::string, Scene>> all;
    Scene scene = above(thin_cloud());
    all.emplace_back("a cloud", scene);
    scene.settings.filter = Filter::nearest;
    scene.periodic = Periodic{{-4.0, 0.0, -4.2}, {4.5, 0.0, 4.0}}; // cuts some of it off
    all.emplace_back("a cloud, cut", scene);
    scene.periodic->low.z = scene.periodic->high.z = 0.0;
    all.emplace_back("rows of clouds along x", scene);
    scene.periodic = Periodic{{-4.0, -5.0, 0.0}, {4.5, 5.0, 0.0}};
    scene.camera.position = {1.0, 3.0, -2.0};
    all.emplace_back("clouds along x and y, from within", scene);
    Scene balls = above(medium(Sphere{{1.0, 0.5, 0.0}, 2.5}, 0.7, {0.95}, 0.6));
    balls.lights = {SunLight{glm::normalize(glm::dvec3(-0.3, 0.9, 0.2)), {3.0, 2.8, 2.0}, 10.0}};
    all.emplace_back("balls under a sun with an extent", balls);
    Volume leaning = medium(Box{{0.0, 0.0, 0.0}, {4.0, 2.0, 3.0}}, 0.9, 0.9, -0.3);
    leaning.transform = glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1.0, 0.3, -0.5)));
    leaning.Le = {0.3, 0.1, 0.0};
    all.emplace_back("boxes that lean and glow", above(leaning));
    Scene colors = above(leaning);
    colors.volumes.front().sigma_s = {0.9, 0.5, 0.3};
    all.emplace_back("of colours", colors);
    Scene several = above(thin_cloud());
    several.volumes.push_back(medium(Sphere{{-1.0, 1.5, 2.0}, 2.0}, 0.8, 0.8));
    all.emplace_back("several", several);
    Volume thinning = medium(Box{{0.0, 0.0, 0.0}, {10.0, 6.0, 10.0}}, 0.8, 0.9, 0.3);
    thinning.layers = Layers{1, -3.0, 3.0, 1.5, -3.0};
    all.emplace_back("an exponential, in closed forms", above(thinning));
    Scene in_air = above(thin_cloud());
    in_air.volumes.push_back(medium(Everywhere{}, 0.05, 0.9, 0.3));
    in_air.volumes.back().layers = Layers{1, -6.0, 30.0, 8.0, -6.0};
    all.emplace_back("clouds in air", in_air);
    for (const auto& [name, each] : in_turn(all, 0, 4))
        check_against_reference(each, name);
}

// Half a turn leaves 1e-16 where there should be nothing, of what reaches 1e20 far.
TEST_CASE("air that is turned reaches as far as air that is not", "[cpu][periodic]") {
    for (const double degrees : {90.0, 180.0, 270.0}) {
        CAPTURE(degrees);
        Volume air = medium(Everywhere{}, 0.05, 0.9);
        air.layers = Layers{1, 0.0, 20.0, 1.0, 0.0};
        air.transform = glm::rotate(glm::dmat4(1.0), glm::radians(degrees), glm::dvec3(1.0, 0.0, 0.0));
        Scene scene = above(air);
        if (degrees != 180.0)
            scene.periodic = Periodic{{-5.0, -5.0, 0.0}, {5.0, 5.0, 0.0}};
        const Assets assets = load_assets(scene, choose_method(scene));
        const shared::PeriodParams period = make_period(scene, assets.media, glm::dvec3(0.0));
        const int axis = degrees == 180.0 ? 1 : 2;
        const double top = degrees == 90.0 ? 20.0 : -20.0;
        // make_period goes beyond by 1e-5 of 20, and 2^-20 of it.
        CHECK(period.range_low[axis] == Approx(std::min(top, 0.0)).margin(3e-4));
        CHECK(period.range_high[axis] == Approx(std::max(top, 0.0)).margin(3e-4));
    }
}

TEST_CASE("all unbiased estimators agree where a domain repeats", "[gpu][image][periodic][hard][long]") {
    Scene scene = above(thin_cloud());
    scene.volumes.front().Le = Rgb(0.2);
    const Film reference = render_reference(scene, 2);
    const std::vector<Combination> all = unbiased_combinations(scene);
    REQUIRE(all.size() > 20);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!thorough() && i % 20 != 3)
            continue;
        Scene other = scene;
        other.settings.choices = all[i].choices;
        CHECK_AGREEMENT(agree(render_here(other, 1).film, reference, all[i].name));
    }
}

TEST_CASE("a domain that holds the same twice is the same", "[gpu][image][periodic]") {
    const Scene balls = above(medium(Sphere{{1.0, 0.5, 0.0}, 2.5}, 0.7, 0.9, 0.6));
    CHECK_AGREEMENT(agree(render_here(repeated(balls, {2, 1}), 1).film, render_here(balls, 2).film, "balls"));
    Scene solid = balls;
    solid.surfaces.emplace_back().shape = BallSurface{{-1.5, -1.0, 2.0}, 1.5};
    solid.surfaces.back().material.color = {0.8, 0.4, 0.2};
    solid.surfaces.emplace_back().shape = PlaneSurface{{0.0, -3.0, 0.0}, up_y};
    solid.surfaces.back().material.color = Rgb(0.5);
    CHECK_AGREEMENT(agree(render_here(repeated(solid, {2, 2}), 1).film, render_here(solid, 2).film, "and solid ones"));
    for (const MaterialKind kind : in_turn(std::vector{MaterialKind::mirror, MaterialKind::dielectric}, 1, 2)) {
        solid.surfaces.front().material.kind = kind;
        CHECK_AGREEMENT(agree(render_here(repeated(solid, {1, 2}), 1).film, render_here(solid, 2).film, "and shiny"));
    }
    solid.volumes.clear();
    CHECK_AGREEMENT(agree(render_here(repeated(solid, {2, 1}), 1).film, render_here(solid, 2).film, "no media"));
}

// Where the domain begins is for its author to say.
TEST_CASE("a domain may be moved by its own size, and its camera by any number of them",
          "[gpu][image][periodic][long]") {
    const Scene scene = above(thin_cloud());
    const Film film = render_here(scene, 1).film;
    Scene far = scene;
    far.camera.position += glm::dvec3(40.0, 0.0, -70.0);
    CHECK_AGREEMENT(agree(film, render_here(far, 2).film, "from afar"));
    Scene halved = scene; // the same matter, cut elsewhere: what the faces cut off has a copy on the other side
    halved.volumes.push_back(scene.volumes.front());
    halved.volumes.back().transform = glm::translate(glm::dmat4(1.0), glm::dvec3(-10.0, 0.0, 0.0));
    halved.periodic = Periodic{{-9.0, 0.0, -5.0}, {1.0, 0.0, 5.0}};
    CHECK_AGREEMENT(agree(film, render_here(halved, 3).film, "cut elsewhere"));
}

TEST_CASE("what is flat repeats as well", "[gpu][image][periodic][surfaces]") {
    // Aslant, two domains wide and four deep, a quarter of each of which shines.
    const Scene scene = parse_scene(R"(<options><periodic x="-1 1" z="-1 1"/>
        <surfaces><rectangle lookAt="0 1 0"><emission r="1" g="1" b="1"/></rectangle></surfaces>
        <camera y="5" pitch="-30" projection="orthographic" viewHeight="4"/><width>8</width><height>8</height>
        <rayPerPixelCount>256</rayPerPixelCount></options>)",
                                    "flat.xml");
    const double error = std::sqrt(0.25 * 0.75 / (64.0 * 256.0));
    CHECK(std::abs(mean_of(render_here(scene, 1).film) - 0.25) < 4.0 * error); // one in 16,000
}

TEST_CASE("both schedules go through a domain that repeats alike", "[gpu][image][periodic][determinism][long]") {
    Scene scene = above(thin_cloud());
    scene.settings.spp = 16;
    Scene solid = scene;
    solid.surfaces.emplace_back().shape = BallSurface{{-1.5, -1.0, 2.0}, 1.5};
    solid.surfaces.emplace_back().shape = PlaneSurface{{0.0, -5.0, 0.0}, up_y};
    Scene tentative = solid;
    tentative.settings.integrator = "ratioNEE";
    Scene layered = scene;
    layered.layers = layer_depth | layer_position | layer_indirect;
    Scene all = tentative;
    all.layers = layered.layers;
    for (const Scene& each : thorough() ? std::vector{scene, solid, tentative, layered} : std::vector{all}) {
        RenderJob fused, staged;
        fused.plan.schedule = Schedule::fused;
        staged.plan.schedule = Schedule::staged;
        CHECK((same_bits(render_here(each, 1, fused).film, render_here(each, 1, staged).film) ||
               !test_device().is_cpu()));
    }
}

TEST_CASE("depths count from the eye, however many domains are between", "[gpu][image][periodic][aovs]") {
    Scene scene;
    scene.volumes = {medium(Box{{0.0, -1.0, 0.0}, {2.0, 0.5, 2.0}}, 1e5, 0.5)};
    scene.volumes.push_back(medium(Sphere{{0.0, 6.0, 0.0}, 0.1}, 1e-9, 0.5)); // so that rays enter far above
    scene.periodic = Periodic{{-1.0, 0.0, -1.0}, {1.0, 0.0, 1.0}};
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = 1e-2;
    scene.camera.position = {17.0, 9.25, -5.0};
    scene.camera.pitch = -20.0;
    scene.camera.yaw = 35.0;
    scene.picture = {2, 2, 0.0, 0.0, 2.0, 2.0};
    scene.layers = layer_depth;
    scene.settings.integrator = "deltaTracking";
    scene.settings.spp = 4;
    const RenderResult result = render_here(scene, 1);
    const FilmLayer* depth = result.film.layer("depth");
    REQUIRE(depth);
    for (const glm::vec3& pixel : depth->mean)
        CHECK(pixel.x == Approx(10.0 / std::sin(glm::radians(20.0))).epsilon(1e-3));
}

TEST_CASE("a level ray through nothing is cut after a million domains, and counted", "[gpu][periodic][long]") {
    Scene scene;
    scene.volumes = {medium(Sphere{{0.0, 0.5, 0.0}, 0.1}, 1.0, 0.5), medium(Sphere{{0.0, -0.5, 0.0}, 0.1}, 1.0, 0.5)};
    scene.periodic = Periodic{{-1.0, 0.0, -1.0}, {1.0, 0.0, 1.0}};
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = 1e-3;
    scene.camera.yaw = -90.0; // along x
    scene.picture = {2, 1, 0.0, 0.0, 2.0, 1.0};
    scene.background = Rgb(1.0);
    scene.settings.integrator = "deltaTracking";
    RenderJob job;
    job.crop = {0, 2, 0, 1};
    job.disk_cache = false;
    const RenderResult result = render(test_device(), scene, job);
    CHECK(result.counts.step_caps == 2);
    CHECK(result.film.mean[0] == glm::vec3(0.0f));
}

// Which is everywhere, but nothing: paths that leave would go on to it.
TEST_CASE("media that hold nothing keep no path in a domain that repeats", "[gpu][image][periodic]") {
    Scene scene = scene_of(medium(Sphere{{0.0, 0.0, 0.0}, 0.5}, 1.0, 1.0), 2.0, 8);
    scene.volumes.push_back(medium(Everywhere{}, 0.0, 0.0));
    scene.periodic = Periodic{{-1.0, 0.0, -1.0}, {1.0, 0.0, 1.0}};
    scene.camera.pitch = -80.0;
    scene.background = Rgb(1.0);
    scene.settings.roulette_threshold = 0.0;
    const RenderResult result = render_here(scene, 1);
    CHECK(result.counts.step_caps == 0);
    for (const glm::vec3& pixel : result.film.mean)
        CHECK(pixel.x == Approx(1.0));
}

TEST_CASE("a domain that repeats and holds nothing shows what is beyond", "[gpu][image][periodic][long]") {
    Scene scene = scene_of(medium(Box{{0.0, 0.0, 0.0}, {2.0, 1.0, 2.0}}, 0.0, 0.0), 2.0, 4);
    scene.periodic = Periodic{{-1.0, 0.0, -1.0}, {1.0, 0.0, 1.0}};
    scene.background = {1.0, 2.0, 0.5};
    for (const bool has_volume : {true, false}) {
        if (!has_volume)
            scene.volumes.clear();
        const Film film = render_here(scene, 1).film;
        for (const glm::vec3& pixel : film.mean)
            CHECK(glm::distance(pixel, glm::vec3(scene.background)) < 1e-5f);
        // What comes to a plane, by rays and by particles.
        Scene flux = scene;
        flux.camera = {};
        flux.camera.projection = Projection::irradiance;
        flux.camera.size = {2.0, 2.0};
        look_along(flux.camera, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0});
        flux.picture = {1, 1, 0.0, 0.0, 1.0, 1.0};
        flux.background = Rgb(0.0);
        flux.lights = {DirectionalLight{glm::normalize(glm::dvec3(0.0, 1.0, std::sqrt(3.0))), Rgb(1.0, 2.0, 1.0)}};
        for (const char* integrator : {"ratioTracking", "lightTracing"}) {
            CAPTURE(integrator, has_volume);
            flux.settings.integrator = integrator;
            flux.settings.spp = 256;
            CHECK_AGREEMENT(agree_with_means(render_here(flux, 2).film, {Rgb(0.5, 1.0, 0.5)}, integrator));
        }
    }
}

TEST_CASE("domains that repeat in scene files", "[cpu][xml][periodic]") {
    const Scene scene = parse(R"(<sphere/><periodic x="-1 1" z="0 2.5"/>)");
    REQUIRE(scene.periodic);
    CHECK(scene.periodic->low == glm::dvec3(-1.0, 0.0, 0.0));
    CHECK(scene.periodic->high == glm::dvec3(1.0, 0.0, 2.5));
    CHECK_FALSE(parse("<sphere/>").periodic);
    CHECK(scene_hash(scene) != scene_hash(parse(R"(<sphere/><periodic x="-1 1" z="0 2"/>)")));
    CHECK_THAT(error_of("<periodic/>"), Contains("repeats along no axis"));
    CHECK_THAT(error_of("<periodic x='1'/>"), Contains("where the domain begins and where it ends"));
    CHECK_THAT(error_of("<periodic x='1 1'/>"), Contains("where the domain begins and where it ends"));
    CHECK_THAT(error_of("<periodic w='1 2'/>"), Contains("unknown attribute 'w'"));
}

// As much of a beam goes from one direction into another as the other way.
TEST_CASE("radiances of a domain that repeats are reciprocal", "[gpu][image][periodic][long]") {
    const glm::dvec3 steep(0.6, 0.8, 0.0), flat(-std::sqrt(0.75), 0.5, 0.0);
    const auto reflected = [&](glm::dvec3 sun, glm::dvec3 view) {
        Scene scene = above(thin_cloud());
        scene.background = Rgb(0.0);
        scene.lights = {DirectionalLight{sun, Rgb(1.0)}};
        scene.camera.projection = Projection::orthographic;
        scene.camera.view_height = 10.0 * view.y; // all of a domain, once
        scene.camera.position = 30.0 * view;
        look_along(scene.camera, -view, up_y);
        const int high = int(std::lround(20.0 * view.y));
        scene.picture = {20, high, 0.0, 0.0, 20.0, double(high)};
        scene.settings.spp = 1024;
        const Film film = render_here(scene, 1).film;
        double mean = 0.0, variance = 0.0;
        const auto pixels = double(film.mean.size());
        for (std::size_t i = 0; i < film.mean.size(); ++i) {
            mean += film.mean[i].x / pixels;
            variance += film.variance[i].x / (pixels * pixels);
        }
        return glm::dvec2(mean, std::sqrt(variance)) / sun.y;
    };
    const glm::dvec2 there = reflected(steep, flat), back = reflected(flat, steep);
    CAPTURE(there.x, back.x, there.y, back.y);
    CHECK(std::abs(there.x - back.x) < 4.0 * std::hypot(there.y, back.y));
    CHECK(std::hypot(there.y, back.y) < 0.02 * there.x);
}

TEST_CASE("what a domain that repeats cannot have is said", "[cpu][method][periodic]") {
    Scene scene = above(thin_cloud());
    CHECK(choose_method(scene).nee == NEE_COLLISIONS);
    scene.settings.integrator.clear();
    CHECK(choose_method(scene).nee == NEE_COLLISIONS); // no lattice goes across
    scene.settings.integrator = "bidirectional";
    CHECK_THROWS_WITH(choose_method(scene), Contains("a camera sees all domains that repeat"));
    scene.settings.integrator = "ratioTracking";
    scene.lights.push_back(PointLight{{1.0, 2.0, 3.0}, Rgb(30.0)});
    CHECK_THROWS_WITH(load_assets(scene, choose_method(scene)), Contains("would stand in every domain"));
    scene.lights.pop_back();
    scene.surfaces.emplace_back().shape = PlaneSurface{{0.0, -3.0, 0.0}, glm::normalize(glm::dvec3(0.1, 1.0, 0.0))};
    CHECK_THROWS_WITH(load_assets(scene, choose_method(scene)), Contains("has to lie along all axes"));
}

TEST_CASE("paths of a domain that repeats come to an end", "[cpu][method][periodic]") {
    Scene scene = above(medium(Sphere{{0.0, 0.0, 0.0}, 2.0}, 1.0, 1.0));
    const auto loads = [&] { load_assets(scene, choose_method(scene)); };
    CHECK_NOTHROW(loads()); // upwards and downwards
    scene.periodic->low.y = -5.0;
    scene.periodic->high.y = 5.0;
    CHECK_THROWS_WITH(loads(), Contains("keeps its paths for ever"));
    scene.settings.max_depth = 10;
    CHECK_NOTHROW(loads());
    scene.settings.max_depth.reset();
    scene.surfaces.emplace_back().shape = BallSurface{{3.0, 3.0, 3.0}, 1.0};
    scene.surfaces.back().material.color = Rgb(0.9);
    CHECK_NOTHROW(loads());
    scene.surfaces.back().material.color = {0.9, 0.9, 1.0};
    CHECK_THROWS_WITH(loads(), Contains("keeps its paths for ever"));
    scene.surfaces.back().material = {MaterialKind::conductor, Rgb(1.0)};
    CHECK_NOTHROW(loads());
    scene.surfaces.clear();
    scene.volumes.push_back(medium(Sphere{{4.0, 0.0, 0.0}, 1.0}, 0.01, 0.5));
    CHECK_NOTHROW(loads());
    scene.volumes = {medium(write_grid(cloud_grid()), 1.0, 1.0)};
    CHECK_THROWS_WITH(loads(), Contains("keeps its paths for ever"));
    scene.volumes.back().map.is_transfer = true;
    scene.volumes.back().map.points = {{0.0, 0.0, Rgb(1.0)}, {1.0, 1.0, Rgb(1.0)}};
    CHECK_THROWS_WITH(loads(), Contains("keeps its paths for ever"));
    scene.volumes.back().map.points.back().albedo = Rgb(0.3);
    CHECK_NOTHROW(loads());
}

TEST_CASE("paths of a single scattering end where nothing absorbs, too", "[cpu][method][periodic]") {
    Scene scene = above(medium(Sphere{{0.0, 0.0, 0.0}, 2.0}, 1.0, 1.0));
    scene.periodic->low.y = -5.0;
    scene.periodic->high.y = 5.0;
    Scene fog = above(medium(Everywhere{}, 1.0, 1.0));
    fog.periodic.reset();
    for (Scene* endless : {&scene, &fog}) {
        CHECK_THROWS_WITH(load_assets(*endless, choose_method(*endless)), Contains("keeps its paths for ever"));
        for (const int scattering : {SCATTERING_SINGLE, SCATTERING_NONE}) {
            endless->settings.choices.scattering = scattering;
            CHECK_NOTHROW(load_assets(*endless, choose_method(*endless)));
        }
    }
}

TEST_CASE("a colour that nothing collides with keeps no path for ever", "[cpu][method][periodic]") {
    Scene fog = above(medium(Everywhere{}, 1.0, 1.0));
    fog.periodic.reset();
    fog.volumes.front().sigma_a = {0.1, 0.1, 0.0};
    CHECK_THROWS_WITH(load_assets(fog, choose_method(fog)), Contains("keeps its paths for ever"));
    fog.volumes.front().sigma_s = {1.0, 1.0, 0.0};
    CHECK_NOTHROW(load_assets(fog, choose_method(fog)));
}
