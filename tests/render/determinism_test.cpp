// The same scene, seed and samples give the same bits, however the work is cut up and scheduled.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <stdexcept>

#include "merge.h"
#include "support/images.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "support/test_device.h"
#include "support/thorough.h"
#include "test_paths.h"

using namespace vkvol;

namespace {

// Sun, sky and emission; part of the picture misses the cloud. The sample count is no power of two.
Scene glowing_cloud(std::uint32_t samples = 11) {
    static const GridFile file = write_grid(cloud_grid());
    Scene scene = scene_of(medium(file, 2.0, 0.9, 0.5), 13.0, 40, 25.0, glm::dvec3(1.0, 0.0, 0.0), {10.0, 25.0, -5.0});
    scene.background = {0.3, 0.5, 0.9};
    scene.lights = {sunlight()};
    scene.volumes.front().Le = {0.5, 0.2, 0.1};
    scene.settings.spp = samples;
    return scene;
}

RenderJob with_tuning(std::uint32_t slots, std::uint32_t lanes, std::uint32_t budget, std::uint32_t steps_per_turn) {
    RenderJob job;
    job.plan.slots = slots;
    job.plan.lanes = lanes;
    job.plan.budget = budget;
    job.plan.steps = steps_per_turn;
    return job;
}

// The pixels of `whole` that lie in `crop`.
Film cut(const Film& whole, const Crop& crop) {
    Film film = whole;
    film.crop = crop;
    film.mean.clear();
    film.variance.clear();
    film.samples.clear();
    for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
            const std::size_t i = std::size_t(y) * whole.width() + x;
            film.mean.push_back(whole.mean[i]);
            film.variance.push_back(whole.variance[i]);
            film.samples.push_back(whole.samples[i]);
        }
    return film;
}

// Each pixel holds exactly its first samples[pixel] samples: the bits of a render of that many.
void check_samples_are_true(const Scene& scene, std::uint32_t seed, const Film& film) {
    std::map<std::uint32_t, Film> full;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const std::uint32_t n = film.samples[i];
        if (n == 0) {
            wrong += film.mean[i] != glm::vec3(0.0f) || film.variance[i] != glm::vec3(0.0f);
            continue;
        }
        if (!full.count(n)) {
            Scene shorter = scene;
            shorter.settings.spp = n;
            full[n] = render_here(shorter, seed).film;
        }
        wrong += film.mean[i] != full[n].mean[i] || film.variance[i] != full[n].variance[i];
    }
    CAPTURE(full.size());
    CHECK(wrong == 0);
}

} // namespace

TEST_CASE("the sizes of the machine change no bit", "[gpu][determinism]") {
    for (const char* integrator : in_turn(std::vector{"deltaTracking", "ratioTracking"}, 1, 2)) {
        Scene scene = glowing_cloud();
        scene.settings.integrator = integrator;
        const Film usual = render_here(scene, 30).film;
        CHECK(same_bits(render_here(scene, 30).film, usual)); // again
        const Film other_seed = render_here(scene, 31).film;
        CHECK_FALSE(same_bits(other_seed, usual));
        for (const std::uint32_t slots : {256u, 4096u}) // the picture has 1600 pixels
            for (const std::uint32_t lanes : {64u, 512u})
                for (const std::uint32_t budget : {16u, 1024u}) {
                    if ((slots == 256) == (lanes == 64) && budget == 16 && !thorough())
                        continue;
                    CAPTURE(integrator, slots, lanes, budget);
                    const std::uint32_t steps = slots == 256 ? (lanes == 64 ? 1 : 8) : (budget == 16 ? 2 : 4);
                    CHECK(same_bits(render_here(scene, 30, with_tuning(slots, lanes, budget, steps)).film, usual));
                }
    }
}

// Devices need not take more than 128 MiB as one buffer, and Mesa's software driver does not.
TEST_CASE("there are no more paths than have room in one buffer", "[gpu][determinism][long]") {
    const Scene scene = glowing_cloud(2);
    RenderJob job = with_tuning(most_slots, 64, 16, 1), usual;
    job.plan.schedule = usual.plan.schedule = GENERATE(Schedule::fused, Schedule::staged);
    const RenderResult most = render_here(scene, 30, job);
    CHECK(most.plan.slots * path_bytes <= test_device().limits().maxStorageBufferRange);
    CHECK(same_bits(most.film, render_here(scene, 30, usual).film));
}

// On GPUs other kernels have other roundings.
TEST_CASE("how paths get to memory changes no bit", "[gpu][determinism][long]") {
    if (!test_device().is_cpu())
        return;
    Scene scene = glowing_cloud();
    const std::vector<std::string> integrators{"deltaTracking", "ratioNEE", "rayMarching"};
    scene.settings.integrator = GENERATE_REF(from_range(in_turn(integrators, 1)));
    const Film usual = render_here(scene, 30).film;
    for (const Schedule schedule : {Schedule::fused, Schedule::staged})
        for (const PathCopies copies : {PathCopies::by_word, PathCopies::in_loops}) {
            if ((copies == PathCopies::in_loops) != (schedule == Schedule::staged) && !thorough())
                continue;
            RenderJob job = with_tuning(512, 64, 16, 1);
            job.plan.schedule = schedule;
            job.plan.copies = copies;
            CAPTURE(scene.settings.integrator, int(schedule), int(copies));
            CHECK(same_bits(render_here(scene, 30, job).film, usual));
        }
}

// llvmpipe ends all loops of an invocation after 65535 iterations, and says nothing: a lane that goes on for so long
// loses what it was searching for, and its sample has other bits. A table of 65000 nodes is searched by 16 halvings and
// a look at whether that was all; seven times a turn, to draw and to evaluate for the lamp, for the sun, and for the
// next flight. A thousand turns, as lanes may have where nothing loops, would take twice what there is.
TEST_CASE("no search in a phase function is cut short, however long a lane works", "[gpu][determinism][phase]") {
    constexpr int nodes = 65000;
    std::string table;
    for (int i = 0; i < nodes; ++i)
        table += fmt::format("{:.6f} {:.6f}\n", 180.0 * i / (nodes - 1), 1.0 + 50.0 * std::exp(-i / 2000.0));
    Volume volume = medium(Sphere{{0, 0, 0}, 1.0}, 8.0, 1.0);
    volume.phase = PhaseFunction::table;
    volume.phase_details.file = write_text(table);
    Scene scene = scene_of(volume, 2.0, 8);
    scene.lights = {SphereLight{{0.0, 3.0, 0.0}, 0.5, Rgb(5.0)}, SunLight{{1.0, 0.0, 0.0}, Rgb(1.0), 20.0}};
    scene.settings.spp = 256;
    RenderJob patient; // submits are as long as they may be
    patient.plan.submit_seconds = 1e3;
    const RenderResult longest = render_here(scene, 45, patient);
    CAPTURE(longest.plan.budget);
    CHECK(longest.plan.budget * 7 * 17 <= 65535);
    CHECK(same_bits(longest.film, render_here(scene, 45, with_tuning(0, 0, 16, 0)).film));
}

// The same by looks from along flights and at tentative collisions besides: 19 searches a turn, in lanes of their own.
TEST_CASE("no search in a phase function is cut short, wherever light is looked for", "[gpu][determinism][phase]") {
    std::string table;
    for (int i = 0; i < 1801; ++i)
        table += fmt::format("{:.6f} {:.6f}\n", 0.1 * i, 1.0 + 50.0 * std::exp(-i / 60.0));
    Volume volume = medium(Box{{0, 0, 0}, glm::dvec3(2.0)}, 8.0, 1.0);
    volume.phase = PhaseFunction::table;
    volume.phase_details.file = write_text(table);
    Scene scene = scene_of(volume, 2.0, 8);
    scene.lights = {SphereLight{{0.0, 1.5, 0.0}, 0.5, Rgb(5.0)}, SunLight{{1.0, 0.0, 0.0}, Rgb(1.0), 20.0}};
    scene.settings.integrator = "ratioNEE";
    scene.settings.choices.free_flight = FREE_FLIGHT_DELTA;
    scene.settings.choices.distance = DISTANCE_MIXED;
    scene.settings.majorant_scale = 2.0;
    scene.settings.spp = 256;
    RenderJob patient; // submits are as long as they may be
    patient.plan.submit_seconds = 1e3;
    const RenderResult longest = render_here(scene, 45, patient);
    CAPTURE(longest.plan.budget);
    CHECK(longest.plan.budget * 19 * 12 <= 65535);
    CHECK(same_bits(longest.film, render_here(scene, 45, with_tuning(0, 0, 16, 0)).film));
}

TEST_CASE("samples wanted in several goes are those of one", "[gpu][determinism]") {
    const Scene scene = glowing_cloud(11);
    const Film whole = render_here(scene, 40).film;
    RenderJob job;
    job.plan.schedule = GENERATE(Schedule::fused, Schedule::staged);
    job.seed = 40;
    job.disk_cache = false;
    job.crop = {0, scene.picture.width, 0, scene.picture.height};
    Session session(test_device(), scene, job);
    session.render(3);
    CHECK(session.result().samples == 3);
    CHECK(*std::max_element(session.result().film.samples.begin(), session.result().film.samples.end()) == 3);
    session.render(4);
    session.render(11);
    CHECK(session.result().samples == 11);
    CHECK((same_bits(session.result().film, whole) || !test_device().is_cpu()));
}

TEST_CASE("a session that begins again has the bits of a new one", "[gpu][determinism]") {
    Scene scene = glowing_cloud(11);
    scene.settings.integrator = GENERATE("cachedRatioTracking", "lightTracing");
    scene.layers = scene.settings.integrator == "lightTracing" ? 0u : layer_direct | layer_depth;
    RenderJob job;
    job.plan.schedule = GENERATE(Schedule::fused, Schedule::staged);
    job.plan.slots = 64;
    job.plan.submit_seconds = 0.0;
    job.disk_cache = false;
    job.crop = {0, scene.picture.width, 0, scene.picture.height};
    job.seed = 41;
    Session session(test_device(), scene, job);
    int asked = 0;
    job.interrupted = [&] { return ++asked > 4; }; // with pixels left, but of particles
    session.render(7);
    const auto [least, most] =
        std::minmax_element(session.result().film.samples.begin(), session.result().film.samples.end());
    CHECK((*least < *most || scene.layers == 0u));
    job.interrupted = nullptr;
    job.seed = 42;
    session.begin_again();
    session.render(11);
    const RenderResult again = session.result();
    const RenderResult anew = render(test_device(), scene, job);
    CHECK((same_bits(again.film, anew.film) || !test_device().is_cpu()));
    CHECK(again.samples == 11);
    CHECK(again.counts.paths == anew.counts.paths);
    CHECK(again.counts.real_collisions == anew.counts.real_collisions);
    CHECK_FALSE(again.interrupted);
    const auto checkpointed = [&] {
        job.checkpoint = [](const Checkpoint&) {};
        session.begin_again();
    };
    CHECK_THROWS_AS(checkpointed(), std::logic_error);
}

// A search through many pieces takes several turns, and lanes are laid aside amid it.
TEST_CASE("a flight rests while a shadow ray from amid it asks for surfaces", "[gpu][determinism][surfaces]") {
    Scene scene = glowing_cloud(4);
    TriangleSurface confetti; // which rays pass near, and seldom meet
    for (int i = 0; i < 6000; ++i) {
        const glm::dvec3 share =
            glm::fract(double(i) * glm::dvec3(0.8191725, 0.6710436, 0.5497005)); // evenly in a cube
        const glm::dvec3 at = 14.0 * share - glm::dvec3(6.0, 7.0, 7.0);
        const int first = 3 * i;
        for (const glm::dvec3& corner : {glm::dvec3(0.0), glm::dvec3(0.03, 0.0, 0.0), glm::dvec3(0.0, 0.0, 0.03)})
            confetti.vertices.push_back(at + corner);
        confetti.triangles.emplace_back(first, first + 1, first + 2);
    }
    scene.surfaces.emplace_back().shape = confetti;
    scene.settings.integrator = "ratioNEE";
    RenderJob usual = with_tuning(0, 0, 0, 0), short_of_turns = with_tuning(0, 0, 16, 1);
    for (const Schedule schedule : {Schedule::fused, Schedule::staged})
        for (const PathCopies copies : {PathCopies::by_word, PathCopies::in_loops}) {
            if ((copies == PathCopies::by_word) != (schedule == Schedule::staged) && !thorough())
                continue;
            usual.plan.schedule = short_of_turns.plan.schedule = schedule;
            short_of_turns.plan.copies = copies;
            CHECK((same_bits(render_here(scene, 3, usual).film, render_here(scene, 3, short_of_turns).film) ||
                   !test_device().is_cpu()));
        }
}

TEST_CASE("trying both schedules leaves no trace in the picture", "[gpu][determinism]") {
    const Scene scene = glowing_cloud(11);
    const RenderResult usual = render_here(scene, 39);
    RenderJob job;
    job.plan.tries = true;
    job.seed = 39;
    job.disk_cache = false;
    job.crop = {0, scene.picture.width, 0, scene.picture.height};
    const RenderResult tried = render(test_device(), scene, job);
    CHECK((tried.plan.schedule == Schedule::fused || tried.plan.schedule == Schedule::staged));
    CHECK((same_bits(tried.film, usual.film) || !test_device().is_cpu()));
    CHECK(tried.counts.paths == usual.counts.paths);
}

TEST_CASE("a homogeneous picture does not depend on the sizes of the machine", "[gpu][determinism]") {
    Scene scene = scene_of(medium(Sphere{}, 5.0, 0.9, 0.5), 3.0, 33);
    scene.lights = {sunlight()};
    scene.settings.spp = 7;
    const Film usual = render_here(scene, 32).film;
    CHECK(same_bits(render_here(scene, 32, with_tuning(256, 64, 16, 1)).film, usual));
    CHECK(same_bits(render_here(scene, 32, with_tuning(4096, 512, 64, 8)).film, usual));
}

TEST_CASE("noise of many octaves has them all, however long a lane works", "[gpu][determinism]") {
    Scene scene = scene_of(medium(Sphere{}, 20.0, 0.97), 1.6, 48, 3.0);
    scene.volumes.front().noise = Noise{};
    scene.volumes.front().noise->octaves = GENERATE(5, 16);
    scene.volumes.front().noise->gain = 0.7;
    scene.volumes.front().Le = {0.3, 0.2, 0.1};
    scene.lights = {sunlight()};
    scene.background = Rgb(0.5);
    scene.settings.spp = 8;
    if (GENERATE(false, true)) {
        scene.settings.integrator = "unbiasedRayMarching";
    } else { // as many sums a step as there can be
        scene.settings.integrator = "ratioTracking";
        scene.settings.choices.transmittance = TRANSMITTANCE_JACKKNIFE;
        scene.settings.choices.emission = EMISSION_AT_STEPS;
    }
    CAPTURE(scene.volumes.front().noise->octaves, scene.settings.integrator);
    const Film whole = render_here(scene, 38).film;
    RenderJob job;
    job.crop = {17, 31, 9, 40}; // other lanes go other ways together
    CHECK(same_bits(render_here(scene, 38, job).film, cut(whole, job.crop)));
    job.plan.budget = 16;
    CHECK(same_bits(render_here(scene, 38, job).film, cut(whole, job.crop)));
}

TEST_CASE("tiles are parts of the whole picture, bit for bit", "[gpu][determinism]") {
    const Scene scene = glowing_cloud();
    const Film whole = render_here(scene, 33).film;
    for (const Crop& crop : {Crop{0, 13, 0, 40}, Crop{13, 40, 0, 17}, Crop{13, 40, 17, 40}, Crop{39, 40, 39, 40}}) {
        CAPTURE(crop.x0, crop.x1, crop.y0, crop.y1);
        RenderJob job;
        job.crop = crop;
        const Film tile = render_here(scene, 33, job).film;
        CHECK(tile.crop.x0 == crop.x0);
        CHECK(same_bits(tile, cut(whole, crop)));
    }
}

TEST_CASE("a film in several storage buffers has the same bits", "[gpu][determinism]") {
    const Scene scene = glowing_cloud();
    const Film whole = render_here(scene, 34).film;
    for (const std::uint64_t rows : {7, 17, 39}) {
        CAPTURE(rows);
        RenderJob job;
        job.plan.most_film_bytes = rows * 40 * sizeof(shared::FilmPixel);
        CHECK(same_bits(render_here(scene, 34, job).film, whole));
    }
}

// Both sums are exact to some 2^-48; mean and variance are rounded to single precision once before and once after
// merging: 2 units in the last place, 2^-22 relative, and for the variance that of the mean's square besides.
TEST_CASE("two ranges of samples merged are one run", "[gpu][determinism]") {
    const Film whole = render_here(glowing_cloud(16), 35).film;
    std::vector<MergeInput> parts;
    for (const std::uint32_t begin : {0u, 5u}) {
        Scene scene = glowing_cloud(begin == 0 ? 5 : 11);
        RenderJob job;
        job.sample_offset = begin;
        MergeInput part;
        part.name = std::to_string(begin);
        part.film = render_here(scene, 35, job).film;
        part.metadata = {
            {"vkvol/seed", 35}, {"vkvol/sampleOffset", int(begin)}, {"samplesPerPixel", int(scene.settings.spp)}};
        parts.push_back(std::move(part));
    }
    const Film merged = merge_films(parts).film;
    REQUIRE(merged.samples == whole.samples);
    double worst_mean = 0.0, worst_variance = 0.0;
    for (std::size_t i = 0; i < whole.pixel_count(); ++i)
        for (int channel = 0; channel < 3; ++channel) {
            const double mean = whole.mean[i][channel], variance = whole.variance[i][channel];
            worsen(worst_mean, std::abs(merged.mean[i][channel] - mean) / mean);
            worsen(worst_variance, std::abs(merged.variance[i][channel] - variance) /
                                       (variance + mean * std::sqrt(variance / 16) + 1e-9 * mean * mean));
        }
    CAPTURE(worst_mean, worst_variance);
    CHECK(worst_mean < 0x1p-22);
    CHECK(worst_variance < 0x1p-20);
}

// s^2 / n for two samples is (a - b)^2 / 4. The film's sums of squares are exact to 2^-45 of themselves, and the result
// is rounded to single precision.
TEST_CASE("the variance is that of the mean", "[gpu][determinism]") {
    const Film both = render_here(glowing_cloud(2), 36).film;
    RenderJob second;
    second.sample_offset = 1;
    const Film a = render_here(glowing_cloud(1), 36).film, b = render_here(glowing_cloud(1), 36, second).film;
    std::size_t wrong = 0, varying = 0;
    for (std::size_t i = 0; i < both.pixel_count(); ++i)
        for (int channel = 0; channel < 3; ++channel) {
            const double difference = double(a.mean[i][channel]) - b.mean[i][channel];
            const double expected = difference * difference / 4.0;
            varying += expected > 0.0;
            const double mean = both.mean[i][channel];
            wrong += std::abs(both.variance[i][channel] - expected) > 1e-6 * expected + 0x1p-44 * mean * mean;
            CHECK(a.variance[i][channel] == 0.0f);
        }
    CHECK(wrong == 0);
    CHECK(varying > 1000);
}

TEST_CASE("an interrupted render keeps true sample counts", "[gpu][determinism]") {
    const Scene scene = glowing_cloud(64);
    for (const int patience : {0, 3, 20, 60}) {
        CAPTURE(patience);
        RenderJob job = with_tuning(256, 64, 16, 1);
        job.plan.schedule = GENERATE(Schedule::fused, Schedule::staged);
        job.plan.submit_seconds = 1e-6; // one round per submit
        int asked = 0;
        job.interrupted = [&] { return asked++ >= patience; };
        const RenderResult result = render_here(scene, 37, job);
        CHECK(result.interrupted);
        CHECK(result.samples < 64);
        CHECK(*std::min_element(result.film.samples.begin(), result.film.samples.end()) >= result.samples);
        std::uint64_t paths = 0;
        for (const std::uint32_t n : result.film.samples)
            paths += n;
        CHECK(result.counts.paths == paths);
        check_samples_are_true(scene, 37, result.film);
    }
}

TEST_CASE("a render stopped by its time limit keeps true sample counts", "[gpu][determinism]") {
    const Scene scene = glowing_cloud(1u << 20);
    RenderJob job;
    job.time_limit = 0.3;
    job.plan.schedule = GENERATE(Schedule::fused, Schedule::staged);
    const RenderResult result = render_here(scene, 38, job);
    CHECK_FALSE(result.interrupted);
    CHECK(result.samples < scene.settings.spp);
    check_samples_are_true(scene, 38, result.film);
}

TEST_CASE("a render ends at the first power of two of samples whose noise is low enough", "[gpu][determinism]") {
    const auto noise_of = [](std::uint32_t spp) {
        return relative_noise(render_here(glowing_cloud(spp), 39).film).value();
    };
    const Scene scene = glowing_cloud(1u << 10);
    RenderJob job;
    job.plan.schedule = GENERATE(Schedule::fused, Schedule::staged);
    const double between = 0.5 * (noise_of(32) + noise_of(64));
    job.noise_goal = between;
    const RenderResult result = render_here(scene, 39, job);
    CHECK((result.reached_goal && !result.interrupted));
    CHECK(result.samples == 64);
    CHECK(result.film.mean == render_here(glowing_cloud(64), 39).film.mean);
    // Nothing is looked at before there are 16 samples.
    job.noise_goal = 0.9;
    CHECK(render_here(scene, 39, job).samples == 16);
    // With fewer samples than that takes.
    job.noise_goal = between;
    const RenderResult few = render_here(glowing_cloud(48), 39, job);
    CHECK((few.samples == 48 && !few.reached_goal));
}

// 49 of 50 paths pass, so that 16 do as a rule, which would be without noise.
TEST_CASE("noise is not looked at before what is rare can have been met", "[gpu][determinism]") {
    Scene scene = scene_of(medium(Sphere{{0.0, 0.0, 0.0}, 1.0}, 0.01, 0.0), 2.0, 8);
    scene.settings.spp = 1 << 20;
    scene.background = Rgb(1.0);
    scene.settings.choices.free_flight = FREE_FLIGHT_DELTA;
    RenderJob job;
    job.crop = {4, 5, 4, 5};
    job.noise_goal = 0.002;
    const RenderResult result = render_here(scene, 3, job);
    CHECK(result.reached_goal);
    CHECK(result.samples >= 2048); // four over the noise
    CHECK(result.film.variance.front().x > 0.0f);
}

TEST_CASE("all samples are taken, though a driver's loops end after 65535 iterations", "[gpu][determinism][long]") {
    Scene scene;
    RenderJob job;
    SECTION("of a background") {
        scene.picture.width = scene.picture.height = 2;
        job.plan.most_batch = GENERATE(0u, 1u << 20); // as it is chosen, and longer than any such loop
    }
    SECTION("beside a mesh, whose hierarchy each of them looks through") {
        const MeshFiles ball{{VKVOL_SOURCE_DIR "/scenes/thesis/models/SphereOnly.obj"}};
        scene = scene_of(medium(ball, 1.0, 0.5), 6.0, 60, 10.0, {0.0, 0.5, 0.0});
        job.crop = {53, 55, 7, 8}; // within its box
    }
    scene.background = {0.3, 0.5, 0.9};
    scene.settings.spp = 200000;
    const RenderResult result = render_here(scene, 1, job);
    CHECK(result.film.samples == std::vector<std::uint32_t>(result.film.pixel_count(), 200000));
    CHECK(result.counts.paths == 200000 * result.film.pixel_count());
}
