#include "empty_space.h"

#include <algorithm>
#include <array>

namespace vkvol {

namespace {

constexpr std::uint8_t far_away = 255;

} // namespace

// Distances to the nearest cell that is not empty, by two sweeps over the 13 neighbours on either side of a cell, exact
// in this metric (Rosenfeld and Pfaltz, "Sequential Operations in Digital Picture Processing", 1966). A border of empty
// cells stands for what is beyond the grid.
std::vector<std::uint8_t> empty_reaches(const MajorantGrid& cells) {
    std::vector<std::uint8_t> reaches(cells.bounds.size());
    if (std::find(cells.bounds.begin(), cells.bounds.end(), 0.0f) == cells.bounds.end())
        return reaches;
    const glm::ivec3 dims = cells.dims;
    const std::ptrdiff_t row = dims.z + 2, plane = row * (dims.y + 2);
    std::vector<std::uint8_t> distance(static_cast<std::size_t>(plane * (dims.x + 2)), far_away);
    const auto place = [&](int x, int y, int z) { return (x + 1) * plane + (y + 1) * row + z + 1; };
    std::array<std::ptrdiff_t, 13> before;
    for (std::ptrdiff_t i = 0; i < 13; ++i)
        before[std::size_t(i)] = (i / 9 - 1) * plane + (i / 3 % 3 - 1) * row + i % 3 - 1;
    std::size_t i = 0;
    for (int x = 0; x < dims.x; ++x)
        for (int y = 0; y < dims.y; ++y)
            for (int z = 0; z < dims.z; ++z) {
                std::uint8_t* at = &distance[std::size_t(place(x, y, z))];
                std::uint8_t nearest = far_away - 1;
                for (const std::ptrdiff_t offset : before)
                    nearest = std::min(nearest, at[offset]);
                *at = cells.bounds[i++] > 0.0f ? 0 : nearest + 1;
            }
    for (int x = dims.x - 1; x >= 0; --x)
        for (int y = dims.y - 1; y >= 0; --y)
            for (int z = dims.z - 1; z >= 0; --z) {
                std::uint8_t* at = &distance[std::size_t(place(x, y, z))];
                std::uint8_t nearest = *at;
                for (const std::ptrdiff_t offset : before)
                    nearest = std::min<std::uint8_t>(nearest, std::min<std::uint8_t>(at[-offset], far_away - 1) + 1);
                *at = nearest;
                reaches[--i] = std::max<std::uint8_t>(nearest, 1) - 1;
            }
    return reaches;
}

std::vector<float> walked_cells(const MajorantGrid& cells) {
    std::vector<float> walked = cells.bounds;
    if (!cells.leaps)
        return walked;
    const std::vector<std::uint8_t> reaches = empty_reaches(cells);
    for (std::size_t i = 0; i < walked.size(); ++i)
        if (walked[i] == 0.0f)
            walked[i] = -float(reaches[i]);
    return walked;
}

} // namespace vkvol
