#include "specialization.h"

#include <fmt/format.h>
#include <spirv-tools/optimizer.hpp>
#include <unordered_map>

#include "error.h"

namespace vkvol {

namespace {
// SPIR-V 1.5, sections 2.3 and 3: five words of header, then instructions with their length in the upper half of the
// first word, and what they are in the lower one.
constexpr std::uint32_t spirv_header = 5;
} // namespace

Specialization declared_of(std::span<const std::uint32_t> spirv, const Specialization& specialization) {
    // Decorations come before the first function.
    constexpr std::uint32_t op_function = 54, op_decorate = 71, decoration_spec_id = 1;
    Specialization declared{};
    for (std::size_t i = spirv_header; i < spirv.size() && (spirv[i] & 0xffff) != op_function; i += spirv[i] >> 16)
        if ((spirv[i] & 0xffff) == op_decorate && spirv[i + 2] == decoration_spec_id)
            declared[spirv[i + 3]] = specialization[spirv[i + 3]];
    return declared;
}

const char* const specialization_method = "2";

std::vector<std::uint32_t> specialized(std::span<const std::uint32_t> spirv, const Specialization& specialization) {
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> values;
    for (std::uint32_t id = 0; id < SPEC_COUNT; ++id)
        values[id] = {static_cast<std::uint32_t>(specialization[id])};
    std::string trouble;
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_2);
    optimizer.SetMessageConsumer(
        [&](spv_message_level_t, const char*, const spv_position_t&, const char* message) { trouble += message; });
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass());
    // First what whole functions can shed, so that less is inlined, then, with the few left in one, what follows from
    // each other. More passes would spare drivers less time than they take themselves.
    for (const bool inlined : {false, true}) {
        if (inlined)
            optimizer.RegisterPass(spvtools::CreateInlineExhaustivePass())
                .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
        else
            optimizer.RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
                .RegisterPass(spvtools::CreateDeadBranchElimPass());
        optimizer.RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
            .RegisterPass(spvtools::CreateCCPPass())
            .RegisterPass(spvtools::CreateDeadBranchElimPass())
            .RegisterPass(spvtools::CreateAggressiveDCEPass());
    }
    spvtools::OptimizerOptions options;
    options.set_run_validator(false); // it was validated when built
    std::vector<std::uint32_t> result;
    if (!optimizer.Run(spirv.data(), spirv.size(), &result, options))
        throw RenderError(
            fmt::format("a kernel could not be specialised: {}; please report this with the scene", trouble));
    return result;
}

std::vector<std::uint32_t> loops_kept(std::vector<std::uint32_t> spirv) {
    constexpr std::uint32_t op_loop_merge = 246, unroll = 1, dont_unroll = 2;
    for (std::size_t i = spirv_header; i < spirv.size(); i += spirv[i] >> 16)
        if ((spirv[i] & 0xffff) == op_loop_merge && spirv[i + 3] == unroll)
            spirv[i + 3] = dont_unroll;
    return spirv;
}

} // namespace vkvol
