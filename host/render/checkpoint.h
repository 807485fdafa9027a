// The state of a render between two submits, and the file that keeps it: a render that goes on from there ends with the
// same bits as one that was never stopped.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compute_pass.h"
#include "light_table.h"
#include "loaded_medium.h"
#include "plan.h"
#include "render_counts.h"
#include "shared/items.h"
#include "surface_table.h"

namespace vkvol {

// What must be equal for a render to be continued to the same bits.
struct RenderIdentity {
    std::string
        kernel; // fingerprint of all that the kernels see: scene, estimators, seed, samples' offset, crop, grids
    std::string program;                  // program_text() of vkvol
    std::string device;                   // and its driver
    std::vector<std::uint32_t> band_rows; // how the film lies in buffers

    bool operator==(const RenderIdentity&) const = default;
};

// Batches are rendered band by band; a band's pixels in any order, each with all samples of the batch at once.
struct Checkpoint {
    RenderIdentity identity;
    std::uint32_t done = 0;                           // samples per pixel in whole batches
    std::uint32_t batch = 0;                          // samples of the batch under way
    std::uint32_t band = 0;                           // in which it is
    std::optional<std::vector<std::uint32_t>> pixels; // of that band, still without the batch's samples; none: all
    std::vector<shared::FilmPixel> film;              // all bands, row by row
    std::vector<shared::FilmPixel> sums;              // of particles: each band's
    std::vector<glm::vec3> layers;                    // sums of layers, all bands, row by row
    RenderCounts counts;
    std::vector<NonFiniteSample> non_finite;
    double seconds = 0.0; // of rendering
    Schedule schedule = Schedule::fused;
    std::vector<PassFigures> passes; // of all samples
    std::uint64_t rounds = 0;
};

// `media`: rows, of several. `points`: where flux is read.
RenderIdentity identify(const shared::FrameParams& frame, const Specialization& specialization, const Assets& assets,
                        const LightTable& lights, std::span<const shared::MediumParams> media,
                        const SurfaceTable& surfaces, std::span<const glm::vec3> points, std::uint32_t sample_offset,
                        const std::string& device, std::vector<std::uint32_t> band_rows);

// Atomically: the file is the last checkpoint or this one. Throws RenderError.
void save_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

// Whether it is a file that begins like a checkpoint of any version.
bool is_checkpoint(const std::filesystem::path& file);

// Throws InputError if the file is no whole checkpoint.
Checkpoint load_checkpoint(const std::filesystem::path& file);

// Throws InputError, naming the first difference, unless the two are the same render.
void check_identity(const RenderIdentity& saved, const RenderIdentity& here);

} // namespace vkvol
