// Layers besides radiance: their sums are the picture, and each is what a scene of its own would show, or a closed
// form.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

#include "checkpoint.h"
#include "error.h"
#include "film_channels.h"
#include "image_io.h"
#include "layer_plan.h"
#include "merge.h"
#include "scene_hash.h"
#include "shared/constants.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/test_device.h"
#include "support/thorough.h"
#include "tests/reference/reference.h"

using namespace vkvol;
using Catch::Contains;

namespace {

constexpr unsigned of_light = layer_background | layer_emission | layer_direct | layer_indirect;
constexpr unsigned everything = 2 * layer_normal - 1;

// Two media, one of which glows, under a sun in a group, a lamp in another, and a sky in none.
Scene busy(const std::string& integrator, std::uint32_t spp) {
    Volume cloud = medium(write_grid(cloud_grid()), 1.0, 0.8, 0.4);
    cloud.name = "cloud";
    Volume ball = medium(Sphere{{1.5, 0.0, 0.0}, 2.0}, 0.6, 0.5);
    ball.Le = {0.5, 0.2, 0.1};
    Scene scene = scene_of(cloud, 13.0, 16, 25.0, glm::dvec3(0.0), {10.0, 25.0, -5.0});
    scene.volumes.push_back(ball);
    scene.background = {0.1, 0.2, 0.4};
    DirectionalLight sun = sunlight();
    sun.group = "sun";
    SphereLight lamp{{4.5, 5.5, 2.0}, 1.2, {14.0, 10.0, 6.0}};
    lamp.group = "lamp";
    scene.lights = {sun, lamp, SunLight{glm::normalize(glm::dvec3(1.0, 2.0, 0.5)), {3.0, 2.5, 2.0}, 30.0}};
    scene.settings.integrator = integrator;
    scene.settings.spp = spp;
    return scene;
}

// A scene of one medium, with what else there may be to sum.
Scene plain(const std::string& integrator, std::uint32_t spp) {
    Scene scene = busy(integrator, spp);
    scene.volumes.pop_back();
    scene.volumes.front().Le = {0.5, 0.2, 0.1};
    return scene;
}

const FilmLayer& layer_of(const Film& film, std::string_view name) {
    const FilmLayer* layer = film.layer(std::string(name));
    INFO(name);
    REQUIRE(layer);
    return *layer;
}

Film as_film(Film film, const std::string& name) {
    const FilmLayer& layer = layer_of(film, name);
    film.mean = layer.mean;
    film.variance = layer.variance;
    return film;
}

// The same sums of the same contributions, in another order: each addition rounds by 2^-24 of what there is, of a path
// with N of them at most N 2^-24 of the sum of their magnitudes. N is below 1000 here, and what is negative, in the
// corrections of a cache, no more than what is positive.
void check_sum(const Film& film, const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < film.pixel_count(); ++i)
        for (int channel = 0; channel < 3; ++channel) {
            double sum = 0.0, magnitude = 0.0;
            for (const std::string& name : names) {
                sum += double(layer_of(film, name).mean[i][channel]);
                magnitude += std::abs(double(layer_of(film, name).mean[i][channel]));
            }
            CAPTURE(i, channel);
            REQUIRE(std::abs(sum - film.mean[i][channel]) <= 2.0 * 1000.0 * 0x1p-24 * magnitude);
        }
}

// By other kernels from the same random numbers: the same bits, but where a GPU's compiler may round them differently.
// There the pictures share their noise, so that no more than an error beyond it is seen; what has no variance is not
// judged.
void check_same(const Film& film, const Film& before, const std::string& name) {
    INFO(name);
    if (test_device().is_cpu())
        CHECK((film.mean == before.mean && film.variance == before.variance));
    else if (!film.variance.empty())
        CHECK_AGREEMENT(agree(film, before, name));
}

void check_same_layers(const Film& film, const Film& before) {
    REQUIRE(film.layers.size() == before.layers.size());
    for (const FilmLayer& layer : film.layers)
        check_same(as_film(film, layer.name), as_film(before, layer.name), layer.name);
}

// All rays run along -z through one point, but for a millionth of their length.
Scene beam(const Volume& volume, double distance, std::uint32_t spp) {
    Scene scene = scene_of(volume, 1e-6, 16);
    scene.camera.position = {0.0, 0.0, distance};
    scene.settings.spp = spp;
    return scene;
}

std::vector<Rgb> everywhere(const Film& film, const Rgb& value) {
    return std::vector<Rgb>(film.pixel_count(), value);
}

} // namespace

TEST_CASE("layers leave the picture its bits, and sum up to it", "[gpu][image][aovs]") {
    const std::vector<std::string> integrators = {
        "ratioNEE",         "cachedRatioTracking", "ratioTracking",
        "weightedTracking", "deltaTracking",       "ratioTracking:emission=steps",
        "regularTracking",  "rayMarching",         "ratioTracking:mis=phase"};
    const std::string integrator = GENERATE_REF(from_range(in_turn(integrators, 0, 5)));
    for (const bool several : {false, true}) {
        if (several && integrator != "ratioTracking" && integrator != "ratioNEE" && integrator != "rayMarching")
            continue; // how light gets its label among several media goes by where flights meet it, of which these are
                      // all
        Scene scene = several ? busy("", 32) : plain("", 32);
        const std::size_t colon = integrator.find(':');
        scene.settings.integrator = integrator.substr(0, colon);
        if (integrator.ends_with("steps"))
            scene.settings.choices.emission = EMISSION_AT_STEPS;
        if (integrator.ends_with("phase"))
            scene.settings.choices.mis = MIS_PHASE;
        const Film before = render_here(scene, 3).film;
        scene.layers = everything;
        const Film film = render_here(scene, 3).film; // by both schedules
        CAPTURE(integrator, several);
        check_same(film, before, integrator);
        check_sum(film, {"background", "emission", "direct", "indirect"});
        check_sum(film, {"group.none", "group.sun", "group.lamp"});
        if (several)
            check_sum(film, {"background", "medium.cloud", "medium.volume2"});
        else
            check_sum(film, {"background", "medium.cloud"});
    }
}

TEST_CASE("distances drawn for a light's sake are in layers, too", "[gpu][image][aovs]") {
    Scene scene = scene_of(medium(Sphere{{0.0, 0.0, 0.0}, 3.0}, 0.3, 0.8), 7.0, 16);
    PointLight lamp{{0.0, 2.0, 0.5}, Rgb(20.0)};
    lamp.group = "lamp";
    scene.lights = {lamp};
    scene.background = Rgb(0.1);
    scene.settings.spp = 32;
    scene.settings.choices.distance = DISTANCE_MIXED;
    scene.settings.choices.transmittance = GENERATE(TRANSMITTANCE_ANALYTIC, TRANSMITTANCE_RATIO);
    scene.settings.choices.nee = NEE_COLLISIONS;
    scene.layers = everything;
    const Film film = render_here(scene, 4).film;
    check_sum(film, {"background", "emission", "direct", "indirect"});
    check_sum(film, {"group.none", "group.lamp"});
    check_sum(film, {"background", "medium.volume1"});
}

TEST_CASE("layers are what scenes of their own show", "[gpu][image][aovs]") {
    Scene scene = plain("ratioTracking", 256);
    scene.layers = of_light | layer_groups;
    const Film film = render_here(scene, 5).film;
    Scene alone = scene;
    alone.layers = 0;
    alone.background = Rgb(0.0);
    alone.volumes.front().Le = Rgb(0.0);
    alone.lights.resize(1);
    CHECK_AGREEMENT(agree(as_film(film, "group.sun"), render_here(alone, 6).film, "the sun's group alone"));
    alone = scene;
    alone.layers = of_light;
    alone.settings.max_depth = 1; // nothing is scattered twice
    const Film once = render_here(alone, 7).film;
    CHECK_AGREEMENT(agree(as_film(film, "direct"), as_film(once, "direct"), "direct light"));
    CHECK(std::all_of(layer_of(once, "indirect").mean.begin(), layer_of(once, "indirect").mean.end(),
                      [](const glm::vec3& pixel) { return pixel == glm::vec3(0.0f); }));
    alone = scene;
    alone.layers = 0;
    alone.settings.choices.scattering = SCATTERING_NONE;
    const Film unscattered = render_here(alone, 8).film;
    Film sum = as_film(film, "background");
    for (std::size_t i = 0; i < sum.pixel_count(); ++i) {
        sum.mean[i] += layer_of(film, "emission").mean[i];
        sum.variance[i] += layer_of(film, "emission").variance[i]; // a path has but one of them: an upper bound
    }
    CHECK_AGREEMENT(agree(sum, unscattered, "light that was not scattered"));
}

TEST_CASE("what a medium sends out is in its layer", "[gpu][image][aovs]") {
    Volume red = medium(Sphere{{0.0, 0.0, 0.0}, 2.0}, 0.5, 0.0),
           blue = medium(Box{{1.0, 0.5, 0.3}, Rgb(3.0)}, 0.4, 0.0);
    red.Le = {1.0, 0.5, 0.0};
    blue.Le = {0.0, 0.5, 2.0};
    red.name = "red smoke";
    Scene scene = scene_of(red, 6.0, 16);
    scene.volumes.push_back(blue);
    scene.settings.spp = 512;
    scene.layers = layer_media;
    const Film film = render_here(scene, 5).film;
    scene.layers = 0;
    scene.volumes.back().Le = Rgb(0.0);
    CHECK_AGREEMENT(agree(as_film(film, "medium.red_smoke"), render_here(scene, 6).film, "one of two that glow"));
    scene.volumes.back() = blue;
    scene.volumes.back().name = red.name; // one layer for both
    scene.layers = layer_media;
    const Film shared = render_here(scene, 5).film;
    CHECK(shared.layers.size() == 1);
    check_sum(shared, {"medium.red_smoke"});
}

TEST_CASE("alpha of a homogeneous slab is 1 - exp(-tau)", "[gpu][image][aovs]") {
    const double tau = GENERATE(0.1, 1.0, 5.0);
    Scene scene = beam(slab(tau, 0.7), 3.0, 512);
    scene.layers = layer_alpha | layer_transmittance | layer_depth;
    for (const char* const integrator : {"ratioTracking", "weightedTracking", "spectralTracking", "rayMarching"}) {
        scene.settings.integrator = integrator;
        const Film film = render_here(scene, 4).film;
        // A ray collides, or it does not: of some pixels none may come through.
        const std::vector<double> through(film.pixel_count(), std::exp(-tau));
        CHECK_AGREEMENT(agree_with_escapes(as_film(film, "alpha"), through, Rgb(0.0), Rgb(1.0),
                                           fmt::format("alpha of {}, {}", tau, integrator)));
        CHECK_AGREEMENT(agree_with_escapes(as_film(film, "transmittance"), through, Rgb(1.0), Rgb(0.0),
                                           fmt::format("transmittance of {}, {}", tau, integrator)));
        CHECK_AGREEMENT(agree_with_escapes(as_film(film, "coverage"), through, Rgb(0.0), Rgb(1.0),
                                           fmt::format("coverage of {}, {}", tau, integrator)));
    }
    // Goes through: every sample has the value, without scattering that of the absorption alone.
    scene.settings.integrator = "densitySampling";
    const double absorbed = 0.3 * tau;
    const Film film = render_here(scene, 4).film;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        CHECK(layer_of(film, "alpha").mean[i].x == Approx(-std::expm1(-absorbed)).epsilon(1e-5));
        CHECK(layer_of(film, "coverage").mean[i].x == Approx(-std::expm1(-absorbed)).epsilon(1e-5));
    }
    scene.settings.integrator = "spectralTracking";
    scene.volumes.front().sigma_a *= Rgb(1.0, 0.5, 0.0);
    scene.volumes.front().sigma_s *= Rgb(1.0, 0.5, 0.2);
    const Rgb depth = scene.volumes.front().sigma_a + scene.volumes.front().sigma_s;
    const Film colored = render_here(scene, 4).film;
    CHECK_AGREEMENT(agree_with_means(as_film(colored, "transmittance"), everywhere(colored, glm::exp(-depth)),
                                     fmt::format("transmittance in colours, {}", tau)));
    const double mean = 1.0 - (std::exp(-depth.x) + std::exp(-depth.y) + std::exp(-depth.z)) / 3.0;
    CHECK_AGREEMENT(agree_with_means(as_film(colored, "alpha"), everywhere(colored, Rgb(mean)),
                                     fmt::format("grey alpha, {}", tau)));
}

TEST_CASE("the first collision in a slab is where its density has it", "[gpu][image][aovs]") {
    const double tau = GENERATE(0.5, 4.0), distance = GENERATE(3.0, 20000.0); // from afar rays begin before the medium
    const bool flat = GENERATE(false, true);
    Scene scene = beam(slab(tau, 0.7), distance, 1024);
    if (distance > 100.0) // of a slab that is not too wide for that
        scene.volumes.front() = medium(Box{{0.0, 0.0, -0.5}, {4.0, 4.0, 1.0}}, tau, 0.7);
    if (flat) {
        scene.camera.projection = Projection::orthographic;
        scene.camera.view_height = 1e-3;
    }
    scene.layers = layer_depth | layer_position | layer_albedo;
    const Film film = render_here(scene, 4).film;
    // Mean of an exponential that is cut at 1, of rate tau.
    const auto mean_below = [](double rate) { return 1.0 / rate - std::exp(-rate) / -std::expm1(-rate); };
    const double below = mean_below(tau);
    CHECK_AGREEMENT(agree_with_means(as_film(film, "depth"), everywhere(film, Rgb(distance + below)),
                                     fmt::format("depth {}, {}, {}", tau, distance, flat)));
    if (!flat) { // gone through at once, exactly, of the absorption alone
        scene.settings.integrator = "densitySampling";
        const Film through = render_here(scene, 4).film;
        for (const glm::vec3& pixel : layer_of(through, "depth").mean)
            CHECK(pixel.x == Approx(distance + mean_below(0.3 * tau)).epsilon(2e-7).margin(1e-5));
    }
    const FilmLayer &depth = layer_of(film, "depth"), &position = layer_of(film, "position"),
                    &coverage = layer_of(film, "coverage"), &albedo = layer_of(film, "albedo");
    CHECK(position.variance.empty());
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        CHECK(position.mean[i].z == Approx(distance - depth.mean[i].x).margin(2e-7 * distance + 1e-6));
        CHECK(albedo.mean[i].x == Approx(0.7 * coverage.mean[i].x).epsilon(1e-5));
    }
}

// By how much pixels that all see the same differ: that many times chi squared over its degrees of freedom, whose
// relative standard deviation is sqrt(2 / (n - 1)) for means of many samples.
TEST_CASE("the error of depths is known in any unit, near and far, of any weights", "[gpu][image][aovs]") {
    const auto [unit, distance, is_coloured] =
        GENERATE(std::tuple(1e-6, 3.0, false), std::tuple(1e8, 3.0, false), std::tuple(1.0, 5000.0, true));
    CAPTURE(unit, distance);
    Scene scene = beam(slab(1.0, 0.0), distance, 64);
    scene.volumes.front() = medium(Box{{0.0, 0.0, -0.5 * unit}, {4.0 * unit, 4.0 * unit, unit}}, 4.0 / unit, 0.0);
    if (is_coloured)
        scene.volumes.front().sigma_a = {4.0, 2.0, 1.0};
    scene.camera.position.z = distance * unit;
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = 1e-3 * unit;
    scene.layers = layer_depth;
    const Film film = render_here(scene, 4).film;
    const FilmLayer& depth = layer_of(film, "depth");
    const double n = double(film.pixel_count());
    double sum = 0.0, squares = 0.0, told = 0.0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const double from_front = depth.mean[i].x / unit - distance; // without which little is left of squares
        sum += from_front / n;
        squares += from_front * from_front / n;
        told += depth.variance[i].x / (unit * unit) / n;
    }
    CHECK(told == Approx(n / (n - 1.0) * (squares - sum * sum)).epsilon(5.0 * std::sqrt(2.0 / (n - 1.0))));
}

TEST_CASE("the first collision of what is gone through at once is where its density has it", "[gpu][image][aovs]") {
    const auto mean_below = [](double rate) { return 1.0 / rate - std::exp(-rate) / -std::expm1(-rate); };
    // Channel by channel, weighted by what each loses.
    const Rgb sigma_t = {10.0, 1.0, 0.5};
    Scene scene = beam(slab(1.0, 0.0), 3.0, 4);
    scene.volumes.front().sigma_a = sigma_t;
    scene.settings.integrator = "densitySampling";
    scene.layers = layer_depth;
    double depth = 0.0, lost = 0.0;
    for (int c = 0; c < 3; ++c) {
        depth += -std::expm1(-sigma_t[c]) * mean_below(sigma_t[c]);
        lost += -std::expm1(-sigma_t[c]);
    }
    const Film colours = render_here(scene, 4).film; // of which the film has to outlive its layer
    for (const glm::vec3& pixel : layer_of(colours, "depth").mean)
        CHECK(pixel.x == Approx(3.0 + depth / lost).epsilon(1e-5));
    // Down through an exponential atmosphere, whose mean is an integral: of exp(-tau) - exp(-tau(20)) over the way.
    scene.volumes.front() = medium(Everywhere{}, 1.5, 0.0);
    scene.volumes.front().layers = Layers{1, 0.0, 20.0, 1.0, 0.0};
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = 1e-3;
    scene.camera.position = {0.0, 20.0, 0.0};
    scene.camera.pitch = -90.0;
    scene.settings.spp = 1024;
    const auto passed = [](double t) { return std::exp(-1.5 * (std::exp(t - 20.0) - std::exp(-20.0))); };
    constexpr int steps = 20000; // by midpoints: off by (20 / steps)^2 / 24 of the second derivative, 1e-7
    double mean = 0.0;
    for (int i = 0; i < steps; ++i)
        mean += 20.0 / steps * (passed(20.0 * (i + 0.5) / steps) - passed(20.0)) / (1.0 - passed(20.0));
    const Film air = render_here(scene, 4).film;
    CHECK_AGREEMENT(agree_with_means(as_film(air, "depth"), everywhere(air, Rgb(mean)), "atmosphere"));
}

TEST_CASE("a surface's normal is seen through what is before it", "[gpu][image][aovs]") {
    const double tau = 0.7;
    Scene scene = beam(slab(tau, 0.7), 3.0, 1024);
    scene.surfaces.emplace_back().shape = BallSurface{{-0.6, 0.0, -3.0}, 1.0};
    scene.layers = layer_normal;
    const Film film = render_here(scene, 4).film;
    Film normals = as_film(film, "normal");
    for (std::size_t i = 0; i < film.pixel_count(); ++i) { // y is next to nothing, and has as little variance
        CHECK(std::abs(normals.mean[i].y) < 1e-5);
        normals.mean[i].y = normals.mean[i].x;
        normals.variance[i].y = normals.variance[i].x;
    }
    CHECK_AGREEMENT(agree_with_means(normals, everywhere(film, std::exp(-tau) * Rgb(0.6, 0.6, 0.8)), "normal"));
    // From within.
    scene.volumes.clear();
    scene.camera.position = {0.0, 0.0, -3.0};
    std::get<BallSurface>(scene.surfaces.front().shape).center = {0.6, 0.0, -3.0};
    const Film within = render_here(scene, 5).film;
    for (const glm::vec3& normal : layer_of(within, "normal").mean)
        CHECK(glm::distance(glm::dvec3(normal), glm::dvec3(0.6, 0.0, 0.8)) < 1e-3);
    // What else there is of the first that is met.
    scene.surfaces.front().material.color = {0.2, 0.4, 0.8};
    scene.layers = layer_depth | layer_position | layer_albedo;
    const Film met = render_here(scene, 6).film;
    for (std::size_t i = 0; i < met.pixel_count(); ++i) {
        CHECK(layer_of(met, "depth").mean[i].x == Approx(0.8).epsilon(1e-4));
        CHECK(glm::distance(layer_of(met, "position").mean[i], glm::vec3(0.0f, 0.0f, -3.8f)) < 1e-3f);
        CHECK(glm::distance(layer_of(met, "albedo").mean[i], glm::vec3(0.2f, 0.4f, 0.8f)) < 1e-5f);
    }
}

TEST_CASE("what is behind the media is held out for compositing", "[gpu][image][aovs]") {
    Scene scene = busy("ratioTracking", 32);
    scene.layers = everything;
    const Film with = render_here(scene, 3).film;
    const std::string hash = scene_hash(scene);
    scene.holds_out = true;
    CHECK(scene_hash(scene) != hash); // another picture
    const Film film = render_here(scene, 3).film;
    check_sum(film, {"emission", "direct", "indirect"});
    check_same_layers(film, with);
    // Over a plate of the background alone, in place of what was there.
    scene.lights.clear();
    Scene bare = scene;
    scene.holds_out = false;
    bare.settings.spp = scene.settings.spp = 256;
    const Film whole = render_here(scene, 5).film;
    Film over = render_here(bare, 6).film;
    for (std::size_t i = 0; i < over.pixel_count(); ++i) {
        const float T = 1.0f - layer_of(over, "alpha").mean[i].x;
        over.mean[i] += T * glm::vec3(scene.background);
        over.variance[i] += layer_of(over, "alpha").variance[i].x * glm::vec3(scene.background * scene.background);
    }
    CHECK_AGREEMENT(agree(over, whole, "over a plate"));
}

TEST_CASE("surfaces that shine are before a plate", "[gpu][image][aovs]") {
    Scene scene = busy("ratioTracking", 64);
    scene.volumes.clear();
    scene.lights.clear();
    scene.layers = layer_alpha;
    scene.holds_out = true;
    scene.background = Rgb(1.0);
    scene.surfaces.resize(1);
    Surface& ball = scene.surfaces.front(); // it fills the picture, and reflects half of the background
    ball = {};
    ball.shape = BallSurface{glm::dvec3(0.0), 14.0};
    ball.material = {MaterialKind::diffuse, Rgb(0.5)};
    ball.emission = {2.0, 1.0, 0.5};
    const Film film = render_here(scene, 3).film;
    CHECK_AGREEMENT(agree_with_means(film, everywhere(film, Rgb{2.5, 1.5, 1.0}), "shining"));
    for (const glm::vec3& alpha : layer_of(film, "alpha").mean)
        CHECK(alpha.x == 1.0f);
}

TEST_CASE("layers of flux: the beam, and what was scattered", "[gpu][image][aovs][flux]") {
    const double tau = 0.7;
    Scene scene;
    scene.camera.projection = Projection::fluence;
    scene.camera.points = {{0.0, 0.0, -2.0}, {0.0, 0.0, -3.0}};
    scene.picture = {2, 1, 0.0, 0.0, 2.0, 1.0};
    scene.volumes = {slab(tau, 0.9)};
    scene.lights = {DirectionalLight{{0.0, 0.0, 1.0}, Rgb(2.0)}};
    scene.settings.integrator = "ratioTracking";
    scene.settings.spp = 256;
    scene.layers = of_light | layer_groups | layer_media;
    const Film film = render_here(scene, 2).film;
    check_sum(film, {"background", "emission", "direct", "indirect"});
    check_sum(film, {"background", "medium.volume1"});
    for (const glm::vec3& pixel : layer_of(film, "background").mean)
        CHECK(pixel.x == Approx(2.0 * std::exp(-tau)).epsilon(3e-6));
    scene.layers = layer_depth;
    CHECK_THAT(trouble_with_layers(scene), Contains("depth: is a layer of a camera's rays"));
}

TEST_CASE("layers of a crop, of a resumed and of a merged render are those of the whole", "[gpu][image][aovs]") {
    Scene scene = busy("cachedRatioTracking", 8);
    scene.layers = everything;
    RenderJob job;
    job.plan.schedule = GENERATE(Schedule::fused, Schedule::staged);
    const Film whole = render_here(scene, 7, job).film;

    RenderJob part = job;
    part.crop = {3, 9, 5, 14};
    const Film crop = render_here(scene, 7, part).film;
    for (std::size_t k = 0; k < whole.layers.size(); ++k)
        for (std::size_t i = 0; i < crop.pixel_count(); ++i)
            REQUIRE(crop.layers[k].mean[i] == whole.layers[k].mean[(5 + i / 6) * 16 + 3 + i % 6]);

    part = job;
    part.plan.slots = 64;
    part.plan.submit_seconds = 0.0;
    int asked = 0;
    std::optional<Checkpoint> last;
    part.interrupted = [&] { return ++asked > 5; };
    part.checkpoint_seconds = 1e9;
    part.checkpoint = [&](const Checkpoint& checkpoint) { last = checkpoint; };
    render_here(scene, 7, part);
    REQUIRE(last);
    const auto file = std::filesystem::temp_directory_path() / fmt::format("vkvol-layers-{}", ::getpid());
    save_checkpoint(file, *last);
    const Checkpoint loaded = load_checkpoint(file);
    std::filesystem::remove(file);
    part = job;
    part.resume = &loaded;
    const Film resumed = render_here(scene, 7, part).film;
    CHECK(same_bits(resumed, whole));

    std::vector<MergeInput> halves(2);
    for (std::uint32_t half : {0u, 1u}) {
        part = job;
        scene.settings.spp = half == 0 ? 3 : 5;
        part.sample_offset = half == 0 ? 0 : 3;
        halves[half].film = render_here(scene, 7, part).film;
        halves[half].name = half == 0 ? "a" : "b";
        halves[half].metadata = {{"vkvol/seed", std::string("7")},
                                 {"vkvol/sampleOffset", int(part.sample_offset)},
                                 {"samplesPerPixel", int(scene.settings.spp)}};
    }
    const Film merged = merge_films(halves).film;
    REQUIRE(merged.layers.size() == whole.layers.size());
    for (std::size_t k = 0; k < whole.layers.size(); ++k)
        for (std::size_t i = 0; i < whole.pixel_count(); ++i)
            for (int channel = 0; channel < 3; ++channel) {
                CAPTURE(whole.layers[k].name, i);
                const double expected = whole.layers[k].mean[i][channel];
                // The means are of floats that were rounded three times.
                REQUIRE(merged.layers[k].mean[i][channel] == Approx(expected).epsilon(1e-6).margin(1e-6));
                if (!whole.layers[k].is_of_collisions())
                    REQUIRE(merged.layers[k].variance[i][channel] ==
                            Approx(whole.layers[k].variance[i][channel]).epsilon(1e-3).margin(1e-6));
            }
    halves[1].film.layers.pop_back();
    CHECK_THROWS_WITH(merge_films(halves), Contains("their layers are"));
}

TEST_CASE("layers in image files", "[cpu][image_io][aovs]") {
    const auto file = std::filesystem::temp_directory_path() / fmt::format("vkvol-layers-{}.exr", ::getpid());
    Film film;
    film.picture_width = film.picture_height = 2;
    film.crop = {0, 2, 0, 2};
    film.variance.assign(4, glm::vec3(0.25f));
    film.samples = {70000001u, 2, 3, 4};
    for (const char* name : {"direct", "group.key", "depth", "position", "alpha", "coverage"}) {
        FilmLayer layer{name, {}, {}};
        for (int i = 0; i < 4; ++i) {
            const float x = 0.1f * float(i) + float(film.layers.size());
            const bool single = std::string(layer.channels()).size() == 1;
            layer.mean.push_back(single ? glm::vec3(x) : glm::vec3(x, 2.0f * x, -x));
            if (layer.name != "position")
                layer.variance.push_back(single ? glm::vec3(x * x) : glm::vec3(x * x, x, 1.0f));
        }
        film.layers.push_back(layer);
    }
    film.mean = film.layers.front().mean;
    write_exr(file, film, {});
    Metadata metadata;
    const Film read = read_exr(file, &metadata);
    std::filesystem::remove(file);
    CHECK(same_bits(read, film));
    CHECK(std::get<std::string>(metadata.at(layers_key)) == "direct group.key depth position alpha coverage");

    // What RGB is not multiplied by is no channel A.
    CHECK(channel_name("", film.layers[4], 'A', film.is_premultiplied) == "alpha.A");
    film.is_premultiplied = true;
    CHECK(channel_name("variance.", film.layers[4], 'A', film.is_premultiplied) == "variance.A");
    write_exr(file, film, metadata);
    CHECK(same_bits(read_exr(file, &metadata), film));
    std::filesystem::remove(file);
    film.is_premultiplied = false;

    film.layers.resize(1);
    film.layers.front() = {
        "alpha", std::vector<glm::vec3>{glm::vec3(0.5f), glm::vec3(0.0f), glm::vec3(1.0f), glm::vec3(0.25f)}, {}};
    film.mean.assign(4, glm::vec3(0.25f, 0.0f, 2.0f));
    const std::vector<std::uint8_t> bytes = tone_map(film, {}, film.layers.front());
    REQUIRE(bytes.size() == 16);
    // Through half of the light 0.5, whose sRGB is 187.5 of 255.
    CHECK(std::vector<int>(bytes.begin(), bytes.begin() + 4) == std::vector<int>{188, 0, 255, 128});
    CHECK(std::vector<int>(bytes.begin() + 4, bytes.begin() + 8) == std::vector<int>{0, 0, 0, 0});
    CHECK(std::vector<int>(bytes.begin() + 8, bytes.begin() + 12) == std::vector<int>{137, 0, 255, 255});
}

TEST_CASE("the film of a scene file names its layers", "[cpu][xml][aovs]") {
    const auto parse = [](const std::string& elements) {
        return parse_scene("<options><sphere/>" + elements + "</options>", "s.xml");
    };
    CHECK(parse("").layers == 0);
    CHECK(parse(R"(<film aov="direct, depth indirect"/>)").layers == (layer_direct | layer_depth | layer_indirect));
    const Scene held = parse(R"(<film alpha="true"/>)");
    CHECK(held.holds_out);
    CHECK(held.layers == layer_alpha);
    const Scene lit = parse(R"(<light y="1" r="1" group="key"/><backgroundColor r="1" group="sky"/>
        <lights><point r="1" group="fill"/><sphere r="1" group="key"/></lights>)");
    CHECK(light_groups(lit) == std::vector<std::string>{"key", "fill", "sky"});
    const std::pair<const char*, const char*> errors[] = {
        {R"(<film aov="dept"/>)", "unknown layer 'dept'; did you mean depth?"},
        {R"(<light y="1" r="1" group="a.b"/>)", "'a.b' is no name of a layer"},
        {R"(<light y="1" r="1" group="none"/>)", "and not none"},
        {R"(<fluence>0 0 0</fluence><film alpha="1"/>)", "alpha: is a layer of a camera's rays"}};
    for (const auto& [elements, message] : errors)
        CHECK_THROWS_WITH(parse(elements), Contains(message) && Contains("s.xml:1:"));
    std::string lights;
    for (int i = 0; i < 80; ++i)
        lights += fmt::format("<point r=\"1\" group=\"g{}\"/>", i);
    const Scene many = parse("<film aov=\"groups\"/><lights>" + lights + "</lights>");
    CHECK_THROWS_WITH(plan_layers(many), Contains("64 is the most"));
}
