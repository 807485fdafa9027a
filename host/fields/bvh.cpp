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

struct Box {
    glm::vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};

    void add(glm::vec3 p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    void add(const Box& other) {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
    float half_area() const {
        const glm::vec3 d = high - low;
        return d.x * d.y + d.y * d.z + d.z * d.x;
    }
};

struct Triangle {
    std::array<glm::vec3, 3> corners;
    Box box;
    glm::vec3 middle;
};

using Triangles = std::span<Triangle>;

// Where to cut along `axis` so that area times number of triangles, summed over both sides, is least: the surface area
// heuristic over 16 bins (Wald, "On Fast Construction of SAH-Based Bounding Volume Hierarchies", 2007).
float best_cut(Triangles triangles, const Box& middles, int axis) {
    const float low = middles.low[axis], width = (middles.high[axis] - low) / bin_count;
    if (!(width > 0.0f)) // all in one place
        return low;
    std::array<Box, bin_count> boxes;
    std::array<std::size_t, bin_count> counts{};
    for (const Triangle& t : triangles) {
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
        right_cost[bin] = count > 0 ? side.half_area() * static_cast<float>(count) : 0.0f;
    }
    side = {};
    count = 0;
    float best = std::numeric_limits<float>::infinity();
    int cut = bin_count / 2;
    for (int bin = 1; bin < bin_count; ++bin) {
        side.add(boxes[bin - 1]);
        count += counts[bin - 1];
        const float cost = (count > 0 ? side.half_area() * static_cast<float>(count) : 0.0f) + right_cost[bin];
        if (cost < best) {
            best = cost;
            cut = bin;
        }
    }
    return low + width * static_cast<float>(cut);
}

// How many triangles go to the left; they come first afterwards.
std::size_t split(Triangles triangles) {
    Box middles;
    for (const Triangle& t : triangles)
        middles.add(t.middle);
    const glm::vec3 extent = middles.high - middles.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const float cut = best_cut(triangles, middles, axis);
    const auto right =
        std::partition(triangles.begin(), triangles.end(), [&](const Triangle& t) { return t.middle[axis] < cut; });
    const auto left = static_cast<std::size_t>(right - triangles.begin());
    if (left != 0 && left != triangles.size())
        return left;
    const std::size_t half = triangles.size() / 2; // all in one place
    std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(half), triangles.end(),
                     [&](const Triangle& a, const Triangle& b) { return a.middle[axis] < b.middle[axis]; });
    return half;
}

void build(Bvh& bvh, Triangles triangles) {
    const std::size_t node = bvh.nodes.size();
    bvh.nodes.emplace_back();
    Box box;
    for (const Triangle& t : triangles)
        box.add(t.box);
    bvh.nodes[node].low = box.low;
    bvh.nodes[node].high = box.high;
    if (triangles.size() <= MESH_LEAF) {
        bvh.nodes[node].leaf = static_cast<std::uint32_t>(bvh.triangles.size() / 3 * 8 + triangles.size());
        for (const Triangle& t : triangles)
            bvh.triangles.insert(bvh.triangles.end(), t.corners.begin(), t.corners.end());
    } else {
        const std::size_t left = split(triangles);
        build(bvh, triangles.first(left));
        build(bvh, triangles.subspan(left));
    }
    bvh.nodes[node].skip = static_cast<std::uint32_t>(bvh.nodes.size());
}

} // namespace

Bvh build_bvh(const Mesh& mesh, glm::dvec3 origin) {
    if (mesh.triangles.size() >= (1u << 27)) // nodes then name them in 29 bits, and a buffer's corners in 32
        throw InputError(fmt::format("a mesh of {} triangles is too large; decimate it", mesh.triangles.size()));
    std::vector<Triangle> triangles(mesh.triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (int corner = 0; corner < 3; ++corner) {
            triangles[i].corners[corner] = mesh.vertices[mesh.triangles[i][corner]] - origin;
            triangles[i].box.add(triangles[i].corners[corner]);
        }
        triangles[i].middle = 0.5f * (triangles[i].box.low + triangles[i].box.high);
    }
    Bvh bvh;
    bvh.triangles.reserve(3 * triangles.size());
    bvh.nodes.reserve(triangles.size());
    if (!triangles.empty())
        build(bvh, triangles);
    return bvh;
}

} // namespace vkvol
