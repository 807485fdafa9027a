// .vdb files that OpenVDB itself writes: all that can be read of them is, whatever lies beside it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <nanovdb/NanoVDB.h> // before OpenVDB's, which has macros
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <sstream>
#include <unistd.h>

#include "density_field.h"
#include "error.h"
#include "loaded_medium.h"
#include "method.h"
#include "support/shell.h"
#include "test_paths.h"
#include "vdb_import.h"

using namespace vkvol;
using Catch::Contains;

namespace {

class WrittenVdb {
public:
    explicit WrittenVdb(const openvdb::GridPtrVec& grids, const char* ending = ".vdb",
                        std::uint32_t compression = openvdb::io::Archive::DEFAULT_COMPRESSION_FLAGS)
        : path_(std::filesystem::temp_directory_path() / fmt::format("vkvol_written_{}{}", getpid(), ending)) {
        openvdb::initialize();
        openvdb::io::File file(path_.string());
        file.setCompression(compression);
        file.write(grids);
        file.close();
    }
    ~WrittenVdb() { std::filesystem::remove(path_); }
    WrittenVdb(const WrittenVdb&) = delete;
    WrittenVdb& operator=(const WrittenVdb&) = delete;

    const std::filesystem::path& path() const { return path_; }
    DensityField field(const std::string& grid = "density") const { return load_density_field({path_, grid}); }

    // What later libraries write of the format, with what these knew already.
    void set_version(std::uint32_t version) const {
        std::fstream file(path_, std::ios::binary | std::ios::in | std::ios::out);
        file.seekp(8).write(reinterpret_cast<const char*>(&version), sizeof version);
    }

    // In the place of some text in the file, another of the same length.
    void replace(const std::string& text, const std::string& by) const {
        std::ifstream in(path_, std::ios::binary);
        std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
        REQUIRE(bytes.find(text) != std::string::npos);
        bytes.replace(bytes.find(text), text.size(), by);
        std::ofstream(path_, std::ios::binary) << bytes;
    }

private:
    std::filesystem::path path_;
};

openvdb::FloatGrid::Ptr grid_named(const char* name, float background = 0.0f) {
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(background);
    grid->setName(name);
    return grid;
}

openvdb::FloatGrid::Ptr ramp(const char* name, float background = 0.0f) {
    const auto grid = grid_named(name, background);
    for (int i = 0; i < 20; ++i)
        grid->tree().setValue({i, 1, 2}, 1.0f + float(i));
    return grid;
}

} // namespace

TEST_CASE("grids that follow one another without offsets are read", "[cpu][density]") {
    const auto density = grid_named("density"), heat = grid_named("temperature", 2.0f);
    for (int i = 0; i < 300; ++i) {
        density->tree().setValue({i % 7, i % 11, i}, 0.01f * float(i + 1));
        heat->tree().setValue({i, 0, 0}, 900.0f);
    }
    heat->setSaveFloatAsHalf(true);
    const WrittenVdb file({density, heat});
    const auto write = [&](const openvdb::GridCPtrVec& grids) {
        std::ofstream out(file.path(), std::ios::binary);
        openvdb::io::Stream(out).write(grids);
    };
    const DensityField whole = file.field(), whole_heat = file.field("temperature");
    write({density, heat});
    CHECK(std::ranges::equal(file.field().bytes.span(), whole.bytes.span()));
    CHECK(std::ranges::equal(file.field("temperature").bytes.span(), whole_heat.bytes.span()));
    CHECK(read_vdb_entries(file.path()).size() == 2);
    const auto number = openvdb::Int32Grid::create();
    number->setName("id");
    write({density, number}); // which nothing here knows the end of
    CHECK_THROWS_WITH(file.field(), Contains("\"id\" is none of floats") && Contains("save it again as a file"));
}

TEST_CASE("an empty grid in a .vdb file is read, and its neighbours are", "[cpu][density]") {
    const WrittenVdb file({grid_named("shadow"), ramp("density")});
    CHECK(file.field("shadow").active_voxels == 0);
    CHECK(file.field().active_voxels == 20);
    CHECK(file.field().value({7, 1, 2}) == 8.0f);
    const Run info = run(fmt::format("'{}' info '{}'", VKVOL_BINARY, file.path().string()));
    CHECK(info.code == exit_done);
    CHECK_THAT(info.text, Contains("the grid is empty") && Contains("1..20, mean 10.5"));
}

TEST_CASE("a grid of tiles alone, without leaves, is read", "[cpu][density]") {
    const auto tiles = grid_named("density");
    tiles->tree().addTile(1, {8, 16, 24}, 0.5f, true);
    const WrittenVdb file({tiles});
    CHECK(file.field().active_voxels == 512);
    CHECK(file.field().value({8, 16, 24}) == 0.5f);
    CHECK(file.field().value({15, 23, 31}) == 0.5f);
    CHECK(file.field().value({16, 23, 31}) == 0.0f);
}

TEST_CASE("grids of colours are read where colours are wanted, with every compression", "[cpu][density]") {
    const auto colors = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.25f, 0.5f, 0.75f));
    colors->setName("Cd");
    for (int i = 0; i < 20; ++i)
        colors->tree().setValue({i, 1, 2}, openvdb::Vec3s(1.0f + float(i), 2.0f, i == 3 ? -1.0f : 0.125f * float(i)));
    colors->tree().addTile(1, {32, 0, 0}, openvdb::Vec3s(4.0f, 5.0f, 6.0f), true);
    colors->tree().addTile(2, {128, 0, 0}, openvdb::Vec3s(7.0f, 8.0f, 9.0f), true);
    for (const bool half : {false, true})
        for (const std::uint32_t compression : {0u, 2u, 3u, 6u}) {
            colors->setSaveFloatAsHalf(half);
            const WrittenVdb file({ramp("density"), colors}, ".vdb", compression);
            const DensityField field = load_density_field({file.path(), "Cd"}, GridValues::numbers_or_colors);
            CHECK(field.type == GRID_COLOR);
            CHECK(field.color({7, 1, 2}) == glm::vec3(8.0f, 2.0f, 0.875f));
            CHECK(field.value({7, 1, 2}) == 8.0f);
            CHECK(field.color({3, 1, 2}) == glm::vec3(4.0f, 2.0f, 0.0f)); // cleaned
            CHECK(field.cleaned == 1);
            CHECK(field.color({33, 4, 5}) == glm::vec3(4.0f, 5.0f, 6.0f));
            CHECK(field.color({200, 4, 5}) == glm::vec3(7.0f, 8.0f, 9.0f));
            CHECK(field.color({7, 3, 3}) == glm::vec3(0.25f, 0.5f, 0.75f)); // the background, in the box
            CHECK(field.color({-1, 1, 2}) == glm::vec3(0.0f));
            CHECK(field.max_value() == 20.0f);
            CHECK(file.field().color({7, 1, 2}) == glm::vec3(8.0f));
            CHECK_THROWS_WITH(file.field("Cd"), Contains("not a grid of floats"));
        }
}

TEST_CASE("a grid that shares another's tree is read with its own transform", "[cpu][density]") {
    const auto original = ramp("density");
    const auto instance = openvdb::FloatGrid::create(*original);
    instance->setTree(original->treePtr());
    instance->setName("twin");
    instance->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    const WrittenVdb file({original, instance});
    CHECK(file.field().value({7, 1, 2}) == 8.0f);
    CHECK(file.field("twin").value({7, 1, 2}) == 8.0f);
    CHECK(file.field("twin").voxel_size() == Approx(0.25));
    CHECK(std::filesystem::file_size(file.path()) < std::filesystem::file_size(WrittenVdb({original}).path()) + 1000);
}

TEST_CASE("of several grids of one name the first has it, and all can be named", "[cpu][density]") {
    const auto second = ramp("density");
    second->tree().setValue({7, 1, 2}, 100.0f);
    const WrittenVdb file({ramp("density"), second});
    const std::vector<VdbEntry> entries = read_vdb_entries(file.path());
    REQUIRE(entries.size() == 2);
    CHECK(entries[0].name == "density");
    CHECK(entries[1].name == "density[1]");
    CHECK(file.field().value({7, 1, 2}) == 8.0f);
    CHECK(file.field("density[1]").value({7, 1, 2}) == 100.0f);
}

TEST_CASE("a grid without a name is read by its number", "[cpu][density]") {
    const WrittenVdb file({ramp("")});
    const std::vector<VdbEntry> entries = read_vdb_entries(file.path());
    REQUIRE(entries.size() == 1);
    CHECK(entries[0].name == "[0]");
    CHECK(file.field("[0]").value({7, 1, 2}) == 8.0f);
}

TEST_CASE("a grid of a type that nobody knows costs itself alone", "[cpu][density]") {
    const auto vectors = openvdb::Vec3SGrid::create();
    vectors->setName("velocity");
    const WrittenVdb file({vectors, ramp("density")});
    file.replace("Tree_vec3s_5_4_3", "Tree_quark_7_7_7");
    CHECK(file.field().value({7, 1, 2}) == 8.0f);
    CHECK_THROWS_WITH(file.field("velocity"), Contains("is not a grid of floats"));
    const Run info = run(fmt::format("'{}' info '{}'", VKVOL_BINARY, file.path().string()));
    CHECK(info.code == exit_done);
    CHECK_THAT(info.text, Contains("velocity: Tree_quark_7_7_7") && Contains("not usable as density") &&
                              Contains("1..20, mean 10.5"));
}

TEST_CASE("a damaged grid costs itself alone", "[cpu][density]") {
    const WrittenVdb file({ramp("density"), ramp("heat")});
    file.replace("ScaleMap", "SkaleMap"); // of the first
    CHECK_THROWS_WITH(file.field(), Contains("transform of unknown kind"));
    CHECK(file.field("heat").value({7, 1, 2}) == 8.0f);
}

TEST_CASE("a background other than 0 counts in the box of active voxels, and is named", "[cpu][density]") {
    const auto grid = grid_named("density", 0.25f);
    grid->tree().setValue({0, 0, 0}, 1.0f);
    grid->tree().setValue({40, 40, 40}, 1.0f);
    const WrittenVdb file({grid, ramp("heat")});
    const DensityField field = file.field();
    CHECK(field.background == 0.25f);
    CHECK(field.value({0, 0, 1}) == 0.25f);
    CHECK(field.value({20, 20, 20}) == 0.25f);
    CHECK(field.value({41, 40, 40}) == 0.0f);
    CHECK(file.field("heat").background == 0.0f);
    const Run info = run(fmt::format("'{}' info '{}'", VKVOL_BINARY, file.path().string()));
    CHECK_THAT(info.text, Contains("background     0.25"));

    Scene scene;
    scene.volumes.emplace_back();
    scene.volumes.front().shape = GridFile{file.path(), "density"};
    const Assets assets = load_assets(scene, choose_method(scene));
    const LoadedMedium& loaded = assets.media.front();
    REQUIRE(loaded.warnings.size() == 1);
    CHECK_THAT(loaded.warnings.front(), Contains("background of 0.25"));
}

TEST_CASE("endings in upper case are those in lower case", "[cpu][density]") {
    const WrittenVdb file({ramp("density")}, ".VDB");
    CHECK(file.field().value({7, 1, 2}) == 8.0f);
    const std::filesystem::path nvdb = std::filesystem::temp_directory_path() / fmt::format("vkvol_{}.NVDB", getpid());
    std::filesystem::copy_file(std::filesystem::path(VKVOL_TEST_FIELDS) / "ramp.nvdb", nvdb,
                               std::filesystem::copy_options::overwrite_existing);
    CHECK(load_density_field({nvdb, "density"}).active_voxels > 0);
    std::filesystem::remove(nvdb);
}

// The library itself would read it, and print a warning each time.
TEST_CASE("files of later versions are read in silence", "[cpu][density]") {
    const openvdb::FloatGrid::Ptr grid = grid_named("density");
    grid->tree().setValue(openvdb::Coord(3, 4, 5), 2.0f);
    const WrittenVdb file({grid});
    file.set_version(225);
    std::ostringstream said;
    std::streambuf* const out = std::cout.rdbuf(said.rdbuf());
    std::streambuf* const err = std::cerr.rdbuf(said.rdbuf());
    const float value = file.field().value({3, 4, 5});
    std::cout.rdbuf(out);
    std::cerr.rdbuf(err);
    CHECK(value == 2.0f);
    CHECK(said.str().empty());
}
