#include "vdb_import.h"

#include <cstring>
#include <fmt/format.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>

#include "error.h"
#include "one_line.h"
#include "vdb_check.h"

namespace vkvol {

namespace {

// Runs `use` on the opened file; OpenVDB's exceptions become InputErrors.
template <class Use> auto with_file(const std::filesystem::path& path, const char* grid, Use&& use) {
    check_vdb(path, grid);
    try {
        openvdb::initialize();
        openvdb::io::File file(path.string());
        file.open(false); // all at once: no delayed loading from a file that may change
        return use(file);
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& e) {
        throw InputError(
            one_line(fmt::format("{}: not readable as OpenVDB: {}; copy or export it again", path.string(), e.what())));
    }
}

} // namespace

std::vector<VdbEntry> read_vdb_entries(const std::filesystem::path& path) {
    return with_file(path, nullptr, [](openvdb::io::File& file) {
        std::vector<VdbEntry> entries;
        for (auto name = file.beginName(); name != file.endName(); ++name)
            entries.push_back({*name, file.readGridMetadata(*name)->type()});
        return entries;
    });
}

GridBytes read_vdb_grid(const std::filesystem::path& path, const std::string& name) {
    return with_file(path, name.c_str(), [&](openvdb::io::File& file) {
        const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(name));
        if (!grid)
            throw InputError(fmt::format("{}: grid \"{}\" is not a grid of floats; only float and half are read",
                                         path.string(), one_line(name)));
        const auto handle = nanovdb::openToNanoVDB(*grid);
        GridBytes bytes(handle.size());
        std::memcpy(bytes.data(), handle.data(), handle.size());
        return bytes;
    });
}

} // namespace vkvol
