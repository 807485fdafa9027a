#include "cells.h"

#include <algorithm>
#include <cmath>

#include "mapped.h"

namespace reference {

CellWalk::CellWalk(const Medium& medium, const Ray& ray)
    : medium_(medium), index_ray_(medium.grid() ? medium.grid()->to_index(ray) : ray),
      intervals_(support(medium, ray)) {}

bool CellWalk::next(Cell& cell) {
    const double scale = medium_.majorant_scale;
    if (medium_.periodic) { // one bound of all there is
        if (interval_ == intervals_.size())
            return false;
        const Interval& interval = intervals_[interval_++];
        const double most = largest_density(medium_);
        cell = {interval.t0, interval.t1, most * scale, 0.0, most * scale};
        return true;
    }
    if (const Grid* grid = medium_.grid()) {
        if (!grid_walk_ && !intervals_.empty())
            grid_walk_.emplace(*grid, index_ray_, intervals_.front());
        MajorantSegment segment;
        if (!grid_walk_ || !grid_walk_->next(segment))
            return false;
        const auto [least, most] = mapped_extremes(medium_.map, segment.minorant, segment.majorant);
        cell = {segment.t0, segment.t1, most * scale, least, (most - least) * scale};
        return true;
    }
    if (interval_ == intervals_.size())
        return false;
    if (medium_.layers)
        return next_layer(cell);
    const Interval& interval = intervals_[interval_++];
    if (medium_.noise) {
        const double bound = noise_bound(*medium_.noise), control = 0.5 * bound;
        cell = {interval.t0, interval.t1, bound * scale, control, std::max(bound - control, control)};
    } else {
        cell = {interval.t0, interval.t1, scale, 1.0, std::max(scale - 1.0, 0.0)};
    }
    return true;
}

// Steps of equal height, of which each has the extremes of its layers; of a level ray there is but one.
bool CellWalk::next_layer(Cell& cell) {
    constexpr int steps = 40;
    const vkvol::Layers& layers = *medium_.layers;
    const Ray ray = medium_.unmoved(index_ray_);
    const double rise = ray.direction[layers.axis], edge = (layers.top - layers.bottom) / steps;
    const Interval& interval = intervals_[interval_];
    const double t0 = layer_ == 0 ? interval.t0 : layer_end_, from = medium_.height(ray.at(t0));
    ++layer_;
    double t1 = interval.t1, to = from;
    if (rise != 0.0) {
        const int at = static_cast<int>(std::floor(from / edge + (rise > 0.0 ? 1e-9 : -1e-9)));
        t1 = std::min(t1, t0 + ((at + (rise > 0.0)) * edge - from) / rise);
        to = medium_.height(ray.at(t1));
    }
    t1 = std::max(t1, t0);
    layer_end_ = t1;
    if (t1 >= interval.t1) {
        ++interval_;
        layer_ = 0;
    }
    const auto [low, high] = std::minmax({from, to});
    Extremes range{};
    if (layers.scale_height > 0.0)
        range = {std::exp((layers.reference - layers.bottom - high) / layers.scale_height),
                 std::exp((layers.reference - layers.bottom - low) / layers.scale_height)};
    else
        range = mapped_extremes(medium_.map, std::max(low, 0.0), high);
    const double scale = medium_.majorant_scale, slack = 1e-9 * range.most; // of heights found in two ways
    cell = {t0, t1, (range.most + slack) * scale, std::max(range.least - slack, 0.0),
            (range.most - range.least + 2.0 * slack) * scale};
    return true;
}

int step_count(const Interval& interval, double longest) {
    return std::max(1, static_cast<int>(std::ceil(interval.length() / longest)));
}

void for_each_step(const Medium& medium, const Ray& ray, double longest, const Step& step) {
    for (const Interval& interval : support(medium, ray)) {
        const int n = step_count(interval, longest);
        const double length = interval.length() / n;
        for (int k = 0; k < n; ++k)
            if (!step(interval.t0 + k * length, length))
                return;
    }
}

void for_each_adaptive_step(const Medium& medium, const Ray& ray, double optical_step, const Step& step) {
    CellWalk walk(medium, ray);
    Cell cell;
    while (walk.next(cell)) {
        const double sigma_maj = medium.largest() * cell.majorant;
        if (sigma_maj == 0.0)
            continue;
        const double longest = optical_step / sigma_maj;
        double t = cell.t0;
        while (cell.t1 - t > longest) {
            if (!step(t, longest))
                return;
            t += longest;
        }
        if (t < cell.t1 && !step(t, cell.t1 - t))
            return;
    }
}

vkvol::March resolve_march(const vkvol::March& march, const Medium& medium) {
    const Grid* grid = medium.grid();
    const double unit = grid && march.unit == vkvol::CoefficientUnit::voxel ? grid->voxel_length() : 1.0;
    vkvol::March resolved = march;
    resolved.unit = vkvol::CoefficientUnit::world;
    resolved.step = march.step > 0.0 ? march.step * unit : grid ? 0.5 * grid->voxel_length() : 0.2;
    resolved.shadow_step = march.shadow_step > 0.0 ? march.shadow_step * unit : resolved.step;
    return resolved;
}

} // namespace reference
