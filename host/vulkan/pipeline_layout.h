// How kernels find what is bound: one descriptor set, and push constants. A device has one, which outlives all
// pipelines that were made with it, as Vulkan 1.2 asks.
#pragma once

#include <cstdint>
#include <vulkan/vulkan.h>

#include "shared/constants.h"

namespace vkvol {

VkDescriptorType descriptor_type(std::uint32_t binding);

class PipelineLayout {
public:
    // `has_boxes`: BINDING_BOXES is among what is bound. Throws VulkanError.
    PipelineLayout(VkDevice device, bool has_boxes);
    ~PipelineLayout();
    PipelineLayout(const PipelineLayout&) = delete;
    PipelineLayout& operator=(const PipelineLayout&) = delete;

    VkPipelineLayout handle() const { return layout_; }
    VkDescriptorSetLayout set_layout() const { return set_layout_; }

private:
    VkDevice device_;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
};

} // namespace vkvol
