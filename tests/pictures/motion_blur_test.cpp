// What moves while a picture is taken: the moments of samples, a closed form, the same bits as pictures of each moment,
// and the reference at times of its own.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <random>
#include <regex>
#include <set>

#include "compare.h"
#include "drift.h"
#include "error.h"
#include "explain.h"
#include "field_cache.h"
#include "memory_grids.h"
#include "method.h"
#include "preset.h"
#include "requested_scene.h"
#include "scene_hash.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/test_device.h"

using namespace vkvol;
using Catch::Contains;

namespace {

Scene parse_at(const std::string& body, double frame, const std::string& blur = R"(<motionBlur open="0" close="1"/>)") {
    return parse(blur + body, {{"F", fmt::format("{}", frame)}});
}

// A camera, a leaning box, a lamp and a ball that all move, in a small picture.
const std::string all_that_moves = R"(
    <width>16</width> <height>12</height> <rayPerPixelCount>96</rayPerPixelCount>
    <camera x="${= F}" y="1" z="9" lookAt="0 ${= 0.4*F} 0" fov="${= 40 - 8*F}"/>
    <volumes><volume>
      <box width="3" height="2" depth="2"/>
      <transform><rotate z="1" angle="${= 60*F}"/><translate x="${= 1.5*F - 1}"/></transform>
      <sigma_a>0.2</sigma_a> <sigma_s>${= 0.6 + F}</sigma_s>
      <heyneygreenstein_g>0.3</heyneygreenstein_g>
    </volume></volumes>
    <lights><point x="${= 2 - 3*F}" y="2.5" z="1" r="20" g="${= 10 + 10*F}" b="5"/></lights>
    <surfaces><sphere x="${= 2*F - 2}" y="-1.2" z="2" radius="0.6" r="0.8" g="0.6" b="0.4"/></surfaces>
    <backgroundColor r="0.2" g="0.3" b="0.5"/>)";

// Pictures of single moments as the samples of one: its variance is that of their means.
Film mean_of_films(const std::vector<Film>& films) {
    Film mean = films.front();
    const double n = double(films.size());
    for (std::size_t i = 0; i < mean.mean.size(); ++i) {
        glm::dvec3 sum(0.0), square(0.0);
        for (const Film& film : films) {
            sum += glm::dvec3(film.mean[i]);
            square += glm::dvec3(film.mean[i]) * glm::dvec3(film.mean[i]);
        }
        mean.mean[i] = glm::vec3(sum / n);
        mean.variance[i] = glm::vec3(glm::max((square - sum * sum / n) / (n * (n - 1.0)), 0.0));
        mean.samples[i] = std::uint32_t(n);
    }
    return mean;
}

} // namespace

TEST_CASE("samples have moments by their numbers alone", "[cpu][motion]") {
    const MotionBlur blur{-0.25, 0.5, {}};
    std::set<double> times;
    std::uint64_t sample = 0, moments = 0;
    while (sample < 4096) {
        const Moment moment = moment_of_sample(sample);
        CHECK(moment.first == sample);
        CHECK(moment.index == moments);
        // As many as a quarter to a half of the root of their number, so that n samples have at most 6 sqrt(n).
        CHECK(double(moment.end - moment.first) <= std::max(1.0, 0.5 * std::sqrt(double(sample))));
        for (std::uint64_t other = moment.first; other < moment.end; ++other)
            CHECK(moment_of_sample(other).index == moment.index);
        const double time = time_of(blur, moment, 7);
        CHECK(time >= blur.open);
        CHECK(time <= blur.close);
        CHECK(times.insert(time).second);
        sample = moment.end;
        ++moments;
        if (sample == 16 || sample == 64 || sample == 256 || sample == 1024)
            CHECK(moments == (sample == 16 ? 16u : sample == 64 ? 40u : sample == 256 ? 88u : 184u));
    }
    // One of the first 16 is in each sixteenth, wherever the seed turns them: they are 1/16 apart around the circle.
    std::vector<double> first;
    for (std::uint64_t i = 0; i < 16; ++i)
        first.push_back(time_of({0.0, 1.0, {}}, moment_of_sample(i), 123));
    std::sort(first.begin(), first.end());
    for (std::size_t i = 1; i < first.size(); ++i)
        CHECK(first[i] - first[i - 1] == Approx(1.0 / 16.0));
    // Over seeds the time of one moment is even: of n the mean has a standard error of 1 / sqrt(12 n), and that of its
    // square about the middle one of 1 / sqrt(180 n).
    double sum = 0.0, square = 0.0;
    constexpr int seeds = 20000;
    for (std::uint32_t seed = 0; seed < seeds; ++seed) {
        const double off = time_of({0.0, 1.0, {}}, moment_of_sample(5), seed) - 0.5;
        sum += off;
        square += off * off;
    }
    CHECK(std::abs(sum / seeds) < 5.0 / std::sqrt(12.0 * seeds));
    CHECK(std::abs(square / seeds - 1.0 / 12.0) < 5.0 / std::sqrt(180.0 * seeds));
}

TEST_CASE("the frame's number is a time in arithmetic alone", "[cpu][motion][xml]") {
    const Scene scene = parse_at(R"(<camera x="${= 2*F}" y="$F" z="${= ${F:-9} + 1}"/>)", 3);
    CHECK(scene.camera.position == glm::dvec3(6.0, 3.0, 4.0));
    const Scene later = scene_of_time(scene, 0.25);
    CHECK(later.camera.position == glm::dvec3(6.5, 3.0, 4.25));
    CHECK(later.picture.width == scene.picture.width);
    CHECK(scene_of_time(parse_at(R"(<camera x="${= F4 + 1}" y="${= F}"/>)", 3), 0.5).camera.position ==
          glm::dvec3(4.0, 3.5, 0.0));
}

TEST_CASE("files are those of the frame, by whatever arithmetic", "[cpu][motion][xml]") {
    const Scene scene = parse_at(R"(<camera x="${= F}"/><densityField>smoke.${= F + 100}.nvdb</densityField>)", 3);
    for (const double time : {-0.25, 0.1, 1.0}) {
        const Scene then = scene_of_time(scene, time);
        CHECK(std::get<GridFile>(then.volumes.front().shape).path.filename() == "smoke.103.nvdb");
        CHECK(then.camera.position.x == 3.0 + time);
    }
    // Nor does such a scene move by that.
    CHECK(!parse_at("<densityField>smoke.${= F + 100}.nvdb</densityField>", 3).motion_blur);
}

// Its light is 0 when the shutter opens.
TEST_CASE("pixels that move together know no error of their mean", "[gpu][motion]") {
    const Scene scene =
        parse_at(R"(<sphere/><sigma_s>1</sigma_s><camera z="5" fov="40"/><width>12</width><height>12</height>
        <rayPerPixelCount>16</rayPerPixelCount><light y="1" r="1" g="1" b="1" multiplier="${= F}"/>)",
                 0.0);
    CHECK(!foresee(scene));
    Scene at_rest = scene;
    at_rest.motion_blur.reset();
    const Film film = render_here(scene, 1).film, still = render_here(at_rest, 1).film;
    CHECK(film.is_correlated);
    CHECK(!image_mean(film).standard_error);
    CHECK(!still.is_correlated);
    CHECK(image_mean(still).standard_error);
    const Comparison result = compare_films(film, render_here(scene, 2).film, {});
    CHECK(!result.has_mean_z);
    CHECK(compare_films(still, still, {}).has_mean_z);
}

TEST_CASE("what is said of motion that cannot be", "[cpu][motion][xml]") {
    const std::string moving = R"(<camera x="${= ${F:-0}}"/>)";
    CHECK_THAT(error_of(R"(<motionBlur open="1" close="0.5"/>)" + moving), Contains("closes before it opens"));
    CHECK_THAT(error_of(R"(<motionBlur open="x"/>)" + moving), Contains("a number of frames"));
    const Scene still = parse(R"(<motionBlur/><camera x="3"/>)");
    CHECK(!still.motion_blur);
    CHECK(warns(still, "nothing moves: no value is computed from F, as in yaw"));
    const Scene moves = parse("<motionBlur/>" + moving);
    REQUIRE(moves.motion_blur);
    CHECK(moves.motion_blur->open == -0.25);
    CHECK(moves.motion_blur->close == 0.25);
    // Before anything is rendered, with the time.
    CHECK_THAT(error_of(R"(<motionBlur/><sphere/><sigma_s>${= ${F:-0} + 0.2}</sigma_s>)"),
               Contains("s.xml:2") && Contains("-0.25 frames from the picture's"));
    const std::string fading = R"(<motionBlur open="0" close="1"/><lights>
                                    <point y="2" r="${= 1 - ${F:-0}}" group="key"/></lights>)";
    CHECK(light_groups(scene_of_time(parse(fading + R"(<film aov="groups"/>)"), 1.0)).size() == 1);
    CHECK_THAT(error_of(R"(<motionBlur/><film aov="position"/>)" + moving), Contains("position: what moves"));
    // It shows in the picture, so it counts for merging.
    CHECK(scene_hash(moves) != scene_hash(parse(moving)));
    CHECK(scene_hash(moves) != scene_hash(parse(R"(<motionBlur open="0"/>)" + moving)));
    CHECK(scene_hash(moves) != scene_hash(parse(R"(<motionBlur/><camera x="${= 2*${F:-0}}"/>)")));
    CHECK(scene_hash(moves) == scene_hash(parse("<motionBlur/>" + moving)));
}

// An absorbing box, 1 wide and 1 deep, goes from left to right by 2: before a place x, seen along its depth, it is for
// as much of the time as [x - 1/2, x + 1/2] has in common with its middle's way [-1, 1], over 2. Of 2^k moments that
// are even around the circle such an interval has its share but for less than 1. 64 samples have 16 moments of one
// sample each, and 16 and 8 of two: 5 samples at most are wrong. Pixels see a hundredth of their width, 1/800 of a unit
// or 1/1600 of the time.
TEST_CASE("a box that passes covers for its time", "[motion]") {
    const Scene scene = parse_at(R"(<width>32</width><height>1</height><rayPerPixelCount>64</rayPerPixelCount>
        <camera z="5" projection="orthographic" viewHeight="0.125"/><pixelFilter radius="0.01">box</pixelFilter>
        <volumes><volume><box width="1" height="1" depth="1"/>
          <transform><translate x="${= 2*F - 1}"/></transform><sigma_a>2</sigma_a><sigma_s>0</sigma_s></volume></volumes>
        <backgroundColor r="1" g="1" b="1"/>)",
                                 0);
    const Film film = render_here(scene, 5).film;
    const double absorbed = 1.0 - std::exp(-2.0);
    for (int x = 0; x < scene.picture.width; ++x) {
        const double at = (x + 0.5 - 16.0) / 8.0;
        const double covered = std::max(0.0, std::min(at + 0.5, 1.0) - std::max(at - 0.5, -1.0)) / 2.0;
        INFO("pixel " << x);
        CHECK(std::abs(film.mean[std::size_t(x)].r - (1.0 - covered * absorbed)) <
              (5.0 / 64.0 + 2.0 / 1600.0) * absorbed);
    }
}

TEST_CASE("a sample sees its moment", "[motion][long]") {
    const Scene scene = parse_at(all_that_moves, 0);
    for (const std::uint32_t sample : {0u, 5u, 17u, 70u}) {
        RenderJob job;
        job.sample_offset = sample;
        Scene one = scene;
        one.settings.spp = 1;
        const Film film = render_here(one, 3, job).film;
        const double time = time_of(*scene.motion_blur, moment_of_sample(sample), 3);
        Scene then = parse(all_that_moves, {{"F", fmt::format("{}", time)}});
        then.settings = one.settings;
        CHECK(same_bits(film, render_here(then, 3, job).film));
    }
}

// As the grid, the glow and the albedo that it has at the moment of the sample.
TEST_CASE("a sample sees grids drifted", "[motion][long]") {
    GridRecipe wind = cloud_grid();
    wind.name = "v";
    wind.first -= 12;
    wind.last += 12;
    wind.color = [](glm::ivec3 v) { return glm::vec3(6.0f - 0.2f * float(v.y), 0.3f * float(v.x), -2.0f); };
    GridRecipe heat = cloud_grid();
    heat.name = "temperature";
    GridRecipe tint = cloud_grid();
    tint.name = "tint";
    tint.color = [](glm::ivec3 v) { return glm::vec3(0.5 + 0.5 * voxel_noise(v, 4), 0.8, 0.4); };
    const GridFile file = write_grids({cloud_grid(), wind, heat, tint});
    const std::string body = fmt::format(R"(
        <width>12</width><height>12</height><camera x="2" y="1" z="14" lookAt="0 0 0" fov="50"/>
        <densityField velocity="v" framesPerSecond="2">{}</densityField>
        <sigma_a unit="world">0.4</sigma_a><sigma_s unit="world">0.8</sigma_s><albedo grid="tint"/>
        <emission r="1" g="2" b="1"/><backgroundColor r="0.2" g="0.3" b="0.5"/>)",
                                         file.path.string());
    const Scene scene = parse(R"(<motionBlur open="-1" close="1"/>)" + body);
    REQUIRE(scene.motion_blur);
    const auto field = [&](const char* name, GridValues values) {
        return load_density_field(file.beside(name), values);
    };
    for (const std::uint32_t sample : {0u, 33u}) {
        RenderJob job;
        job.sample_offset = sample;
        const Film film = render_here(scene, 8, job).film;
        const double seconds = time_of(*scene.motion_blur, moment_of_sample(sample), 8) / 2.0;
        const auto grids = std::make_shared<MemoryGrids>();
        for (const char* name : {"density", "temperature", "tint"})
            grids->grids.push_back({name, drifted(field(name, GridValues::numbers_or_colors),
                                                  field("v", GridValues::vectors), seconds, name == std::string("tint"))
                                              .bytes});
        Scene then = parse(body);
        std::get<GridFile>(then.volumes.front().shape).memory = grids;
        CHECK(same_bits(film, render_here(then, 8, job).film));
        CHECK(!same_bits(film, render_here(parse(body), 8, job).film));
    }
    // Without its velocities nothing is rendered.
    const Scene other = parse("<motionBlur/>" + std::regex_replace(body, std::regex("\"v\""), "\"w\""));
    CHECK_THROWS_WITH(render_here(other, 1), Contains("has no grid \"w\""));
}

// A batch has room for what its own moment's lights leave room for, not for what those of the moment before did, which
// were fewer: a black lamp is none.
TEST_CASE("batches are no larger than their moment has room for", "[motion]") {
    std::string lamps;
    for (int i = 0; i < 100; ++i)
        lamps +=
            fmt::format(R"(<sphere x="{}" y="3" z="{}" radius="0.1" multiplier="${{= max(0, F)}}"/>)", i % 10, i / 10);
    Scene scene = parse_at(
        fmt::format(R"(<width>1</width><height>1</height><irradiance y="0" lookAt="0 1 0" width="2" height="2"/>
        <integrator>lightTracing</integrator><sphere y="1" radius="0.5"/><sigma_a>0.2</sigma_a><sigma_s>0.4</sigma_s>
        <lights><sphere y="4" radius="0.5"/>{}</lights>)",
                    lamps),
        0, R"(<motionBlur open="-1" close="1"/>)");
    scene.settings.spp = 2048;
    RenderJob job;
    job.sample_offset = 1 << 20; // where 512 samples share a moment
    job.noise_goal = 1e-9;       // never reached, nor looked at
    const Film film = render_here(scene, 4, job).film;
    job.plan.most_batch = 16;
    CHECK(same_bits(film, render_here(scene, 4, job).film));
}

TEST_CASE("what moves is the same however it is carried out", "[motion]") {
    Scene scene = parse_at(all_that_moves, 0);
    scene.settings.spp = 40;
    const Film film = render_here(scene, 1).film;
    RenderJob job;
    job.crop = {0, scene.picture.width, 0, scene.picture.height};
    job.seed = 1;
    Session session(test_device(), scene, job);
    session.render(7);
    session.render(21); // amid two samples that share a moment
    session.render(40);
    CHECK(same_bits(film, session.result().film));

    // Stopped amid its samples, and gone on with.
    std::optional<Checkpoint> kept;
    int asked = 0;
    job.checkpoint_seconds = 1e9;
    job.checkpoint = [&](const Checkpoint& checkpoint) { kept = checkpoint; };
    job.interrupted = [&] { return ++asked > 60; };
    const RenderResult stopped = render(test_device(), scene, job);
    REQUIRE(stopped.interrupted);
    REQUIRE(kept);
    CHECK(kept->done > 0);
    job.interrupted = nullptr;
    job.resume = &*kept;
    CHECK(same_bits(film, render(test_device(), scene, job).film));
    // What is another only once its first moment is over is another render.
    const double first = time_of(*scene.motion_blur, moment_of_sample(0), job.seed);
    REQUIRE(first < 0.9);
    Scene other = parse_at(
        std::regex_replace(all_that_moves, std::regex("8\\*F"), fmt::format("8*F + 5*max(0, F - {})", first + 0.01)),
        0);
    other.settings = scene.settings;
    CHECK_THROWS_AS(Session(test_device(), other, job), InputError);
}

// A lamp that is below 0 for a fiftieth of the time on either side of 0.62, where nobody looks before.
TEST_CASE("a moment that cannot be leaves what was rendered", "[motion]") {
    Scene scene = parse_at(R"(<width>8</width><height>8</height><camera z="5"/><sphere/>
        <lights><point y="3" r="${= abs(F - 0.62) - 0.02}" g="1"/></lights>)",
                           0);
    RenderJob job;
    job.crop = {0, 8, 0, 8};
    std::optional<Checkpoint> kept;
    job.checkpoint_seconds = 1e9;
    job.checkpoint = [&](const Checkpoint& checkpoint) { kept = checkpoint; };
    Session session(test_device(), scene, job);
    CHECK_THROWS_WITH(session.render(256), Contains("frames from the picture's, which its <motionBlur> includes"));
    REQUIRE(session.samples() > 0);
    CHECK(session.result().film.samples.front() == session.samples());
    REQUIRE(kept);
    CHECK(kept->done == session.samples());
    CHECK_THROWS_AS(session.render(256), InputError);
    CHECK(session.result().film.samples.front() == session.samples());
}

TEST_CASE("a moment whose files are gone leaves a picture and a checkpoint", "[motion]") {
    const RadianceMap map{4, 2, std::vector<glm::vec3>(8, glm::vec3(1.0f)), 0};
    const std::filesystem::path sky = write_sky(map).file;
    Scene scene = parse_at(fmt::format(R"(<width>8</width><height>8</height><camera x="${{= F}}" z="5"/><sphere/>
        <lights><sky>{}</sky></lights>)",
                                       sky.string()),
                           0);
    scene.layers = layer_groups | layer_position;
    RenderJob job;
    job.crop = {0, 8, 0, 8};
    std::optional<Checkpoint> kept;
    job.checkpoint_seconds = 1e9;
    job.checkpoint = [&](const Checkpoint& checkpoint) { kept = checkpoint; };
    Session session(test_device(), scene, job);
    session.render(2);
    kept.reset();
    std::filesystem::remove(sky);
    CHECK_THROWS_AS(session.render(4096), InputError);
    REQUIRE(kept);
    CHECK(kept->done >= 2);
    CHECK_FALSE(session.can_go_on());
    CHECK(session.has_whole_film());
    const RenderResult& result = session.result();
    CHECK(result.interrupted);
    CHECK(result.samples == kept->done);
    CHECK(result.film.samples.front() == kept->done);
    CHECK_THROWS_AS(session.render(4096), RenderError);
}

TEST_CASE("a moment whose files have changed leaves a picture", "[motion]") {
    const std::filesystem::path sky = write_sky({4, 2, std::vector<glm::vec3>(8, glm::vec3(1.0f)), 0}).file;
    const Scene scene = parse_at(fmt::format(R"(<width>8</width><height>8</height><camera x="${{= F}}" z="5"/><sphere/>
        <lights><sky>{}</sky></lights>)",
                                             sky.string()),
                                 0);
    RenderJob job;
    job.crop = {0, 8, 0, 8};
    Session session(test_device(), scene, job);
    session.render(2);
    std::filesystem::last_write_time(sky, std::filesystem::last_write_time(sky) + std::chrono::seconds(3));
    CHECK_THROWS_WITH(session.render(64), Contains("was changed while it was rendered"));
    CHECK(session.has_whole_film());
    CHECK(session.result().samples >= 2);
}

// Seed 0 begins at 0.883, with light, and goes on at 0.383, without.
TEST_CASE("what is dark at some moments is rendered as what is not", "[motion]") {
    const std::string dims = "${= max(0, 2*F - 1)}",
                      body = R"(<width>8</width><height>8</height><camera z="5" fov="40"/>)";
    Scene lit = parse_at(body + "<sphere/><light y=\"1\" r=\"1\" multiplier=\"" + dims + "\"/>", 0);
    lit.settings.spp = 1;
    RenderJob job, later;
    job.crop = later.crop = {0, 8, 0, 8};
    later.sample_offset = 1;
    const RenderResult first = render(test_device(), lit, job), second = render(test_device(), lit, later);
    CHECK(mean_of(first.film) > 0.0);
    CHECK(mean_of(second.film) == 0.0);
    CHECK(first.integrator == second.integrator);
    CHECK(choose_method(with_preset(with_steady_integrator(lit))).integrator == first.integrator);
    // Also where it is lit at none of the moments that are looked at before.
    const Scene pulse =
        parse_at(body + R"(<sphere/><light y="1" r="1" multiplier="${= max(0, 1 - 20*abs(F - 0.1))}"/>)", 0);
    CHECK(std::string(choose_method(with_preset(with_steady_integrator(pulse))).integrator) == "ratioTracking");
    lit.settings.integrator = "bidirectional"; // which has nothing to send at some
    for (const RenderJob& each : {job, later})
        CHECK_THROWS_WITH(Session(test_device(), lit, each), Contains("at some moments"));
    // Neither is a fire that is out at the last moment shown as fog.
    Scene fire =
        parse_at(body + R"(<sphere/><sigma_s>0</sigma_s><medium r="1" g="0.5" multiplier=")" + dims + "\"/>", 0);
    fire.settings.spp = 2;
    CHECK(render(test_device(), fire, job).glows);
}

TEST_CASE("a camera that --frame has moved goes on to move", "[motion]") {
    Scene scene =
        parse_at(R"(<width>8</width><height>8</height><camera x="${= F}" z="50" yaw="${= 30*F}"/><sphere/>)", 0);
    RenderRequest request;
    request.frame = true;
    FieldCache fields;
    apply_request(request, false, scene, fields);
    CHECK(scene.camera.position.z < 10.0);
    const Camera later = scene_of_time(scene, 0.5).camera;
    CHECK(later.yaw == 15.0);
    CHECK(later.position.x == Approx(scene.camera.position.x + 0.5));
    CHECK(later.position.z == Approx(scene.camera.position.z));
}

TEST_CASE("a lens that opens has sharp what it had before --frame moved its camera", "[motion]") {
    const auto framed = [](const std::string& camera) {
        Scene scene = parse_at("<width>8</width><height>8</height><sphere/>" + camera, 0);
        RenderRequest request;
        request.frame = true;
        FieldCache fields;
        apply_request(request, false, scene, fields);
        return scene;
    };
    const Scene scene = framed(R"(<camera z="50" focus="50" lensRadius="${= 0.1*F}"/>)");
    const Camera later = scene_of_time(scene, 0.5).camera;
    CHECK(later.position.z < 10.0);
    CHECK(later.lens.radius == 0.05);
    CHECK(later.lens.focus == Approx(later.position.z));
    const Scene lost = framed(R"(<camera z="50" focus="4" lensRadius="${= 0.1*F}"/>)");
    CHECK_THROWS_WITH(scene_of_time(lost, 0.5), Catch::Contains("behind it; raise <camera> focus"));
}

// The reference at times that are drawn one by one.
TEST_CASE("what moves agrees with the reference", "[motion][long]") {
    const Scene scene = parse_at(all_that_moves, 0);
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> time(scene.motion_blur->open, scene.motion_blur->close);
    std::vector<Film> films;
    for (std::uint32_t i = 0; i < 96; ++i) {
        Scene then = scene_of_time(scene, time(random));
        then.motion_blur.reset();
        then.settings.spp = 1;
        films.push_back(render_reference(then, i));
    }
    CHECK_AGREEMENT(agree(render_here(scene, 2).film, mean_of_films(films), "motion"));
}
