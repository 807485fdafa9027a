#include "info.h"

#include <algorithm>
#include <fmt/format.h>

#include "density_field.h"
#include "error.h"
#include "shared/bindings.h"
#include "vdb_import.h"

namespace vkvol {

namespace {

// Values of active voxels are told from background by being above 0, which is all a density can say.
struct Statistics {
    double low = 0.0, high = 0.0, sum = 0.0;
    std::uint64_t positive = 0;
    // Sums of values along the lines of voxels parallel to each axis: largest, and mean over lines that are not empty.
    glm::dvec3 largest_column{0.0}, mean_column{0.0};
};

void add_columns(Statistics& s, const std::array<std::vector<double>, 3>& columns) {
    for (int axis = 0; axis < 3; ++axis) {
        std::size_t filled = 0;
        for (const double column : columns[axis]) {
            s.largest_column[axis] = std::max(s.largest_column[axis], column);
            filled += column > 0.0;
        }
        s.mean_column[axis] = filled > 0 ? s.sum / static_cast<double>(filled) : 0.0;
    }
}

Statistics gather(const DensityField& field) {
    Statistics s;
    const glm::ivec3 n = field.voxel_max - field.voxel_min + 1;
    std::array<std::vector<double>, 3> columns = {std::vector<double>(std::size_t(n.y) * n.z),
                                                  std::vector<double>(std::size_t(n.x) * n.z),
                                                  std::vector<double>(std::size_t(n.x) * n.y)};
    for (int x = 0; x < n.x; ++x)
        for (int y = 0; y < n.y; ++y)
            for (int z = 0; z < n.z; ++z) {
                const double value = field.value(field.voxel_min + glm::ivec3(x, y, z));
                if (value <= 0.0)
                    continue;
                s.low = s.positive == 0 ? value : std::min(s.low, value);
                s.high = std::max(s.high, value);
                s.sum += value;
                ++s.positive;
                columns[0][std::size_t(y) * n.z + z] += value;
                columns[1][std::size_t(x) * n.z + z] += value;
                columns[2][std::size_t(x) * n.y + y] += value;
            }
    add_columns(s, columns);
    return s;
}

// The world-space box of the index-space cells [min, max + 1].
std::pair<glm::dvec3, glm::dvec3> world_box(const DensityField& field) {
    glm::dvec3 low(1e300), high(-1e300);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 pick(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 index =
            glm::mix(glm::dvec3(field.voxel_min), glm::dvec3(field.voxel_max + 1), glm::dvec3(pick));
        const glm::dvec3 world(field.index_to_world * glm::dvec4(index, 1.0));
        low = glm::min(low, world);
        high = glm::max(high, world);
    }
    return {low, high};
}

void print_field(const DensityField& field) {
    fmt::print("  active voxels  {}\n", field.active_voxels);
    if (field.active_voxels == 0) {
        fmt::print("  the grid is empty: it renders as if it were not there\n");
        return;
    }
    const glm::ivec3 low = field.voxel_min, high = field.voxel_max, size = high - low + 1;
    const auto [world_low, world_high] = world_box(field);
    const glm::dmat3 linear(field.index_to_world);
    const glm::dvec3 edges(glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2]));
    fmt::print("  index box      [{},{},{}]..[{},{},{}] ({} x {} x {})\n", low.x, low.y, low.z, high.x, high.y, high.z,
               size.x, size.y, size.z);
    fmt::print("  voxel size     {:.6g} x {:.6g} x {:.6g}\n", edges.x, edges.y, edges.z);
    fmt::print("  world box      [{:.6g},{:.6g},{:.6g}]..[{:.6g},{:.6g},{:.6g}]\n", world_low.x, world_low.y,
               world_low.z, world_high.x, world_high.y, world_high.z);
    const Statistics s = gather(field);
    fmt::print("  values > 0     {:.6g}..{:.6g}, mean {:.6g}, in {} voxels\n", s.low, s.high,
               s.positive > 0 ? s.sum / static_cast<double>(s.positive) : 0.0, s.positive);
    if (field.cleaned > 0)
        fmt::print("  unusable       {} values were NaN, infinite or negative and count as 0\n", field.cleaned);
    const glm::dvec3 most = s.largest_column * edges, mean = s.mean_column * edges;
    fmt::print("  optical depth  along x, y, z per unit of sigma_t (unit=\"world\"): at most {:.4g}, {:.4g}, {:.4g}; "
               "mean {:.4g}, {:.4g}, {:.4g}\n",
               most.x, most.y, most.z, mean.x, mean.y, mean.z);
    fmt::print("                 the same for unit=\"voxel\": at most {:.4g}, {:.4g}, {:.4g}\n",
               most.x / field.voxel_size(), most.y / field.voxel_size(), most.z / field.voxel_size());
    const double tables = static_cast<double>(field.leaf_table.size()) * sizeof(std::uint32_t);
    fmt::print("  memory         {:.2f} MiB, and {:.2f} MiB for the table of leaves\n",
               static_cast<double>(field.bytes.size()) / 1048576.0, tables / 1048576.0);
}

// A grid that cannot serve as density (vectors, integers, a level set) is listed, with the reason, not an error.
void print_grid(const GridFile& file) {
    try {
        print_field(load_density_field(file));
    } catch (const InputError& e) {
        fmt::print("  not usable as density: {}\n", e.what());
    }
}

} // namespace

int run_info(const std::filesystem::path& file) {
    if (file.extension() == ".vdb") {
        for (const VdbEntry& entry : read_vdb_entries(file)) {
            fmt::print("{}: {} (OpenVDB)\n", entry.name, entry.type);
            print_grid({file, entry.name});
        }
        return exit_done;
    }
    for (const GridEntry& entry : read_nvdb_entries(file)) {
        fmt::print("{}: {}, {} (NanoVDB {}, codec {}, {:.2f} MiB on disk)\n", entry.name, grid_type_name(entry.type),
                   grid_class_name(entry.grid_class), entry.version, codec_name(entry.codec),
                   static_cast<double>(entry.file_bytes) / 1048576.0);
        print_grid({file, entry.name});
    }
    return exit_done;
}

} // namespace vkvol
