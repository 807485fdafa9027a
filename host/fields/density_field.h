// A grid of densities, temperatures, colours or velocities ready for lookup: NanoVDB bytes, checked and cleaned, with a
// table of its leaves.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "grid_values.h"
#include "nvdb_file.h"
#include "scene.h"

namespace vkvol {

// Copies share what is large in it.
struct DensityField {
    GridBytes bytes;
    int type = 0; // GRID_FLOAT, GRID_FP4, ...
    glm::dmat4 index_to_world{1.0};
    glm::dmat4 as_authored{1.0};     // the same as the file has it
    std::uint64_t active_voxels = 0; // 0: the field is 0 everywhere, and what follows is meaningless
    glm::ivec3 voxel_min{0};         // box of active voxels, inclusive; density outside is 0
    glm::ivec3 voxel_max{0};
    // One word per aligned 8^3 block from leaf_min on, z fastest; see shaders/field/density.glsl.
    glm::ivec3 leaf_min{0};
    glm::ivec3 leaf_dims{0};
    SharedArray<std::uint32_t> leaf_table;
    float background = 0.0f;   // what voxels have that the file gives no value: it counts in the box, as all others do
    bool is_signed = false;    // vectors
    bool is_staggered = false; // whose components are in the middle of the lower faces of voxels
    std::uint64_t cleaned = 0; // values that were NaN, infinite or negative and count as 0

    // Decoded value of a voxel, >= 0; 0 outside the box of active voxels. Of a colour its largest channel.
    float value(glm::ivec3 ijk) const;
    glm::vec3 color(glm::ivec3 ijk) const; // of a grid of numbers: grey; of vectors: the vector
    // The largest voxel value.
    float max_value() const;
    // Part of the box that the 8^3 block has, and its value if it is one constant, else none. `block`: from leaf_min.
    struct Block {
        glm::ivec3 low, high; // voxels, inclusive
        std::optional<float> constant;
    };
    Block block(glm::ivec3 block) const;
    // value() of voxels from `first` along z, as many of the eight as its block and the box have; 0 of others.
    std::array<float, 8> row(glm::ivec3 first) const;
    // World units per voxel: |det|^(1/3) of index_to_world.
    double voxel_size() const;
    // To where `transform` moves it from where the file has it.
    void place(const glm::dmat4& transform) { index_to_world = transform * as_authored; }
};

// Throws InputError naming file, grid, what is wrong and the remedy.
DensityField load_density_field(const GridFile& file, GridValues values = GridValues::numbers);

// Names of all grids in the file, in its order. Throws InputError if it cannot be read.
std::vector<std::string> grid_names(const std::filesystem::path& file);
std::vector<std::string> grid_names(const GridFile& file); // or in memory

// True if the file can be read and has a grid of that name. Throws InputError if it cannot be read.
bool has_grid(const GridFile& file);

// True if the grid has no active voxel. Throws as load_density_field.
bool is_empty_grid(const GridFile& file);

// From a NanoVDB grid in memory; `place` stands in messages.
DensityField make_density_field(GridBytes bytes, const std::string& place, GridValues values = GridValues::numbers);

} // namespace vkvol
