// From a scene to a film: the facade that the command line and the tests use.
#pragma once

#include <functional>
#include <optional>

#include "checkpoint.h"
#include "device.h"
#include "film.h"
#include "medium_outline.h"
#include "scene.h"
#include "wavefront.h"

namespace vkvol {

class RenderSession;

struct RenderJob {
    Crop crop; // the part of the picture to render
    std::uint32_t seed = 0;
    std::uint32_t sample_offset = 0;   // number of the first sample
    std::optional<double> time_limit;  // seconds of rendering; the batch then under way is cut short
    bool disk_cache = true;            // keep compiled pipelines between runs
    Plan plan;                         // what of it is chosen wins
    std::function<bool()> interrupted; // asked between submits; true ends the render early
    // After each submit: samples per pixel finished, as a real number; and, now and then, the picture's relative
    // standard error.
    std::function<void(double, std::optional<double>)> progress;
    // Called every so many seconds, and at the end of a render that was ended early.
    double checkpoint_seconds = 0.0;
    std::function<void(const Checkpoint&)> checkpoint;
    const Checkpoint* resume = nullptr; // goes on from there
    bool trace = false;                 // record the vertices of the path; crop and samples leave just one
    RenderSession* session = nullptr;   // whose grids and pipelines are used, and kept for further frames
    bool dry_run = false;               // set up everything, and render nothing
};

struct RenderResult {
    Film film;
    RenderCounts counts;
    std::vector<NonFiniteSample> non_finite; // the first few
    std::vector<std::string> warnings;       // what the scene asks for and its files do not hold
    std::string integrator;
    bool glows = false;         // the medium does, by <medium> or <emission>
    std::string biased;         // why its mean is not exact; empty: it is
    std::string specialization; // in words: what the kernels were compiled for
    Plan plan;
    std::vector<PassFigures> passes;
    std::uint64_t rounds = 0; // of all passes but the sky
    double load_seconds = 0, upload_seconds = 0, pipeline_seconds = 0, render_seconds = 0;
    std::uint64_t device_bytes = 0;         // of all buffers
    MediumOutline outline;                  // to explain the picture by
    std::vector<shared::TraceRecord> trace; // positions relative to trace_origin
    glm::dvec3 trace_origin{0.0};           // world space
    std::uint32_t samples = 0;              // per pixel, finished for every pixel
    bool interrupted = false;               // ended before the samples asked for, by a signal
};

RenderResult render(const Device& device, const Scene& scene, const RenderJob& job);

} // namespace vkvol
