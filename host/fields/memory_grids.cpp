#include "memory_grids.h"

#include <algorithm>
#include <cstring>
#include <nanovdb/util/IO.h>
#include <new>
#include <sstream>
#include <type_traits>

#include "error.h"
#include "finish_grid.h"

namespace vkvol {

namespace {

template <class Value, class ValueAt>
GridBytes build(const std::string& name, glm::ivec3 dims, const GridPlace& place, const ValueAt& value_at) {
    const Value nothing(0.0f);
    constexpr bool is_number = std::is_same_v<Value, float>;
    nanovdb::GridBuilder<Value> builder(nothing,
                                        is_number ? nanovdb::GridClass::FogVolume : nanovdb::GridClass::Unknown);
    auto accessor = builder.getAccessor();
    std::size_t i = 0;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x, ++i)
                if (const Value value = value_at(i); value != nothing)
                    accessor.setValue({x, y, z}, value);
    // The box of active voxels is the array's: a map may make a medium of zeros, and where colours are looked up beyond
    // the outermost voxels these go on.
    const auto mark = [&](glm::ivec3 voxel, std::size_t at) {
        accessor.setValue({voxel.x, voxel.y, voxel.z}, value_at(at));
    };
    if (i > 0) {
        mark({0, 0, 0}, 0);
        mark(dims - 1, i - 1);
    }
    glm::dmat4 to_world(1.0);
    for (int axis = 0; axis < 3; ++axis)
        to_world[axis][axis] = place.voxel_size[axis];
    to_world[3] = glm::dvec4(place.origin, 1.0);
    return finish_grid(builder, to_world, name);
}

} // namespace

const GridBytes* MemoryGrids::find(const std::string& name) const {
    const auto found = std::find_if(grids.begin(), grids.end(), [&](const Grid& grid) { return grid.name == name; });
    return found == grids.end() ? nullptr : &found->bytes;
}

GridBytes make_grid(const std::string& name, glm::ivec3 dims, std::span<const float> values, const GridPlace& place) {
    return build<float>(name, dims, place, [&](std::size_t i) { return values[i]; });
}

GridBytes make_grid(const std::string& name, glm::ivec3 dims, std::span<const glm::vec3> colors,
                    const GridPlace& place) {
    return build<nanovdb::Vec3f>(name, dims, place,
                                 [&](std::size_t i) { return nanovdb::Vec3f(colors[i].x, colors[i].y, colors[i].z); });
}

std::string nvdb_file_of(const MemoryGrids& grids) {
    // The writer begins behind its header, some 200 bytes and a name for each, and streams go no further than they are.
    std::size_t header = 1 << 16;
    for (const MemoryGrids::Grid& grid : grids.grids)
        header += 512 + grid.name.size();
    std::ostringstream file(std::string(header, '\0'));
    std::vector<nanovdb::GridHandle<>> handles;
    for (const MemoryGrids::Grid& grid : grids.grids) {
        auto buffer = nanovdb::HostBuffer::create(grid.bytes.size());
        std::memcpy(buffer.data(), grid.bytes.data(), grid.bytes.size());
        handles.emplace_back(std::move(buffer));
    }
    nanovdb::io::writeGrids(file, handles, nanovdb::io::Codec::ZIP);
    if (!file) // streams keep that to themselves
        throw std::bad_alloc();
    std::string text = file.str();
    text.resize(static_cast<std::size_t>(file.tellp()));
    return text;
}

} // namespace vkvol
