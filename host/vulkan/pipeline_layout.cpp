#include "pipeline_layout.h"

#include <vector>

#include "shared/frame.h"
#include "vulkan_error.h"

namespace vkvol {

VkDescriptorType descriptor_type(std::uint32_t binding) {
    return binding == BINDING_FRAME    ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
           : binding == BINDING_BOXES  ? VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR
           : binding < BINDING_BUFFERS ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                       : VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
}

PipelineLayout::PipelineLayout(VkDevice device, bool has_boxes) : device_(device) {
    static_assert(BINDING_BOXES == BINDING_COUNT, "it comes after the buffers");
    std::vector<VkDescriptorSetLayoutBinding> slots(BINDING_COUNT + (has_boxes ? 1 : 0));
    for (std::uint32_t i = 0; i < slots.size(); ++i)
        slots[i] = {i, descriptor_type(i), 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    VkDescriptorSetLayoutCreateInfo set_layout{};
    set_layout.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set_layout.bindingCount = static_cast<std::uint32_t>(slots.size());
    set_layout.pBindings = slots.data();
    VK_CHECK(vkCreateDescriptorSetLayout(device_, &set_layout, nullptr, &set_layout_));

    const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(shared::PassPush)};
    VkPipelineLayoutCreateInfo layout{};
    layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &set_layout_;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &push;
    const VkResult made = vkCreatePipelineLayout(device_, &layout, nullptr, &layout_);
    if (made < 0)
        vkDestroyDescriptorSetLayout(device_, set_layout_, nullptr);
    check_vulkan(made, "vkCreatePipelineLayout", __FILE__, __LINE__);
}

PipelineLayout::~PipelineLayout() {
    vkDestroyPipelineLayout(device_, layout_, nullptr);
    vkDestroyDescriptorSetLayout(device_, set_layout_, nullptr);
}

} // namespace vkvol
