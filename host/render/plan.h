// How a render is carried out: sizes, and the order of its work. The picture's bits depend on none but the majorant
// cells and, on a GPU, the schedule.
#pragma once

#include <cstdint>
#include <string>

#include "device.h"
#include "shared/path_state.h"

namespace vkvol {

// fused: one pass takes its lanes' pixels through all stages. staged: passes of their own over queues of paths, so that
// a small picture fills a large device. See shaders/passes.
enum class Schedule { automatic, fused, staged };

// How the words of paths get to memory and back: one by one, or in loops; see laid_aside.glsl.
enum class PathCopies { automatic, by_word, in_loops };

// How kernels find what surfaces a ray meets, the same ones by either (see piece_boxes.h): by a search of their own through a tree, or by
// asking the device (VK_KHR_ray_query).
enum class Hits { automatic, tree, query };

// 0, automatic: what suits device and scene.
struct Plan {
    Schedule schedule = Schedule::automatic;
    bool tries = false;                        // automatic: try both even where one is known to be faster
    PathCopies copies = PathCopies::automatic; // how its driver compiles them best
    Hits hits = Hits::automatic;               // tree: what query does for speed was never measured on a GPU
    std::uint32_t slots = 0;                   // fused: pixels in work; staged: paths
    std::uint32_t waiting = 0;          // staged: room for samples that wait to be added to the film, or at least this
    std::uint32_t lanes = 0;            // invocations that share a queue of paths
    std::uint32_t budget = 0;           // turns after which a lane lays its path aside
    std::uint32_t steps = 0;            // of tracking in a turn
    std::uint32_t step_limit = 0;       // steps after which a flight is cut, and counted
    std::uint32_t most_batch = 0;       // samples per pixel
    std::uint32_t splats = 0;           // particles: samples of a batch for whose splats there is room
    double submit_seconds = 0.08;       // aimed at; no submit should hold a device much longer
    std::uint64_t most_film_bytes = 0;  // in one buffer; a larger film lies in several
    std::uint32_t band_rows = 0;        // of the film in one buffer; 0: as many as it holds
    std::uint64_t most_grid_bytes = 0;  // likewise, of all grids together
    std::uint64_t most_texel_bytes = 0; // what has more is read as storage
    int majorant_cell = 0;              // voxels along an edge of a majorant cell; 0 as well where there are none
    bool leaps = false;                 // walks pass empty ones together
    std::uint64_t sky_samples = 0;      // per submit of the passes over pixels
};

// Of a slot, in memory.
constexpr std::uint64_t path_bytes = MOST_PATH_WORDS * sizeof(std::uint32_t);

// Dispatches over slots, and over samples that wait, keep to the 65535 groups that every device allows.
constexpr std::uint32_t most_slots = 1u << 19;

// What a turn of the tracking passes loops over.
struct LoopSizes {
    bool mesh = false;
    bool surfaces = false;
    std::uint32_t queried = 0;  // pieces of surfaces that a software driver may ask in a ray query; 0 without
    bool facets = false;        // of rough surfaces
    std::uint32_t octaves = 0;  // of noise; 0 without it
    std::uint32_t halvings = 0; // of a search in a map of values; 0 without one
    std::uint32_t media = 0;    // that a look-up asks, at most; 0 where there is but one
    std::uint32_t even = 0;     // media, each of which a shadow ray asks; 0 where they are walked through
    std::uint32_t models = 0;   // meshes among them
    std::uint32_t faces = 0;    // of one of these, that a look-up asks, at most
    std::uint32_t phase = 0;    // iterations within phase functions
    std::uint32_t layers = 0;   // of a path's record
    std::uint32_t lights = 0;   // iterations over lamps, suns and the levels of a tree; 0 without a choice of lights
};

// Completes `wish`, of which what is chosen wins. `pixels`: of the picture.
Plan make_plan(const Device& device, const LoopSizes& loops, std::uint64_t pixels, const Plan& wish);

// Where there are particles: as many samples in a batch as have room for their splats, and of as few pixels at a time
// as one of them takes. `pixels`: of the picture. `batch`: for which there has to be room.
void fit_splats(const Device& device, std::uint64_t pixels, std::uint32_t batch, Plan& plan);

// Places in each queue.
std::uint32_t queue_capacity(const Plan& plan);

const char* name_of(Schedule schedule);
const char* name_of(Hits hits);

// "staged, 65536 paths, 4 steps a turn, majorant cells of 8 voxels, empty ones leapt"
std::string describe(const Plan& plan);

} // namespace vkvol
