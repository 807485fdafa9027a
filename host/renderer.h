// From a scene to a film: the facade that the command line and the tests use.
#pragma once

#include <functional>
#include <optional>

#include "device.h"
#include "film.h"
#include "scene.h"
#include "wavefront.h"

namespace vkvol {

struct RenderJob {
    Crop crop; // the part of the picture to render
    std::uint32_t seed = 0;
    std::uint32_t sample_offset = 0;   // number of the first sample
    std::optional<double> time_limit;  // seconds of rendering; the batch then under way is cut short
    bool disk_cache = true;            // keep compiled pipelines between runs
    Tuning tuning;                     // 0: what suits the device
    std::function<bool()> interrupted; // asked between submits; true ends the render early
    // After each submit: samples per pixel finished, as a real number; and, now and then, the picture's relative
    // standard error.
    std::function<void(double, std::optional<double>)> progress;
};

// Totals over the render; see shared::Counters for the meaning of each.
struct RenderCounts {
    std::uint64_t paths = 0, real_collisions = 0, null_collisions = 0, lookups = 0, cells = 0, shadow_rays = 0;
    std::uint64_t depth_caps = 0, step_caps = 0, majorant_violations = 0, non_finite = 0, queue_overflows = 0;
    std::uint64_t cleaned_voxels = 0;

    bool any_cap() const { return depth_caps + step_caps + majorant_violations + non_finite + queue_overflows > 0; }
};

struct NonFiniteSample {
    int x, y; // of the picture
    std::uint32_t sample;
};

struct RenderResult {
    Film film;
    RenderCounts counts;
    std::vector<NonFiniteSample> non_finite; // the first few
    std::vector<std::string> warnings;       // what the scene asks for and its files do not hold
    std::string integrator;
    std::string biased;         // why its mean is not exact; empty: it is
    std::string specialization; // in words: what the kernels were compiled for
    PassSeconds pass_seconds{};
    double load_seconds = 0, upload_seconds = 0, pipeline_seconds = 0, render_seconds = 0;
    std::uint64_t device_bytes = 0; // of all buffers
    std::uint32_t samples = 0;      // per pixel, finished for every pixel
    bool interrupted = false;       // ended before the samples asked for, by a signal
};

RenderResult render(const Device& device, const Scene& scene, const RenderJob& job);

} // namespace vkvol
