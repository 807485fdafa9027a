// What a render counts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>

namespace vkvol {

// Totals over the render; see shared::Counters for the meaning of each.
struct RenderCounts {
    std::uint64_t paths = 0, real_collisions = 0, null_collisions = 0, lookups = 0, cells = 0, shadow_rays = 0;
    std::uint64_t depth_caps = 0, step_caps = 0, majorant_violations = 0, non_finite = 0, queue_overflows = 0;
    std::uint64_t room = 0, steps = 0;
    std::uint64_t abandoned = 0; // paths that would not end when the render was to
    std::uint64_t cleaned_voxels = 0;

    // Share of the steps for which lanes of the track pass had room that took a path further; 0 if there were none.
    double lane_use() const { return room > 0 ? double(steps) / double(room) : 0.0; }
    bool any_cap() const {
        return depth_caps + step_caps + majorant_violations + non_finite + queue_overflows + abandoned +
                   cleaned_voxels >
               0;
    }
};

// All but `cleaned_voxels`, of which every result has the whole number.
inline void add_counts(RenderCounts& total, const RenderCounts& c) {
    for (const auto count :
         {&RenderCounts::paths, &RenderCounts::real_collisions, &RenderCounts::null_collisions, &RenderCounts::lookups,
          &RenderCounts::cells, &RenderCounts::shadow_rays, &RenderCounts::depth_caps, &RenderCounts::step_caps,
          &RenderCounts::majorant_violations, &RenderCounts::non_finite, &RenderCounts::queue_overflows,
          &RenderCounts::room, &RenderCounts::steps, &RenderCounts::abandoned})
        total.*count += c.*count;
}

// What a pass came to.
struct PassFigures {
    std::string name;
    double seconds = 0.0;
    std::uint64_t queued = 0; // items that it found in its queue, over all rounds
};

constexpr std::size_t most_examples = 16; // of them that are named
struct NonFiniteSample {
    int x, y; // of the picture
    std::uint32_t sample;
};

} // namespace vkvol
