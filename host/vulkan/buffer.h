// A Vulkan buffer with its memory.
#pragma once

#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "device.h"

namespace vkvol {

enum class BufferPlace {
    device, // fast for kernels; the host reaches it through copies, or directly where the memory allows
    host    // mapped for the host, coherent
};

class Buffer {
public:
    // Throws InputError naming the buffer if it is larger than the device allows, RenderError if memory is short.
    Buffer(const Device& device, const std::string& name, VkDeviceSize bytes, VkBufferUsageFlags usage,
           BufferPlace place);
    ~Buffer();
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;
    Buffer(Buffer&& other) noexcept;

    VkBuffer handle() const { return buffer_; }
    VkDeviceSize bytes() const { return bytes_; }
    // For kernels; needs VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT.
    VkDeviceAddress address() const;
    // Null if the host cannot see this memory.
    void* mapped() const { return mapped_; }

    template <class T> std::span<T> view() const { return {static_cast<T*>(mapped_), bytes_ / sizeof(T)}; }

private:
    void release();

    const Device& device_;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkDeviceSize bytes_;
    void* mapped_ = nullptr;
};

} // namespace vkvol
