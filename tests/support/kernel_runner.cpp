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
    BoundBuffers bound{};
    bound[BINDING_COUNTERS] = &counters_;
    scene_buffers_.reserve(7); // the set keeps their addresses
    const auto bind = [&](int binding, const char* name, std::span<const std::byte> data, VkBufferUsageFlags usage) {
        scene_buffers_.push_back(make_buffer(commands_, name, data, usage));
        bound[binding] = &scene_buffers_.back();
    };
    bind(BINDING_FRAME, "frame", std::as_bytes(std::span(&scene.frame, 1)), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    const auto storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    if (scene.volume && scene.volume->field) {
        bind(BINDING_GRID, "grid", scene.volume->field->bytes.span(), storage);
        bind(BINDING_LEAF_TABLE, "leaf table", std::as_bytes(std::span(scene.volume->field->leaf_table)), storage);
        bind(BINDING_MAJORANTS, "majorants", std::as_bytes(std::span(scene.volume->majorants->bounds)), storage);
        if (!scene.volume->controls.empty())
            bind(BINDING_CONTROLS, "controls", std::as_bytes(std::span(scene.volume->controls)), storage);
    }
    if (scene.volume && scene.volume->bvh) {
        bind(BINDING_TRIANGLES, "triangles", std::as_bytes(std::span(scene.volume->bvh->triangles)), storage);
        bind(BINDING_BVH, "hierarchy", std::as_bytes(std::span(scene.volume->bvh->nodes)), storage);
    }
    bindings_.emplace(test_device(), bound);
    pass_.emplace(test_device(), *bindings_, spirv, specialization, VK_NULL_HANDLE);
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
