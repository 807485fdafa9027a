#include "test_grids.h"

#include <cmath>
#include <cstring>
#include <memory>
#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/SampleFromVoxels.h>

#include "tests/reference/rng.h"

namespace vkvol {

namespace {

nanovdb::Coord to_coord(glm::ivec3 i) {
    return {i.x, i.y, i.z};
}
glm::ivec3 to_ivec3(const nanovdb::Coord& c) {
    return {c[0], c[1], c[2]};
}

nanovdb::Map make_map(const glm::dmat3& linear, const glm::dvec3& translation) {
    nanovdb::Map map{};
    const glm::dmat3 inverse = glm::inverse(linear);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            map.mMatD[3 * row + column] = linear[column][row];
            map.mInvMatD[3 * row + column] = inverse[column][row];
            map.mMatF[3 * row + column] = static_cast<float>(linear[column][row]);
            map.mInvMatF[3 * row + column] = static_cast<float>(inverse[column][row]);
        }
        map.mVecD[row] = translation[row];
        map.mVecF[row] = static_cast<float>(translation[row]);
    }
    map.mTaperD = map.mTaperF = 1.0;
    return map;
}

template <class Build> GridBytes build(const GridRecipe& recipe) {
    nanovdb::GridBuilder<float, Build> builder(recipe.background, nanovdb::GridClass::FogVolume);
    builder([&](const nanovdb::Coord& c) { return recipe.value(to_ivec3(c)); },
            nanovdb::CoordBBox(to_coord(recipe.first), to_coord(recipe.last)));
    const auto handle = builder.template getHandle<nanovdb::AbsDiff>(make_map(recipe.linear, recipe.translation),
                                                                     recipe.name, nanovdb::AbsDiff(0.001f));
    GridBytes bytes(handle.size());
    std::memcpy(bytes.edit(), handle.data(), handle.size());
    return bytes;
}

GridBytes build_colors(const GridRecipe& recipe) {
    nanovdb::GridBuilder<nanovdb::Vec3f> builder(nanovdb::Vec3f(recipe.background));
    builder(
        [&](const nanovdb::Coord& c) {
            const glm::vec3 color = recipe.color(to_ivec3(c));
            return nanovdb::Vec3f(color.x, color.y, color.z);
        },
        nanovdb::CoordBBox(to_coord(recipe.first), to_coord(recipe.last)));
    const auto handle = builder.getHandle(make_map(recipe.linear, recipe.translation), recipe.name);
    GridBytes bytes(handle.size());
    std::memcpy(bytes.edit(), handle.data(), handle.size());
    return bytes;
}

// Points `grid` at NanoVDB's view of `bytes`, a copy that nobody else writes.
template <class Build> void attach(TestGrid& grid, const std::shared_ptr<GridBytes>& bytes) {
    const auto* nano = reinterpret_cast<const nanovdb::NanoGrid<Build>*>(bytes->data());
    using Accessor = decltype(nano->getAccessor());
    const auto accessor = std::make_shared<Accessor>(nano->getAccessor());
    grid.accessor = [bytes, accessor](glm::ivec3 ijk) { return accessor->getValue(to_coord(ijk)); };
    grid.sampler = [bytes, accessor](glm::vec3 p) {
        return nanovdb::createSampler<1>(*accessor)(nanovdb::Vec3f(p.x, p.y, p.z));
    };
    const auto to_world = [nano](double x, double y, double z) {
        const nanovdb::Vec3d p = nano->map().applyMap(nanovdb::Vec3d(x, y, z));
        return glm::dvec3(p[0], p[1], p[2]);
    };
    grid.translation = to_world(0.0, 0.0, 0.0);
    for (int axis = 0; axis < 3; ++axis)
        grid.linear[axis] = to_world(axis == 0, axis == 1, axis == 2) - grid.translation;
    if (nano->activeVoxelCount() > 0) {
        grid.voxel_min = to_ivec3(nano->indexBBox().min());
        grid.voxel_max = to_ivec3(nano->indexBBox().max());
    }
}

void attach_any(TestGrid& grid, const std::shared_ptr<GridBytes>& bytes) {
    switch (reinterpret_cast<const nanovdb::GridData*>(bytes->data())->mGridType) {
    case nanovdb::GridType::Fp4:
        return attach<nanovdb::Fp4>(grid, bytes);
    case nanovdb::GridType::Fp8:
        return attach<nanovdb::Fp8>(grid, bytes);
    case nanovdb::GridType::Fp16:
        return attach<nanovdb::Fp16>(grid, bytes);
    case nanovdb::GridType::FpN:
        return attach<nanovdb::FpN>(grid, bytes);
    default:
        return attach<float>(grid, bytes);
    }
}

} // namespace

const char* storage_name(Storage storage) {
    constexpr const char* names[] = {"float", "Fp4", "Fp8", "Fp16", "FpN"};
    return names[static_cast<int>(storage)];
}

bool TestGrid::in_box(glm::ivec3 ijk) const {
    return ijk == glm::clamp(ijk, voxel_min, glm::max(voxel_min, voxel_max)) && voxel_min.x <= voxel_max.x;
}

float TestGrid::voxel(glm::ivec3 ijk) const {
    const float value = in_box(ijk) ? accessor(ijk) : 0.0f;
    return std::isfinite(value) && value > 0.0f ? value : 0.0f;
}

double TestGrid::trilinear(glm::dvec3 p) const {
    const glm::dvec3 base = glm::floor(p), f = p - base;
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 c(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 w = glm::mix(1.0 - f, f, glm::dvec3(c));
        sum += w.x * w.y * w.z * voxel(glm::ivec3(base) + c);
    }
    return sum;
}

GridBytes make_grid_bytes(const GridRecipe& recipe) {
    if (recipe.color)
        return build_colors(recipe);
    switch (recipe.storage) {
    case Storage::fp4:
        return build<nanovdb::Fp4>(recipe);
    case Storage::fp8:
        return build<nanovdb::Fp8>(recipe);
    case Storage::fp16:
        return build<nanovdb::Fp16>(recipe);
    case Storage::fpn:
        return build<nanovdb::FpN>(recipe);
    default:
        return build<float>(recipe);
    }
}

TestGrid make_test_grid(const GridRecipe& recipe) {
    return make_test_grid(make_grid_bytes(recipe), recipe.cell);
}

TestGrid make_test_grid(GridBytes bytes, int cell) {
    TestGrid grid;
    attach_any(grid, std::make_shared<GridBytes>(bytes));
    grid.volume.field = make_density_field(std::move(bytes), "test grid");
    if (grid.field().active_voxels == 0)
        return grid;
    MajorantGrid majorants = make_majorant_grid(grid.field(), cell);
    majorants.leaps = true; // the harder way
    grid.volume.majorants = std::make_shared<const Majorants>(std::move(majorants));
    for (const float bound : grid.majorants().bounds)
        grid.highest = std::max(grid.highest, bound);
    return grid;
}

GridBytes with_root_tile(GridBytes bytes, glm::ivec3 ijk, float value) {
    auto* nano = reinterpret_cast<nanovdb::NanoGrid<float>*>(bytes.edit());
    auto* root = nano->tree().root().data();
    for (std::uint32_t i = 0; i < root->mTableSize; ++i) {
        auto* tile = root->tile(i);
        const glm::ivec3 low = to_ivec3(tile->origin());
        if (ijk == glm::clamp(ijk, low, low + 4095)) {
            tile->child = 0;
            tile->state = 1;
            tile->value = value;
        }
    }
    return bytes;
}

reference::Grid make_reference_grid(const TestGrid& grid) {
    return reference::make_grid(
        grid.voxel_min, grid.voxel_max, [&](glm::ivec3 i) { return double(grid.accessor(i)); }, grid.linear,
        grid.translation);
}

double voxel_noise(glm::ivec3 ijk, std::uint32_t seed) {
    const auto word = [](int i) { return static_cast<std::uint32_t>(i); };
    return reference::Draw{reference::pcg4d({word(ijk.x), word(ijk.y), word(ijk.z), seed})}.x();
}

float bound_of(const MajorantGrid& m, glm::ivec3 cell) {
    return m.bounds[(std::size_t(cell.x) * m.dims.y + cell.y) * m.dims.z + cell.z];
}

GridRecipe larger_recipe(Storage storage) {
    GridRecipe recipe = rough_recipe();
    recipe.storage = storage;
    recipe.first = {-21, -8, -1};
    recipe.last = {23, 30, 20};
    return recipe;
}

GridRecipe sparse_recipe() {
    GridRecipe recipe{{-21, -8, -1}, {43, 50, 60}, nullptr, Storage::float32};
    recipe.value = [](glm::ivec3 i) {
        for (const glm::ivec3 middle : {glm::ivec3(-19, -6, 1), glm::ivec3(41, 48, 58), glm::ivec3(12, 20, 7)}) {
            const glm::ivec3 apart = i - middle;
            if (glm::dot(glm::vec3(apart), glm::vec3(apart)) < 16.0f)
                return 0.4f + 0.6f * float(voxel_noise(i, 9));
        }
        return 0.0f;
    };
    recipe.cell = 4;
    return recipe;
}

GridRecipe rough_recipe() {
    GridRecipe recipe;
    recipe.first = {-3, 2, 0};
    recipe.last = {9, 12, 10};
    recipe.value = [](glm::ivec3 i) {
        return voxel_noise(i, 1) < 0.4 ? 0.0f : static_cast<float>(2.0 * std::pow(voxel_noise(i, 2), 4.0));
    };
    return recipe;
}

const glm::dmat3 skewed(glm::dvec3(0.3, 0.4, 0.0), glm::dvec3(-0.5, 0.2, 0.1), glm::dvec3(0.05, 0.1, -0.6));

} // namespace vkvol
