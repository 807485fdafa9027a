#pragma once

namespace vkvol {

// Half-open pixel window [x0, x1) x [y0, y1) of the picture: the part that is rendered.
struct Crop {
    int x0 = 0, x1 = 0, y0 = 0, y1 = 0;
    bool operator==(const Crop&) const = default;
};

} // namespace vkvol
