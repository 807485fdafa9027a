// Layers besides radiance: their sums are the picture, and each is what a scene of its own would show, or a closed
// form.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

#include "checkpoint.h"
#include "layer_plan.h"
#include "merge.h"
#include "scene_hash.h"
#include "session.h"
#include "shared/constants.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/test_device.h"
#include "support/thorough.h"

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

// The same sums of the same contributions, in another order: each addition rounds by 2^-24 of what there is, of a path
// with N of them at most N 2^-24 of the sum of their magnitudes. N is below 1000 here, and what is negative, in the
// corrections of a cache, no more than what is positive.
void check_sum(const Film& film, const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < film.pixel_count(); ++i)
        for (int channel = 0; channel < 3; ++channel) {
            double sum = 0.0, magnitude = 0.0;
            for (const std::string& name : names) {
                sum += double(layer_of(film, name.c_str()).mean[i][channel]);
                magnitude += std::abs(double(layer_of(film, name.c_str()).mean[i][channel]));
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

TEST_CASE("distances drawn for a light's sake are in layers, too", "[gpu][image][aovs][long]") {
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

TEST_CASE("what a medium sends out is in its layer", "[gpu][image][aovs][long]") {
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

TEST_CASE("what is behind the media is held out for compositing", "[gpu][image][aovs][long]") {
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

TEST_CASE("surfaces that shine are before a plate", "[gpu][image][aovs][long]") {
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
    CHECK_AGREEMENT(agree_with_means(film, std::vector<Rgb>(film.pixel_count(), Rgb{2.5, 1.5, 1.0}), "shining"));
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

TEST_CASE("a light that is out has a layer, as in the frames in which it shines", "[cpu][xml][aovs]") {
    for (const std::string light :
         {"<light y='1' r='$F' group='key'/>", "<lights><point x='3' r='$F' group='key'/></lights>",
          "<lights><daylight y='1' multiplier='$F' group='key'/></lights>"})
        for (const char* frame : {"0", "1"}) {
            const Scene scene =
                parse("<film aov='groups'/><sphere/><backgroundColor r='.1' group='sky'/>" + light, {{"F", frame}});
            CHECK(light_groups(scene) == std::vector<std::string>{"key", "sky"}); // in the same places
            CHECK(plan_layers(scene).groups == light_groups(scene));
        }
}

TEST_CASE("groups of lights that fade keep their places", "[cpu][xml][aovs]") {
    for (const char* frame : {"0", "1", "2"})
        CHECK(light_groups(parse("<sphere/><lights><point x='1' r='1' group='a'/><point x='2' r='$F' group='b'/>"
                                 "<point x='3' r='${= 2-$F}' group='c'/><point x='4' r='1' group='d'/></lights>",
                                 {{"F", frame}})) == std::vector<std::string>{"a", "b", "c", "d"});
}

TEST_CASE("groups keep their places when the background fades, and when several are out", "[cpu][xml][aovs]") {
    for (const char* frame : {"0", "1"})
        CHECK(light_groups(parse("<sphere/><backgroundColor r='$F' group='sky'/><light y='1' r='$F' group='key'/>"
                                 "<lights><point x='1' r='$F' group='a'/><point x='2' r='$F' group='b'/></lights>",
                                 {{"F", frame}})) == std::vector<std::string>{"key", "a", "b", "sky"});
}

TEST_CASE("layers go on by the schedule they began with, where none is asked for", "[gpu][image][aovs]") {
    Scene scene = busy("cachedRatioTracking", 64); // more paths at a time than fused lanes have
    scene.layers = everything;
    RenderJob job;
    job.plan.schedule = GENERATE(Schedule::fused, Schedule::staged);
    job.plan.slots = 64; // few, so that pixels are left
    job.plan.submit_seconds = 0.0;
    int asked = 0;
    std::optional<Checkpoint> last;
    job.interrupted = [&] { return ++asked > 5; };
    job.checkpoint_seconds = 1e9;
    job.checkpoint = [&](const Checkpoint& checkpoint) { last = checkpoint; };
    render_here(scene, 7, job);
    REQUIRE(last);
    RenderJob rest;
    rest.crop = {0, scene.picture.width, 0, scene.picture.height};
    rest.seed = 7;
    rest.resume = &*last;
    const RenderResult resumed = render(test_device(), scene, rest);
    CHECK(resumed.plan.schedule == job.plan.schedule);
    rest.plan.schedule = job.plan.schedule;
    rest.resume = nullptr;
    CHECK(same_bits(resumed.film, render(test_device(), scene, rest).film));
}

TEST_CASE("layers of a crop and of a resumed render are those of the whole", "[gpu][image][aovs]") {
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
}

TEST_CASE("layers of a merged render are those of the whole", "[gpu][image][aovs]") {
    Scene scene = busy("cachedRatioTracking", 8);
    scene.layers = everything;
    RenderJob job;
    job.plan.schedule = GENERATE(Schedule::fused, Schedule::staged);
    const Film whole = render_here(scene, 7, job).film;
    std::vector<MergeInput> halves(2);
    for (std::uint32_t half : {0u, 1u}) {
        RenderJob part = job;
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
