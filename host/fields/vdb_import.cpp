#include "vdb_import.h"

#include <cstring>
#include <fmt/format.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>

#include "error.h"
#include "one_line.h"

namespace vkvol {

namespace {

// OpenVDB's table of the types it knows is open to kinds of grids alone.
struct GridTypes : openvdb::GridBase {
    using openvdb::GridBase::registerGrid;
    using openvdb::GridBase::unregisterGrid;
};

openvdb::GridBase::Ptr make_some_grid() {
    return openvdb::FloatGrid::create();
}

// OpenVDB opens no file that holds a grid of a type it does not know, though that grid is not asked for. Here such
// types are known while a file is open, by a name that makes some grid.
class StandIns {
public:
    explicit StandIns(const std::vector<VdbEntry>& entries) {
        for (const VdbEntry& entry : entries)
            if (!openvdb::GridBase::isRegistered(type_of(entry))) {
                types_.push_back(type_of(entry));
                GridTypes::registerGrid(types_.back(), make_some_grid);
            }
    }
    ~StandIns() {
        for (const std::string& type : types_)
            GridTypes::unregisterGrid(type);
    }
    StandIns(const StandIns&) = delete;
    StandIns& operator=(const StandIns&) = delete;

private:
    static std::string type_of(const VdbEntry& entry) {
        constexpr std::string_view half = "_HalfFloat";
        const bool is_half = entry.type.ends_with(half);
        return entry.type.substr(0, entry.type.size() - (is_half ? half.size() : 0));
    }

    std::vector<std::string> types_;
};

openvdb::FloatGrid::Ptr read_float_grid(const std::filesystem::path& path, const std::string& name) {
    const std::vector<VdbEntry> entries = read_vdb_entries(path);
    std::string full_name = name;
    for (const VdbEntry& entry : entries)
        if (entry.name == name)
            full_name = entry.full_name;
    check_vdb(path, full_name.c_str());
    try {
        openvdb::initialize();
        const StandIns stand_ins(entries);
        openvdb::io::File file(path.string());
        file.open(false); // all at once: no delayed loading from a file that may change
        return openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(full_name));
    } catch (const std::exception& e) {
        throw InputError(
            one_line(fmt::format("{}: not readable as OpenVDB: {}; copy or export it again", path.string(), e.what())));
    }
}

} // namespace

std::vector<VdbEntry> read_vdb_entries(const std::filesystem::path& path) {
    return check_vdb(path, nullptr);
}

GridBytes read_vdb_grid(const std::filesystem::path& path, const std::string& name) {
    const openvdb::FloatGrid::Ptr grid = read_float_grid(path, name);
    if (!grid)
        throw InputError(fmt::format("{}: grid \"{}\" is not a grid of floats; only float and half are read",
                                     path.string(), one_line(name)));
    try {
        if (grid->activeVoxelCount() == 0) // tiles that are not active are background
            grid->tree().clear();
        const auto handle = nanovdb::openToNanoVDB(*grid);
        GridBytes bytes(handle.size());
        std::memcpy(bytes.data(), handle.data(), handle.size());
        return bytes;
    } catch (const std::exception& e) {
        throw InputError(one_line(fmt::format("{}: grid \"{}\" cannot be converted: {}; copy or export it again",
                                              path.string(), name, e.what())));
    }
}

} // namespace vkvol
