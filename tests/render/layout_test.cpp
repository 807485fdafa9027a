// Host and kernels see the same structs: the host fills each with words that are all different, a kernel writes every
// field out by name, and the host compares. Catches what offsets alone cannot: a wrong layout qualifier, a GLM setting,
// a feature that is not enabled.
#include <catch2/catch.hpp>

#include "layout.spv.h"
#include "support/kernel_runner.h"
#include "support/test_device.h"

using namespace vkvol;

namespace {

struct Structs {
    shared::SamplePlace waiting;
    shared::ControlCell control_cell;
    shared::PhaseNode phase_node;
    shared::MapKnot map_knot;
    shared::LightRow light_row;
    shared::LightNode light_node;
    shared::EmitterRow emitter_row;
    shared::SurfaceRow surface_row;
    shared::SurfacePrimitive piece;
    shared::BvhNode bvh_node;
    shared::QueueHeader header;
    shared::FilmPixel entry;
    shared::Counters counters;
    shared::FrameParams frame;
    shared::PassPush push;
};

// Words from 0x40000001 on are different numbers both as integers and as normal floats, which no device flushes to 0.
Structs distinct_words() {
    Structs all;
    std::vector<std::uint32_t> words(sizeof all / 4);
    for (std::uint32_t i = 0; i < words.size(); ++i)
        words[i] = 0x40000001u + 37u * i;
    std::memcpy(static_cast<void*>(&all), words.data(), sizeof all);
    return all;
}

// The words of all fields by name, as the host sees them.
std::vector<std::uint32_t> list_words(const Structs& all) {
    std::vector<std::uint32_t> words;
    const auto put = [&](const auto& field) {
        const std::size_t first = words.size();
        words.resize(first + sizeof field / 4);
        std::memcpy(&words[first], &field, sizeof field);
    };
    const auto& [waiting, control_cell, phase_node, map_knot, light_row, light_node, emitter_row, surface_row, piece,
                 bvh_node, header, entry, counters, frame, push] = all;
#define PUT(field) put(field);
#define PUT_EACH(field, count)                                                                                         \
    for (int k = 0; k < count; ++k)                                                                                    \
        put(field[k]);
#include "kernels/layout_fields.h"
#undef PUT
#undef PUT_EACH
    return words;
}

template <class T> Buffer second_of_two(Commands& commands, const T& value, VkBufferUsageFlags usage) {
    Buffer buffer(test_device(), "layout test", 2 * sizeof(T), usage, BufferPlace::device);
    const std::array<T, 2> both{T{}, value};
    commands.upload(buffer, std::as_bytes(std::span(both)));
    return buffer;
}

} // namespace

TEST_CASE("shared structs have one layout on host and device", "[gpu][layout]") {
    const Structs all = distinct_words();
    const std::vector<std::uint32_t> expected = list_words(all);
    // Every word of every struct is listed, so the structs have no padding and the list misses no field.
    REQUIRE(expected.size() * 4 == sizeof(Structs));

    const auto storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    Commands commands(test_device());
    const Buffer places = second_of_two(commands, all.waiting, storage);
    const Buffer controls = second_of_two(commands, all.control_cell, storage);
    const Buffer phase_nodes = second_of_two(commands, all.phase_node, storage);
    const Buffer map_knots = second_of_two(commands, all.map_knot, storage);
    const Buffer lights = second_of_two(commands, all.light_row, storage);
    const Buffer light_nodes = second_of_two(commands, all.light_node, storage);
    const Buffer emitters = second_of_two(commands, all.emitter_row, storage);
    const Buffer surfaces = second_of_two(commands, all.surface_row, storage);
    const Buffer primitives = second_of_two(commands, all.piece, storage);
    const Buffer nodes = second_of_two(commands, all.bvh_node, storage);
    const Buffer headers = second_of_two(commands, all.header, storage);
    const Buffer film = second_of_two(commands, all.entry, storage);
    Buffer counters(test_device(), "layout test", sizeof all.counters, storage, BufferPlace::device);
    commands.upload(counters, std::as_bytes(std::span(&all.counters, 1)));
    Buffer frame(test_device(), "layout test", sizeof all.frame, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                 BufferPlace::device);
    commands.upload(frame, std::as_bytes(std::span(&all.frame, 1)));
    const Buffer output(test_device(), "layout test", sizeof(Structs), storage, BufferPlace::device);

    BoundBuffers bound{};
    bound[BINDING_PLACES] = &places;
    bound[BINDING_CONTROLS] = &controls;
    bound[BINDING_PHASE] = &phase_nodes;
    bound[BINDING_MAPS] = &map_knots;
    bound[BINDING_LIGHTS] = &lights;
    bound[BINDING_LIGHT_TREE] = &light_nodes;
    bound[BINDING_EMITTERS] = &emitters;
    bound[BINDING_SURFACES] = &surfaces;
    bound[BINDING_PRIMITIVES] = &primitives;
    bound[BINDING_BVH] = &nodes;
    bound[BINDING_QUEUES] = &headers;
    bound[BINDING_FILM] = &film;
    bound[BINDING_COUNTERS] = &counters;
    bound[BINDING_FRAME] = &frame;
    bound[BINDING_TEST_OUTPUT] = &output;
    const Bindings bindings(test_device(), bound);
    const ComputePass pass(test_device(), bindings, layout_spv, {}, nullptr);
    commands.run([&](VkCommandBuffer c) {
        pass.record(c, all.push, 1);
        record_barrier(c);
    });
    std::vector<std::uint32_t> words(expected.size());
    commands.download(output, std::as_writable_bytes(std::span(words)));
    for (std::size_t i = 0; i < words.size(); ++i) {
        CAPTURE(i);
        CHECK(words[i] == expected[i]);
    }
}
