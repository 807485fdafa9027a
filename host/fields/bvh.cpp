#include "bvh.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <limits>
#include <span>

#include "error.h"

namespace vkvol {

namespace {

static_assert(MESH_LEAF <= 7, "three bits hold the number of a leaf's triangles");
constexpr int bin_count = 16;

using Box = BvhBox;

float half_area(const Box& box) {
    const glm::vec3 d = box.high - box.low;
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

struct Item {
    Box box;
    glm::vec3 middle;
    std::uint32_t number;
};

using Items = std::span<Item>;

// Where to cut along `axis` so that area times number of items, summed over both sides, is least: the surface area
// heuristic over 16 bins (Wald, "On Fast Construction of SAH-Based Bounding Volume Hierarchies", 2007).
float best_cut(Items items, const Box& middles, int axis) {
    const float low = middles.low[axis], width = (middles.high[axis] - low) / bin_count;
    if (!(width > 0.0f)) // all in one place
        return low;
    std::array<Box, bin_count> boxes;
    std::array<std::size_t, bin_count> counts{};
    for (const Item& t : items) {
        const int bin = std::clamp(static_cast<int>((t.middle[axis] - low) / width), 0, bin_count - 1);
        boxes[bin].add(t.box);
        ++counts[bin];
    }
    std::array<float, bin_count> right_cost{}; // of the bins from here on
    Box side;
    std::size_t count = 0;
    for (int bin = bin_count - 1; bin > 0; --bin) {
        side.add(boxes[bin]);
        count += counts[bin];
        right_cost[bin] = count > 0 ? half_area(side) * static_cast<float>(count) : 0.0f;
    }
    side = {};
    count = 0;
    float best = std::numeric_limits<float>::infinity();
    int cut = bin_count / 2;
    for (int bin = 1; bin < bin_count; ++bin) {
        side.add(boxes[bin - 1]);
        count += counts[bin - 1];
        const float cost = (count > 0 ? half_area(side) * static_cast<float>(count) : 0.0f) + right_cost[bin];
        if (cost < best) {
            best = cost;
            cut = bin;
        }
    }
    return low + width * static_cast<float>(cut);
}

// How many items go to the left; they come first afterwards.
std::size_t split(Items items) {
    Box middles;
    for (const Item& t : items)
        middles.add(t.middle);
    const glm::vec3 extent = middles.high - middles.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const float cut = best_cut(items, middles, axis);
    const auto right = std::partition(items.begin(), items.end(), [&](const Item& t) { return t.middle[axis] < cut; });
    const auto left = static_cast<std::size_t>(right - items.begin());
    if (left != 0 && left != items.size())
        return left;
    const std::size_t half = items.size() / 2; // all in one place
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                     [&](const Item& a, const Item& b) { return a.middle[axis] < b.middle[axis]; });
    return half;
}

void build(BoxTree& tree, Items items) {
    const std::size_t node = tree.nodes.size();
    tree.nodes.emplace_back();
    Box box;
    for (const Item& t : items)
        box.add(t.box);
    tree.nodes[node].low = box.low;
    tree.nodes[node].high = box.high;
    if (items.size() <= MESH_LEAF) {
        tree.nodes[node].leaf = static_cast<std::uint32_t>(tree.order.size() * 8 + items.size());
        for (const Item& t : items)
            tree.order.push_back(t.number);
    } else {
        const std::size_t left = split(items);
        build(tree, items.first(left));
        build(tree, items.subspan(left));
    }
    tree.nodes[node].skip = static_cast<std::uint32_t>(tree.nodes.size());
}

} // namespace

BoxTree build_box_tree(std::span<const BvhBox> boxes) {
    if (boxes.size() >= (1u << 27)) // nodes then name them in 29 bits, and a buffer's corners in 32
        throw InputError(fmt::format("a mesh of {} triangles is too large; decimate it", boxes.size()));
    std::vector<Item> items;
    items.reserve(boxes.size());
    for (const BvhBox& box : boxes)
        items.push_back({box, 0.5f * (box.low + box.high), static_cast<std::uint32_t>(items.size())});
    BoxTree tree;
    tree.nodes.reserve(items.size());
    tree.order.reserve(items.size());
    if (!items.empty())
        build(tree, items);
    return tree;
}

Bvh build_bvh(const Mesh& mesh, glm::dvec3 origin) {
    const std::vector<glm::vec3> corners = corners_about(mesh, origin);
    std::vector<BvhBox> boxes(mesh.triangles.size());
    for (std::size_t i = 0; i < corners.size(); ++i)
        boxes[i / 3].add(corners[i]);
    BoxTree tree = build_box_tree(boxes);
    Bvh bvh;
    bvh.nodes = std::move(tree.nodes);
    bvh.triangles.reserve(corners.size());
    for (const std::uint32_t i : tree.order)
        bvh.triangles.insert(bvh.triangles.end(), corners.begin() + 3 * i, corners.begin() + 3 * i + 3);
    return bvh;
}

} // namespace vkvol
