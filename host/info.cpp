#include "info.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "density_field.h"
#include "error.h"
#include "input_file.h"
#include "messages.h"
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

    void add(double value, std::uint64_t voxels) {
        low = positive == 0 ? value : std::min(low, value);
        high = std::max(high, value);
        sum += value * static_cast<double>(voxels);
        positive += voxels;
    }
};

// Sums along the 8 x 8 lines through one column of blocks, along `axis`.
struct Lines {
    std::array<double, 64> sums{};
    double everywhere = 0.0; // to be added to each

    void add(const DensityField::Block& part, const DensityField& field, int axis, Statistics* s) {
        if (part.constant)
            return add_constant(part, *part.constant, axis, s);
        for (int x = part.low.x; x <= part.high.x; ++x)
            for (int y = part.low.y; y <= part.high.y; ++y)
                for (int z = part.low.z; z <= part.high.z; ++z)
                    if (const double value = field.value({x, y, z}); value > 0.0) {
                        line({x, y, z}, axis) += value;
                        if (s)
                            s->add(value, 1);
                    }
    }

private:
    double& line(glm::ivec3 voxel, int axis) {
        return sums[std::size_t((voxel[(axis + 1) % 3] & 7) * 8 + (voxel[(axis + 2) % 3] & 7))];
    }

    void add_constant(const DensityField::Block& part, double value, int axis, Statistics* s) {
        if (value <= 0.0)
            return;
        const glm::ivec3 size = part.high - part.low + 1;
        if (s)
            s->add(value, std::uint64_t(size.x) * std::uint64_t(size.y) * std::uint64_t(size.z));
        if (size == glm::ivec3(8)) {
            everywhere += 8.0 * value;
            return;
        }
        glm::ivec3 last = part.high; // one voxel of each line
        last[axis] = part.low[axis];
        for (int x = part.low.x; x <= last.x; ++x)
            for (int y = part.low.y; y <= last.y; ++y)
                for (int z = part.low.z; z <= last.z; ++z)
                    line({x, y, z}, axis) += size[axis] * value;
    }
};

// Column by column of blocks, since a box of stray voxels can have more lines than fit in memory.
void add_columns(const DensityField& field, int axis, Statistics& s) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::uint64_t filled = 0;
    double sum = 0.0;
    glm::ivec3 block;
    for (block[u] = 0; block[u] < field.leaf_dims[u]; ++block[u])
        for (block[v] = 0; block[v] < field.leaf_dims[v]; ++block[v]) {
            Lines lines;
            for (block[axis] = 0; block[axis] < field.leaf_dims[axis]; ++block[axis])
                lines.add(field.block(block), field, axis, axis == 0 ? &s : nullptr);
            for (const double part : lines.sums) {
                const double line = part + lines.everywhere;
                s.largest_column[axis] = std::max(s.largest_column[axis], line);
                sum += line;
                filled += line > 0.0;
            }
        }
    s.mean_column[axis] = filled > 0 ? sum / static_cast<double>(filled) : 0.0;
}

Statistics gather(const DensityField& field) {
    Statistics s;
    for (int axis = 0; axis < 3; ++axis)
        add_columns(field, axis, s);
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
    tell(stdout, "  active voxels  {}\n", field.active_voxels);
    if (field.active_voxels == 0) {
        tell(stdout, "  the grid is empty: it renders as if it were not there\n");
        return;
    }
    const glm::ivec3 low = field.voxel_min, high = field.voxel_max, size = high - low + 1;
    const auto [world_low, world_high] = world_box(field);
    const glm::dmat3 linear(field.index_to_world);
    const glm::dvec3 edges(glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2]));
    tell(stdout, "  index box      [{},{},{}]..[{},{},{}] ({} x {} x {})\n", low.x, low.y, low.z, high.x, high.y,
         high.z, size.x, size.y, size.z);
    tell(stdout, "  voxel size     {:.6g} x {:.6g} x {:.6g}\n", edges.x, edges.y, edges.z);
    tell(stdout, "  world box      [{:.6g},{:.6g},{:.6g}]..[{:.6g},{:.6g},{:.6g}]\n", world_low.x, world_low.y,
         world_low.z, world_high.x, world_high.y, world_high.z);
    const Statistics s = gather(field);
    tell(stdout, "  values > 0     {:.6g}..{:.6g}, mean {:.6g}, in {} voxels\n", s.low, s.high,
         s.positive > 0 ? s.sum / static_cast<double>(s.positive) : 0.0, s.positive);
    if (field.cleaned > 0)
        tell(stdout, "  unusable       {} values were NaN, infinite or negative and count as 0\n", field.cleaned);
    const glm::dvec3 most = s.largest_column * edges, mean = s.mean_column * edges;
    tell(stdout,
         "  optical depth  along x, y, z per unit of sigma_t (unit=\"world\"): at most {:.4g}, {:.4g}, {:.4g}; "
         "mean {:.4g}, {:.4g}, {:.4g}\n",
         most.x, most.y, most.z, mean.x, mean.y, mean.z);
    tell(stdout, "                 the same for unit=\"voxel\": at most {:.4g}, {:.4g}, {:.4g}\n",
         most.x / field.voxel_size(), most.y / field.voxel_size(), most.z / field.voxel_size());
    const double tables = static_cast<double>(field.leaf_table.size()) * sizeof(std::uint32_t);
    tell(stdout, "  memory         {:.2f} MiB, and {:.2f} MiB for the table of leaves\n",
         static_cast<double>(field.bytes.size()) / 1048576.0, tables / 1048576.0);
}

// A grid that cannot serve as density (vectors, integers, a level set) is listed, with the reason, not an error.
void print_grid(const GridFile& file) {
    try {
        print_field(load_density_field(file));
    } catch (const InputError& e) {
        tell(stdout, "  not usable as density: {}\n", e.what());
    }
}

} // namespace

int run_info(const std::filesystem::path& file) {
    check_input_file(file, "");
    if (file.extension() == ".vdb") {
        for (const VdbEntry& entry : read_vdb_entries(file)) {
            if (std::ferror(stdout)) // nobody reads any more
                break;
            tell(stdout, "{}: {} (OpenVDB)\n", entry.name, entry.type);
            print_grid({file, entry.name});
        }
        return exit_done;
    }
    for (const GridEntry& entry : read_nvdb_entries(file)) {
        if (std::ferror(stdout))
            break;
        tell(stdout, "{}: {}, {} (NanoVDB {}, codec {}, {:.2f} MiB on disk)\n", entry.name, grid_type_name(entry.type),
             grid_class_name(entry.grid_class), entry.version, codec_name(entry.codec),
             static_cast<double>(entry.file_bytes) / 1048576.0);
        print_grid({file, entry.name});
    }
    return exit_done;
}

} // namespace vkvol
