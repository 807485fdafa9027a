#include "field_file.h"

#include <fstream>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Count.h>
#include <unistd.h>

#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include "error.h"
#include "file_ending.h"

namespace vkvol {
namespace {

namespace fs = std::filesystem;

openvdb::Coord to_coord(glm::ivec3 index) {
    return {index.x, index.y, index.z};
}

// OpenVDB multiplies row vectors from the left: its rows are our columns.
openvdb::math::Transform::Ptr transform_of(const Field& field) {
    auto transform = openvdb::math::Transform::createLinearTransform(field.voxel_size);
    if (field.axes != glm::dmat3(1.0)) {
        openvdb::Mat4d matrix = openvdb::Mat4d::identity();
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < 3; ++i)
                matrix(axis, i) = field.voxel_size * field.axes[axis][i];
        transform = openvdb::math::Transform::createLinearTransform(matrix);
    }
    transform->postTranslate({field.origin.x, field.origin.y, field.origin.z});
    return transform;
}

openvdb::FloatGrid::Ptr to_openvdb(const FieldGrid& grid, const Field& field) {
    auto result = openvdb::FloatGrid::create(0.0f);
    result->setName(grid.name);
    result->setGridClass(openvdb::GRID_FOG_VOLUME);
    result->setTransform(transform_of(field));
    for (const Brick& brick : grid.bricks) {
        openvdb::FloatTree::LeafNodeType* leaf = result->tree().touchLeaf(to_coord(brick.origin));
        for (openvdb::Index n = 0; n < brick.value.size(); ++n)
            if (brick.value[n] != 0.0f)
                leaf->setValueOn(n, brick.value[n]);
    }
    for (const Tile& tile : grid.tiles)
        result->tree().addTile(tile.width == brick_width ? 1 : 2, to_coord(tile.origin), tile.value, true);
    result->tree().prune(); // leaves of one value become tiles
    return result;
}

GridSummary summary_of(const openvdb::FloatGrid& grid) {
    GridSummary summary{grid.getName(), {}, grid.activeVoxelCount(), 0.0f, 0.0f};
    if (summary.active == 0)
        return summary;
    const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    summary.box = {{box.min().x(), box.min().y(), box.min().z()}, {box.max().x(), box.max().y(), box.max().z()}};
    const auto extrema = openvdb::tools::minMax(grid.tree());
    summary.lowest = extrema.min();
    summary.highest = extrema.max();
    return summary;
}

template <class NanoType> nanovdb::GridHandle<> to_nanovdb(const openvdb::FloatGrid& grid) {
    return nanovdb::openToNanoVDB<nanovdb::HostBuffer, openvdb::FloatTree, NanoType>(grid, nanovdb::StatsMode::All,
                                                                                     nanovdb::ChecksumMode::Full);
}

nanovdb::GridHandle<> to_nanovdb(const openvdb::FloatGrid& grid, SampleType type) {
    switch (type) {
    case SampleType::float32:
        return to_nanovdb<float>(grid);
    case SampleType::fp4:
        return to_nanovdb<nanovdb::Fp4>(grid);
    case SampleType::fp8:
        return to_nanovdb<nanovdb::Fp8>(grid);
    case SampleType::fp16:
        return to_nanovdb<nanovdb::Fp16>(grid);
    case SampleType::fpn:
        return to_nanovdb<nanovdb::FpN>(grid);
    case SampleType::half:
        break;
    }
    throw InputError("NanoVDB has no samples of type half: use --type fp16, or an output that ends in .vdb");
}

void write_nanovdb(const openvdb::GridPtrVec& grids, const fs::path& path, Codec codec, SampleType type) {
    const nanovdb::io::Codec codecs[] = {nanovdb::io::Codec::NONE, nanovdb::io::Codec::ZIP, nanovdb::io::Codec::BLOSC};
    std::ofstream file;
    file.exceptions(std::ios::badbit | std::ios::failbit);
    file.open(path, std::ios::binary);
    for (const auto& grid : grids) {
        const auto handle = to_nanovdb(*openvdb::gridPtrCast<openvdb::FloatGrid>(grid), type);
        nanovdb::io::writeGrid(file, handle, codecs[int(codec)]);
    }
    file.close();
}

// OpenVDB marks each file it writes with a random UUID, 36 characters at a fixed place of the header. A constant there
// lets the same field give the same bytes.
void fix_uuid(const fs::path& path) {
    constexpr int after_magic_and_versions = 8 + 4 + 4 + 4 + 1;
    std::fstream file;
    file.exceptions(std::ios::badbit | std::ios::failbit);
    file.open(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(after_magic_and_versions);
    file << "00000000-0000-4000-8000-000000000000";
    file.close();
}

void write_openvdb(const openvdb::GridPtrVec& grids, const fs::path& path, Codec codec, SampleType type) {
    if (type != SampleType::float32 && type != SampleType::half)
        throw InputError("OpenVDB has no samples of type fp4, fp8, fp16 or fpn: use --type half, or an output that "
                         "ends in .nvdb");
    const std::uint32_t codecs[] = {openvdb::io::COMPRESS_NONE, openvdb::io::COMPRESS_ZIP, openvdb::io::COMPRESS_BLOSC};
    for (const auto& grid : grids)
        grid->setSaveFloatAsHalf(type == SampleType::half);
    openvdb::io::File file(path.string());
    file.setCompression(codecs[int(codec)] | openvdb::io::COMPRESS_ACTIVE_MASK);
    file.write(grids);
    file.close();
    fix_uuid(path);
}

} // namespace

FileSummary write_field(const Field& field, const fs::path& path, Codec codec, SampleType type) {
    const bool is_vdb = file_ending(path) == ".vdb";
    if (!is_vdb && file_ending(path) != ".nvdb")
        throw InputError(path.string() + ": the output must end in .nvdb or .vdb");
    openvdb::initialize();
    openvdb::GridPtrVec grids;
    FileSummary summary;
    for (const FieldGrid& grid : field.grids) {
        const auto openvdb_grid = to_openvdb(grid, field);
        summary.grids.push_back(summary_of(*openvdb_grid));
        grids.push_back(openvdb_grid);
    }
    fs::path temporary = path;
    temporary += ".tmp" + std::to_string(getpid());
    try {
        (is_vdb ? write_openvdb : write_nanovdb)(grids, temporary, codec, type);
        summary.bytes = fs::file_size(temporary);
        fs::rename(temporary, path);
    } catch (const InputError&) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw;
    } catch (const std::exception&) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw InputError(path.string() + ": cannot be written; does the folder exist, with room and permission?");
    }
    return summary;
}

} // namespace vkvol
