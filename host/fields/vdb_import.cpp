#include "vdb_import.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <mutex>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>
#include <utility>
#include <vector>

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

// The version of the format that files have which are newer than the library is told it as its own: see check_vdb. It
// would read them, and print a warning for each.
class KnownVersion : public std::filebuf {
protected:
    int_type underflow() override {
        const int_type first = std::filebuf::underflow();
        if (!std::exchange(begun_, true) && egptr() - eback() >= 12) {
            std::uint32_t version = 0; // behind 8 bytes that all files begin with
            std::memcpy(&version, eback() + 8, sizeof version);
            version = std::min(version, static_cast<std::uint32_t>(openvdb::OPENVDB_FILE_VERSION));
            std::memcpy(eback() + 8, &version, sizeof version);
        }
        return first;
    }

private:
    bool begun_ = false;
};

// As openvdb::io::File reads a grid, at once: a file may change.
class OneGrid : openvdb::io::Archive {
public:
    // The file's grid of this number, and the tree of another that it may share.
    openvdb::GridBase::Ptr read(const std::filesystem::path& path, std::size_t number) {
        KnownVersion bytes;
        if (!bytes.open(path, std::ios_base::in | std::ios_base::binary))
            throw openvdb::IoError("it cannot be opened");
        std::istream file(&bytes);
        readHeader(file);
        auto traits = openvdb::SharedPtr<openvdb::io::StreamMetadata>(new openvdb::io::StreamMetadata);
        traits->setSeekable(true);
        openvdb::io::setStreamMetadataPtr(file, traits, false);
        setFormatVersion(file);
        setLibraryVersion(file);
        setDataCompression(file);
        openvdb::MetaMap().readMeta(file);
        std::vector<Place> places;
        for (auto count = readGridCount(file); count > 0; --count) {
            Place& place = places.emplace_back();
            place.grid = place.descriptor.read(file);
            if (inputHasGridOffsets())
                place.descriptor.seekToEnd(file);
            else
                readGrid(place.grid, place.descriptor, file);
        }
        const Place& found = places.at(number);
        fill(found, file);
        if (found.descriptor.isInstance())
            for (const Place& place : places)
                if (place.descriptor.uniqueName() == found.descriptor.instanceParentName()) {
                    fill(place, file);
                    found.grid->setTree(place.grid->baseTreePtr());
                }
        return found.grid;
    }

private:
    struct Place {
        openvdb::io::GridDescriptor descriptor;
        openvdb::GridBase::Ptr grid; // not filled yet, where the file says where it lies
    };

    void fill(const Place& place, std::istream& file) const {
        if (!inputHasGridOffsets())
            return;
        place.descriptor.seekToGrid(file);
        readGrid(place.grid, place.descriptor, file);
    }
};

openvdb::GridBase::Ptr read_grid(const std::filesystem::path& path, const std::string& name, GridValues allowed) {
    const std::vector<VdbEntry> entries = read_vdb_entries(path);
    const auto entry = std::find_if(entries.begin(), entries.end(), [&](const VdbEntry& e) { return e.name == name; });
    if (entry == entries.end())
        throw InputError(one_line(fmt::format("{}: has no grid \"{}\"", path.string(), name)));
    const auto number = static_cast<std::size_t>(entry - entries.begin());
    check_vdb(path, number, allowed);
    static std::mutex types; // of grids that are read ahead: OpenVDB has one table of them
    const std::scoped_lock lock(types);
    try {
        openvdb::initialize();
        const StandIns stand_ins(entries);
        return OneGrid().read(path, number);
    } catch (const std::bad_alloc&) { // nothing is wrong with the file
        throw;
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
    return check_vdb(path, {}, GridValues::numbers);
}

GridBytes read_vdb_grid(const std::filesystem::path& path, const std::string& name, GridValues allowed) {
    const openvdb::GridBase::Ptr grid = read_grid(path, name, allowed);
    try {
        if (const auto numbers = openvdb::gridPtrCast<openvdb::FloatGrid>(grid))
            return to_nanovdb(*numbers);
        if (const auto colors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grid))
            return to_nanovdb(*colors);
    } catch (const std::bad_alloc&) { // nothing is wrong with the file
        throw;
    } catch (const std::exception& e) {
        throw InputError(one_line(fmt::format("{}: grid \"{}\" cannot be converted: {}; copy or export it again",
                                              path.string(), name, e.what())));
    }
    throw InputError(fmt::format("{}: grid \"{}\" is not a grid of floats; only float is read, also saved as half",
                                 path.string(), one_line(name)));
}

} // namespace vkvol
