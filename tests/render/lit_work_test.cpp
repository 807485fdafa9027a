// What may be done with a picture — to stop it and go on, to cut it up, to put samples together, to follow a path —
// under a map of the sky, lamps, and surfaces that shine.
#include <catch2/catch.hpp>
#include <filesystem>
#include <optional>

#include "checkpoint.h"
#include "integrators.h"
#include "merge.h"
#include "support/images.h"
#include "support/surface_scenes.h"
#include "support/test_device.h"

using namespace vkvol;

namespace {

constexpr int edge = 24; // pixels

// A cloud above a floor, under all that is drawn from tables: a map, lamps by the tree, pieces of a mesh.
Scene lit_scene(std::uint32_t samples) {
    Scene scene = scene_of(medium(cloud_file(), 2.0, 0.9, 0.5), 13.0, edge);
    scene.lights = {write_sky(sunset_map()), SphereLight{{4.0, 5.5, 2.0}, 0.8, {9.0, 7.0, 4.0}},
                    PointLight{{-5.0, 4.0, 3.0}, {20.0, 30.0, 40.0}}};
    Surface lantern;
    lantern.shape = round_mesh(5, 1.2);
    for (glm::dvec3& vertex : std::get<TriangleSurface>(lantern.shape).vertices)
        vertex += glm::dvec3(3.0, -4.0, 5.0);
    lantern.material = matte(0.2);
    lantern.emission = {2.0, 3.0, 4.0};
    scene.surfaces = {lantern, surface_of(PlaneSurface{{0.0, -6.0, 0.0}, {0.0, 1.0, 0.0}}, MaterialKind::diffuse)};
    scene.settings.spp = samples;
    return scene;
}

RenderResult part_of(const Scene& scene, RenderJob job) {
    if (job.crop.x1 == 0)
        job.crop = {0, edge, 0, edge};
    job.seed = 6;
    return render(test_device(), scene, job);
}

RenderJob job_by(Schedule schedule) {
    RenderJob job;
    job.plan.schedule = schedule;
    return job;
}

Checkpoint last_checkpoint(const Scene& scene) {
    std::optional<Checkpoint> last;
    RenderJob job;
    job.checkpoint_seconds = 0.0;
    job.checkpoint = [&](const Checkpoint& checkpoint) { last = checkpoint; };
    part_of(scene, job);
    REQUIRE(last);
    return *last;
}

} // namespace

TEST_CASE("under a map, lamps and what shines a render goes on with the same bits",
          "[gpu][checkpoint][surfaces][long]") {
    const Schedule schedule = GENERATE(Schedule::fused, Schedule::staged);
    const Scene scene = lit_scene(6);
    RenderJob job = job_by(schedule);
    job.plan.slots = 64;
    job.plan.submit_seconds = 0.0;
    const RenderResult whole = part_of(scene, job);
    std::vector<Checkpoint> checkpoints;
    job.checkpoint = [&](const Checkpoint& checkpoint) { checkpoints.push_back(checkpoint); };
    job.checkpoint_seconds = 0.0;
    part_of(scene, job);
    REQUIRE(checkpoints.size() > 4);
    for (std::size_t i = 0; i < checkpoints.size(); i += (checkpoints.size() / 4) | 1u) {
        RenderJob rest = job_by(schedule == Schedule::fused ? Schedule::staged : Schedule::fused);
        rest.resume = &checkpoints[i];
        CAPTURE(i, checkpoints.size());
        CHECK((same_bits(part_of(scene, rest).film, whole.film) || !test_device().is_cpu()));
    }
}

TEST_CASE("a checkpoint is continued under its own lights alone", "[gpu][checkpoint][surfaces]") {
    const Scene scene = lit_scene(2);
    const Checkpoint last = last_checkpoint(scene);
    Scene other = scene;
    SECTION("of the map's rotation") {
        std::get<SkyLight>(other.lights.front()).rotation = 10.0;
    }
    SECTION("of the map's texels") {
        const SkyLight changed = write_sky(make_map(16, 8, [](int, int row) { return Rgb(row < 2 ? 3.0 : 0.5); }));
        std::filesystem::copy_file(changed.file, std::get<SkyLight>(other.lights.front()).file,
                                   std::filesystem::copy_options::overwrite_existing);
    }
    SECTION("of where a point is") {
        std::get<PointLight>(other.lights.back()).position.x -= 1e-3;
    }
    SECTION("of what a surface sends out") {
        other.surfaces.front().emission.b *= 1.01;
    }
    SECTION("of whether it shines on both sides") {
        other.surfaces.front().shines_both_ways = true;
    }
    SECTION("of where one of its corners is") {
        std::get<TriangleSurface>(other.surfaces.front().shape).vertices.front().y += 1e-3;
    }
    RenderJob rest;
    rest.resume = &last;
    CHECK_THROWS_WITH(part_of(other, rest), Catch::Contains("--resume: the checkpoint is of"));
}

TEST_CASE("under a map, lamps and what shines tiles are parts of the whole", "[gpu][determinism][surfaces][long]") {
    const Scene scene = lit_scene(5);
    const Film whole = part_of(scene, job_by(Schedule::fused)).film;
    RenderJob job = job_by(Schedule::staged);
    job.crop = {5, 19, 7, 24};
    const Film tile = part_of(scene, job).film;
    std::size_t other = 0;
    for (int y = job.crop.y0; y < job.crop.y1; ++y)
        for (int x = job.crop.x0; x < job.crop.x1; ++x) {
            const std::size_t there = std::size_t(y) * edge + std::size_t(x);
            const std::size_t here = std::size_t(y - job.crop.y0) * tile.width() + std::size_t(x - job.crop.x0);
            other += tile.mean[here] != whole.mean[there] || tile.variance[here] != whole.variance[there];
        }
    CHECK((other == 0 || !test_device().is_cpu()));
}

// As in determinism_test.cpp: rounded to single precision before and after.
TEST_CASE("under a map, lamps and what shines two ranges of samples are one run", "[gpu][determinism][surfaces]") {
    const Film whole = part_of(lit_scene(16), job_by(Schedule::fused)).film;
    std::vector<MergeInput> parts;
    for (const std::uint32_t begin : {0u, 5u}) {
        const Scene scene = lit_scene(begin == 0 ? 5 : 11);
        RenderJob job = job_by(Schedule::fused);
        job.sample_offset = begin;
        MergeInput part;
        part.name = std::to_string(begin);
        part.film = part_of(scene, job).film;
        part.metadata = {
            {"vkvol/seed", 6}, {"vkvol/sampleOffset", int(begin)}, {"samplesPerPixel", int(scene.settings.spp)}};
        parts.push_back(std::move(part));
    }
    const Film merged = merge_films(parts).film;
    REQUIRE(merged.samples == whole.samples);
    std::size_t worse = 0;
    for (std::size_t i = 0; i < whole.pixel_count(); ++i)
        for (int channel = 0; channel < 3; ++channel) {
            const double mean = whole.mean[i][channel];
            worse += !(std::abs(merged.mean[i][channel] - mean) <= 0x1p-22 * mean);
        }
    CHECK(worse == 0);
}

TEST_CASE("a path is followed under a map, lamps and what shines", "[gpu][trace][surfaces][long]") {
    const auto [integrator, schedule] = GENERATE(std::pair<std::string, Schedule>("ratioTracking", Schedule::staged),
                                                 std::pair<std::string, Schedule>("ratioNEE", Schedule::fused));
    Scene scene = lit_scene(1);
    const IntegratorRequest request = parse_integrator(integrator);
    scene.settings.integrator = request.name;
    scene.settings.choices = request.choices;
    std::size_t collisions = 0, met = 0;
    for (std::uint32_t sample = 0; sample < 6; ++sample) {
        RenderJob job = job_by(schedule);
        job.crop = {12, 13, 11, 12};
        job.sample_offset = sample;
        const Film plain = part_of(scene, job).film;
        job.trace = true;
        const RenderResult traced = part_of(scene, job);
        CAPTURE(integrator, sample);
        CHECK(same_bits(traced.film, plain));
        REQUIRE_FALSE(traced.trace.empty());
        CHECK(traced.trace.back().radiance == plain.mean.front());
        for (const shared::TraceRecord& record : traced.trace) {
            collisions += record.kind == TRACE_COLLISION;
            met += record.kind == TRACE_SURFACE;
        }
    }
    CHECK(collisions > 1);
    CHECK(met > 1);
}
