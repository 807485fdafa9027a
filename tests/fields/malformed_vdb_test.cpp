// .vdb files whose counts and sizes are not true: OpenVDB would believe them.
#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <unistd.h>
#include <utility>

#include "density_field.h"
#include "error.h"

using namespace vkvol;
using Catch::Contains;

namespace {

// The parts of a small file, each of which a test may make wrong: one grid, whose root has one tile.
struct VdbFile {
    std::uint32_t version = 224, file_metadata = 0, grids = 1, compression = 0, grid_metadata = 0, tiles = 1,
                  children = 0;
    std::uint8_t offsets = 1;
    bool has_tree = true;
    std::string parent, metadata_type = "bool", map = "ScaleTranslateMap";
    std::uint32_t metadata_bytes = 1;
    std::int32_t origin = 4096;
    std::optional<std::int32_t> second; // another tile: where along each axis

    template <class T> static void add(std::string& text, const T& value) {
        text.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    static void add_text(std::string& text, const std::string& value) {
        add(text, static_cast<std::uint32_t>(value.size()));
        text += value;
    }

    std::string grid() const {
        std::string text;
        add(text, compression);
        add(text, grid_metadata);
        if (grid_metadata > 0) {
            add_text(text, "key");
            add_text(text, metadata_type);
            add(text, metadata_bytes);
            text += '\1';
        }
        add_text(text, map);
        const double values[18] = {0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0.5, 0.5, 0.5};
        text.append(reinterpret_cast<const char*>(values), sizeof values);
        if (!has_tree)
            return text;
        add(text, std::uint32_t{1}); // buffers
        add(text, 0.0f);
        add(text, tiles + (second ? 1 : 0));
        add(text, children);
        const glm::ivec3 first = second ? glm::ivec3(origin) : glm::ivec3(origin, 0, 0);
        for (const glm::ivec3 place : {first, glm::ivec3(second.value_or(0))}) {
            add(text, place);
            add(text, 0.5f);
            add(text, std::uint8_t{1});
            if (!second)
                break;
        }
        return text;
    }

    std::string bytes() const {
        std::string text;
        add(text, std::int64_t{0x56444220});
        for (const std::uint32_t number : {version, 10u, 0u})
            add(text, number);
        add(text, offsets);
        text += "01234567-89ab-cdef-0123-456789abcdef";
        add(text, file_metadata);
        add(text, grids);
        add_text(text, "density");
        add_text(text, "Tree_float_5_4_3");
        add_text(text, parent);
        const std::string body = grid();
        const std::uint64_t begin = text.size() + 24;
        for (const std::uint64_t place : {begin, begin + body.size(), begin + body.size()})
            add(text, place);
        return text + body;
    }
};

std::string error_of(const std::string& bytes) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("vkvol_malformed_" + std::to_string(getpid()) + ".vdb");
    std::ofstream(path, std::ios::binary) << bytes;
    std::string message = "no error";
    try {
        load_density_field({path, "density"});
    } catch (const InputError& error) {
        message = error.what();
        CHECK_THAT(message, Contains(path.string()));
    }
    std::filesystem::remove(path);
    return message;
}

std::string error_of(const std::function<void(VdbFile&)>& damage) {
    VdbFile file;
    damage(file);
    return error_of(file.bytes());
}

} // namespace

TEST_CASE("counts, sizes and places in .vdb files are not believed", "[cpu][density]") {
    // What is well-formed is read, and then found to be larger than a table of blocks is made for.
    const auto is_read = Contains("too much for a table of its blocks");
    CHECK_THAT(error_of([](VdbFile&) {}), is_read);
    for (const std::uint32_t count : {1u, 1u << 20, ~0u - 1u}) {
        CAPTURE(count);
        CHECK_THAT(error_of([&](VdbFile& f) { f.file_metadata = count; }),
                   Contains("makes no sense") || Contains("not readable") || Contains("has no grid"));
        CHECK_THAT(error_of([&](VdbFile& f) { f.children = count; }),
                   Contains("makes no sense") || Contains("not readable") || Contains("has no grid"));
        CHECK_THAT(error_of([&](VdbFile& f) { f.tiles = 1 + count; }),
                   Contains("makes no sense") || Contains("not readable") || Contains("has no grid"));
        CHECK_THAT(error_of([&](VdbFile& f) { f.grids = 1 + count; }),
                   Contains("makes no sense") || Contains("not readable") || Contains("has no grid"));
        CHECK_THAT(error_of([&](VdbFile& f) { f.grid_metadata = 1 + count; }),
                   Contains("unknown kind") || Contains("makes no sense") || Contains("not readable") ||
                       Contains("has no grid"));
    }
    CHECK_THAT(error_of([](VdbFile& f) { f.compression = 8; }), Contains("compression"));
    CHECK_THAT(error_of([](VdbFile& f) { f.origin = 5; }), Contains("place of a node"));
    CHECK_THAT(error_of([](VdbFile& f) { f.grid_metadata = 1; }), is_read);
    CHECK_THAT(error_of([](VdbFile& f) {
                   f.grid_metadata = 1;
                   f.metadata_type = "double";
               }),
               Contains("size of metadata"));
    CHECK_THAT(error_of([](VdbFile& f) {
                   f.grid_metadata = 1;
                   f.metadata_type = "text";
                   f.metadata_bytes = ~0u;
               }),
               Contains("makes no sense"));
    CHECK_THAT(error_of([](VdbFile& f) { f.parent = "density"; }),
               Contains("end of a grid")); // it has a tree all the same
    CHECK_THAT(error_of([](VdbFile& f) {
                   f.parent = "density";
                   f.has_tree = false;
               }),
               Contains("none of its own") && Contains("without instances"));
    CHECK_THAT(error_of([](VdbFile& f) {
                   f.parent = "smoke";
                   f.has_tree = false;
               }),
               Contains("\"smoke\", which the file does not have"));
    CHECK_THAT(error_of([](VdbFile& f) { f.version = 219; }), Contains("version 219"));
    CHECK_THAT(error_of([](VdbFile& f) { f.version = 225; }), is_read); // OpenVDB 13
    CHECK_THAT(error_of([](VdbFile& f) { f.version = 226; }), Contains("version 226"));
    CHECK_THAT(error_of([](VdbFile& f) { f.offsets = 0; }), is_read); // one after another
    CHECK_THAT(error_of([](VdbFile& f) { f.offsets = 2; }), Contains("offsets"));
}

TEST_CASE("the size of a table of blocks has no limit of 2^63", "[cpu][density]") {
    for (const auto& [origin, second] : {std::pair{-16777216, 16773120}, {-8998912, 8998912}}) // 2^66 and 1.1e19 blocks
        CHECK_THAT(error_of([&](VdbFile& f) {
                       f.origin = origin;
                       f.second = second;
                   }),
                   Contains("too much for a table of its blocks"));
}

TEST_CASE("a .vdb file cut anywhere is an error", "[cpu][density]") {
    const std::string whole = VdbFile{}.bytes();
    for (std::size_t length = 0; length < whole.size(); ++length) {
        CAPTURE(length);
        CHECK_THAT(error_of(whole.substr(0, length)), !Contains("too much for a table"));
    }
}
