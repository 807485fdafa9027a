#include "memory_grids.h"

#include <algorithm>
#include <cstring>
#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/IO.h>
#include <sstream>

#include "error.h"

namespace vkvol {

const GridBytes* MemoryGrids::find(const std::string& name) const {
    const auto found = std::find_if(grids.begin(), grids.end(), [&](const Grid& grid) { return grid.name == name; });
    return found == grids.end() ? nullptr : &found->bytes;
}

GridBytes make_grid(const std::string& name, glm::ivec3 dims, const std::vector<float>& values) {
    nanovdb::GridBuilder<float> builder(0.0f, nanovdb::GridClass::FogVolume);
    auto accessor = builder.getAccessor();
    std::size_t i = 0;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x, ++i)
                if (values[i] != 0.0f)
                    accessor.setValue({x, y, z}, values[i]);
    const auto handle = builder.getHandle(1.0, nanovdb::Vec3d(0.0), name);
    GridBytes bytes(handle.size());
    std::memcpy(bytes.edit(), handle.data(), handle.size());
    return bytes;
}

std::string nvdb_file_of(const MemoryGrids& grids) {
    std::ostringstream file(
        std::string(1 << 16, '\0')); // the writer begins behind its header, and streams go no further than they are
    std::vector<nanovdb::GridHandle<>> handles;
    for (const MemoryGrids::Grid& grid : grids.grids) {
        auto buffer = nanovdb::HostBuffer::create(grid.bytes.size());
        std::memcpy(buffer.data(), grid.bytes.data(), grid.bytes.size());
        handles.emplace_back(std::move(buffer));
    }
    nanovdb::io::writeGrids(file, handles, nanovdb::io::Codec::ZIP);
    std::string text = file.str();
    text.resize(static_cast<std::size_t>(file.tellp()));
    return text;
}

} // namespace vkvol
