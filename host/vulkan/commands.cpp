#include "commands.h"

#include <algorithm>

#include "vulkan_error.h"

namespace vkvol {

Commands::Commands(const Device& device) : device_(device) {
    try {
        create();
    } catch (...) {
        release();
        throw;
    }
}

void Commands::create() {
    VkCommandPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = device_.queue_family();
    VK_CHECK(vkCreateCommandPool(device_.handle(), &pool, nullptr, &pool_));
    VkCommandBufferAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocate.commandPool = pool_;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    VK_CHECK(vkAllocateCommandBuffers(device_.handle(), &allocate, &buffer_));
    VkFenceCreateInfo fence{};
    fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VK_CHECK(vkCreateFence(device_.handle(), &fence, nullptr, &fence_));
}

Commands::~Commands() {
    release();
}

void Commands::release() {
    vkDestroyFence(device_.handle(), fence_, nullptr);
    vkDestroyCommandPool(device_.handle(), pool_, nullptr);
}

void Commands::run(const std::function<void(VkCommandBuffer)>& record) {
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    VK_CHECK(vkBeginCommandBuffer(buffer_, &begin));
    record(buffer_);
    VK_CHECK(vkEndCommandBuffer(buffer_));
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &buffer_;
    // Here, since a wait that failed left it as it was: signalled it would let what follows begin too early.
    VK_CHECK(vkResetFences(device_.handle(), 1, &fence_));
    VK_CHECK(vkQueueSubmit(device_.queue(), 1, &submit, fence_));
    const VkResult waited = vkWaitForFences(device_.handle(), 1, &fence_, VK_TRUE, UINT64_MAX);
    if (waited < 0)
        vkDeviceWaitIdle(device_.handle()); // whoever learns of the failure frees what the device may still be using
    check_vulkan(waited, "vkWaitForFences", __FILE__, __LINE__);
}

namespace {
constexpr VkDeviceSize staging_bytes = 16u << 20;

void record_copy(VkCommandBuffer commands, const Buffer& from, VkDeviceSize from_offset, const Buffer& to,
                 VkDeviceSize to_offset, VkDeviceSize size) {
    const VkBufferCopy region{from_offset, to_offset, size};
    record_barrier(commands);
    vkCmdCopyBuffer(commands, from.handle(), to.handle(), 1, &region);
    record_barrier(commands);
}
} // namespace

void Commands::upload(const Buffer& buffer, std::span<const std::byte> data, VkDeviceSize begin) {
    if (data.empty())
        return;
    if (buffer.mapped()) {
        std::memcpy(buffer.view<std::byte>().data() + begin, data.data(), data.size());
        return;
    }
    Buffer staging(device_, "staging buffer", std::min<VkDeviceSize>(staging_bytes, data.size()), 0, BufferPlace::host);
    for (VkDeviceSize offset = 0; offset < data.size(); offset += staging.bytes()) {
        const VkDeviceSize size = std::min<VkDeviceSize>(staging.bytes(), data.size() - offset);
        std::memcpy(staging.mapped(), data.data() + offset, size);
        run([&](VkCommandBuffer commands) { record_copy(commands, staging, 0, buffer, begin + offset, size); });
    }
}

void Commands::download(const Buffer& buffer, std::span<std::byte> data, VkDeviceSize begin) {
    if (data.empty())
        return;
    if (buffer.mapped()) {
        std::memcpy(data.data(), buffer.view<std::byte>().data() + begin, data.size());
        return;
    }
    Buffer staging(device_, "staging buffer", std::min<VkDeviceSize>(staging_bytes, data.size()), 0, BufferPlace::host);
    for (VkDeviceSize offset = 0; offset < data.size(); offset += staging.bytes()) {
        const VkDeviceSize size = std::min<VkDeviceSize>(staging.bytes(), data.size() - offset);
        run([&](VkCommandBuffer commands) { record_copy(commands, buffer, begin + offset, staging, 0, size); });
        std::memcpy(data.data() + offset, staging.mapped(), size);
    }
}

void Commands::fill(const Buffer& buffer, std::uint32_t word) {
    run([&](VkCommandBuffer commands) {
        vkCmdFillBuffer(commands, buffer.handle(), 0, VK_WHOLE_SIZE, word);
        record_barrier(commands);
    });
}

void record_barrier(VkCommandBuffer commands) {
    VkMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    barrier.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                            VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT |
                            VK_ACCESS_UNIFORM_READ_BIT | VK_ACCESS_HOST_READ_BIT;
    const VkPipelineStageFlags stages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    vkCmdPipelineBarrier(commands, stages, stages | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0,
                         1, &barrier, 0, nullptr, 0, nullptr);
}

} // namespace vkvol
