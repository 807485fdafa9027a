// The pieces of a ray that have one bound of the density each, and those that a march is made of.
#pragma once

#include <functional>
#include <optional>

#include "medium.h"

namespace reference {

// A majorant cell of a grid, or a whole interval of another medium.
struct Cell {
    double t0, t1;
    double majorant; // of the density, majorant_scale included
    double control;  // a density that is close to all densities of the cell,
    double residual; // and how far they can be from it
};

// The cells that a ray passes, in order.
class CellWalk {
public:
    CellWalk(const Medium& medium, const Ray& ray);
    bool next(Cell& cell);

private:
    bool next_layer(Cell& cell);

    const Medium& medium_;
    Ray index_ray_;
    std::vector<Interval> intervals_;
    std::size_t interval_ = 0;              // the next one, or that whose layers are passed
    int layer_ = 0;                         // cells of it that have been passed,
    double layer_end_ = 0.0;                // and where the last of them ended
    std::optional<MajorantWalk> grid_walk_; // of the present one
};

// Where a march step lies: [t, t + length]. Returns whether to go on.
using Step = std::function<bool(double t, double length)>;

// Cuts every interval of the ray into equal steps, the longest that do not exceed `longest`.
void for_each_step(const Medium& medium, const Ray& ray, double longest, const Step& step);
int step_count(const Interval& interval, double longest);

// Steps of at most the majorant optical depth `optical_step`, which end at the cells' faces; cells of majorant 0 are
// left out.
void for_each_adaptive_step(const Medium& medium, const Ray& ray, double optical_step, const Step& step);

// With lengths in world units and none of them 0.
vkvol::March resolve_march(const vkvol::March& march, const Medium& medium);

} // namespace reference
