#include "wavefront.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <future>
#include <utility>

#include "accumulate_forms.h"
#include "begin.spv.h"
#include "collect.spv.h"
#include "fused_forms.h"
#include "generate_forms.h"
#include "hand_out.spv.h"
#include "kernel_constants.h"
#include "prepare.spv.h"
#include "shadow_forms.h"
#include "sky_forms.h"
#include "track_forms.h"
#include "vulkan_error.h"

namespace vkvol {

namespace {

using Words = std::span<const std::uint32_t>;

constexpr std::uint32_t most_rounds = 64; // per submit
constexpr VkDeviceSize queue_bytes = QUEUE_COUNT * sizeof(shared::QueueHeader);
constexpr double longest_submit = 0.5;        // seconds, on a GPU
constexpr std::uint32_t no_end = 0xffffffffu; // of the work handed out
constexpr std::uint32_t no_queue = QUEUE_COUNT;

// Turns, on a device of unknown speed, and the least: of a slow GPU a few may take as long as its driver waits.
std::uint32_t first_budget(const Device& device) {
    return device.is_cpu() ? 64 : 8;
}
std::uint32_t least_budget(const Device& device) {
    return device.is_cpu() ? 16 : 1;
}

// Nothing left of what the last pass saw, and nothing pushed since.
bool is_empty(const shared::QueueHeader& header) {
    return header.tail == header.limit && static_cast<std::int32_t>(header.limit - header.head) <= 0;
}

// A pass of every round, as a schedule lists it. Without a queue it looks at all places of samples, and seldom, since
// they can wait.
struct PassRow {
    const char* name;
    Words kernel;
    std::uint32_t lanes, queue = no_queue, before = no_queue;
    bool is_large = false;
};
constexpr std::uint32_t seldom_rounds = 4;

// What a pass pushes to an earlier queue, or to its own, waits for the next round.
std::vector<PassRow> passes_of(const Plan& plan, unsigned form, bool has_shadow_rays) {
    if (plan.schedule == Schedule::fused)
        return {{"generate", hand_out_spv, plan.slots, QUEUE_GENERATE, QUEUE_GENERATE},
                {"track", fused_forms[form], plan.lanes, QUEUE_TRACK, QUEUE_RESUME, true}};
    std::vector<PassRow> rows{{"generate", generate_forms[form], plan.slots, QUEUE_GENERATE, QUEUE_GENERATE},
                              {"track", track_forms[form], plan.lanes, QUEUE_TRACK, QUEUE_RESUME, true}};
    if (has_shadow_rays)
        rows.push_back({"shadow", shadow_forms[form], plan.lanes, QUEUE_SHADOW, QUEUE_LOOK, true});
    rows.push_back({"accumulate", accumulate_forms[form], 0});
    return rows;
}

} // namespace

Wavefront::Wavefront(const Device& device, const BoundBuffers& scene_buffers, VkAccelerationStructureKHR boxes,
                     std::uint32_t most_pixels, const Specialization& specialization, unsigned form, const Plan& plan,
                     const PipelineCache* cache, const std::function<void()>& meanwhile)
    : device_(device), plan_(plan), commands_(device),
      readback_(device, "readback", queue_bytes + sizeof(shared::Counters), 0, BufferPlace::host) {
    const std::uint64_t slots = plan.slots;
    add_buffer(BINDING_PATHS, "paths", slots * path_bytes);
    add_buffer(BINDING_QUEUE_ITEMS, "queues",
               std::uint64_t{QUEUE_COUNT} * queue_capacity(plan) * sizeof(std::uint32_t));
    add_buffer(BINDING_QUEUES, "queue headers", queue_bytes, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    add_buffer(BINDING_WORK, "work list", std::uint64_t{most_pixels} * sizeof(std::uint32_t));
    add_buffer(BINDING_COUNTERS, "counters", sizeof(shared::Counters));
    if (const std::uint64_t waiting = plan.waiting; waiting > 0) {
        add_buffer(BINDING_SAMPLES, "waiting samples", waiting * sizeof(glm::vec3));
        add_buffer(BINDING_PLACES, "places of samples", waiting * sizeof(shared::SamplePlace));
    }
    if (plan.splats > 0)
        add_buffer(BINDING_SPLATS, "splats",
                   (std::uint64_t{most_pixels} + 2) * plan.splats * SPLAT_WORDS * sizeof(std::uint32_t));
    bindings_.emplace(device, bound(scene_buffers), boxes);
    make_passes(specialization, form, cache, meanwhile);
    push_.budget = std::min(plan.budget, first_budget(device));
    push_.step_limit = plan.step_limit;
    commands_.fill(buffer(BINDING_QUEUES), 0);
    commands_.fill(buffer(BINDING_COUNTERS), 0);
    if (device.has_timestamps()) {
        VkQueryPoolCreateInfo pool{};
        pool.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        pool.queryType = VK_QUERY_TYPE_TIMESTAMP;
        pool.queryCount = most_rounds * static_cast<std::uint32_t>(figures_.size());
        VK_CHECK(vkCreateQueryPool(device.handle(), &pool, nullptr, &timestamps_));
    }
}

Wavefront::~Wavefront() {
    vkDestroyQueryPool(device_.handle(), timestamps_, nullptr);
}

void Wavefront::add_buffer(std::uint32_t binding, const char* name, std::uint64_t bytes,
                           VkBufferUsageFlags more_usage) {
    buffers_[binding].emplace(device_, name, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | more_usage,
                              BufferPlace::device);
}

BoundBuffers Wavefront::bound(BoundBuffers all) const {
    for (std::size_t i = 0; i < buffers_.size(); ++i)
        if (buffers_[i])
            all[i] = &*buffers_[i];
    return all;
}

// The large kernels compile beside the others, and these one after another: with as many threads as kernels the large
// ones, which are waited for, would have their core to themselves less.
void Wavefront::make_passes(const Specialization& specialization, unsigned form, const PipelineCache* cache,
                            const std::function<void()>& meanwhile) {
    Specialization constants = specialization;
    constants[SPEC_STEPS] = static_cast<std::int32_t>(plan_.steps);
    constants[SPEC_COPIES] = plan_.copies == PathCopies::in_loops ? 1 : 0;
    const auto make = [&](Words spirv) {
        return std::make_unique<ComputePass>(device_, *bindings_, spirv, constants, cache);
    };
    const std::vector<PassRow> rows = passes_of(plan_, form, shadow_rays_walk(specialization, form));
    std::vector<std::future<std::unique_ptr<ComputePass>>> compiling;
    for (const PassRow& row : rows)
        compiling.push_back(std::async(row.is_large ? std::launch::async : std::launch::deferred, make, row.kernel));
    begin_ = make(begin_spv);
    sky_ = make(sky_forms[form]);
    prepare_ = make(prepare_spv);
    if (plan_.splats > 0)
        collect_ = make(collect_spv);
    meanwhile();
    figures_.push_back({"sky"});
    for (std::size_t i = 0; i < rows.size(); ++i) {
        round_.push_back({compiling[i].get(), rows[i].lanes, rows[i].queue, rows[i].before});
        figures_.push_back({rows[i].name});
    }
}

std::uint64_t Wavefront::bytes() const {
    std::uint64_t bytes = readback_.bytes();
    for (const std::optional<Buffer>& own : buffers_)
        bytes += own ? own->bytes() : 0;
    return bytes;
}

void Wavefront::bind_film(const Band& band) {
    bindings_->bind(BINDING_FILM, band.film);
    if (band.layers)
        bindings_->bind(BINDING_LAYERS, *band.layers);
}

void Wavefront::begin_batch(std::uint32_t begin, std::uint32_t end, std::uint32_t first, std::uint32_t last) {
    free_slots(begin, end);
    const auto start = std::chrono::steady_clock::now();
    over_pixels(*sky_, first, last);
    sky_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    sorted_ = last - first;
}

void Wavefront::begin_batch(std::uint32_t begin, std::uint32_t end, std::span<const std::uint32_t> pixels) {
    free_slots(begin, end);
    const auto count = static_cast<std::uint32_t>(pixels.size());
    commands_.upload(buffer(BINDING_WORK), std::as_bytes(pixels));
    commands_.run([&](VkCommandBuffer commands) {
        vkCmdFillBuffer(commands, buffer(BINDING_COUNTERS).handle(), offsetof(shared::Counters, work_count),
                        sizeof count, count);
        record_barrier(commands);
    });
}

// What the work list counts: pixels in a fused render, samples in a staged one.
std::uint64_t Wavefront::items_per_pixel() const {
    return plan_.schedule == Schedule::staged ? samples() : 1;
}

std::uint64_t Wavefront::items_to_hand_out() const {
    return std::min<std::uint64_t>(push_.work_end, counters_.work_count * items_per_pixel());
}

std::uint64_t Wavefront::items_handed_out() const {
    return std::min<std::uint64_t>(counters_.next_work, items_to_hand_out());
}

// A pixel all of whose samples are to be finished has all of them handed out.
void Wavefront::stop_handing_out() {
    const std::uint64_t each = items_per_pixel();
    push_.work_end = static_cast<std::uint32_t>((items_handed_out() + each - 1) / each * each);
}

double Wavefront::handed_out() const {
    const double all = double(items_per_pixel()) * counters_.work_count;
    return all > 0.0 ? double(items_handed_out()) / all : 1.0;
}

std::vector<std::uint32_t> Wavefront::pixels_left() {
    const std::uint64_t each = items_per_pixel();
    const std::uint64_t first = (items_handed_out() + each - 1) / each;
    std::vector<std::uint32_t> pixels(counters_.work_count - first);
    commands_.download(buffer(BINDING_WORK), std::as_writable_bytes(std::span(pixels)), first * sizeof(std::uint32_t));
    return pixels;
}

void Wavefront::free_slots(std::uint32_t begin, std::uint32_t end) {
    push_.sample_begin = begin;
    push_.sample_end = end;
    push_.work_end = no_end;
    push_.places = plan_.waiting / samples();
    finished_ = sorted_ = 0;
    most_in_flight_ = 0;
    rounds_ = 1; // many came to little at the end of the last batch
    if (collect_)
        commands_.fill(buffer(BINDING_SPLATS), 0);
    commands_.run([&](VkCommandBuffer commands) {
        begin_->record(commands, push_, std::max(plan_.slots, plan_.waiting));
        record_barrier(commands);
    });
}

void Wavefront::collect(std::uint32_t pixels) {
    over_pixels(*collect_, 0, pixels);
    over_pixels(*collect_, pixels, pixels + 1);
}

// Each lane loops over the batch's samples.
void Wavefront::over_pixels(ComputePass& pass, std::uint32_t begin, std::uint32_t end) {
    const std::uint32_t samples = push_.sample_end - push_.sample_begin;
    const std::uint64_t most = std::uint64_t{device_.limits().maxComputeWorkGroupCount[0]} * WORKGROUP_SIZE;
    const auto chunk = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(
        plan_.sky_samples / samples, WORKGROUP_SIZE, std::max<std::uint64_t>(most, WORKGROUP_SIZE)));
    for (std::uint32_t first = begin; first < end; first += chunk) {
        push_.pixel_begin = first;
        push_.pixel_end = std::min(end, first + chunk);
        commands_.run([&](VkCommandBuffer commands) {
            pass.record(commands, push_, push_.pixel_end - push_.pixel_begin);
            record_barrier(commands);
        });
    }
}

bool Wavefront::advance() {
    const auto start = std::chrono::steady_clock::now();
    commands_.run([&](VkCommandBuffer commands) {
        if (timestamps_)
            vkCmdResetQueryPool(commands, timestamps_, 0, rounds_ * static_cast<std::uint32_t>(figures_.size()));
        for (std::uint32_t round = 0; round < rounds_; ++round)
            record_round(commands, round);
        record_readback(commands);
    });
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::memcpy(&counters_, readback_.view<std::byte>().data() + queue_bytes, sizeof counters_);
    finished_ += counters_.paths;
    read_figures();
    adapt(seconds);
    if (plan_.schedule == Schedule::staged)
        return in_flight() == 0 && counters_.next_work >= items_to_hand_out();
    const auto headers = std::span(static_cast<const shared::QueueHeader*>(readback_.mapped()), QUEUE_COUNT);
    return std::all_of(headers.begin(), headers.end(), is_empty);
}

// Samples of pixels that miss the medium, which the sky pass finishes at once.
std::uint64_t Wavefront::samples_at_once() const {
    return sorted_ > 0 ? std::uint64_t{sorted_ - counters_.work_count} * samples() : 0;
}

std::uint64_t Wavefront::in_flight() const {
    if (plan_.schedule == Schedule::staged) { // or ended, and waiting for one that has not
        return items_handed_out() - (finished_ - samples_at_once());
    }
    const auto headers = std::span(static_cast<const shared::QueueHeader*>(readback_.mapped()), QUEUE_COUNT);
    const shared::QueueHeader& header = headers[QUEUE_RESUME];
    const bool all_taken = static_cast<std::int32_t>(header.head - header.limit) > 0;
    return header.tail - (all_taken ? header.limit : header.head);
}

void Wavefront::record_round(VkCommandBuffer commands, std::uint32_t round) {
    record_timestamp(commands, round, 0);
    for (std::size_t i = 0; i < round_.size(); ++i) {
        const bool rests = round_[i].queue == no_queue && (round + 1) % seldom_rounds != 0 && round + 1 != rounds_;
        if (!rests)
            record_step(commands, round_[i]);
        record_timestamp(commands, round, i + 1);
    }
}

void Wavefront::record_step(VkCommandBuffer commands, const Step& step) {
    if (step.queue == no_queue) {
        step.pass->record(commands, push_, push_.places);
    } else {
        if (step.before != step.queue)
            record_prepare(commands, step.before, step.before, step.lanes);
        record_prepare(commands, step.queue, step.before, step.lanes);
        const VkDeviceSize header = step.queue * sizeof(shared::QueueHeader);
        step.pass->record_indirect(commands, push_, buffer(BINDING_QUEUES),
                                   header + offsetof(shared::QueueHeader, groups_x));
    }
    record_barrier(commands);
}

void Wavefront::record_prepare(VkCommandBuffer commands, std::uint32_t queue, std::uint32_t before,
                               std::uint32_t lanes) {
    push_.queue = queue;
    push_.before = before;
    push_.lanes = lanes;
    prepare_->record(commands, push_, 1);
    record_barrier(commands);
}

void Wavefront::record_timestamp(VkCommandBuffer commands, std::uint32_t round, std::size_t mark) {
    if (timestamps_)
        vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps_,
                            static_cast<std::uint32_t>(round * figures_.size() + mark));
}

// The host reads counters and queue headers from its own copy; the counters then start again from 0.
void Wavefront::record_readback(VkCommandBuffer commands) {
    const VkBuffer counters = buffer(BINDING_COUNTERS).handle();
    const VkBufferCopy headers{0, 0, queue_bytes};
    const VkBufferCopy counts{0, queue_bytes, sizeof(shared::Counters)};
    vkCmdCopyBuffer(commands, buffer(BINDING_QUEUES).handle(), readback_.handle(), 1, &headers);
    vkCmdCopyBuffer(commands, counters, readback_.handle(), 1, &counts);
    record_barrier(commands);
    constexpr VkDeviceSize kept = offsetof(shared::Counters, paths); // the work list outlives a submit
    vkCmdFillBuffer(commands, counters, kept, sizeof(shared::Counters) - kept, 0);
    record_barrier(commands);
}

void Wavefront::read_figures() {
    rounds_run_ = rounds_;
    // The sky's samples come with the batch's first submit.
    const std::uint64_t at_once = finished_ == counters_.paths ? samples_at_once() : 0;
    figures_.front().seconds = std::exchange(sky_seconds_, 0.0);
    for (std::size_t i = 0; i < round_.size(); ++i) {
        figures_[i + 1].queued =
            round_[i].queue == no_queue ? counters_.paths - at_once : counters_.queued[round_[i].queue];
        figures_[i + 1].seconds = 0.0;
    }
    if (!timestamps_)
        return;
    const std::size_t marks = figures_.size();
    std::vector<std::uint64_t> ticks(rounds_ * marks);
    VK_CHECK(vkGetQueryPoolResults(device_.handle(), timestamps_, 0, static_cast<std::uint32_t>(ticks.size()),
                                   ticks.size() * sizeof ticks[0], ticks.data(), sizeof ticks[0],
                                   VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
    for (std::size_t round = 0; round < rounds_; ++round)
        for (std::size_t pass = 1; pass < marks; ++pass)
            figures_[pass].seconds += static_cast<double>(device_.ticks_between(ticks[round * marks + pass - 1],
                                                                                ticks[round * marks + pass])) *
                                      device_.limits().timestampPeriod * 1e-9;
}

// What comes next may be as dear as anything was, and a GPU's driver waits for a second or two at most.
std::uint32_t Wavefront::bearable_budget() const {
    const double most = longest_submit / std::max(worst_turn_, 1e-9);
    return device_.is_cpu() ? plan_.budget : static_cast<std::uint32_t>(std::clamp(most, 1.0, 1e9));
}

// First lanes work for longer at a time, for they are laid aside less often then; after that there are more rounds.
// Only where a round alone takes far too long, as a slow device's driver would not suffer, lanes work for less long
// again.
void Wavefront::adapt(double seconds) {
    // Not forgotten while a batch ends, when few lanes have work: the next begins with all of them.
    most_in_flight_ = std::max(most_in_flight_, in_flight());
    const bool ends = 2 * in_flight() < most_in_flight_;
    worst_turn_ = std::max((ends ? 1.0 : 0.9) * worst_turn_, seconds / (double(rounds_) * push_.budget));
    const double factor = std::clamp(plan_.submit_seconds / std::max(seconds, 1e-6), 0.5, 2.0);
    if (factor > 1.0 && push_.budget < plan_.budget)
        push_.budget = std::min({2 * push_.budget, plan_.budget, bearable_budget()});
    else if (rounds_ == 1 && seconds > 4.0 * plan_.submit_seconds)
        push_.budget = std::min(std::max(push_.budget / 2, least_budget(device_)), plan_.budget);
    else
        rounds_ = std::clamp(static_cast<std::uint32_t>(rounds_ * factor + 0.5), 1u, most_rounds);
    const double dearest = worst_turn_ * push_.budget;
    if (!device_.is_cpu())
        rounds_ = std::min(rounds_, static_cast<std::uint32_t>(std::max(longest_submit / dearest, 1.0)));
    // Counters have 32 bits, and room for steps is what they count most of.
    const std::uint64_t room = std::uint64_t{plan_.lanes} * push_.budget * std::uint64_t(plan_.steps);
    rounds_ =
        std::min(rounds_, static_cast<std::uint32_t>(std::clamp<std::uint64_t>(0xffffffffu / room, 1, most_rounds)));
}

} // namespace vkvol
