#include "grid_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <nanovdb/NanoVDB.h>
#include <set>

#include "error.h"
#include "shared/constants.h"

namespace vkvol {

namespace {

// Root and internal nodes have the same layout for all types of numbers read here, since their values are floats; only
// leaves differ, and they are taken as bytes.
static_assert(sizeof(nanovdb::NanoUpper<float>::DataType) == sizeof(nanovdb::NanoUpper<nanovdb::Fp8>::DataType));
static_assert(sizeof(nanovdb::NanoLower<float>::DataType) == sizeof(nanovdb::NanoLower<nanovdb::FpN>::DataType));

// What density.glsl knows of a leaf, in bytes.
constexpr std::size_t leaf_flags = 15;
constexpr std::size_t leaf_minimum = 80;
constexpr std::size_t leaf_quantum = 84;
constexpr std::size_t leaf_values = 96;
constexpr std::size_t leaf_colors = 128;
static_assert(offsetof(nanovdb::NanoLeaf<float>::DataType, mValues) == leaf_values);
static_assert(offsetof(nanovdb::NanoLeaf<nanovdb::Vec3f>::DataType, mValues) == leaf_colors);
static_assert(sizeof(nanovdb::Vec3f) == 3 * sizeof(float));
static_assert(sizeof(nanovdb::NanoLeaf<nanovdb::Fp4>::DataType) == leaf_values + 256);
static_assert(sizeof(nanovdb::NanoLeaf<nanovdb::FpN>::DataType) == leaf_values);

// Limit to the entries of a transform and of its inverse: products of three stay finite in the kernels.
constexpr double largest_entry = 1e11;

// The table of leaves keeps word offsets in 31 bits.
constexpr std::size_t largest_grid = std::size_t{1} << 33;

// A table this large means a box of 4300^3 voxels.
constexpr std::int64_t most_blocks = 160'000'000;
// One of 2048^3. Beyond it a thousandth of the blocks must hold a leaf, so that a file of a few stray voxels neither
// fills the memory nor takes minutes.
constexpr std::int64_t small_table = 1 << 24;

unsigned log2_bits(int type, const std::byte* leaf) {
    return type == GRID_FP4    ? 2u
           : type == GRID_FP8  ? 3u
           : type == GRID_FP16 ? 4u
                               : std::to_integer<unsigned>(leaf[leaf_flags]) >> 5u;
}

} // namespace

float read_float(const std::byte* from) {
    float value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

glm::vec3 read_color(const std::byte* from) {
    return {read_float(from), read_float(from + 4), read_float(from + 8)};
}

glm::vec3 leaf_color(const std::byte* leaf, unsigned n) {
    return read_color(leaf + leaf_colors + 12 * n);
}

float leaf_value(int type, const std::byte* leaf, unsigned n) {
    if (type == GRID_FLOAT)
        return read_float(leaf + leaf_values + 4 * n);
    const unsigned log2 = log2_bits(type, leaf);
    std::uint32_t word;
    std::memcpy(&word, leaf + leaf_values + 4 * (n >> (5 - log2)), sizeof word);
    const std::uint32_t code =
        (word >> ((n & ((32u >> log2) - 1)) << log2)) & static_cast<std::uint32_t>((1ull << (1u << log2)) - 1);
    return std::max(static_cast<float>(code) * read_float(leaf + leaf_quantum) + read_float(leaf + leaf_minimum), 0.0f);
}

namespace {

// Walks a grid's tree, never trusting an offset: fills the leaf table and sets unusable values to 0. Value: float, or a
// colour.
template <class Value> class Builder {
    using Root = typename nanovdb::NanoRoot<Value>::DataType;
    using Upper = typename nanovdb::NanoUpper<Value>::DataType;
    using Lower = typename nanovdb::NanoLower<Value>::DataType;
    using Leaf = typename nanovdb::NanoLeaf<Value>::DataType;
    using Tile = typename Root::Tile;

public:
    Builder(DensityField& field, const std::string& place) : field_(field), place_(place) {}

    void build() {
        check_grid_size(field_.bytes.size(), place_);
        auto* grid = at<nanovdb::GridData>(0);
        const std::size_t tree_offset = sizeof(nanovdb::GridData);
        const auto* tree = at<nanovdb::TreeData<3>>(tree_offset);
        const std::size_t root_offset = tree_offset + tree->mNodeOffset[3];
        Root* root = at<Root>(root_offset);
        if (root->mTableSize > field_.bytes.size() / sizeof(Tile))
            damaged();
        bytes_left_ = field_.bytes.size();
        read_transform(*grid);
        field_.active_voxels = tree->mVoxelCount;
        const nanovdb::CoordBBox box = root->mBBox;
        field_.voxel_min = {box.min()[0], box.min()[1], box.min()[2]};
        field_.voxel_max = {box.max()[0], box.max()[1], box.max()[2]};
        field_.background = most(root->mBackground);
        if (field_.active_voxels > 0 && box.empty())
            throw InputError(fmt::format("{}: the grid does not say where its voxels are, since it was written without "
                                         "statistics; write it with NanoVDB's default of StatsMode, or as .vdb",
                                         place_));
        if (field_.active_voxels == 0)
            return;
        check_box(*root, root_offset);
        size_table();
        bytes_left_ = field_.bytes.size();
        clean_unseen(root->mBackground);
        field_.background = most(root->mBackground);
        std::fill(table_.begin(), table_.end(), entry_of_value(&root->mBackground));
        for (std::uint32_t i = 0; i < root->mTableSize; ++i)
            visit_root_tile(*at<Tile>(root_offset + sizeof(Root) + i * sizeof(Tile)), root_offset);
        field_.leaf_table = std::move(table_);
    }

private:
    [[noreturn]] void damaged() const {
        throw InputError(
            fmt::format("{}: the grid's tree points outside its data: the file is damaged; copy or convert "
                        "it again",
                        place_));
    }

    // Nodes are disjoint: together they are no larger than the grid. Where children are shared or go round in a circle
    // they would be.
    void spend(std::size_t size) {
        if (size > bytes_left_)
            damaged();
        bytes_left_ -= size;
    }

    template <class T> T* at(std::size_t offset, std::size_t size = sizeof(T)) {
        if (offset % 32 != 0 || offset > field_.bytes.size() || size > field_.bytes.size() - offset)
            damaged();
        return reinterpret_cast<T*>(field_.bytes.edit() + offset);
    }

    void read_transform(const nanovdb::GridData& grid) {
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column)
                field_.index_to_world[column][row] = grid.mMap.mMatD[3 * row + column];
            field_.index_to_world[3][row] = grid.mMap.mVecD[row];
        }
        const double det = std::abs(glm::determinant(glm::dmat3(field_.index_to_world)));
        if (!(det > 0.0) || !std::isfinite(det))
            throw InputError(
                fmt::format("{}: the grid's transform is singular; export it with a voxel size > 0", place_));
        // The kernels have both directions in single precision.
        field_.as_authored = field_.index_to_world;
        const glm::dmat4 inverse = glm::inverse(field_.index_to_world);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row)
                if (!(std::abs(field_.index_to_world[column][row]) <= largest_entry) ||
                    (column < 3 && !(std::abs(inverse[column][row]) <= largest_entry)))
                    throw InputError(
                        fmt::format("{}: the grid's transform has entries beyond 1e11, or as small; export "
                                    "it with another voxel size, or nearer the origin",
                                    place_));
    }

    // The active voxels lie in the root's tiles and children, and each of these stands once in its table.
    void check_box(const Root& root, std::size_t root_offset) {
        glm::ivec3 low(std::numeric_limits<int>::max()), high(std::numeric_limits<int>::min());
        std::set<std::array<int, 3>> seen;
        for (std::uint32_t i = 0; i < root.mTableSize; ++i) {
            const auto* tile = at<Tile>(root_offset + sizeof(Root) + i * sizeof(Tile));
            const nanovdb::Coord key = tile->origin();
            const glm::ivec3 origin(key[0], key[1], key[2]);
            if (!seen.insert({origin.x, origin.y, origin.z}).second)
                damaged();
            if (tile->isChild())
                include_children<Upper>(child_offset(root_offset, tile->child), origin, low, high);
            else
                include(origin, 4096, low, high);
        }
        for (int axis = 0; axis < 3; ++axis)
            if (field_.voxel_min[axis] < low[axis] || field_.voxel_max[axis] > high[axis])
                throw InputError(
                    fmt::format("{}: the box of active voxels reaches beyond the grid's nodes: the file is "
                                "damaged; copy or convert it again",
                                place_));
    }

    static void include(glm::ivec3 origin, int size, glm::ivec3& low, glm::ivec3& high) {
        low = glm::min(low, origin);
        high = glm::max(high, origin + (size - 1));
    }

    // What has a value of its own below `Node`: children, and tiles that are active.
    template <class Node>
    void include_children(std::size_t offset, glm::ivec3 origin, glm::ivec3& low, glm::ivec3& high) {
        constexpr bool is_upper = std::is_same_v<Node, Upper>;
        spend(sizeof(Node));
        const Node* node = at<Node>(offset);
        for (int n = 0; n < 1 << (3 * log2_dim<Node>); ++n) {
            const bool has_child = node->mChildMask.isOn(n);
            if (!has_child && !node->mValueMask.isOn(n))
                continue;
            const glm::ivec3 child_origin = origin + place_of_child<Node>(n);
            if constexpr (is_upper)
                if (has_child) {
                    include_children<Lower>(child_offset(offset, node->mTable[n].child), child_origin, low, high);
                    continue;
                }
            include(child_origin, is_upper ? 128 : 8, low, high);
        }
    }

    void size_table() {
        const std::int64_t limit = 1 << 24;
        for (int axis = 0; axis < 3; ++axis)
            if (field_.voxel_max[axis] < field_.voxel_min[axis] ||
                std::abs(std::int64_t{field_.voxel_min[axis]}) > limit ||
                std::abs(std::int64_t{field_.voxel_max[axis]}) > limit)
                throw InputError(
                    fmt::format("{}: the box of active voxels reaches beyond +-16 million; crop the grid or "
                                "move its index origin",
                                place_));
        const glm::ivec3 size = field_.voxel_max - field_.voxel_min;
        field_.leaf_min = field_.voxel_min >> 3;
        field_.leaf_dims = (field_.voxel_max >> 3) - field_.leaf_min + 1;
        const double blocks = double(field_.leaf_dims.x) * field_.leaf_dims.y * field_.leaf_dims.z; // up to 2^66
        const auto bytes = static_cast<std::int64_t>(field_.bytes.size());
        if (blocks > double(std::min(most_blocks, small_table + bytes / 2)))
            throw InputError(
                fmt::format("{}: the box of active voxels spans {} x {} x {} voxels, too much for a table of "
                            "its blocks; crop stray voxels or split the grid",
                            place_, size.x + 1, size.y + 1, size.z + 1));
        table_.resize(static_cast<std::size_t>(blocks));
    }

    static float most(float value) { return value; }
    static float most(const nanovdb::Vec3f& color) { return std::max({color[0], color[1], color[2]}); }

    void clean(float& value) {
        if (!(value >= 0.0f) || !std::isfinite(value)) {
            value = 0.0f;
            ++field_.cleaned;
        }
    }
    void clean(nanovdb::Vec3f& color) {
        for (int i = 0; i < 3; ++i)
            if (!field_.is_signed || !std::isfinite(color[i]))
                clean(color[i]);
    }

    void clean_unseen(Value& value) { // no voxel has it
        const std::uint64_t before = field_.cleaned;
        clean(value);
        field_.cleaned = before;
    }
    void clean_tile(Value& value, glm::ivec3 origin, int size) {
        const std::uint64_t before = field_.cleaned;
        clean(value);
        // As many voxels as it has of the box.
        const glm::i64vec3 part = glm::i64vec3(glm::min(origin + (size - 1), field_.voxel_max)) -
                                  glm::i64vec3(glm::max(origin, field_.voxel_min)) + std::int64_t{1};
        const bool is_beyond = glm::any(glm::lessThanEqual(part, glm::i64vec3(0)));
        if (field_.cleaned > before)
            field_.cleaned = before + (is_beyond ? 0 : static_cast<std::uint64_t>(part.x * part.y * part.z));
    }

    std::uint32_t word_offset(const void* p) const {
        return static_cast<std::uint32_t>((static_cast<const std::byte*>(p) - field_.bytes.data()) / 4);
    }
    std::uint32_t entry_of_value(const Value* value) const { return word_offset(value) << 1; }

    // Enters `entry` for the blocks of the cube [origin, origin + size) that the table covers.
    void enter(glm::ivec3 origin, int size, std::uint32_t entry) {
        const glm::ivec3 low = glm::max((origin >> 3) - field_.leaf_min, glm::ivec3(0));
        const glm::ivec3 high = glm::min(((origin + (size - 1)) >> 3) - field_.leaf_min, field_.leaf_dims - 1);
        for (int x = low.x; x <= high.x; ++x)
            for (int y = low.y; y <= high.y; ++y)
                for (int z = low.z; z <= high.z; ++z)
                    table_[(std::size_t(x) * field_.leaf_dims.y + y) * field_.leaf_dims.z + z] = entry;
    }

    std::size_t child_offset(std::size_t parent, std::int64_t child) const {
        return parent + static_cast<std::size_t>(child); // wraps where it points outside, which at() finds
    }

    void visit_root_tile(Tile& tile, std::size_t root_offset) {
        const nanovdb::Coord key = tile.origin();
        const glm::ivec3 origin(key[0], key[1], key[2]);
        if (tile.isChild()) {
            visit<Upper>(child_offset(root_offset, tile.child), origin);
        } else {
            clean_tile(tile.value, origin, 4096);
            enter(origin, 4096, entry_of_value(&tile.value));
        }
    }

    template <class Node> static constexpr int log2_dim = std::is_same_v<Node, Upper> ? 5 : 4;

    // Voxels from the node's origin to its n-th child's.
    template <class Node> static glm::ivec3 place_of_child(int n) {
        constexpr int log2 = log2_dim<Node>, mask = (1 << log2) - 1;
        return glm::ivec3(n >> (2 * log2), (n >> log2) & mask, n & mask) * (std::is_same_v<Node, Upper> ? 128 : 8);
    }

    template <class Node> void visit(std::size_t offset, glm::ivec3 origin) {
        constexpr bool is_upper = std::is_same_v<Node, Upper>;
        constexpr int child_size = is_upper ? 128 : 8;
        spend(sizeof(Node));
        Node* node = at<Node>(offset);
        for (int n = 0; n < 1 << (3 * log2_dim<Node>); ++n) {
            const glm::ivec3 child_origin = origin + place_of_child<Node>(n);
            if (!node->mChildMask.isOn(n)) {
                clean_tile(node->mTable[n].value, child_origin, child_size);
                enter(child_origin, child_size, entry_of_value(&node->mTable[n].value));
            } else if constexpr (is_upper) {
                visit<Lower>(child_offset(offset, node->mTable[n].child), child_origin);
            } else {
                visit_leaf(child_offset(offset, node->mTable[n].child), child_origin);
            }
        }
    }

    void visit_leaf(std::size_t offset, glm::ivec3 origin) {
        std::byte* leaf = at<std::byte>(offset, leaf_values);
        if (field_.type == GRID_FLOAT || field_.type == GRID_COLOR) {
            spend(sizeof(Leaf));
            Value* const values = at<Leaf>(offset)->mValues;
            for (int n = 0; n < 512; ++n)
                is_voxel(origin, n) ? clean(values[n]) : clean_unseen(values[n]);
        } else {
            const unsigned log2 = log2_bits(field_.type, leaf);
            if (log2 > 4)
                damaged();
            spend(leaf_values + (std::size_t{64} << log2));
            at<std::byte>(offset, leaf_values + (std::size_t{64} << log2));
            clean_quantised(leaf, origin);
        }
        enter(origin, 8, word_offset(leaf) << 1 | 1u);
    }

    // Of a leaf the n-th value, whose place counts z fastest, lies in the box of voxels.
    bool is_voxel(glm::ivec3 origin, int n) const {
        const glm::ivec3 place = origin + glm::ivec3(n >> 6, n >> 3 & 7, n & 7);
        return place == glm::clamp(place, field_.voxel_min, field_.voxel_max);
    }

    void clean_quantised(std::byte* leaf, glm::ivec3 origin) {
        const float minimum = read_float(leaf + leaf_minimum);
        const float quantum = read_float(leaf + leaf_quantum);
        const auto codes = static_cast<float>((1u << (1u << log2_bits(field_.type, leaf))) - 1u);
        const float highest = codes * quantum + minimum;
        if (!std::isfinite(minimum) || !std::isfinite(quantum) || !std::isfinite(highest)) {
            std::memset(leaf + leaf_minimum, 0, 8);
            for (int n = 0; n < 512; ++n)
                field_.cleaned += is_voxel(origin, n);
        } else if (minimum < 0.0f) { // decoding clamps; here they are only counted
            for (int n = 0; n < 512; ++n)
                field_.cleaned +=
                    is_voxel(origin, n) && leaf_value(field_.type, leaf, static_cast<unsigned>(n)) == 0.0f;
        }
    }

    DensityField& field_;
    const std::string& place_;
    std::vector<std::uint32_t> table_; // of leaves
    std::size_t bytes_left_ = 0;       // that nodes not yet seen can have
};

} // namespace

void check_grid_size(std::size_t bytes, const std::string& place) {
    if (bytes > largest_grid)
        throw InputError(fmt::format("{}: the grid takes {:.1f} GiB, and 8 GiB are the most; crop it or write it "
                                     "quantised (nanovdb_convert --fp8 takes a quarter of the bytes of floats)",
                                     place, double(bytes) / 1073741824.0));
}

void read_tree(DensityField& field, const std::string& place) {
    if (field.type == GRID_COLOR)
        Builder<nanovdb::Vec3f>(field, place).build();
    else
        Builder<float>(field, place).build();
}

} // namespace vkvol
