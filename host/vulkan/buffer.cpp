#include "buffer.h"

#include <fmt/format.h>
#include <utility>

#include "file_limit.h"
#include "vulkan_error.h"

namespace vkvol {

Buffer::Buffer(const Device& device, const std::string& name, VkDeviceSize bytes, VkBufferUsageFlags usage,
               BufferPlace place)
    : device_(device), bytes_(bytes) {
    const VkDeviceSize range = device.limits().maxStorageBufferRange;
    if ((usage & VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) && bytes > range)
        throw InputError(fmt::format("the {} takes {:.1f} MiB, but a storage buffer of \"{}\" ends at {:.1f} MiB; "
                                     "use a grid, mesh or picture of fewer voxels, triangles or pixels",
                                     name, bytes / 1048576.0, device.info().name, range / 1048576.0));
    VkBufferCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    create.size = bytes;
    create.usage = usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VK_CHECK(vkCreateBuffer(device.handle(), &create, nullptr, &buffer_));
    VkMemoryRequirements need;
    vkGetBufferMemoryRequirements(device.handle(), buffer_, &need);

    const VkMemoryPropertyFlags visible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    int type = -1;
    // Where the device is this machine's processor one mapping spares every copy.
    if (place == BufferPlace::host || device.is_cpu())
        type = device.find_memory_type(need.memoryTypeBits, visible | VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
    if (place == BufferPlace::host && type < 0)
        type = device.find_memory_type(need.memoryTypeBits, visible);
    const bool map = type >= 0;
    if (type < 0)
        type = device.find_memory_type(need.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    if (type < 0)
        type = device.find_memory_type(need.memoryTypeBits, 0);

    VkMemoryAllocateFlagsInfo flags{};
    flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocate.pNext = usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT ? &flags : nullptr;
    allocate.allocationSize = need.size;
    allocate.memoryTypeIndex = static_cast<std::uint32_t>(type);
    file_limit_met(); // by others before
    const VkResult result = vkAllocateMemory(device.handle(), &allocate, nullptr, &memory_);
    if (file_limit_met()) { // even where the result is a success: its pages would not be there
        release();
        throw RenderError(fmt::format("\"{}\" keeps its memory in a file, and no file may grow enough for the {} "
                                      "({:.1f} MiB); raise the limit of file sizes (ulimit -f)",
                                      device.info().name, name, bytes / 1048576.0));
    }
    if (result != VK_SUCCESS) {
        release();
        throw VulkanError(result, fmt::format("{} for the {} ({:.1f} MiB) on \"{}\"; use a smaller picture or grid",
                                              result_name(result), name, bytes / 1048576.0, device.info().name));
    }
    try {
        VK_CHECK(vkBindBufferMemory(device.handle(), buffer_, memory_, 0));
        if (map)
            VK_CHECK(vkMapMemory(device.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &mapped_));
    } catch (...) {
        release();
        throw;
    }
}

Buffer::Buffer(Buffer&& other) noexcept
    : device_(other.device_), buffer_(std::exchange(other.buffer_, VK_NULL_HANDLE)),
      memory_(std::exchange(other.memory_, VK_NULL_HANDLE)), bytes_(other.bytes_), mapped_(other.mapped_) {}

VkDeviceAddress Buffer::address() const {
    VkBufferDeviceAddressInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    info.buffer = buffer_;
    return vkGetBufferDeviceAddress(device_.handle(), &info);
}

Buffer::~Buffer() {
    release();
}

void Buffer::release() {
    vkDestroyBuffer(device_.handle(), buffer_, nullptr);
    vkFreeMemory(device_.handle(), memory_, nullptr);
}

} // namespace vkvol
