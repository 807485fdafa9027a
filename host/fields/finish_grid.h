// From NanoVDB's builder to the bytes of a grid. For who includes that builder, which takes long to read.
#pragma once

#include <cstring>
#include <glm/glm.hpp>
#include <nanovdb/util/GridBuilder.h>
#include <string>

#include "nvdb_file.h"

namespace vkvol {

template <class Value>
GridBytes finish_grid(nanovdb::GridBuilder<Value>& builder, const glm::dmat4& index_to_world, const std::string& name) {
    const glm::dmat3 linear(index_to_world), inverse = glm::inverse(linear);
    double to_world[3][3], to_index[3][3];
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            to_world[row][column] = linear[column][row];
            to_index[row][column] = inverse[column][row];
        }
    const glm::dvec3 origin(index_to_world[3]);
    nanovdb::Map map;
    map.set(to_world, to_index, nanovdb::Vec3d(origin.x, origin.y, origin.z), 1.0);
    const auto handle = builder.getHandle(map, name);
    GridBytes bytes(handle.size());
    std::memcpy(bytes.edit(), handle.data(), handle.size());
    return bytes;
}

} // namespace vkvol
