#include "plan.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <fmt/format.h>

#include "error.h"
#include "shared/constants.h"
#include "shared/items.h"

namespace vkvol {

namespace {

// llvmpipe leaves every loop of an invocation after so many iterations in all, the one that ends a loop included, and
// without a word.
constexpr std::uint32_t most_iterations = 65535;

// Iterations, at most, of all loops in a turn that are not unrolled: of turns and bursts of four, which end too, less
// than two. Every step has up to four places for a sum over
// octaves, or media, which all lanes of a group pass under a mask: a flight's look-up, emission along it, and two of a
// shadow ray that marches in several sets of samples; and a look from along a flight has one.
std::uint64_t turn_iterations(const LoopSizes& loops, std::uint32_t steps) {
    constexpr std::uint32_t triangle = 2, node = 1 + (MESH_LEAF + 1) + MESH_LEAF * triangle;
    std::uint64_t iterations = 2 + (steps + 1);
    if (loops.mesh)
        iterations += 2 + 1 + MESH_NODES_PER_TURN * node;
    if (loops.surfaces) // planes when a segment begins, also beyond a seam, then a search, in which what is met is
                        // asked whether the light lies in it
        iterations += 2 * (MOST_PLANES + 1) + 1 + (loops.queried > 0 ? 0 : SURFACE_NODES_PER_TURN * node) + 2;
    // Of a binary tree over them every node and, as the kernel has them given, every piece, if the worst comes; twice,
    // since lanes of a group wait for each other between pieces.
    iterations += loops.queried > 0 ? 2 * (3 * std::uint64_t{loops.queried} + 8) : 0;
    if (loops.facets) // a way on, and what leaves toward a light and toward a sensor
        iterations += 3 * (MOST_FACETS + 1);
    const std::uint32_t octaves = loops.octaves > 0 ? loops.octaves + 1 : 0;
    const std::uint32_t search = loops.halvings > 0 ? loops.halvings + 1 : 0;
    const std::uint64_t of_one = octaves + search;
    const std::uint64_t of_models =
        std::uint64_t{std::min(loops.models, loops.media)} * (1 + (1 + triangle) * loops.faces);
    const std::uint64_t look_up = loops.media > 0 ? 1 + loops.media * (1 + of_one) + of_models : of_one;
    iterations += (4 * steps + 1) * look_up + 4 * search; // colours are looked up at collisions
    if (loops.media > 0)                                  // where all of them glow, or absorb, too
        iterations += look_up + loops.media * std::uint64_t{std::max(4u, 2 * steps)} * search;
    if (loops.even > 0) // a shadow ray's parts, or whole ones: from two kinds of collisions, along flights, toward
                        // sensors, and three as paths begin
        iterations += (steps + 8) * std::uint64_t{loops.even + 1};
    // A record is begun and added, and lights in the sky are noted one by one.
    const std::uint32_t records = loops.layers > 0 ? 2 * (loops.layers + 1) + loops.lights : 0;
    return iterations + loops.phase + loops.lights + records;
}

// Of taking a path up and laying it aside, and adding what a lane has seen.
constexpr std::uint32_t copy_iterations = 2 * (MOST_PATH_WORDS / WORDS_AT_ONCE + 1) + TALLIED + 1;
static_assert(offsetof(shared::Counters, paths) == TALLY_FIRST * sizeof(std::uint32_t) &&
              offsetof(shared::Counters, majorant_violations) == (TALLY_FIRST + TALLIED - 1) * sizeof(std::uint32_t));
static_assert(WORDS_AT_ONCE == 4 && MOST_PATH_WORDS % WORDS_AT_ONCE == 0); // as laid_aside.glsl writes them out

// Turns whose loops stay below the limit. Between bursts of turns a lane of a staged pass may pass its path on.
std::uint32_t longest_budget(const LoopSizes& loops, const Plan& plan) {
    const std::uint32_t copy = plan.copies == PathCopies::in_loops ? copy_iterations : 0;
    const std::uint32_t in_burst = plan.schedule == Schedule::staged ? (copy + STAGED_BURST - 1) / STAGED_BURST : 0;
    const std::uint64_t turns = (most_iterations - copy) / (turn_iterations(loops, plan.steps) + in_burst);
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(turns, 1, 1024));
}

// Samples of a pixel that one lane loops over: the sky's, and those added to the film.
constexpr std::uint32_t longest_batch = most_iterations / 2;

constexpr std::uint32_t waiting_per_slot = 4;

// Per submit: some 70 ms on two cores of a software driver. Lights are asked one by one.
constexpr std::uint64_t sky_samples = 1u << 22;

// Paths of a staged render on a GPU: as many as have room in one buffer. Of layers, what waits has a record each, in
// the buffer of each band.
std::uint32_t slots_that_fit(const Device& device, std::uint32_t layers, std::uint64_t most_film_bytes) {
    const auto fits = [&](std::uint64_t slots) {
        return slots * path_bytes <= device.limits().maxStorageBufferRange &&
               waiting_per_slot * slots * layers * sizeof(glm::vec3) <= most_film_bytes / 4;
    };
    std::uint32_t slots = most_slots;
    while (slots > 1u << 15 && !fits(slots))
        slots /= 2;
    return slots;
}

} // namespace

Plan make_plan(const Device& device, const LoopSizes& loops, std::uint64_t pixels, const Plan& wish) {
    const auto pick = [](auto wanted, auto usual) { return wanted != 0 ? wanted : usual; };
    Plan plan = wish;
    if (plan.schedule == Schedule::automatic)
        plan.schedule = Schedule::fused;
    if (plan.hits == Hits::automatic || !loops.surfaces)
        plan.hits = Hits::tree;
    const bool staged = plan.schedule == Schedule::staged;
    // A software driver wants its state in cache and few lanes that each do much; a GPU wants to be full. There a pass
    // of a staged render lasts as long as its longest lane: lanes take several paths each, and lay long ones aside.
    const bool wide = staged && !device.is_cpu();
    plan.most_film_bytes =
        pick(wish.most_film_bytes, std::min<std::uint64_t>(device.limits().maxStorageBufferRange, 1u << 30));
    const std::uint32_t wide_slots = slots_that_fit(device, loops.layers, plan.most_film_bytes);
    plan.slots = pick(wish.slots, device.is_cpu() ? (staged ? 32768u : 8192u) : wide ? wide_slots : 1u << 18);
    plan.slots = std::min<std::uint64_t>(plan.slots, device.limits().maxStorageBufferRange / path_bytes);
    if (plan.copies == PathCopies::automatic)
        plan.copies = device.writes_out_lanes() ? PathCopies::in_loops : PathCopies::by_word;
    plan.lanes = pick(wish.lanes, device.is_cpu() ? 512u : wide ? 1u << 16 : 1u << 17);
    plan.steps = pick(wish.steps, 4u);
    constexpr std::uint32_t most = most_iterations - 2 * copy_iterations; // of one turn, beside what is about it
    if (turn_iterations(loops, plan.steps) > most)
        plan.steps = 1;
    if (loops.queried > 0 && turn_iterations(loops, plan.steps) > most)
        throw InputError(fmt::format("--schedule hits=query: software drivers may end a search among {} pieces of "
                                     "surfaces before it is done; leave hits=query out",
                                     loops.queried));
    if (device.is_cpu() && turn_iterations(loops, plan.steps) > most)
        throw InputError(
            fmt::format("{} volumes overlap somewhere, and software drivers end sums over so many, and the "
                        "octaves of their noise or faces of their models, before they are done; leave some out, or "
                        "render on a GPU",
                        loops.media));
    const std::uint32_t longest = longest_budget(loops, plan);
    plan.budget = std::min(pick(wish.budget, wide ? 32u : longest), longest);
    plan.step_limit = pick(wish.step_limit, 1u << 26);
    plan.sky_samples = sky_samples / (1 + loops.lights / 16);
    plan.most_batch = std::min(pick(wish.most_batch, longest_batch),
                               longest_batch / (1 + loops.lights + loops.layers)); // each looks at them
    plan.waiting = staged ? std::max(wish.waiting, waiting_per_slot * plan.slots) : 0;
    // One lane adds all samples of a pixel to the film: so many pixels have a place at a time, at least.
    const std::uint64_t places =
        std::min<std::uint64_t>(wide ? std::clamp<std::uint64_t>(pixels, 2, 8192) : 2, plan.slots);
    if (staged)
        plan.most_batch = std::min<std::uint32_t>(plan.most_batch, plan.waiting / places);
    plan.most_grid_bytes = pick(
        wish.most_grid_bytes, std::min<std::uint64_t>(device.limits().maxStorageBufferRange, device.most_allocation()));
    // GPUs read storage as fast as texels; software drivers gather only these.
    const std::uint64_t texels = device.is_cpu() ? 4ull * device.limits().maxTexelBufferElements : 1u;
    plan.most_texel_bytes = pick(wish.most_texel_bytes, texels);
    return plan;
}

void fit_splats(const Device& device, std::uint64_t pixels, std::uint32_t batch, Plan& plan) {
    // Particles of a band are traced for its pixels alone: it has all the picture, where one sample of that fits.
    constexpr std::uint64_t each = SPLAT_WORDS * sizeof(std::uint32_t), least = 1u << 26; // bytes
    const std::uint64_t usual = std::clamp<std::uint64_t>(each * (pixels + 2), least, 1u << 30);
    const std::uint64_t most = std::min<std::uint64_t>(usual, device.limits().maxStorageBufferRange);
    plan.most_film_bytes = std::min<std::uint64_t>(plan.most_film_bytes, (most / each - 2) * sizeof(shared::FilmPixel));
    pixels = std::min<std::uint64_t>(pixels, plan.most_film_bytes / sizeof(shared::FilmPixel));
    plan.most_batch =
        static_cast<std::uint32_t>(std::clamp<std::uint64_t>(most / (each * (pixels + 2)), 1, plan.most_batch));
    plan.splats = std::max(plan.most_batch, batch);
}

std::uint32_t queue_capacity(const Plan& plan) {
    return std::bit_ceil(2 * plan.slots);
}

const char* name_of(Schedule schedule) {
    return schedule == Schedule::staged ? "staged" : schedule == Schedule::fused ? "fused" : "auto";
}

const char* name_of(Hits hits) {
    return hits == Hits::query ? "query" : hits == Hits::tree ? "tree" : "auto";
}

std::string describe(const Plan& plan) {
    std::string text = fmt::format("{}, {} {}, {} steps a turn", name_of(plan.schedule), plan.slots,
                                   plan.schedule == Schedule::staged ? "paths" : "pixels", plan.steps);
    if (plan.hits == Hits::query)
        text += ", surfaces by ray queries";
    if (plan.majorant_cell > 0)
        text +=
            fmt::format(", majorant cells of {} voxels{}", plan.majorant_cell, plan.leaps ? ", empty ones leapt" : "");
    return text;
}

} // namespace vkvol
