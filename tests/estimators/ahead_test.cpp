// A walk that finds several steps ahead (ahead.glsl) ends as one that takes them one at a time: the same event at the
// same place, with the same throughput, random numbers and counts, bit for bit.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

#include "ahead.spv.h"
#include "ahead_chromatic.spv.h"
#include "support/numbers.h"
#include "support/test_medium.h"

using namespace vkvol;
using shared::AheadOutput;
using shared::RayInput;
using test_numbers::collided;
using test_numbers::left;
using test_numbers::opaque;

namespace {

enum class Segment : std::uint32_t { flight = 0, shadow_ray = 1 };

std::vector<AheadOutput> segments(const TestScene& scene, const std::vector<RayInput>& rays, Segment segment,
                                  int steps_ahead) {
    Specialization specialization = scene.specialization;
    specialization[SPEC_STEPS] = std::max(steps_ahead, 1);
    const EmbeddedKernel& spirv = scene.chromatic ? ahead_chromatic_spv : ahead_spv;
    KernelRunner runner(spirv, specialization, scene.kernel);
    runner.push.step_limit = 20000;
    runner.push.sample_begin = steps_ahead > 0 ? 1 : 0;
    runner.push.sample_end = static_cast<std::uint32_t>(segment);
    return runner.run<AheadOutput>(rays);
}

// Rays into the medium in many directions, each with many random numbers.
std::vector<RayInput> inputs(const TestMedium& medium) {
    std::vector<RayInput> all;
    std::uint32_t seed = 71;
    for (const reference::Ray& ray : medium.random_rays(40, 70, 0.05, 1e9))
        for (const RayInput& input : medium.flights_along(ray, 25, seed++, {0.7f, 1.0f, 0.4f}))
            all.push_back(input);
    return all;
}

bool same(const AheadOutput& a, const AheadOutput& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

// Checks what one step at a time makes of all rays: a test of few kinds of ends would prove little.
void check_variety(const std::vector<AheadOutput>& ends, Segment segment) {
    const auto count = [&](const auto& is) { return std::count_if(ends.begin(), ends.end(), is); };
    CHECK(count([](const AheadOutput& end) { return end.event == left; }) > 20);
    const std::uint32_t other = segment == Segment::flight ? collided : opaque;
    CHECK(count([&](const AheadOutput& end) { return end.event == other; }) > 20);
    CHECK(count([](const AheadOutput& end) { return end.nulls > 2; }) > 20);
    CHECK(count([](const AheadOutput& end) { return end.cells > 2; }) > 20);
}

} // namespace

TEST_CASE("steps of split flights found ahead are those taken one at a time",
          "[gpu][free_flight][first_flight][long]") {
    const bool chromatic = GENERATE(false, true);
    MediumRecipe recipe;
    recipe.filter = Filter::stochastic;
    recipe.leaps = true;
    recipe.grid = sparse_recipe();
    recipe.grid.cell = 4;
    recipe.grid.linear = skewed;
    recipe.estimators = {chromatic ? FREE_FLIGHT_SPECTRAL : FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO, {}};
    recipe.sigma_t = chromatic ? Rgb(1.0, 0.3, 0.6) : Rgb(1.0);
    const TestMedium medium(recipe);
    TestScene scene = medium.scene();
    scene.specialization[SPEC_FIRST_FLIGHT] = FIRST_FLIGHT_SPLIT;
    const std::vector<RayInput> rays = inputs(medium);
    const std::vector<AheadOutput> one_at_a_time = segments(scene, rays, Segment::flight, 0);
    check_variety(one_at_a_time, Segment::flight);
    for (const int ahead : {1, 2, 4}) {
        const std::vector<AheadOutput> found_ahead = segments(scene, rays, Segment::flight, ahead);
        const auto first = std::mismatch(found_ahead.begin(), found_ahead.end(), one_at_a_time.begin(), same).first;
        CAPTURE(chromatic, ahead, first - found_ahead.begin());
        CHECK(first == found_ahead.end());
    }
}

TEST_CASE("steps found ahead are those taken one at a time", "[gpu][free_flight][transmittance]") {
    struct Case {
        int free_flight, transmittance;
        Filter filter;
        Storage storage;
        bool chromatic, leaps;
        double majorant_scale;
    };
    const std::vector<Case> cases = {
        {FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO, Filter::stochastic, Storage::float32, false, false, 2.0},
        {FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO, Filter::stochastic, Storage::fp8, false, true, 2.0},
        {FREE_FLIGHT_DELTA, TRANSMITTANCE_DELTA, Filter::trilinear, Storage::float32, false, true, 3.0},
        {FREE_FLIGHT_DELTA, TRANSMITTANCE_RATIO, Filter::nearest, Storage::fpn, false, false, 2.0},
        {FREE_FLIGHT_WEIGHTED, TRANSMITTANCE_RATIO, Filter::stochastic, Storage::float32, false, true, 0.7},
        {FREE_FLIGHT_SPECTRAL, TRANSMITTANCE_RATIO, Filter::stochastic, Storage::fp16, true, true, 2.0},
        {FREE_FLIGHT_SPECTRAL, TRANSMITTANCE_DELTA, Filter::trilinear, Storage::fp4, true, false, 2.0},
    };
    const Case c = cases[static_cast<std::size_t>(GENERATE(range(0, 7)))];
    MediumRecipe recipe;
    recipe.filter = c.filter;
    recipe.majorant_scale = c.majorant_scale;
    recipe.leaps = c.leaps;
    recipe.grid = c.leaps ? sparse_recipe() : larger_recipe(c.storage);
    recipe.grid.storage = c.storage;
    recipe.grid.cell = 4;
    recipe.grid.linear = skewed;
    recipe.estimators = {c.free_flight, c.transmittance, {}};
    recipe.sigma_t = Rgb(c.leaps ? 4.0 : 0.8) * (c.chromatic ? Rgb(1.0, 0.3, 0.6) : Rgb(1.0));
    const TestMedium medium(recipe);
    const std::vector<RayInput> rays = inputs(medium);
    for (const Segment segment : {Segment::flight, Segment::shadow_ray}) {
        const std::vector<AheadOutput> one_at_a_time = segments(medium.scene(), rays, segment, 0);
        CAPTURE(c.free_flight, c.transmittance, int(c.filter), c.leaps, int(segment));
        check_variety(one_at_a_time, segment);
        for (const int ahead : {1, 2, 4, 7}) {
            const std::vector<AheadOutput> found_ahead = segments(medium.scene(), rays, segment, ahead);
            const auto first = std::mismatch(found_ahead.begin(), found_ahead.end(), one_at_a_time.begin(), same).first;
            CAPTURE(ahead, first - found_ahead.begin());
            CHECK(first == found_ahead.end());
        }
    }
}
