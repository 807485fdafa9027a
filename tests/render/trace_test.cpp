// The path that is followed is the one that was rendered.
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <set>

#include "support/images.h"
#include "support/scenes.h"
#include "support/test_device.h"
#include "support/thorough.h"
#include "trace.h"

using namespace vkvol;

namespace {

Scene looking_away() {
    Scene scene = sunlit_cloud(24, 1);
    scene.camera.yaw += 180.0;
    return scene;
}

RenderResult one_sample(Scene scene, int x, int y, std::uint32_t sample, bool trace,
                        Schedule schedule = Schedule::automatic) {
    scene.settings.spp = 1;
    RenderJob job;
    job.crop = {x, x + 1, y, y + 1};
    job.seed = 3;
    job.sample_offset = sample;
    job.trace = trace;
    job.plan.schedule = schedule;
    return render(test_device(), scene, job);
}

} // namespace

TEST_CASE("a followed path gathers the radiance of its sample, bit by bit", "[gpu][trace][long]") {
    const std::string integrator = GENERATE("ratioTracking", "cachedRatioTracking", "ratioNEE", "deltaTracking",
                                            "weightedTracking", "regularTracking");
    const bool chromatic = GENERATE(false, true);
    const Schedule schedule = GENERATE(Schedule::fused, Schedule::staged);
    if (chromatic != (schedule == Schedule::staged) && !thorough())
        return;
    Scene scene = sunlit_cloud(24, 1);
    scene.settings.integrator = integrator;
    if (chromatic)
        scene.volumes.front().sigma_s *= Rgb(1.0, 0.7, 0.2);
    CAPTURE(integrator, chromatic);
    std::size_t collisions = 0;
    for (const std::uint32_t sample : {2u, 3u}) { // which collide
        const RenderResult plain = one_sample(scene, 12, 11, sample, false, schedule);
        const RenderResult traced = one_sample(scene, 12, 11, sample, true, schedule);
        CHECK(plain.trace.empty());
        REQUIRE(traced.trace.size() >= 2);
        CHECK(traced.trace.front().kind == TRACE_DEPART);
        CHECK(traced.trace.back().kind == TRACE_END);
        CHECK(same_bits(plain.film, traced.film));
        CHECK(traced.trace.back().radiance == plain.film.mean.front());
        for (const shared::TraceRecord& r : traced.trace)
            collisions += r.kind == TRACE_COLLISION;
    }
    CHECK(collisions > 1);
}

TEST_CASE("a followed path is printed", "[gpu][trace]") {
    const RenderResult hit = one_sample(sunlit_cloud(24, 1), 12, 11, 4, true);
    const std::string table = trace_table(hit.trace, hit.trace_origin, hit.film.mean.front());
    for (const char* word : {"camera", "position (world)", "end"})
        CHECK_THAT(table, Catch::Contains(word));
    const RenderResult missed = one_sample(looking_away(), 0, 0, 4, true);
    CHECK(missed.trace.empty());
    CHECK_THAT(trace_table(missed.trace, missed.trace_origin, missed.film.mean.front()),
               Catch::Contains("radiance 0.3 0.5 0.9"));
}

TEST_CASE("each kind of vertex of a followed path has a name", "[gpu][trace][long]") {
    Scene scene = sunlit_cloud(24, 1);
    scene.surfaces.emplace_back().shape = BallSurface{{0.0, 0.0, 0.0}, 1.5};
    scene.settings.integrator = "bidirectional";
    std::string tables;
    std::set<std::uint32_t> kinds;
    for (std::uint32_t sample = 0; sample < 8; ++sample) {
        const RenderResult traced = one_sample(scene, 12, 11, sample, true);
        tables += trace_table(traced.trace, traced.trace_origin, traced.film.mean.front());
        for (const shared::TraceRecord& r : traced.trace)
            kinds.insert(r.kind);
    }
    CHECK(kinds.size() == TRACE_KINDS);
    for (const char* name : {"camera", "source", "scatter", "collision", "light", "surface", "escape", "end"})
        CHECK_THAT(tables, Catch::Contains(fmt::format("\n{} ", name)));
}
