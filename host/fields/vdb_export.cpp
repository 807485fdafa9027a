#include "vdb_export.h"

#include <algorithm>
#include <fmt/format.h>
#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>
#include <sstream>

#include "error.h"

namespace vkvol {

namespace {

template <class Grid, class Value> openvdb::GridBase::Ptr grid_of(const BoxGrid& box, const Value& value) {
    auto grid = Grid::create();
    auto accessor = grid->getAccessor();
    std::size_t i = 0;
    for (int z = 0; z < box.dims.z; ++z)
        for (int y = 0; y < box.dims.y; ++y)
            for (int x = 0; x < box.dims.x; ++x, ++i)
                if (box.colors[i] != glm::vec3(0.0f))
                    accessor.setValue(openvdb::Coord(x, y, z), value(box.colors[i]));
    if (i > 0) { // as make_grid does: the box of active voxels is the whole
        accessor.setValue(openvdb::Coord(0, 0, 0), value(box.colors.front()));
        accessor.setValue(openvdb::Coord(box.dims.x - 1, box.dims.y - 1, box.dims.z - 1), value(box.colors.back()));
    }
    return grid;
}

openvdb::GridBase::Ptr to_openvdb(const BoxGrid& box) {
    const auto number = [](const glm::vec3& color) { return color.x; };
    const auto color = [](const glm::vec3& c) { return openvdb::Vec3f(c.x, c.y, c.z); };
    const openvdb::GridBase::Ptr grid =
        box.is_grey() ? grid_of<openvdb::FloatGrid>(box, number) : grid_of<openvdb::Vec3SGrid>(box, color);
    auto transform = openvdb::math::Transform::createLinearTransform();
    transform->postScale(openvdb::Vec3d(box.place.voxel_size.x, box.place.voxel_size.y, box.place.voxel_size.z));
    transform->postTranslate(openvdb::Vec3d(box.place.origin.x, box.place.origin.y, box.place.origin.z));
    grid->setTransform(transform);
    if (box.is_grey())
        grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setName(box.name);
    return grid;
}

// As openvdb::io::File writes them, with the places where grids begin, but into memory.
class Archive : openvdb::io::Archive {
public:
    std::string bytes_of(const openvdb::GridPtrVec& grids) const {
        std::ostringstream stream(std::ios_base::binary);
        write(stream, grids, true);
        if (!stream)
            throw RenderError("there is not enough memory to write a .vdb file");
        return stream.str();
    }
};

} // namespace

bool BoxGrid::is_grey() const {
    return std::all_of(colors.begin(), colors.end(),
                       [](const glm::vec3& color) { return color.x == color.y && color.y == color.z; });
}

std::string vdb_file_of(const std::vector<BoxGrid>& grids) {
    openvdb::initialize();
    openvdb::GridPtrVec all;
    for (const BoxGrid& grid : grids)
        all.push_back(to_openvdb(grid));
    try {
        return Archive().bytes_of(all);
    } catch (const openvdb::Exception& error) {
        throw RenderError(fmt::format("a .vdb file cannot be made: {}", error.what()));
    }
}

std::string nvdb_file_of(const std::vector<BoxGrid>& grids) {
    MemoryGrids all;
    for (const BoxGrid& grid : grids) {
        if (!grid.is_grey()) {
            all.grids.push_back({grid.name, make_grid(grid.name, grid.dims, grid.colors, grid.place)});
            continue;
        }
        std::vector<float> values(grid.colors.size());
        std::transform(grid.colors.begin(), grid.colors.end(), values.begin(),
                       [](const glm::vec3& color) { return color.x; });
        all.grids.push_back({grid.name, make_grid(grid.name, grid.dims, values, grid.place)});
    }
    return nvdb_file_of(all);
}

} // namespace vkvol
