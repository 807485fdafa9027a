// Kernels are compiled once for all who ask for the same.
#include <catch2/catch.hpp>
#include <future>

#include "begin.spv.h"
#include "bindings.h"
#include "fused.spv.h"
#include "pipelines.h"
#include "support/test_device.h"

using namespace vkvol;

TEST_CASE("a kernel is compiled once, however many ask for it", "[gpu][specialization]") {
    Pipelines pipelines(test_device().handle());
    const Bindings bindings(test_device(), {}), others(test_device(), {});
    const auto get = [&](std::span<const std::uint32_t> spirv, const Specialization& constants, const Bindings& by) {
        return pipelines.get(spirv, constants, by.layout(), VK_NULL_HANDLE);
    };
    Specialization constants{}, more_steps{};
    more_steps[SPEC_STEPS] = 7;
    const SharedPipeline fused = get(fused_spv, constants, bindings);
    CHECK(get(fused_spv, constants, others) == fused);
    CHECK(get(fused_spv, more_steps, bindings) != fused);
    // Which `begin` does not have.
    CHECK(get(begin_spv, constants, bindings) == get(begin_spv, more_steps, bindings));
    CHECK(get(begin_spv, constants, bindings) != fused);
    more_steps[SPEC_STEPS] = 8;
    auto ask = [&] { return get(fused_spv, more_steps, bindings); };
    auto first = std::async(std::launch::async, ask), second = std::async(std::launch::async, ask);
    CHECK(first.get() == second.get());
}

TEST_CASE("kernels that were not asked for in a long time are given up", "[gpu][specialization]") {
    Pipelines pipelines(test_device().handle(), 3);
    const Bindings bindings(test_device(), {});
    const auto get = [&](int steps) {
        Specialization constants{};
        constants[SPEC_STEPS] = steps;
        return std::weak_ptr(pipelines.get(fused_spv, constants, bindings.layout(), VK_NULL_HANDLE));
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
