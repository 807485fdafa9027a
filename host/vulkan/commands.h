// Recording, submitting and waiting for one command buffer at a time, and copies between host and device.
#pragma once

#include <functional>
#include <span>

#include "buffer.h"

namespace vkvol {

class Commands {
public:
    explicit Commands(const Device& device);
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    // Records, submits and waits until the device is done.
    void run(const std::function<void(VkCommandBuffer)>& record);

    // `data` to the buffer from byte `begin` on.
    void upload(const Buffer& buffer, std::span<const std::byte> data, VkDeviceSize begin = 0);
    // From byte `begin` of the buffer on.
    void download(const Buffer& buffer, std::span<std::byte> data, VkDeviceSize begin = 0);
    void fill(const Buffer& buffer, std::uint32_t word);

private:
    void create();
    void release();

    const Device& device_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer buffer_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
};

// Everything written before is visible to every later command: right between passes, which all share their buffers.
void record_barrier(VkCommandBuffer commands);

} // namespace vkvol
