#include "wavefront.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>
#include <future>
#include <utility>

#include "begin.spv.h"
#include "generate.spv.h"
#include "prepare.spv.h"
#include "sky.spv.h"
#include "track.spv.h"
#include "track_chromatic.spv.h"
#include "track_chromatic_windows.spv.h"
#include "track_windows.spv.h"
#include "vulkan_error.h"

namespace vkvol {

namespace {

constexpr std::uint32_t most_rounds = 64;          // per submit
constexpr std::uint32_t marks = pass_names.size(); // timestamps per round: before and after each pass but sky
constexpr VkDeviceSize queue_bytes = QUEUE_COUNT * sizeof(shared::QueueHeader);
constexpr std::uint64_t sky_samples = 1u << 22; // per submit: some 70 ms on two cores of a software driver
constexpr std::uint32_t first_budget = 64;      // on a device of unknown speed

BoundBuffers with_queues(BoundBuffers buffers, const Buffer& paths, const Buffer& betas, const Buffer& suspended,
                         const Buffer& items, const Buffer& queues, const Buffer& work, const Buffer& counters) {
    buffers[BINDING_PATHS] = &paths;
    buffers[BINDING_BETAS] = &betas;
    buffers[BINDING_SUSPENDED] = &suspended;
    buffers[BINDING_QUEUE_ITEMS] = &items;
    buffers[BINDING_QUEUES] = &queues;
    buffers[BINDING_WORK] = &work;
    buffers[BINDING_COUNTERS] = &counters;
    return buffers;
}

// Nothing left of what the last pass saw, and nothing pushed since.
bool is_empty(const shared::QueueHeader& header) {
    return header.tail == header.limit && static_cast<std::int32_t>(header.limit - header.head) <= 0;
}

// llvmpipe leaves every loop of an invocation after so many iterations in all, the one that ends a loop included, and
// without a word.
constexpr std::uint32_t most_iterations = 65535;

// Of all loops in a turn of the track pass that are not unrolled, at most. Every step has up to four places for a sum
// over octaves, which all lanes of a group pass under a mask: a flight's look-up, emission along it, and two of a
// shadow ray that marches in several sets of samples.
std::uint32_t turn_iterations(const LoopSizes& loops, std::uint32_t steps) {
    constexpr std::uint32_t triangle = 2, node = 1 + (MESH_LEAF + 1) + MESH_LEAF * triangle;
    std::uint32_t iterations = 2 + (steps + 1);
    if (loops.mesh)
        iterations += 2 + 1 + MESH_NODES_PER_TURN * node;
    if (loops.octaves > 0)
        iterations += 4 * steps * (loops.octaves + 1);
    return iterations;
}

// Turns of the track pass, and samples of a pixel that the sky pass loops over, whose loops stay below the limit.
std::uint32_t longest_budget(const LoopSizes& loops, std::uint32_t steps) {
    return std::clamp(most_iterations / turn_iterations(loops, steps), 1u, 1024u);
}
constexpr std::uint32_t longest_batch = most_iterations / 2;

std::span<const std::uint32_t> track_kernel(const TrackVariant& variant) {
    if (variant.window_bits)
        return variant.chromatic ? std::span<const std::uint32_t>(track_chromatic_windows_spv) : track_windows_spv;
    return variant.chromatic ? std::span<const std::uint32_t>(track_chromatic_spv) : track_spv;
}

} // namespace

Tuning tune(const Device& device, const LoopSizes& loops, const Tuning& wish) {
    const auto pick = [](auto wanted, auto usual) { return wanted != 0 ? wanted : usual; };
    Tuning tuning = wish;
    // A software driver wants its state in cache and few lanes that each do much; a GPU wants to be full.
    tuning.slots = pick(wish.slots, device.is_cpu() ? 8192u : 1u << 18);
    tuning.lanes = pick(wish.lanes, device.is_cpu() ? 512u : 1u << 17);
    tuning.steps_per_look = pick(wish.steps_per_look, 4u);
    const std::uint32_t longest = longest_budget(loops, tuning.steps_per_look);
    tuning.budget = std::min(pick(wish.budget, longest), longest);
    tuning.step_limit = pick(wish.step_limit, 1u << 26);
    tuning.most_batch = pick(wish.most_batch, longest_batch);
    tuning.most_film_bytes =
        pick(wish.most_film_bytes, std::min<std::uint64_t>(device.limits().maxStorageBufferRange, 1u << 30));
    tuning.most_grid_bytes = pick(wish.most_grid_bytes, std::uint64_t{device.limits().maxStorageBufferRange});
    // GPUs read storage as fast as texels; software drivers gather only these.
    const std::uint64_t texels = device.is_cpu() ? 4ull * device.limits().maxTexelBufferElements : 1u;
    tuning.most_texel_bytes = pick(wish.most_texel_bytes, texels);
    return tuning;
}

std::uint32_t queue_capacity(const Tuning& tuning) {
    return std::bit_ceil(2 * tuning.slots);
}

Wavefront::Wavefront(const Device& device, const BoundBuffers& scene_buffers, std::uint32_t most_pixels,
                     const Specialization& specialization, const TrackVariant& variant, const Tuning& tuning,
                     VkPipelineCache cache)
    : device_(device), tuning_(tuning), commands_(device),
      paths_(device, "path states", tuning.slots * sizeof(shared::PathState), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
             BufferPlace::device),
      betas_(device, "path throughputs", tuning.slots * (variant.chromatic ? sizeof(glm::vec3) : sizeof(float)),
             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::device),
      suspended_(device, "suspended paths", tuning.slots * sizeof(shared::Suspended),
                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::device),
      queue_items_(device, "queues", std::uint64_t{QUEUE_COUNT} * queue_capacity(tuning) * sizeof(std::uint32_t),
                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::device),
      queues_(device, "queue headers", queue_bytes,
              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, BufferPlace::device),
      work_(device, "work list", std::uint64_t{most_pixels} * sizeof(std::uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            BufferPlace::device),
      counter_buffer_(device, "counters", sizeof(shared::Counters), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                      BufferPlace::device),
      readback_(device, "readback", queue_bytes + sizeof(shared::Counters), 0, BufferPlace::host),
      bindings_(device,
                with_queues(scene_buffers, paths_, betas_, suspended_, queue_items_, queues_, work_, counter_buffer_)) {
    Specialization constants = specialization;
    constants[SPEC_STEPS] = static_cast<std::int32_t>(tuning.steps_per_look);
    push_.budget = std::min(tuning.budget, first_budget);
    constants[SPEC_WINDOW_BITS] = static_cast<std::int32_t>(variant.window_bits.value_or(0));
    const auto make = [&](std::span<const std::uint32_t> spirv) {
        return std::make_unique<ComputePass>(device, bindings_, spirv, constants, cache);
    };
    // The one large kernel compiles beside the others.
    auto track = std::async(std::launch::async, make, track_kernel(variant));
    begin_ = make(begin_spv);
    sky_ = make(sky_spv);
    prepare_ = make(prepare_spv);
    generate_ = make(generate_spv);
    track_ = track.get();

    commands_.fill(queues_, 0);
    commands_.fill(counter_buffer_, 0);
    if (device.has_timestamps()) {
        VkQueryPoolCreateInfo pool{};
        pool.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        pool.queryType = VK_QUERY_TYPE_TIMESTAMP;
        pool.queryCount = most_rounds * marks;
        VK_CHECK(vkCreateQueryPool(device.handle(), &pool, nullptr, &timestamps_));
    }
}

Wavefront::~Wavefront() {
    vkDestroyQueryPool(device_.handle(), timestamps_, nullptr);
}

std::uint64_t Wavefront::bytes() const {
    return paths_.bytes() + betas_.bytes() + suspended_.bytes() + queue_items_.bytes() + queues_.bytes() +
           work_.bytes() + counter_buffer_.bytes() + readback_.bytes();
}

void Wavefront::bind_film(const Buffer& film) {
    bindings_.bind(BINDING_FILM, film);
}

void Wavefront::begin_batch(std::uint32_t begin, std::uint32_t end, std::uint32_t pixels) {
    free_slots(begin, end);
    const auto start = std::chrono::steady_clock::now();
    sort_pixels(pixels);
    sky_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Wavefront::begin_batch(std::uint32_t begin, std::uint32_t end, std::span<const std::uint32_t> pixels) {
    free_slots(begin, end);
    const auto count = static_cast<std::uint32_t>(pixels.size());
    commands_.upload(work_, std::as_bytes(pixels));
    commands_.run([&](VkCommandBuffer commands) {
        vkCmdFillBuffer(commands, counter_buffer_.handle(), offsetof(shared::Counters, work_count), sizeof count,
                        count);
        record_barrier(commands);
    });
}

std::vector<std::uint32_t> Wavefront::pixels_left() {
    const std::uint32_t first = std::min(counters_.next_work, counters_.work_count);
    std::vector<std::uint32_t> pixels(counters_.work_count - first);
    commands_.download(work_, std::as_writable_bytes(std::span(pixels)), first * sizeof(std::uint32_t));
    return pixels;
}

void Wavefront::free_slots(std::uint32_t begin, std::uint32_t end) {
    push_.sample_begin = begin;
    push_.sample_end = end;
    push_.stop = 0;
    push_.step_limit = tuning_.step_limit;
    rounds_ = 1; // many came to little at the end of the last batch
    commands_.run([&](VkCommandBuffer commands) {
        begin_->record(commands, push_, tuning_.slots);
        record_barrier(commands);
    });
}

void Wavefront::sort_pixels(std::uint32_t pixels) {
    const std::uint32_t samples = push_.sample_end - push_.sample_begin;
    const std::uint64_t most = std::uint64_t{device_.limits().maxComputeWorkGroupCount[0]} * WORKGROUP_SIZE;
    const auto chunk = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(
        sky_samples / samples, WORKGROUP_SIZE, std::max<std::uint64_t>(most, WORKGROUP_SIZE)));
    for (std::uint32_t first = 0; first < pixels; first += chunk) {
        push_.pixel_begin = first;
        push_.pixel_end = std::min(pixels, first + chunk);
        commands_.run([&](VkCommandBuffer commands) {
            sky_->record(commands, push_, push_.pixel_end - push_.pixel_begin);
            record_barrier(commands);
        });
    }
}

bool Wavefront::advance() {
    const auto start = std::chrono::steady_clock::now();
    commands_.run([&](VkCommandBuffer commands) {
        if (timestamps_)
            vkCmdResetQueryPool(commands, timestamps_, 0, rounds_ * marks);
        for (std::uint32_t round = 0; round < rounds_; ++round)
            record_round(commands, round);
        record_readback(commands);
    });
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    read_timestamps();
    adapt(seconds);
    std::memcpy(&counters_, readback_.view<std::byte>().data() + queue_bytes, sizeof counters_);
    const auto headers = std::span(static_cast<const shared::QueueHeader*>(readback_.mapped()), QUEUE_COUNT);
    return std::all_of(headers.begin(), headers.end(), is_empty);
}

std::uint32_t Wavefront::in_flight() const {
    const auto headers = std::span(static_cast<const shared::QueueHeader*>(readback_.mapped()), QUEUE_COUNT);
    const shared::QueueHeader& header = headers[QUEUE_RESUME];
    const bool all_taken = static_cast<std::int32_t>(header.head - header.limit) > 0;
    return header.tail - (all_taken ? header.limit : header.head);
}

// generate -> track. What a pass pushes to an earlier queue, or to its own, waits for the next round.
void Wavefront::record_round(VkCommandBuffer commands, std::uint32_t round) {
    record_timestamp(commands, round, 0);
    record_pass(commands, QUEUE_GENERATE, *generate_, tuning_.slots);
    record_timestamp(commands, round, 1);
    record_prepare(commands, QUEUE_RESUME, QUEUE_RESUME, tuning_.lanes);
    record_prepare(commands, QUEUE_TRACK, QUEUE_RESUME, tuning_.lanes);
    record_consumer(commands, QUEUE_TRACK, *track_);
    record_timestamp(commands, round, 2);
}

void Wavefront::record_pass(VkCommandBuffer commands, std::uint32_t queue, const ComputePass& pass,
                            std::uint32_t lanes) {
    record_prepare(commands, queue, queue, lanes);
    record_consumer(commands, queue, pass);
}

void Wavefront::record_prepare(VkCommandBuffer commands, std::uint32_t queue, std::uint32_t before,
                               std::uint32_t lanes) {
    push_.queue = queue;
    push_.before = before;
    push_.lanes = lanes;
    prepare_->record(commands, push_, 1);
    record_barrier(commands);
}

void Wavefront::record_consumer(VkCommandBuffer commands, std::uint32_t queue, const ComputePass& pass) {
    const VkDeviceSize header = queue * sizeof(shared::QueueHeader);
    pass.record_indirect(commands, push_, queues_, header + offsetof(shared::QueueHeader, groups_x));
    record_barrier(commands);
}

void Wavefront::record_timestamp(VkCommandBuffer commands, std::uint32_t round, std::uint32_t mark) {
    if (timestamps_)
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps_, round * marks + mark);
}

// The host reads counters and queue headers from its own copy; the counters then start again from 0.
void Wavefront::record_readback(VkCommandBuffer commands) {
    const VkBufferCopy headers{0, 0, queue_bytes};
    const VkBufferCopy counters{0, queue_bytes, sizeof(shared::Counters)};
    vkCmdCopyBuffer(commands, queues_.handle(), readback_.handle(), 1, &headers);
    vkCmdCopyBuffer(commands, counter_buffer_.handle(), readback_.handle(), 1, &counters);
    record_barrier(commands);
    constexpr VkDeviceSize kept = offsetof(shared::Counters, paths); // the work list outlives a submit
    vkCmdFillBuffer(commands, counter_buffer_.handle(), kept, sizeof(shared::Counters) - kept, 0);
    record_barrier(commands);
}

void Wavefront::read_timestamps() {
    pass_seconds_ = {std::exchange(sky_seconds_, 0.0)};
    if (!timestamps_)
        return;
    std::array<std::uint64_t, most_rounds * marks> ticks;
    VK_CHECK(vkGetQueryPoolResults(device_.handle(), timestamps_, 0, rounds_ * marks, sizeof ticks, ticks.data(),
                                   sizeof(std::uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
    for (std::uint32_t round = 0; round < rounds_; ++round)
        for (std::uint32_t pass = 1; pass < pass_names.size(); ++pass)
            pass_seconds_[pass] += static_cast<double>(ticks[round * marks + pass] - ticks[round * marks + pass - 1]) *
                                   device_.limits().timestampPeriod * 1e-9;
}

// First lanes work for longer at a time, for they are laid aside less often then; after that there are more rounds.
// Only where a round alone takes far too long, as a slow device's driver would not suffer, lanes work for less long
// again.
void Wavefront::adapt(double seconds) {
    const double factor = std::clamp(tuning_.submit_seconds / std::max(seconds, 1e-6), 0.5, 2.0);
    if (factor > 1.0 && push_.budget < tuning_.budget)
        push_.budget = std::min(2 * push_.budget, tuning_.budget);
    else if (rounds_ == 1 && seconds > 4.0 * tuning_.submit_seconds)
        push_.budget = std::min(std::max(push_.budget / 2, 16u), tuning_.budget);
    else
        rounds_ = std::clamp(static_cast<std::uint32_t>(rounds_ * factor + 0.5), 1u, most_rounds);
}

} // namespace vkvol
