// Kernels are compiled once for all who ask for the same.
#include <catch2/catch.hpp>
#include <future>

#include "begin.spv.h"
#include "fused.spv.h"
#include "pipelines.h"
#include "support/test_device.h"

using namespace vkvol;

TEST_CASE("a kernel is compiled once, however many ask for it", "[gpu][specialization]") {
    Pipelines pipelines(test_device().handle(), test_device().layout());
    const auto get = [&](std::span<const std::uint32_t> spirv, const Specialization& constants) {
        return pipelines.get(spirv, constants, nullptr);
    };
    Specialization constants{}, more_steps{};
    more_steps[SPEC_STEPS] = 7;
    const SharedPipeline fused = get(fused_spv, constants);
    CHECK(get(fused_spv, constants) == fused);
    CHECK(get(fused_spv, more_steps) != fused);
    // Which `begin` does not have.
    CHECK(get(begin_spv, constants) == get(begin_spv, more_steps));
    CHECK(get(begin_spv, constants) != fused);
    more_steps[SPEC_STEPS] = 8;
    auto ask = [&] { return get(fused_spv, more_steps); };
    auto first = std::async(std::launch::async, ask), second = std::async(std::launch::async, ask);
    CHECK(first.get() == second.get());
}

TEST_CASE("kernels that were not asked for in a long time are given up", "[gpu][specialization]") {
    Pipelines pipelines(test_device().handle(), test_device().layout(), false, 3);
    const auto get = [&](int steps) {
        Specialization constants{};
        constants[SPEC_STEPS] = steps;
        return std::weak_ptr(pipelines.get(fused_spv, constants, nullptr));
    };
    const auto first = get(1), second = get(2), third = get(3);
    get(2);
    get(1);
    get(2);
    const auto fourth = get(4);
    CHECK_FALSE(first.expired());
    CHECK_FALSE(second.expired());
    CHECK(third.expired());
    CHECK_FALSE(fourth.expired());
}

TEST_CASE("loops that a kernel asks to have written out are kept where that is pleaded for", "[cpu][specialization]") {
    Specialization constants{};
    constants[SPEC_SHAPE] = SHAPE_BOX;
    constants[SPEC_FIELD] = FIELD_GRID;
    constants[SPEC_FREE_FLIGHT] = FREE_FLIGHT_DELTA;
    constants[SPEC_SCATTERING] = SCATTERING_MULTIPLE;
    constants[SPEC_FILTER] = FILTER_TRILINEAR;
    constants[SPEC_STEPS] = 4;
    const std::vector<std::uint32_t> before = specialized(fused_spv, constants), after = loops_kept(before);
    REQUIRE(after.size() == before.size());
    constexpr std::uint32_t loop_merge = 246, unroll = 1, keep = 2;
    int kept = 0;
    std::size_t others = 0;
    for (std::size_t at = 5; at < before.size(); at += before[at] >> 16) {
        const bool asks = (before[at] & 0xffffu) == loop_merge && before[at + 3] == unroll;
        kept += asks && after[at + 3] == keep;
        for (std::size_t i = at; i < at + (before[at] >> 16); ++i)
            others += before[i] != after[i];
    }
    CHECK(kept > 0);
    CHECK(std::size_t(kept) == others);
}
