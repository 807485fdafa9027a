#include "layers.h"

#include <algorithm>
#include <cmath>

namespace vkvol {

namespace {

constexpr int cells = 64;
// Relative error of an exponential: Vulkan's exp errs by 3 + 2 |x| units in the last place, and |x| is 20 by default.
constexpr double rounding = 1e-5;

// Range of the density in the i-th cell from below.
DensityRange cell_range(const Volume& volume, int i) {
    const LayerBox box = layer_box(volume);
    const int axis = volume.layers->axis;
    const double edge = box.size[axis] / cells, low = box.low[axis] + i * edge;
    const double margin = 1e-3 * edge; // rays know where they are in single precision
    return layer_range(volume, std::max(low - margin, box.low[axis]),
                       std::min(low + edge + margin, box.low[axis] + box.size[axis]));
}

} // namespace

LayerBox layer_box(const Volume& volume) {
    LayerBox box{glm::dvec3(-everywhere_reach), glm::dvec3(2.0 * everywhere_reach)};
    if (const auto* shape = std::get_if<Box>(&volume.shape))
        box = {shape->center - 0.5 * shape->size, shape->size};
    const Layers& layers = *volume.layers;
    const double low = std::max(box.low[layers.axis], layers.bottom);
    box.size[layers.axis] = std::min(box.low[layers.axis] + box.size[layers.axis], layers.top) - low;
    box.low[layers.axis] = low;
    return box;
}

double layer_density(const Volume& volume, double height) {
    const Layers& layers = *volume.layers;
    if (!(height >= layers.bottom && height <= layers.top))
        return 0.0;
    if (layers.scale_height > 0.0)
        return std::exp(-(height - layers.reference) / layers.scale_height);
    return mapped_density(volume.map, height - layers.bottom);
}

DensityRange layer_range(const Volume& volume, double low, double high) {
    const Layers& layers = *volume.layers;
    const double from = std::max(low, layers.bottom), to = std::min(high, layers.top);
    if (!(from <= to))
        return {};
    DensityRange range;
    if (layers.scale_height > 0.0)
        range = {layer_density(volume, to) * (1.0 - rounding), layer_density(volume, from) * (1.0 + rounding)};
    else
        range = mapped_range(volume.map, from - layers.bottom, to - layers.bottom);
    if (low < from || high > to)
        range.least = 0.0;
    return range;
}

MajorantGrid layer_cells(const Volume& volume) {
    MajorantGrid grid;
    grid.cell = 1;
    grid.dims = glm::ivec3(1);
    grid.dims[volume.layers->axis] = cells;
    for (int i = 0; i < cells; ++i)
        grid.bounds.push_back(static_cast<float>(cell_range(volume, i).most));
    return grid;
}

std::vector<shared::ControlCell> layer_controls(const Volume& volume) {
    constexpr double within = 1e-6; // of the bound, so that single precision does not violate it
    std::vector<shared::ControlCell> controls;
    for (int i = 0; i < cells; ++i) {
        const DensityRange range = cell_range(volume, i);
        const double control = range.least * (1.0 - within);
        controls.push_back({float(control), float(range.most - control + within * range.most)});
    }
    return controls;
}

} // namespace vkvol
