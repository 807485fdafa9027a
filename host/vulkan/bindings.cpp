#include "bindings.h"

#include <cstring>

#include "pipeline_layout.h"
#include "vulkan_error.h"

namespace vkvol {

namespace {
VkFormat texel_format(std::uint32_t binding) {
    return binding == BINDING_LATTICE_TEXELS                                    ? VK_FORMAT_R32G32B32A32_SFLOAT
           : binding == BINDING_SKY_ALIAS_TEXELS                                ? VK_FORMAT_R32G32_UINT
           : binding == BINDING_MAJORANT_TEXELS                                 ? VK_FORMAT_R32_SFLOAT
           : binding == BINDING_MEMBER_TEXELS || binding >= BINDING_NODE_TEXELS ? VK_FORMAT_R32G32B32A32_UINT
                                                                                : VK_FORMAT_R32_UINT;
}
} // namespace

Bindings::Bindings(const Device& device, const BoundBuffers& buffers, VkAccelerationStructureKHR boxes)
    : device_(device), unused_(device, "placeholder", 256,
                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                                   VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
                               BufferPlace::host) {
    std::memset(unused_.mapped(), 0, unused_.bytes()); // what is read in vain, and nothing of it used, may be an index
    try {
        create();
        for (std::uint32_t i = 0; i < BINDING_BUFFERS; ++i)
            bind(i, buffers[i] ? *buffers[i] : unused_);
        for (std::uint32_t i = BINDING_BUFFERS; i < BINDING_COUNT; ++i)
            bind_texels(i, buffers[i] ? *buffers[i] : unused_);
        if (boxes)
            bind_boxes(boxes);
    } catch (...) {
        release();
        throw;
    }
}

void Bindings::create() {
    std::vector<VkDescriptorPoolSize> sizes{{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
                                            {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, BINDING_BUFFERS - 1},
                                            {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, BINDING_COUNT - BINDING_BUFFERS}};
    if (device_.has_ray_queries())
        sizes.push_back({VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1});
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.maxSets = 1;
    pool.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    pool.pPoolSizes = sizes.data();
    VK_CHECK(vkCreateDescriptorPool(device_.handle(), &pool, nullptr, &pool_));
    VkDescriptorSetAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocate.descriptorPool = pool_;
    allocate.descriptorSetCount = 1;
    const VkDescriptorSetLayout layout = device_.layout().set_layout();
    allocate.pSetLayouts = &layout;
    VK_CHECK(vkAllocateDescriptorSets(device_.handle(), &allocate, &set_));
}

void Bindings::write(std::uint32_t binding, const VkDescriptorBufferInfo* buffer, const VkBufferView* texels,
                     const void* more) {
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.pNext = more;
    write.dstSet = set_;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = descriptor_type(binding);
    write.pBufferInfo = buffer;
    write.pTexelBufferView = texels;
    vkUpdateDescriptorSets(device_.handle(), 1, &write, 0, nullptr);
}

void Bindings::bind(std::uint32_t binding, const Buffer& buffer) {
    const VkDescriptorBufferInfo info{buffer.handle(), 0, buffer.bytes()};
    write(binding, &info, nullptr);
}

void Bindings::bind_texels(std::uint32_t binding, const Buffer& buffer) {
    VkBufferViewCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO;
    create.buffer = buffer.handle();
    create.format = texel_format(binding);
    create.range = VK_WHOLE_SIZE;
    VK_CHECK(vkCreateBufferView(device_.handle(), &create, nullptr, &views_.emplace_back(VK_NULL_HANDLE)));
    write(binding, nullptr, &views_.back());
}

void Bindings::bind_boxes(VkAccelerationStructureKHR boxes) {
    VkWriteDescriptorSetAccelerationStructureKHR structure{};
    structure.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR;
    structure.accelerationStructureCount = 1;
    structure.pAccelerationStructures = &boxes;
    write(BINDING_BOXES, nullptr, nullptr, &structure);
}

Bindings::~Bindings() {
    release();
}

void Bindings::release() {
    for (const VkBufferView view : views_)
        vkDestroyBufferView(device_.handle(), view, nullptr);
    vkDestroyDescriptorPool(device_.handle(), pool_, nullptr);
}

} // namespace vkvol
