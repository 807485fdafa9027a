// Small grids for tests, made in memory by NanoVDB's own builder, with NanoVDB's own lookups to compare with.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "loaded_medium.h"
#include "tests/reference/grid.h"

namespace vkvol {

enum class Storage { float32, fp4, fp8, fp16, fpn };
constexpr Storage all_storages[] = {Storage::float32, Storage::fp4, Storage::fp8, Storage::fp16, Storage::fpn};
const char* storage_name(Storage storage);

// What the builder is given: value(ijk) for the voxels [first, last]; those that equal the background stay inactive.
struct GridRecipe {
    glm::ivec3 first{0}, last{0};
    std::function<float(glm::ivec3)> value;
    Storage storage = Storage::float32;
    float background = 0.0f;
    glm::dmat3 linear{1.0}; // world = linear * index + translation
    glm::dvec3 translation{0.0};
    std::string name = "density";
    int cell = 8; // of the majorants; 0: chosen for density 1 having extinction 1 per voxel
    std::function<glm::vec3(glm::ivec3)> color = {}; // in place of `value`: a grid of colours
};

struct TestGrid {
    LoadedMedium volume; // as the renderer loads it
    // As NanoVDB sees it, through the accessor and the trilinear sampler of its C++ library.
    std::function<float(glm::ivec3)> accessor;
    std::function<float(glm::vec3)> sampler;
    glm::ivec3 voxel_min{0}, voxel_max{-1}; // NanoVDB's box of active voxels
    glm::dmat3 linear{1.0};                 // to world space, by NanoVDB's map
    glm::dvec3 translation{0.0};
    float highest = 0.0f; // of the values that count

    const DensityField& field() const { return *volume.field; }
    const MajorantGrid& majorants() const { return *volume.majorants; }
    // change(MajorantGrid&) of a copy, which takes their place.
    template <class Change> void change_majorants(const Change& change) {
        MajorantGrid changed = majorants();
        change(changed);
        volume.majorants = std::make_shared<const Majorants>(std::move(changed));
    }
    bool in_box(glm::ivec3 ijk) const;
    // What a voxel counts as: the accessor's value within the box if that is finite and positive, else 0.
    float voxel(glm::ivec3 ijk) const;
    double trilinear(glm::dvec3 p) const; // of voxel()
};

// NanoVDB bytes of the recipe.
GridBytes make_grid_bytes(const GridRecipe& recipe);

TestGrid make_test_grid(const GridRecipe& recipe);
TestGrid make_test_grid(GridBytes bytes, int cell = 8);

// The bytes with the 4096^3 voxels around `ijk`, which must have a node of their own, made one tile of that value.
GridBytes with_root_tile(GridBytes bytes, glm::ivec3 ijk, float value);

// For the reference, from NanoVDB's accessor alone.
reference::Grid make_reference_grid(const TestGrid& grid);

// Bound of one majorant cell.
float bound_of(const MajorantGrid& majorants, glm::ivec3 cell);

// A number in [0, 1) for each voxel.
double voxel_noise(glm::ivec3 ijk, std::uint32_t seed);

// Holes and peaks side by side, the hardest field for majorants: 13 x 11 x 11 voxels across leaf borders, with a corner
// at negative indices.
GridRecipe rough_recipe();

// As rough, 45 x 39 x 22 voxels: several majorant cells of each size along each axis.
GridRecipe larger_recipe(Storage storage);

// Small balls far apart in nothing: majorant cells of every reach.
GridRecipe sparse_recipe();

// Rotation, shear, unequal scales and a mirror.
extern const glm::dmat3 skewed;

} // namespace vkvol
