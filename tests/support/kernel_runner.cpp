#include "kernel_runner.h"

#include "test_device.h"

namespace vkvol {

namespace {

Buffer make_buffer(Commands& commands, const char* name, std::span<const std::byte> data, VkBufferUsageFlags usage) {
    Buffer buffer(test_device(), name, data.size(), usage, BufferPlace::device);
    commands.upload(buffer, data);
    return buffer;
}

} // namespace

KernelRunner::KernelRunner(std::span<const std::uint32_t> spirv, const Specialization& specialization,
                           const KernelScene& scene)
    : commands_(test_device()), counters_(test_device(), "counters", sizeof(shared::Counters),
                                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::device) {
    commands_.fill(counters_, 0);
    scene_buffers_.emplace(test_device(), commands_, Media(scene.volume, scene.volume ? 1 : 0), nullptr,
                           scene.most_grid_bytes != 0 ? scene.most_grid_bytes
                                                      : std::uint64_t{test_device().limits().maxStorageBufferRange},
                           std::uint64_t{4} * test_device().limits().maxTexelBufferElements);
    if (scene.lights)
        scene_buffers_->upload_lights(test_device(), commands_, *scene.lights, scene.sky);
    scene_buffers_->set_frame(commands_, scene.frame);
    BoundBuffers bound = scene_buffers_->bound();
    bound[BINDING_COUNTERS] = &counters_;
    Specialization constants = specialization;
    constants[SPEC_TEXELS] = scene_buffers_->texels() ? 1 : 0;
    constants[SPEC_WINDOW_BITS] = static_cast<std::int32_t>(scene_buffers_->window_bits().value_or(0));
    bindings_.emplace(test_device(), bound);
    pass_.emplace(test_device(), *bindings_, spirv, constants, VK_NULL_HANDLE);
}

shared::Counters KernelRunner::counters() {
    shared::Counters counters;
    commands_.download(counters_, std::as_writable_bytes(std::span(&counters, 1)));
    return counters;
}

void KernelRunner::run_bytes(std::span<const std::byte> inputs, std::span<std::byte> outputs, std::uint32_t threads) {
    const auto storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    const Buffer in = make_buffer(commands_, "test inputs", inputs, storage);
    const Buffer out(test_device(), "test outputs", outputs.size(), storage, BufferPlace::device);
    commands_.fill(out, 0xffffffffu); // what no invocation wrote shows as NaN
    bindings_->bind(BINDING_TEST_INPUT, in);
    bindings_->bind(BINDING_TEST_OUTPUT, out);
    push.lanes = threads;
    commands_.run([&](VkCommandBuffer commands) {
        pass_->record(commands, push, threads);
        record_barrier(commands);
    });
    commands_.download(out, outputs);
}

} // namespace vkvol
