#include <algorithm>
#include <cmath>
#include <limits>

#include "bricks.h"
#include "recipes.h"

namespace vkvol {
namespace {

Field one_grid(double voxel_size, glm::dvec3 origin, FieldGrid grid) {
    return {voxel_size, origin, {std::move(grid)}};
}

// A cube of `size` samples around index 0, one sample more below 0 than above where `size` is even.
IndexBox centred_box(int size) {
    const glm::ivec3 min(-(size / 2));
    return {min, min + (size - 1)};
}

// Of `size` samples, its first corner below 0 and no multiple of a leaf's width.
IndexBox cube(int size) {
    const glm::ivec3 min(-5);
    return {min, min + (size - 1)};
}

} // namespace

Field make_constant(int size, std::uint32_t) {
    return one_grid(0.5, glm::dvec3(0.0), grid_of(cube(size), [](glm::ivec3) { return 1.0f; }));
}

// 1 within size/2 - 4 samples of index (-1/2, -1/2, -1/2), 0 three samples further out, linear between.
Field make_sphere(int size, std::uint32_t) {
    const double radius = size / 2 - 4;
    return one_grid(0.125, {1.0, 2.0, -3.0}, grid_of(centred_box(size), [=](glm::ivec3 index) {
                        const double distance = glm::length(glm::dvec3(index) + 0.5);
                        return float(std::clamp((radius + 3.0 - distance) / 3.0, 0.0, 1.0));
                    }));
}

Field make_ramp(int size, std::uint32_t) {
    return one_grid(1.0, glm::dvec3(0.0), grid_of({glm::ivec3(0), glm::ivec3(size - 1)}, [=](glm::ivec3 index) {
                        return float(index.x + 1) / float(size);
                    }));
}

// Cubes of four samples cross no leaf, so majorant cells of 8 samples see 1 everywhere and those of 4 do not.
Field make_checker(int size, std::uint32_t) {
    FieldGrid grid = grid_of(centred_box(size), [](glm::ivec3 index) {
        const glm::ivec3 cube = index >> 2; // rounds down, also below 0
        return float((cube.x + cube.y + cube.z) & 1);
    });
    const int beside = (centred_box(size).max.x | (brick_width - 1)) + 1;
    grid.tiles.push_back({glm::ivec3(beside, 0, 0), brick_width, 0.5f});
    return one_grid(0.25, {0.0, 0.0, 4.0}, std::move(grid));
}

Field make_voxel(int, std::uint32_t) {
    const glm::ivec3 index(-7, -3, -11);
    return one_grid(2.0, glm::dvec3(0.0), grid_of({index, index}, [](glm::ivec3) { return 1.0f; }));
}

Field make_spike(int size, std::uint32_t) {
    const double radius = size / 2 - 1;
    return one_grid(0.1, glm::dvec3(0.0), grid_of(centred_box(size), [=](glm::ivec3 index) {
                        if (index == glm::ivec3(-1, 2, -3))
                            return 20.0f;
                        return glm::length(glm::dvec3(index) + 0.5) < radius ? 0.05f : 0.0f;
                    }));
}

// The leaf's samples are 1/8 .. 1 along z, so that a sampler which mistakes tile for leaf is caught.
Field make_tiles(int, std::uint32_t) {
    FieldGrid grid = grid_of({glm::ivec3(-8, 0, 0), glm::ivec3(-1, 7, 7)},
                             [](glm::ivec3 index) { return float(index.z + 1) / 8.0f; });
    grid.tiles = {{glm::ivec3(0, 0, 0), 128, 0.5f},
                  {glm::ivec3(-8, 8, 0), 8, 0.75f},
                  {glm::ivec3(-16, 0, 0), 8, 0.25f},
                  {glm::ivec3(-8, -8, -8), 8, 1.0f}};
    return one_grid(0.25, {-16.0, 0.0, 0.0}, std::move(grid));
}

Field make_empty(int, std::uint32_t) {
    return one_grid(1.0, glm::dvec3(0.0), FieldGrid{});
}

Field make_sheared(int size, std::uint32_t seed) {
    Field field = make_constant(size, seed);
    field.axes = glm::dmat3({0.8, 0.3, 0.0}, {-0.4, 1.0, 0.2}, {0.2, -0.1, -1.5}); // left-handed
    return field;
}

Field make_far(int size, std::uint32_t seed) {
    Field field = make_constant(size, seed);
    field.origin = {1e6, -1e6, 1e6};
    return field;
}

// By k - min: 2 is NaN, 5 infinite, 8 minus infinite, 11 negative; all of them count as 0.
Field make_unclean(int size, std::uint32_t) {
    const IndexBox box = cube(size);
    constexpr float infinity = std::numeric_limits<float>::infinity();
    return one_grid(0.5, glm::dvec3(0.0), grid_of(box, [=](glm::ivec3 index) {
                        switch (index.z - box.min.z) {
                        case 2:
                            return std::numeric_limits<float>::quiet_NaN();
                        case 5:
                            return infinity;
                        case 8:
                            return -infinity;
                        case 11:
                            return -1.0f;
                        default:
                            return 1.0f;
                        }
                    }));
}

// The temperature reaches beyond the density, so that it is 1 wherever something glows.
Field make_glow(int size, std::uint32_t seed) {
    Field field = make_constant(size, seed);
    IndexBox wider = cube(size);
    wider.min -= 4;
    wider.max += 4;
    field.grids.push_back(grid_of(wider, [](glm::ivec3) { return 1.0f; }));
    field.grids.back().name = "temperature";
    return field;
}

} // namespace vkvol
