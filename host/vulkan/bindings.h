// The one descriptor set that every pass shares.
#pragma once

#include <array>
#include <vector>

#include "buffer.h"
#include "shared/constants.h"

namespace vkvol {

// Buffers by binding number. Bindings that a scene has no use for may be left null. Those from BINDING_BUFFERS on are
// read as texels, and made with VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT.
using BoundBuffers = std::array<const Buffer*, BINDING_COUNT>;

class Bindings {
public:
    // `boxes`: at BINDING_BOXES, where kernels ask for them.
    Bindings(const Device& device, const BoundBuffers& buffers, VkAccelerationStructureKHR boxes = VK_NULL_HANDLE);
    ~Bindings();
    Bindings(const Bindings&) = delete;
    Bindings& operator=(const Bindings&) = delete;

    // Puts `buffer` in place of what was bound there. No submitted work may still use the set.
    void bind(std::uint32_t binding, const Buffer& buffer);

    VkDescriptorSet set() const { return set_; }

private:
    void create();
    void release();
    void bind_texels(std::uint32_t binding, const Buffer& buffer);
    void bind_boxes(VkAccelerationStructureKHR boxes);
    void write(std::uint32_t binding, const VkDescriptorBufferInfo* buffer, const VkBufferView* texels,
               const void* more = nullptr);

    const Device& device_;
    Buffer unused_; // stands where a scene needs no buffer
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    std::vector<VkBufferView> views_;
};

} // namespace vkvol
