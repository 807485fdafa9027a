// .nvdb files: damaged in the container, in the grid before it is compressed, and anywhere.
#include <cmath>
#include <cstddef>
#include <cstring>
#include <nanovdb/util/IO.h>

#include "corpus.h"
#include "density_field.h"
#include "empty_space.h"
#include "info.h"
#include "majorant_grid.h"
#include "mutate.h"
#include "pilot_paths.h"
#include "target.h"
#include "use_scene.h"

namespace vkvol::fuzz {

namespace {

// Their sum, modulo 2^64: offsets in a damaged tree may be anything.
std::int64_t beyond(std::int64_t a, std::int64_t b) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

template <class Node> Node* node_at(std::span<std::byte> grid, std::int64_t offset) {
    if (offset < 0 || offset % 32 != 0 || static_cast<std::size_t>(offset) + sizeof(Node) > grid.size())
        return nullptr;
    return reinterpret_cast<Node*>(grid.data() + offset);
}

// Damage to the tree of a grid of numbers, whose internal nodes are alike in all types, or of colours.
template <class Value> struct TreeDamage {
    using Root = typename nanovdb::NanoRoot<Value>::DataType;
    using Upper = typename nanovdb::NanoUpper<Value>::DataType;
    using Lower = typename nanovdb::NanoLower<Value>::DataType;
    using Tile = typename Root::Tile;

    // A random way down the tree, as far as it leads: offsets of root, tile, upper, lower, leaf.
    struct Way {
        std::int64_t root = -1, tile = -1, upper = -1, lower = -1, leaf = -1;
    };

    template <class Node> static constexpr std::uint32_t child_count = std::extent_v<decltype(Node::mTable)>;

    template <class Node> static std::int64_t random_child(Node* node, std::int64_t offset, Random& random) {
        for (int attempt = 0; attempt < 50000; ++attempt) { // few bits are set
            const auto n = static_cast<std::uint32_t>(random.below(child_count<Node>));
            if (node->mChildMask.isOn(n))
                return beyond(offset, node->mTable[n].child);
        }
        return -1;
    }

    static Way random_way(std::span<std::byte> grid, Random& random) {
        Way way;
        const auto* tree = node_at<nanovdb::TreeData<3>>(grid, sizeof(nanovdb::GridData));
        way.root = beyond(sizeof(nanovdb::GridData), static_cast<std::int64_t>(tree->mNodeOffset[3]));
        const Root* root = node_at<Root>(grid, way.root);
        if (!root || root->mTableSize == 0)
            return way;
        way.tile = way.root + static_cast<std::int64_t>(sizeof(Root) + random.below(root->mTableSize) * sizeof(Tile));
        const auto* tile = node_at<Tile>(grid, way.tile);
        if (!tile || tile->child == 0)
            return way;
        way.upper = beyond(way.root, tile->child);
        if (auto* upper = node_at<Upper>(grid, way.upper))
            way.lower = random_child(upper, way.upper, random);
        if (auto* lower = node_at<Lower>(grid, way.lower))
            way.leaf = random_child(lower, way.lower, random);
        return way;
    }

    // Turns a child's slot of an internal node into another child: of the same node, of any place, or none.
    template <class Node> static void redirect_child(std::span<std::byte> grid, std::int64_t offset, Random& random) {
        Node* node = node_at<Node>(grid, offset);
        if (!node)
            return;
        const std::int64_t child = random_child(node, offset, random);
        const auto n = static_cast<std::uint32_t>(random.below(child_count<Node>));
        if (random.one_in(2)) {
            node->mChildMask.setOn(n);
            node->mTable[n].child = random.one_in(2)
                                        ? beyond(child, -offset)
                                        : static_cast<std::int64_t>(random.below(grid.size())) / 32 * 32 - offset;
        } else if (random.one_in(20)) { // the whole table: nothing but one child
            for (std::uint32_t i = 0; i < child_count<Node>; ++i) {
                node->mChildMask.setOn(i);
                node->mTable[i].child = beyond(child, -offset);
            }
        } else {
            put_interesting(
                grid, static_cast<std::size_t>(reinterpret_cast<std::byte*>(&node->mTable[n]) - grid.data()), random);
            if (random.one_in(4))
                node->mChildMask.setOn(n);
        }
    }

    static void put_within(std::span<std::byte> grid, std::int64_t offset, std::size_t size, Random& random) {
        const std::int64_t at = offset + static_cast<std::int64_t>(random.below(size) / 4 * 4);
        if (offset >= 0 && static_cast<std::size_t>(at) < grid.size())
            put_interesting(grid, static_cast<std::size_t>(at), random);
    }

    static void damage_tree(GridBytes& bytes, Random& random) {
        const std::span<std::byte> grid(bytes.edit(), bytes.size());
        const Way way = random_way(grid, random);
        switch (random.below(12)) {
        case 0:
            return put_within(grid, 0, sizeof(nanovdb::GridData), random);
        case 1: // the affine map
            return put_within(grid, offsetof(nanovdb::GridData, mMap), sizeof(nanovdb::Map), random);
        case 2:
            return put_within(grid, sizeof(nanovdb::GridData), sizeof(nanovdb::TreeData<3>), random);
        case 3:
        case 4: // the box, the table's size, the background
            return put_within(grid, way.root, sizeof(Root), random);
        case 5:
            return put_within(grid, way.tile, sizeof(Tile), random);
        case 6:
            return redirect_child<Upper>(grid, way.upper, random);
        case 7:
            return redirect_child<Lower>(grid, way.lower, random);
        case 8: // box, flags, masks
            return put_within(grid, random.one_in(2) ? way.upper : way.lower, 64, random);
        case 9:
        case 10: // flags, minimum, quantum, values
            return put_within(grid, way.leaf, random.one_in(2) ? 96 : 160, random);
        default:
            put_within(grid, 0, grid.size(), random);
        }
    }
};

// An eye around the field or within it, and a medium from nearly empty to opaque.
PilotScene random_pilot(const DensityField& field, Random& random) {
    const auto anywhere = [&] { return glm::dvec3(random.uniform(), random.uniform(), random.uniform()); };
    const glm::dvec3 low(field.voxel_min), size(field.voxel_max - field.voxel_min + 1);
    PilotScene scene;
    scene.eye = low + size * (3.0 * anywhere() - 1.0);
    if (random.one_in(2))
        scene.light = glm::normalize(anywhere() - 0.5 + 1e-9);
    scene.sigma_t = std::pow(10.0, 12.0 * random.uniform() - 8.0);
    scene.albedo = random.uniform();
    scene.g = random.one_in(2) ? 0.0 : 1.98 * random.uniform() - 0.99;
    return scene;
}

void check_majorants(const DensityField& field, Random& random) {
    const MajorantGrid grid = random.one_in(2)
                                  ? choose_majorant_grid(field, random_pilot(field, random),
                                                         random.one_in(4) ? static_cast<int>(1 + random.below(64)) : 0)
                                  : make_majorant_grid(field, static_cast<int>(1 + random.below(64)));
    const glm::ivec3 n = grid.dims;
    expect(grid.bounds.size() == std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z) && !grid.bounds.empty(),
           "majorant cells are not as many as their dimensions say");
    const glm::ivec3 size = field.voxel_max - field.voxel_min + 1;
    for (int i = 0; i < 1000; ++i) {
        const glm::ivec3 step(random.below(std::uint64_t(size.x)), random.below(std::uint64_t(size.y)),
                              random.below(std::uint64_t(size.z)));
        const float value = field.value(field.voxel_min + step);
        expect(std::isfinite(value) && value >= 0.0f, "a voxel's value is no density");
        const glm::ivec3 c = (field.voxel_min + step - grid.origin) / grid.cell;
        expect(glm::all(glm::lessThan(c, n)), "a voxel lies in no majorant cell");
        expect(value <= grid.bounds[(std::size_t(c.x) * n.y + c.y) * n.z + c.z], "a density exceeds its majorant");
    }
    const std::vector<float> walked = walked_cells(grid);
    for (int i = 0; i < 100; ++i) {
        const std::size_t any = random.below(walked.size());
        const glm::ivec3 cell(any / (std::size_t(n.y) * n.z), any / n.z % n.y, any % n.z);
        expect(walked[any] >= 0.0f ? walked[any] == grid.bounds[any] : grid.leaps, "a cell is not walked as it is");
        const int reach = std::max(-static_cast<int>(walked[any]), 0);
        const glm::ivec3 apart(random.below(2 * reach + 1), random.below(2 * reach + 1), random.below(2 * reach + 1));
        const glm::ivec3 near = cell + apart - reach;
        if (walked[any] < 0.0f && near == glm::clamp(near, glm::ivec3(0), n - 1))
            expect(grid.bounds[(std::size_t(near.x) * n.y + near.y) * n.z + near.z] == 0.0f,
                   "a walk would leap over matter");
    }
    if (grid.bounds.size() * std::pow(grid.cell + 1.0, 3.0) < 1e7)
        expect(make_controls(field, grid, random.uniform()).size() == grid.bounds.size(),
               "controls are not as many as cells");
}

} // namespace

void use_grid_file(const std::filesystem::path& file, Random& random) {
    // One of these, since each reads the file anew.
    if (random.one_in(3)) {
        run_info(file);
        return;
    }
    if (random.one_in(2)) {
        const char* grid = random.one_in(4) ? "colour" : random.one_in(3) ? "temperature" : "density";
        const DensityField field = load_density_field({file, grid}, GridValues::numbers_or_colors);
        check_field(field);
        if (field.active_voxels > 0) {
            check_majorants(field, random);
            field.max_value();
        }
        return;
    }
    Scene scene;
    scene.volumes.emplace_back();
    scene.volumes.front().shape = GridFile{file, "density"};
    scene.volumes.front().unit = random.one_in(2) ? CoefficientUnit::world : CoefficientUnit::voxel;
    if (random.one_in(2)) {
        scene.volumes.front().temperature.color = Rgb(1.0);
        scene.volumes.front().temperature.model =
            random.one_in(2) ? TemperatureEmission::Model::color : TemperatureEmission::Model::blackbody;
    }
    if (random.one_in(2))
        scene.volumes.front().albedo_grid = random.one_in(2) ? "temperature" : "colour";
    if (random.one_in(2)) {
        scene.volumes.front().map.points = {{0.0, 0.1}, {0.4, 1.0}, {0.4, 0.0}, {0.8, 3.0}};
        scene.volumes.front().map.rise = random.one_in(2) ? 0.5 : 0.0;
        scene.volumes.front().map.is_transfer = random.one_in(2);
    }
    if (random.one_in(2))
        scene.settings.integrator = random.one_in(2) ? "decompositionTracking" : "rayMarching";
    use_scene(scene);
}

namespace {

class GridTarget : public Target {
public:
    GridTarget() : Target("grid", ".nvdb", 256, 1040) {}

    void prepare(const std::filesystem::path& directory) override {
        file_ = directory / "input.nvdb";
        densities_ = make_grids("density");
        temperatures_ = make_grids("temperature");
        colors_ = make_color_grids("colour");
    }

    std::string make(Random& random) override {
        std::vector<StoredGrid> grids = {{random.pick(densities_), "density"}};
        if (random.one_in(4))
            grids.push_back({random.pick(temperatures_), "temperature"});
        if (random.one_in(3))
            grids.push_back({random.pick(colors_), "colour"});
        const bool tree = !random.one_in(3);
        for (StoredGrid& grid : grids)
            for (std::uint64_t n = tree ? 1 + random.below(3) : 0; n > 0; --n)
                grid.name == "colour" ? TreeDamage<nanovdb::Vec3f>::damage_tree(grid.bytes, random)
                                      : TreeDamage<float>::damage_tree(grid.bytes, random);
        std::string file = make_nvdb(grids, static_cast<std::uint16_t>(random.below(3)));
        if (!tree && random.one_in(2)) // the container
            put_interesting(std::as_writable_bytes(std::span(file)), random.below(nvdb_header_size(grids)), random);
        else if (!tree)
            mutate_bytes(file, random, make_nvdb({{random.pick(densities_), "density"}}, 1));
        return file;
    }

    void use(const std::string& input, Random& random) override {
        write_file(file_, input);
        use_grid_file(file_, random);
    }

private:
    std::filesystem::path file_;
    std::vector<GridBytes> densities_, temperatures_, colors_;
};

// OpenVDB's own reader does the work here, and its memory is not ours to bound as tightly.
class VdbTarget : public Target {
public:
    VdbTarget() : Target("vdb", ".vdb", 256, 1040) {}

    void prepare(const std::filesystem::path& directory) override {
        file_ = directory / "input.vdb";
        corpus_ = make_vdbs(directory);
    }

    std::string make(Random& random) override {
        std::string file = random.pick(corpus_);
        if (random.one_in(2)) // headers, where every byte has a meaning
            put_interesting(std::as_writable_bytes(std::span(file)),
                            random.below(std::min<std::size_t>(file.size(), 2000)), random);
        else
            mutate_bytes(file, random, random.pick(corpus_));
        return file;
    }

    void use(const std::string& input, Random& random) override {
        write_file(file_, input);
        use_grid_file(file_, random);
    }

private:
    std::filesystem::path file_;
    std::vector<std::string> corpus_;
};

} // namespace

Target& grid_target() {
    static GridTarget target;
    return target;
}

Target& vdb_target() {
    static VdbTarget target;
    return target;
}

} // namespace vkvol::fuzz
