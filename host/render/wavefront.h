// The wavefront: which passes run, in which order, over which queues.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "commands.h"
#include "compute_pass.h"
#include "film_bands.h"
#include "plan.h"
#include "render_counts.h"
#include "shared/items.h"

namespace vkvol {

class Wavefront {
public:
    // `boxes`: null, but where kernels ask for them. `most_pixels`: of any film that will be bound. `form`: of the
    // kernels, see specialization.h. `meanwhile`: called while the large kernels compile.
    Wavefront(const Device& device, const BoundBuffers& scene_buffers, VkAccelerationStructureKHR boxes,
              std::uint32_t most_pixels, const Specialization& specialization, unsigned form, const Plan& plan,
              const PipelineCache* cache, const std::function<void()>& meanwhile);
    ~Wavefront();
    Wavefront(const Wavefront&) = delete;
    Wavefront& operator=(const Wavefront&) = delete;

    void bind_film(const Band& band);

    // Samples [begin, end) of pixels [first, last) of the bound film. Then call advance() until it returns true.
    void begin_batch(std::uint32_t begin, std::uint32_t end, std::uint32_t first, std::uint32_t last);
    // The same for these pixels alone.
    void begin_batch(std::uint32_t begin, std::uint32_t end, std::span<const std::uint32_t> pixels);
    // Particles: once advance() has returned true, what they brought becomes the batch's samples. A batch that is not
    // collected has left no trace in the film.
    void collect(std::uint32_t pixels);
    // Hands out no further pixels; those begun are finished.
    void stop_handing_out();
    // Pixels of the batch that were not handed out.
    std::vector<std::uint32_t> pixels_left();
    // Part of the batch's work that was handed out, in [0, 1].
    double handed_out() const;
    // One submit of as many rounds as fit its time. True when no path is in flight any more.
    bool advance();
    // Samples handed out that the last submit left unfinished.
    std::uint64_t in_flight() const;

    std::uint64_t bytes() const; // of its buffers

    // What happened in the last submit.
    const shared::Counters& counters() const { return counters_; }
    std::span<const PassFigures> passes() const { return figures_; }
    std::uint32_t rounds() const { return rounds_run_; }

private:
    // A pass of every round: how many lanes it may have, its queue, and one whose items they take first.
    struct Step {
        std::unique_ptr<ComputePass> pass;
        std::uint32_t lanes, queue, before;
    };

    void make_passes(const Specialization& specialization, unsigned form, const PipelineCache* cache,
                     const std::function<void()>& meanwhile);
    void add_buffer(std::uint32_t binding, const char* name, std::uint64_t bytes, VkBufferUsageFlags more_usage = 0);
    BoundBuffers bound(BoundBuffers scene_buffers) const;
    const Buffer& buffer(std::uint32_t binding) const { return *buffers_[binding]; }
    std::uint32_t samples() const { return push_.sample_end - push_.sample_begin; }
    std::uint64_t items_per_pixel() const;
    std::uint64_t samples_at_once() const;
    std::uint64_t items_to_hand_out() const;
    std::uint64_t items_handed_out() const;
    void record_round(VkCommandBuffer commands, std::uint32_t round);
    void free_slots(std::uint32_t begin, std::uint32_t end);
    void over_pixels(ComputePass& pass, std::uint32_t begin, std::uint32_t end);
    void record_step(VkCommandBuffer commands, const Step& step);
    void record_prepare(VkCommandBuffer commands, std::uint32_t queue, std::uint32_t before, std::uint32_t lanes);
    void record_timestamp(VkCommandBuffer commands, std::uint32_t round, std::size_t mark);
    void record_readback(VkCommandBuffer commands);
    void read_figures();
    void adapt(double seconds);
    std::uint32_t bearable_budget() const;

    const Device& device_;
    Plan plan_;
    Commands commands_;
    std::array<std::optional<Buffer>, BINDING_BUFFERS> buffers_; // its own
    Buffer readback_;
    std::optional<Bindings> bindings_;
    std::unique_ptr<ComputePass> begin_, sky_, prepare_, collect_;
    std::vector<Step> round_;
    VkQueryPool timestamps_ = VK_NULL_HANDLE;
    shared::PassPush push_{};
    shared::Counters counters_{};
    std::vector<PassFigures> figures_; // the sky, and each step of the rounds
    double sky_seconds_ = 0.0;         // of this batch, told with its first submit
    std::uint64_t finished_ = 0;       // paths of the batch
    std::uint32_t sorted_ = 0;         // pixels of which those that miss the medium never were paths
    double worst_turn_ = 0.0;          // seconds of a round over its budget, at most
    std::uint64_t most_in_flight_ = 0; // of the batch
    std::uint32_t rounds_ = 1, rounds_run_ = 0;
};

} // namespace vkvol
