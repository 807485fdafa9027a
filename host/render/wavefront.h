// The wavefront: which passes run, in which order, over which queues.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "commands.h"
#include "compute_pass.h"
#include "pipeline_cache.h"
#include "shared/items.h"

namespace vkvol {

// Sizes of the machine, none of which changes the picture.
struct Tuning {
    std::uint32_t slots = 0;            // pixels in work
    std::uint32_t lanes = 0;            // invocations that share the track queue
    std::uint32_t budget = 0;           // iterations after which a lane lays its path aside
    std::uint32_t step_limit = 0;       // steps after which a flight is cut, and counted
    std::uint32_t most_batch = 0;       // samples per pixel
    double submit_seconds = 0.08;       // aimed at; no submit should hold a device much longer
    std::uint32_t steps_per_look = 0;   // tracking steps between two looks at what they led to
    std::uint64_t most_film_bytes = 0;  // in one buffer; a larger film lies in several
    std::uint64_t most_grid_bytes = 0;  // likewise, of all grids together
    std::uint64_t most_texel_bytes = 0; // what has more is read as storage
};

// What a turn of the track pass loops over.
struct LoopSizes {
    bool mesh = false;
    std::uint32_t octaves = 0; // of noise; 0 without it
};

// What suits the device and the scene; fields of `wish` that are not 0 win.
Tuning tune(const Device& device, const LoopSizes& loops, const Tuning& wish = {});

// Places in each queue.
std::uint32_t queue_capacity(const Tuning& tuning);

constexpr std::array pass_names = {"sky", "generate", "track"};
using PassSeconds = std::array<double, pass_names.size()>;

// Which of its compiled forms the track kernel takes.
struct TrackVariant {
    bool chromatic = false;                   // the throughput has three channels
    std::optional<std::uint32_t> window_bits; // grids lie in windows of 2^bits words
};

class Wavefront {
public:
    // `most_pixels`: of any film that will be bound.
    Wavefront(const Device& device, const BoundBuffers& scene_buffers, std::uint32_t most_pixels,
              const Specialization& specialization, const TrackVariant& variant, const Tuning& tuning,
              VkPipelineCache cache);
    ~Wavefront();
    Wavefront(const Wavefront&) = delete;
    Wavefront& operator=(const Wavefront&) = delete;

    void bind_film(const Buffer& film);

    // Samples [begin, end) of pixels [0, pixels) of the bound film. Then call advance() until it returns true.
    void begin_batch(std::uint32_t begin, std::uint32_t end, std::uint32_t pixels);
    // The same for these pixels alone.
    void begin_batch(std::uint32_t begin, std::uint32_t end, std::span<const std::uint32_t> pixels);
    // Hands out no further pixels; those begun are finished.
    void stop_handing_out() { push_.stop = 1; }
    // Pixels of the batch that were not handed out.
    std::vector<std::uint32_t> pixels_left();
    // One submit of as many rounds as fit its time. True when no path is in flight any more.
    bool advance();
    // Paths that the last submit left amid their way.
    std::uint32_t in_flight() const;

    std::uint64_t bytes() const; // of its buffers

    // What happened in the last submit.
    const shared::Counters& counters() const { return counters_; }
    const PassSeconds& pass_seconds() const { return pass_seconds_; }

private:
    void record_round(VkCommandBuffer commands, std::uint32_t round);
    void free_slots(std::uint32_t begin, std::uint32_t end);
    void sort_pixels(std::uint32_t pixels);
    void record_pass(VkCommandBuffer commands, std::uint32_t queue, const ComputePass& pass, std::uint32_t lanes);
    void record_prepare(VkCommandBuffer commands, std::uint32_t queue, std::uint32_t before, std::uint32_t lanes);
    void record_consumer(VkCommandBuffer commands, std::uint32_t queue, const ComputePass& pass);
    void record_timestamp(VkCommandBuffer commands, std::uint32_t round, std::uint32_t mark);
    void record_readback(VkCommandBuffer commands);
    void read_timestamps();
    void adapt(double seconds);

    const Device& device_;
    Tuning tuning_;
    Commands commands_;
    Buffer paths_, betas_, suspended_, queue_items_, queues_, work_, counter_buffer_, readback_;
    Bindings bindings_;
    std::unique_ptr<ComputePass> begin_, sky_, prepare_, generate_, track_;
    VkQueryPool timestamps_ = VK_NULL_HANDLE;
    shared::PassPush push_{};
    shared::Counters counters_{};
    PassSeconds pass_seconds_{};
    double sky_seconds_ = 0.0; // of this batch, reported with its first submit
    std::uint32_t rounds_ = 1;
};

} // namespace vkvol
