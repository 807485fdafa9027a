#include "compute_pass.h"

#include "vulkan_error.h"

namespace vkvol {

ComputePass::ComputePass(const Device& device, const Bindings& bindings, std::span<const std::uint32_t> spirv,
                         const Specialization& specialization, VkPipelineCache cache)
    : device_(device), bindings_(bindings) {
    const std::vector<std::uint32_t> code = specialized(spirv, specialization);
    VkShaderModuleCreateInfo module_info{};
    module_info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    module_info.codeSize = code.size() * sizeof(std::uint32_t);
    module_info.pCode = code.data();
    VkShaderModule module = VK_NULL_HANDLE;
    VK_CHECK(vkCreateShaderModule(device.handle(), &module_info, nullptr, &module));

    VkComputePipelineCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    create.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    create.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    create.stage.module = module;
    create.stage.pName = "main";
    create.layout = bindings.layout();
    const VkResult result = vkCreateComputePipelines(device.handle(), cache, 1, &create, nullptr, &pipeline_);
    vkDestroyShaderModule(device.handle(), module, nullptr);
    check_vulkan(result, "vkCreateComputePipelines", __FILE__, __LINE__);
}

ComputePass::~ComputePass() {
    vkDestroyPipeline(device_.handle(), pipeline_, nullptr);
}

void ComputePass::bind(VkCommandBuffer commands, const shared::PassPush& push) const {
    const VkDescriptorSet set = bindings_.set();
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, bindings_.layout(), 0, 1, &set, 0, nullptr);
    vkCmdPushConstants(commands, bindings_.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(push), &push);
}

void ComputePass::record(VkCommandBuffer commands, const shared::PassPush& push, std::uint32_t threads) const {
    bind(commands, push);
    vkCmdDispatch(commands, (threads + WORKGROUP_SIZE - 1) / WORKGROUP_SIZE, 1, 1);
}

void ComputePass::record_indirect(VkCommandBuffer commands, const shared::PassPush& push, const Buffer& arguments,
                                  VkDeviceSize offset) const {
    bind(commands, push);
    vkCmdDispatchIndirect(commands, arguments.handle(), offset);
}

} // namespace vkvol
