#include "density_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <nanovdb/NanoVDB.h>
#include <optional>

#include "error.h"
#include "file_ending.h"
#include "grid_tree.h"
#include "input_file.h"
#include "memory_grids.h"
#include "missing_field.h"
#include "nearest_name.h"
#include "one_line.h"
#include "shared/constants.h"
#include "vdb_import.h"

namespace vkvol {

namespace {

std::optional<int> lookup_type(nanovdb::GridType type, GridValues values) {
    if (values == GridValues::vectors)
        return type == nanovdb::GridType::Vec3f ? std::optional(GRID_COLOR) : std::nullopt;
    switch (type) {
    case nanovdb::GridType::Vec3f:
        return values == GridValues::numbers ? std::nullopt : std::optional(GRID_COLOR);
    case nanovdb::GridType::Float:
    case nanovdb::GridType::Half: // NanoVDB 32.x keeps the values of half grids as floats
        return GRID_FLOAT;
    case nanovdb::GridType::Fp4:
        return GRID_FP4;
    case nanovdb::GridType::Fp8:
        return GRID_FP8;
    case nanovdb::GridType::Fp16:
        return GRID_FP16;
    case nanovdb::GridType::FpN:
        return GRID_FPN;
    default:
        return std::nullopt;
    }
}

std::string list_names(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names)
        text += (text.empty() ? "\"" : ", \"") + name + "\"";
    return text.empty() ? "no grid" : text;
}

[[noreturn]] void no_such_grid(const GridFile& file, const std::vector<std::string>& names) {
    const std::string nearest = nearest_name(file.grid, names);
    throw InputError(one_line(fmt::format("{}: has no grid \"{}\"{}; it holds {}", file.path.string(), file.grid,
                                          nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest),
                                          list_names(names))));
}

std::string place_of(const GridFile& file) {
    return one_line(fmt::format("{}: \"{}\"", file.path.string(), file.grid));
}

GridBytes read_grid(const GridFile& file, GridValues values) {
    const std::vector<std::string> names = grid_names(file);
    if (std::find(names.begin(), names.end(), file.grid) == names.end())
        no_such_grid(file, names);
    if (file.memory)
        return *file.memory->find(file.grid);
    if (file_ending(file.path) == ".vdb")
        return read_vdb_grid(file.path, file.grid, values);
    const std::vector<GridEntry> entries = read_nvdb_entries(file.path);
    const GridEntry& entry =
        *std::find_if(entries.begin(), entries.end(), [&](const GridEntry& each) { return each.name == file.grid; });
    check_grid_size(entry.memory, place_of(file));
    return read_nvdb_grid(file.path, entry);
}

} // namespace

namespace {
std::uint32_t block_entry(const DensityField& field, glm::ivec3 ijk) {
    const glm::ivec3 block = (ijk >> 3) - field.leaf_min;
    return field.leaf_table[(std::size_t(block.x) * field.leaf_dims.y + block.y) * field.leaf_dims.z + block.z];
}

unsigned place_in_leaf(glm::ivec3 ijk) {
    const glm::ivec3 low = ijk & 7;
    return static_cast<unsigned>(low.x << 6 | low.y << 3 | low.z);
}

float largest_channel(glm::vec3 color) {
    return std::max({color.x, color.y, color.z});
}
} // namespace

float DensityField::value(glm::ivec3 ijk) const {
    if (type == GRID_COLOR)
        return largest_channel(color(ijk));
    if (active_voxels == 0 || ijk != glm::clamp(ijk, voxel_min, voxel_max))
        return 0.0f;
    const std::uint32_t entry = block_entry(*this, ijk);
    const std::byte* at = bytes.data() + std::size_t{entry >> 1} * 4;
    if (!(entry & 1u))
        return read_float(at);
    return leaf_value(type, at, place_in_leaf(ijk));
}

glm::vec3 DensityField::color(glm::ivec3 ijk) const {
    if (type != GRID_COLOR)
        return glm::vec3(value(ijk));
    if (active_voxels == 0 || ijk != glm::clamp(ijk, voxel_min, voxel_max))
        return glm::vec3(0.0f);
    const std::uint32_t entry = block_entry(*this, ijk);
    const std::byte* at = bytes.data() + std::size_t{entry >> 1} * 4;
    return entry & 1u ? leaf_color(at, place_in_leaf(ijk)) : read_color(at);
}

DensityField::Block DensityField::block(glm::ivec3 block) const {
    const glm::ivec3 first = (leaf_min + block) * 8;
    Block result{glm::max(first, voxel_min), glm::min(first + 7, voxel_max), std::nullopt};
    if (const std::uint32_t entry = block_entry(*this, first); !(entry & 1u))
        result.constant = value(result.low);
    return result;
}

std::array<float, 8> DensityField::row(glm::ivec3 first) const {
    std::array<float, 8> values{};
    const std::uint32_t entry = block_entry(*this, first);
    const std::byte* at = bytes.data() + std::size_t{entry >> 1} * 4;
    const unsigned place = place_in_leaf(first);
    const int count = std::min(8 - (first.z & 7), voxel_max.z - first.z + 1);
    for (unsigned i = 0; i < static_cast<unsigned>(count); ++i)
        values[i] = type == GRID_COLOR ? largest_channel(entry & 1u ? leaf_color(at, place + i) : read_color(at))
                    : entry & 1u       ? leaf_value(type, at, place + i)
                                       : read_float(at);
    return values;
}

float DensityField::max_value() const {
    float largest = 0.0f;
    glm::ivec3 b;
    for (b.x = 0; b.x < leaf_dims.x; ++b.x)
        for (b.y = 0; b.y < leaf_dims.y; ++b.y)
            for (b.z = 0; b.z < leaf_dims.z; ++b.z) {
                const Block part = block(b);
                largest = std::max(largest, part.constant.value_or(0.0f));
                if (part.constant)
                    continue;
                for (int x = part.low.x; x <= part.high.x; ++x)
                    for (int y = part.low.y; y <= part.high.y; ++y)
                        for (const float each : row({x, y, part.low.z}))
                            largest = std::max(largest, each);
            }
    return largest;
}

double DensityField::voxel_size() const {
    return std::cbrt(std::abs(glm::determinant(glm::dmat3(index_to_world))));
}

DensityField make_density_field(GridBytes bytes, const std::string& place, GridValues values) {
    DensityField field;
    field.bytes = std::move(bytes);
    if (field.bytes.size() < sizeof(nanovdb::GridData) + sizeof(nanovdb::TreeData<3>))
        throw InputError(fmt::format("{}: too short for a grid: the file is damaged; copy or convert it again", place));
    nanovdb::GridData header;
    std::memcpy(static_cast<void*>(&header), field.bytes.data(), sizeof header);
    const std::optional<int> type = lookup_type(header.mGridType, values);
    if (!type && values == GridValues::vectors)
        throw InputError(fmt::format("{}: the grid's type is {}, but velocities are vectors (Vec3f); name another grid "
                                     "(vkvol info lists them)",
                                     place, grid_type_name(static_cast<std::uint32_t>(header.mGridType))));
    if (!type && header.mGridType == nanovdb::GridType::Vec3f)
        throw InputError(
            fmt::format("{}: the grid's values are colours (Vec3f), and not numbers; <albedo> and <emission "
                        "model=\"color\"> take such grids",
                        place));
    if (!type)
        throw InputError(fmt::format("{}: the grid's type is {}, but Float, Half, Fp4, Fp8, Fp16 and FpN are read{}; "
                                     "convert it to one of these",
                                     place, grid_type_name(static_cast<std::uint32_t>(header.mGridType)),
                                     values == GridValues::numbers ? "" : ", and Vec3f for colours"));
    if (header.mGridClass == nanovdb::GridClass::LevelSet)
        throw InputError(fmt::format("{}: the grid is a level set, distances to a surface, not a density; convert it "
                                     "to a fog volume (vdb_tool -fog, or sdfToFogVolume in OpenVDB)",
                                     place));
    field.type = *type;
    field.is_signed = values == GridValues::vectors;
    field.is_staggered = field.is_signed && header.mGridClass == nanovdb::GridClass::Staggered;
    read_tree(field, place);
    return field;
}

std::vector<std::string> grid_names(const std::filesystem::path& file) {
    check_input_file(file, missing_field_hint(file));
    std::vector<std::string> names;
    if (file_ending(file) == ".vdb")
        for (const VdbEntry& entry : read_vdb_entries(file))
            names.push_back(entry.name);
    else
        for (const GridEntry& entry : read_nvdb_entries(file))
            names.push_back(entry.name);
    return names;
}

std::vector<std::string> grid_names(const GridFile& file) {
    if (!file.memory)
        return grid_names(file.path);
    std::vector<std::string> names;
    for (const MemoryGrids::Grid& grid : file.memory->grids)
        names.push_back(grid.name);
    return names;
}

bool has_grid(const GridFile& file) {
    const std::vector<std::string> names = grid_names(file);
    return std::find(names.begin(), names.end(), file.grid) != names.end();
}

bool is_empty_grid(const GridFile& file) {
    return load_density_field(file).active_voxels == 0;
}

DensityField load_density_field(const GridFile& file, GridValues values) {
    return make_density_field(read_grid(file, values), place_of(file), values);
}

} // namespace vkvol
