#include "vdb_import.h"

#include <cstring>
#include <fmt/format.h>
#include <mutex>
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

openvdb::GridBase::Ptr read_grid(const std::filesystem::path& path, const std::string& name, GridValues allowed) {
    const std::vector<VdbEntry> entries = read_vdb_entries(path);
    std::string full_name = name;
    for (const VdbEntry& entry : entries)
        if (entry.name == name)
            full_name = entry.full_name;
    check_vdb(path, full_name.c_str(), allowed);
    static std::mutex types; // of grids that are read ahead: OpenVDB has one table of them
    const std::scoped_lock lock(types);
    try {
        openvdb::initialize();
        const StandIns stand_ins(entries);
        openvdb::io::File file(path.string());
        file.open(false); // all at once: no delayed loading from a file that may change
        return file.readGrid(full_name);
    } catch (const std::exception& e) {
        throw InputError(
            one_line(fmt::format("{}: not readable as OpenVDB: {}; copy or export it again", path.string(), e.what())));
    }
}

template <class Grid> GridBytes to_nanovdb(Grid& grid) {
    if (grid.activeVoxelCount() == 0) // tiles that are not active are background
        grid.tree().clear();
    const auto handle = nanovdb::openToNanoVDB(grid);
    grid.tree().clear(); // no three copies at a time
    GridBytes bytes(handle.size());
    std::memcpy(bytes.edit(), handle.data(), handle.size());
    return bytes;
}

} // namespace

std::vector<VdbEntry> read_vdb_entries(const std::filesystem::path& path) {
    return check_vdb(path, nullptr, GridValues::numbers);
}

GridBytes read_vdb_grid(const std::filesystem::path& path, const std::string& name, GridValues allowed) {
    const openvdb::GridBase::Ptr grid = read_grid(path, name, allowed);
    try {
        if (const auto numbers = openvdb::gridPtrCast<openvdb::FloatGrid>(grid))
            return to_nanovdb(*numbers);
        if (const auto colors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grid))
            return to_nanovdb(*colors);
    } catch (const std::exception& e) {
        throw InputError(one_line(fmt::format("{}: grid \"{}\" cannot be converted: {}; copy or export it again",
                                              path.string(), name, e.what())));
    }
    throw InputError(fmt::format("{}: grid \"{}\" is not a grid of floats; only float and half are read", path.string(),
                                 one_line(name)));
}

} // namespace vkvol
