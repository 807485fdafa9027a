// A field as plain sparse data, the way generators make it and before any file format sees it.
// Index space: sample (i, j, k) sits at index position (i, j, k). World position = voxel_size * axes * index + origin.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace vkvol {

constexpr int brick_width = 8; // samples along an edge: one leaf of the OpenVDB tree

// 8^3 samples, the last coordinate fastest. A sample is active if it is not 0.
struct Brick {
    glm::ivec3 origin{0}; // multiple of 8
    std::array<float, brick_width * brick_width * brick_width> value{};

    static int offset(int i, int j, int k) { return (i * brick_width + j) * brick_width + k; }
};

// A cube of one active value without samples of its own.
struct Tile {
    glm::ivec3 origin{0}; // multiple of `width`
    int width = 8;        // 8 or 128: the tile sizes of the two levels of internal nodes
    float value = 0.0f;
};

struct FieldGrid {
    std::string name = "density";
    std::vector<Brick> bricks;
    std::vector<Tile> tiles;
};

struct Field {
    double voxel_size = 1.0;      // world units
    glm::dvec3 origin{0.0};       // world position of index (0, 0, 0)
    std::vector<FieldGrid> grids; // share the transform
    glm::dmat3 axes{1.0};         // columns: where the index axes point
};

} // namespace vkvol
