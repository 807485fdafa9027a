#include "compute_pass.h"

#include "pipeline_layout.h"
#include "pipelines.h"

namespace vkvol {

ComputePass::ComputePass(const Device& device, const Bindings& bindings, std::span<const std::uint32_t> spirv,
                         const Specialization& specialization, const PipelineCache* cache)
    : bindings_(bindings), layout_(device.layout().handle()),
      pipeline_(device.pipelines().get(spirv, specialization, cache)) {}

void ComputePass::bind(VkCommandBuffer commands, const shared::PassPush& push) const {
    const VkDescriptorSet set = bindings_.set();
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_->handle());
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set, 0, nullptr);
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(push), &push);
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
