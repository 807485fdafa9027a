#include "info.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>

#include "error.h"
#include "file_ending.h"
#include "file_scene.h"
#include "grid_summary.h"
#include "input_file.h"
#include "messages.h"
#include "missing_field.h"
#include "vdb_import.h"

namespace vkvol {

namespace {

using Json = nlohmann::ordered_json;

// One grid of the file, as far as it is a density.
struct GridInfo {
    std::string name, type;
    std::optional<GridEntry> nanovdb;   // none for .vdb
    std::string unusable;               // why it is no density; empty: it is one
    std::optional<DensityField> header; // without its bytes
    std::uint64_t bytes = 0, table_bytes = 0;
    GridSummary summary;

    bool is_empty() const { return header && header->active_voxels == 0; }
};

// A grid that cannot serve as density (vectors, integers, a level set) is listed, with the reason, not an error.
void read_field(const std::filesystem::path& file, GridInfo& grid) {
    try {
        grid.header = load_density_field({file, grid.name});
        DensityField& field = *grid.header;
        if (field.active_voxels > 0)
            grid.summary = summarize(field);
        grid.bytes = field.bytes.size();
        grid.table_bytes = field.leaf_table.size() * sizeof(std::uint32_t);
        field.bytes = {};
        field.leaf_table = {};
    } catch (const InputError& e) {
        grid.unusable = e.what();
    }
}

std::vector<GridInfo> read_grids(const std::filesystem::path& file) {
    std::vector<GridInfo> grids;
    if (file_ending(file) == ".vdb")
        for (const VdbEntry& entry : read_vdb_entries(file)) {
            grids.emplace_back();
            grids.back().name = entry.name;
            grids.back().type = entry.type;
        }
    else
        for (const GridEntry& entry : read_nvdb_entries(file)) {
            grids.emplace_back();
            grids.back().name = entry.name;
            grids.back().type = grid_type_name(entry.type);
            grids.back().nanovdb = entry;
        }
    return grids;
}

double mebibytes(std::uint64_t bytes) {
    return static_cast<double>(bytes) / 1048576.0;
}

void print_field(const GridInfo& grid) {
    const DensityField& field = *grid.header;
    tell(stdout, "  active voxels  {}\n", field.active_voxels);
    if (grid.is_empty()) {
        tell(stdout, "  the grid is empty: it renders as if it were not there\n");
        return;
    }
    const glm::ivec3 low = field.voxel_min, high = field.voxel_max, size = high - low + 1;
    const auto [world_low, world_high] = world_box(field);
    const glm::dvec3 edges = voxel_edges(field);
    tell(stdout, "  index box      [{},{},{}]..[{},{},{}] ({} x {} x {})\n", low.x, low.y, low.z, high.x, high.y,
         high.z, size.x, size.y, size.z);
    tell(stdout, "  voxel size     {:.6g} x {:.6g} x {:.6g}\n", edges.x, edges.y, edges.z);
    tell(stdout, "  world box      [{:.6g},{:.6g},{:.6g}]..[{:.6g},{:.6g},{:.6g}]\n", world_low.x, world_low.y,
         world_low.z, world_high.x, world_high.y, world_high.z);
    const GridSummary& s = grid.summary;
    tell(stdout, "  values > 0     {:.6g}..{:.6g}, mean {:.6g}, in {} voxels\n", s.low, s.high, s.mean(), s.positive);
    if (field.background > 0.0f)
        tell(stdout, "  background     {:g}: it counts in the box of active voxels, and not outside\n",
             field.background);
    if (field.cleaned > 0)
        tell(stdout, "  unusable       {} values were NaN, infinite or negative and count as 0\n", field.cleaned);
    const glm::dvec3 most = s.largest_column * edges, mean = s.mean_column * edges;
    tell(stdout,
         "  optical depth  along x, y, z per unit of sigma_t (unit=\"world\"): at most {:.4g}, {:.4g}, {:.4g}; "
         "mean {:.4g}, {:.4g}, {:.4g}\n",
         most.x, most.y, most.z, mean.x, mean.y, mean.z);
    tell(stdout, "                 the same for unit=\"voxel\": at most {:.4g}, {:.4g}, {:.4g}\n",
         most.x / field.voxel_size(), most.y / field.voxel_size(), most.z / field.voxel_size());
    tell(stdout, "  memory         {:.2f} MiB, and {:.2f} MiB for the table of leaves\n", mebibytes(grid.bytes),
         mebibytes(grid.table_bytes));
}

void print_grid(const GridInfo& grid) {
    if (grid.nanovdb)
        tell(stdout, "{}: {}, {} (NanoVDB {}, codec {}, {:.2f} MiB on disk)\n", grid.name, grid.type,
             grid_class_name(grid.nanovdb->grid_class), grid.nanovdb->version, codec_name(grid.nanovdb->codec),
             mebibytes(grid.nanovdb->file_bytes));
    else
        tell(stdout, "{}: {} (OpenVDB)\n", grid.name, grid.type);
    if (grid.unusable.empty())
        print_field(grid);
    else
        tell(stdout, "  not usable as density: {}\n", grid.unusable);
}

Json json_of(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

Json json_of_field(const GridInfo& grid) {
    const DensityField& field = *grid.header;
    const GridSummary& s = grid.summary;
    Json json;
    json["activeVoxels"] = field.active_voxels;
    json["empty"] = grid.is_empty();
    if (grid.is_empty())
        return json;
    const glm::ivec3 low = field.voxel_min, high = field.voxel_max;
    const auto [world_low, world_high] = world_box(field);
    const glm::dvec3 edges = voxel_edges(field);
    json["indexBox"] = {{low.x, low.y, low.z}, {high.x, high.y, high.z}};
    json["worldBox"] = {json_of(world_low), json_of(world_high)};
    json["voxelSize"] = json_of(edges);
    json["values"] = {{"low", s.low}, {"high", s.high}, {"mean", s.mean()}, {"voxels", s.positive}};
    json["background"] = field.background;
    json["cleanedVoxels"] = field.cleaned;
    json["opticalDepth"] = {{"most", json_of(s.largest_column * edges)}, {"mean", json_of(s.mean_column * edges)}};
    json["memoryBytes"] = grid.bytes + grid.table_bytes;
    return json;
}

Json json_of(const GridInfo& grid) {
    Json json = {{"name", grid.name}, {"type", grid.type}};
    if (grid.nanovdb) {
        json["class"] = grid_class_name(grid.nanovdb->grid_class);
        json["version"] = grid.nanovdb->version;
        json["codec"] = codec_name(grid.nanovdb->codec);
        json["fileBytes"] = grid.nanovdb->file_bytes;
    }
    json["usable"] = grid.unusable.empty();
    if (grid.unusable.empty())
        json.update(json_of_field(grid));
    else
        json["why"] = grid.unusable;
    return json;
}

Json json_of(const FileView& view) {
    const SuitableMedium& m = view.medium;
    Json json = {{"grid", view.grid}};
    json["camera"] = {{"lookAt", json_of(view.orbit.target)}, {"distance", view.orbit.distance},
                      {"azimuth", view.orbit.azimuth},        {"elevation", view.orbit.elevation},
                      {"up", json_of(view.orbit.up)},         {"fov", view.fov}};
    json["opticalDepth"] = m.depth;
    json["sigma_a"] = (1.0 - m.albedo) * m.sigma_t;
    json["sigma_s"] = m.albedo * m.sigma_t;
    json["heyneygreenstein_g"] = m.g;
    json["emission"] = nullptr;
    if (m.kelvin)
        json["emission"] = {{"grid", view.temperature},
                            {"temperatureScale", m.kelvin->scale},
                            {"temperatureOffset", m.kelvin->offset},
                            {"referenceTemperature", m.kelvin->hottest},
                            {"multiplier", m.glow}};
    json["elements"] = "  " + camera_element(view) + "\n" + medium_elements(view);
    return json;
}

void print_view(const std::filesystem::path& file, const Picture& picture) {
    try {
        const FileView view = view_file(file, picture, Up::y);
        tell(stdout, "to start from, an optical depth of {:g} in \"{}\":\n  {}\n{}", view.medium.depth, view.grid,
             camera_element(view), medium_elements(view));
    } catch (const InputError& error) {
        tell(stdout, "nothing to render: {}\n", error.what());
    }
}

} // namespace

int run_info(const std::filesystem::path& file, bool json) {
    check_input_file(file, missing_field_hint(file));
    std::vector<GridInfo> grids = read_grids(file);
    const Picture picture = file_picture();
    if (!json) {
        for (GridInfo& grid : grids) {
            if (std::ferror(stdout)) // nobody reads any more
                return exit_done;
            read_field(file, grid);
            print_grid(grid);
        }
        print_view(file, picture);
        return exit_done;
    }
    Json all = {{"file", file.string()}, {"grids", Json::array()}};
    for (GridInfo& grid : grids) {
        read_field(file, grid);
        all["grids"].push_back(json_of(grid));
    }
    try {
        all["view"] = json_of(view_file(file, picture, Up::y));
    } catch (const InputError& error) {
        all["view"] = nullptr;
        all["why"] = error.what();
    }
    put(stdout, all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    return exit_done;
}

} // namespace vkvol
