// Damaged grids: found by tests/fuzz, kept here.
#include <catch2/catch.hpp>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <nanovdb/NanoVDB.h>
#include <unistd.h>

#include "density_field.h"
#include "error.h"
#include "loaded_medium.h"
#include "majorant_grid.h"
#include "support/scenes.h"
#include "support/test_grids.h"
#include "upload_layout.h"

using namespace vkvol;
using Catch::Contains;

namespace {

using Grid = nanovdb::NanoGrid<float>;

std::string error_of(GridBytes bytes, const std::function<void(Grid&)>& damage) {
    damage(*reinterpret_cast<Grid*>(bytes.edit()));
    try {
        make_density_field(std::move(bytes), "a grid");
    } catch (const InputError& error) {
        CHECK_THAT(error.what(), Catch::StartsWith("a grid: "));
        return error.what();
    }
    return "no error";
}

GridBytes rough() {
    return make_grid_bytes(rough_recipe());
}

// Across eight root tiles.
GridBytes spread() {
    GridRecipe recipe;
    recipe.first = glm::ivec3(-2);
    recipe.last = glm::ivec3(1);
    recipe.value = [](glm::ivec3) { return 1.0f; };
    return make_grid_bytes(recipe);
}

} // namespace

TEST_CASE("transforms that single precision cannot hold are refused", "[cpu][density]") {
    for (const double entry :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300, -1e12}) {
        CAPTURE(entry);
        CHECK_THAT(error_of(rough(), [&](Grid& grid) { grid.data()->mMap.mVecD[1] = entry; }), Contains("transform"));
        CHECK_THAT(error_of(rough(), [&](Grid& grid) { grid.data()->mMap.mMatD[0] = entry; }), Contains("transform"));
    }
    // A determinant of 1 says little.
    CHECK_THAT(error_of(rough(),
                        [](Grid& grid) {
                            grid.data()->mMap.mMatD[0] = 1e200;
                            grid.data()->mMap.mMatD[4] = 1e-200;
                        }),
               Contains("transform"));
}

TEST_CASE("nodes that several parents share, or that contain themselves, are damage", "[cpu][density]") {
    CHECK_THAT(error_of(rough(),
                        [](Grid& grid) { // every child of the upper node is the same lower node
                            auto* root = grid.tree().root().data();
                            auto* upper = root->getChild(root->tile(0))->data();
                            std::int64_t child = 0;
                            for (std::uint32_t n = 0; n < 32768; ++n)
                                if (upper->mChildMask.isOn(n))
                                    child = upper->mTable[n].child;
                            for (std::uint32_t n = 0; n < 32768; ++n) {
                                upper->mChildMask.setOn(n);
                                upper->mTable[n].child = child;
                            }
                        }),
               Contains("damaged"));
    CHECK_THAT(error_of(spread(),
                        [](Grid& grid) { // one tile of the root, twice
                            auto* root = grid.tree().root().data();
                            REQUIRE(root->mTableSize == 8);
                            *root->tile(1) = *root->tile(0);
                        }),
               Contains("damaged"));
}

TEST_CASE("boxes of active voxels lie within the nodes", "[cpu][density]") {
    const auto with_box = [](nanovdb::Coord low, nanovdb::Coord high) {
        return error_of(rough(), [&](Grid& grid) { grid.tree().root().data()->mBBox = {low, high}; });
    };
    constexpr int most = std::numeric_limits<int>::max();
    CHECK_THAT(with_box({-most - 1, 0, 0}, {most, 0, 0}), Contains("box of active voxels"));
    CHECK_THAT(with_box({-3, 2, 0}, {1 << 20, 12, 10}), Contains("box of active voxels"));
    CHECK_THAT(with_box({-3, 2, 0}, {4000, 4000, 4000}), Contains("box of active voxels"));
    CHECK(with_box({-3, 2, 0}, {9, 12, 10}) == "no error");
}

namespace {

// 4096^3 voxels of one value, 4, and some of 1.5: by the voxel anything about them would take minutes.
DensityField large_tile() {
    GridRecipe recipe;
    recipe.first = {4090, 0, 0};
    recipe.last = {8200, 0, 0};
    recipe.value = [](glm::ivec3 i) { return i.x < 4093 || i.x > 8195 ? 1.5f : i.x == 5000 ? 2.0f : 0.0f; };
    GridBytes bytes = with_root_tile(make_grid_bytes(recipe), {5000, 0, 0}, 4.0f);
    reinterpret_cast<Grid*>(bytes.edit())->tree().root().data()->mBBox = {{4090, 0, 0}, {8200, 1000, 1000}};
    return make_density_field(std::move(bytes), "tiles");
}

float bound_at(const MajorantGrid& majorants, glm::ivec3 voxel) {
    const glm::ivec3 cell = (voxel - majorants.origin) / majorants.cell;
    return majorants.bounds[(std::size_t(cell.x) * majorants.dims.y + cell.y) * majorants.dims.z + cell.z];
}

} // namespace

TEST_CASE("large tiles cost no more than small ones", "[cpu][density]") {
    const DensityField field = large_tile();
    CHECK(field.max_value() == 4.0f);
    const MajorantGrid majorants = make_majorant_grid(field, 64);
    CHECK(bound_at(majorants, {6000, 500, 500}) == 4.0f);
    CHECK(bound_at(majorants, {4092, 500, 500}) == 4.0f); // a cell of 64 reaches across the border at 4096
}

TEST_CASE("large tiles cost no more than small ones under a map of values", "[cpu][density][value_map]") {
    ValueMap map; // that falls: the least value decides
    map.points = {{.value = 0.0, .density = 2.0}, {.value = 5.0, .density = 1.0}};
    const MajorantGrid majorants = make_majorant_grid(large_tile(), 64, map);
    CHECK(bound_at(majorants, {6000, 500, 500}) == Approx(1.2).epsilon(1e-5));
    CHECK(bound_at(majorants, {4092, 500, 500}) == Approx(2.0).epsilon(1e-5));  // beside it is nothing
    CHECK(bound_at(majorants, {6000, 1000, 500}) == Approx(2.0).epsilon(1e-5)); // where the grid ends is none, either
}

TEST_CASE("grids that end within a word lie behind one another whole", "[cpu][several]") {
    const GridBytes even = make_grid_bytes(cloud_grid());
    GridBytes odd(even.size() + 2);
    std::memcpy(odd.edit(), even.data(), even.size());
    reinterpret_cast<nanovdb::GridData*>(odd.edit())->mGridSize = odd.size();
    std::vector<LoadedMedium> media(1);
    media[0].field = make_density_field(std::move(odd), "odd");
    media[0].temperature = make_density_field(make_grid_bytes(cloud_grid()), "even");
    const UploadLayout layout(media);
    REQUIRE(layout.grids().size() == 2);
    CHECK(layout.place_of(*media[0].field).first_word == 0);
    CHECK(4 * layout.place_of(*media[0].temperature).first_word == layout.grids()[0].size());
    CHECK(layout.grids()[0].size() == even.size() + 4);
    CHECK(layout.grids()[0].back() == std::byte{0});
}
