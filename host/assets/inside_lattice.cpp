#include "inside_lattice.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "error.h"
#include "shared/constants.h"

namespace vkvol {

namespace {

constexpr int fewest = 16, most = 160; // cubes along the longest edge
constexpr std::uint32_t most_listed = 1000;
// What single precision may move a point by, in sizes of the mesh; and how much of a cube its point is from all faces,
// if that can be had.
constexpr double rounding = 4e-6, far_enough = 0.15;
constexpr int most_tries = 64;

struct Triangle {
    std::array<glm::dvec3, 3> corners;
    glm::dvec3 normal; // unit, or 0 without an area

    glm::dvec3 low() const { return glm::min(corners[0], glm::min(corners[1], corners[2])); }
    glm::dvec3 high() const { return glm::max(corners[0], glm::max(corners[1], corners[2])); }
};

std::vector<Triangle> read(std::span<const glm::vec3> corners) {
    std::vector<Triangle> triangles(corners.size() / 3);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        Triangle& t = triangles[i];
        t.corners = {glm::dvec3(corners[3 * i]), glm::dvec3(corners[3 * i + 1]), glm::dvec3(corners[3 * i + 2])};
        const glm::dvec3 normal = glm::cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]);
        const double length = glm::length(normal);
        t.normal = length > 0.0 ? normal / length : glm::dvec3(0.0);
    }
    return triangles;
}

double squared(const glm::dvec3& v) {
    return glm::dot(v, v);
}

// Of a point from the edge that begins at `a`.
double squared_distance(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& along) {
    const double length = squared(along);
    const double t = length > 0.0 ? std::clamp(glm::dot(p - a, along) / length, 0.0, 1.0) : 0.0;
    return squared(p - a - t * along);
}

double squared_distance(const glm::dvec3& p, const Triangle& t) {
    double least = std::numeric_limits<double>::infinity();
    bool above = t.normal != glm::dvec3(0.0); // the triangle, or below it
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 along = t.corners[(i + 1) % 3] - t.corners[i];
        above = above && glm::dot(glm::cross(along, p - t.corners[i]), t.normal) >= 0.0;
        least = std::min(least, squared_distance(p, t.corners[i], along));
    }
    const double height = glm::dot(p - t.corners[0], t.normal);
    return above ? height * height : least;
}

// Where the line through a point along z crosses a triangle: 1 out of it, upwards, -1 into it, 0 not at all. As
// cross_triangle in mesh.glsl, ties of coordinates included, so that a closed surface stays closed.
struct Crossing {
    int turn = 0;
    double z = 0.0;
};

bool is_left(double area, const glm::dvec2& p, const glm::dvec2& q) {
    return area != 0.0 ? area > 0.0 : (p.y != q.y ? p.y > q.y : q.x > p.x);
}

Crossing cross_along_z(const Triangle& t, const glm::dvec2& point) {
    std::array<glm::dvec2, 3> at;
    for (int i = 0; i < 3; ++i)
        at[i] = glm::dvec2(t.corners[i]) - point;
    glm::dvec3 areas;
    int left = 0;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec2 p = at[(i + 1) % 3], q = at[(i + 2) % 3];
        areas[i] = p.x * q.y - p.y * q.x;
        left += is_left(areas[i], p, q) ? 1 : 0;
    }
    const double sum = areas.x + areas.y + areas.z;
    if ((left != 0 && left != 3) || sum == 0.0) // a needle along z is seen from its end
        return {};
    const glm::dvec3 heights(t.corners[0].z, t.corners[1].z, t.corners[2].z);
    return {left == 3 ? 1 : -1, glm::dot(areas, heights) / sum};
}

// Whether a triangle and a cube are apart along this direction.
bool are_apart(const Triangle& t, const glm::dvec3& middle, double half, const glm::dvec3& along) {
    const double a = glm::dot(t.corners[0] - middle, along), b = glm::dot(t.corners[1] - middle, along),
                 c = glm::dot(t.corners[2] - middle, along);
    const double reach = half * (std::abs(along.x) + std::abs(along.y) + std::abs(along.z));
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
}

// Whether it reaches into a cube whose box its own box meets (Akenine-Moller, "Fast 3D Triangle-Box Overlap Testing",
// 2001).
bool reaches_into(const Triangle& t, const glm::dvec3& middle, double half) {
    if (are_apart(t, middle, half, t.normal))
        return false;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 edge = t.corners[(i + 1) % 3] - t.corners[i];
        if (are_apart(t, middle, half, {0.0, -edge.z, edge.y}) || are_apart(t, middle, half, {edge.z, 0.0, -edge.x}) ||
            are_apart(t, middle, half, {-edge.y, edge.x, 0.0}))
            return false;
    }
    return true;
}

// A point of the unit cube, whose coordinates are those of no other (Roberts' sequence).
glm::dvec3 point_of_cube(int k) {
    const glm::dvec3 step(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
    const glm::dvec3 at = 0.5 + double(k) * step;
    return at - glm::floor(at);
}

class Builder {
public:
    explicit Builder(std::span<const glm::vec3> corners) : triangles_(read(corners)) {
        glm::dvec3 high(-std::numeric_limits<double>::infinity());
        found_.low = -high;
        for (const Triangle& t : triangles_) {
            found_.low = glm::min(found_.low, t.low());
            high = glm::max(high, t.high());
        }
        const glm::dvec3 size = high - found_.low;
        const double longest = std::max({size.x, size.y, size.z});
        reach_ = std::max({-found_.low.x, -found_.low.y, -found_.low.z, high.x, high.y, high.z});
        // About as many cubes with triangles as there are triangles.
        const double along = std::clamp(std::sqrt(double(triangles_.size()) / 4.0), double(fewest), double(most));
        found_.edge = longest / std::floor(along);
        dims_ = glm::max(glm::ivec3(glm::ceil(size / found_.edge - 1e-6)), 1);
        margin_ = 1e-4 * found_.edge + rounding * reach_;
        found_.cells = MajorantGrid{1, glm::ivec3(0), dims_, {}};
        found_.cells.bounds.assign(std::size_t(dims_.x) * dims_.y * dims_.z, 0.0f);
        lists_.resize(found_.cells.bounds.size());
    }

    InsideLattice build() {
        for (std::uint32_t i = 0; i < triangles_.size(); ++i)
            list(i);
        write_head();
        for (int x = 0; x < dims_.x; ++x)
            for (int y = 0; y < dims_.y; ++y)
                fill_column(x, y);
        found_.words[INSIDE_CORNERS] = static_cast<std::uint32_t>(found_.words.size());
        for (const Triangle& t : triangles_)
            for (const glm::dvec3& corner : t.corners)
                append(corner);
        return std::move(found_);
    }

private:
    std::size_t index(const glm::ivec3& cell) const {
        return (std::size_t(cell.x) * dims_.y + cell.y) * dims_.z + cell.z;
    }
    glm::dvec3 corner(const glm::ivec3& cell) const { return found_.low + found_.edge * glm::dvec3(cell); }

    void append(float value) { found_.words.push_back(std::bit_cast<std::uint32_t>(value)); }
    void append(const glm::dvec3& v) {
        for (int axis = 0; axis < 3; ++axis)
            append(static_cast<float>(v[axis]));
    }

    // In all cubes that it reaches into.
    void list(std::uint32_t i) {
        const Triangle& t = triangles_[i];
        const glm::ivec3 from = glm::clamp(glm::ivec3(glm::floor((t.low() - margin_ - found_.low) / found_.edge)),
                                           glm::ivec3(0), dims_ - 1);
        const glm::ivec3 to = glm::clamp(glm::ivec3(glm::floor((t.high() + margin_ - found_.low) / found_.edge)),
                                         glm::ivec3(0), dims_ - 1);
        for (int x = from.x; x <= to.x; ++x)
            for (int y = from.y; y <= to.y; ++y)
                for (int z = from.z; z <= to.z; ++z) {
                    if (!reaches_into(t, corner({x, y, z}) + 0.5 * found_.edge, 0.5 * found_.edge + margin_))
                        continue;
                    std::vector<std::uint32_t>& listed = lists_[index({x, y, z})];
                    if (listed.size() == most_listed)
                        throw InputError(fmt::format(
                            "more than {} triangles of a model meet within {:.3g} world units, as many as are rendered "
                            "beside other volumes; decimate it there, or keep it alone",
                            most_listed, found_.edge));
                    listed.push_back(i);
                }
    }

    void write_head() {
        append(found_.low);
        append(static_cast<float>(1.0 / found_.edge));
        for (int axis = 0; axis < 3; ++axis)
            found_.words.push_back(static_cast<std::uint32_t>(dims_[axis]));
        found_.words.push_back(0); // INSIDE_CORNERS, known at the end
        append(static_cast<float>(2.0 * reach_));
        found_.words.resize(INSIDE_HEAD + lists_.size(), 0);
    }

    // Bodies that a point of the column is within, by the triangles that the column has.
    int bodies(std::span<const std::uint32_t> column, const glm::dvec3& point) const {
        int number = 0;
        for (const std::uint32_t i : column)
            if (const Crossing crossing = cross_along_z(triangles_[i], glm::dvec2(point)); crossing.z > point.z)
                number += crossing.turn;
        return number;
    }

    void fill_column(int x, int y) {
        std::vector<std::uint32_t> column;
        for (int z = 0; z < dims_.z; ++z) {
            const std::vector<std::uint32_t>& list = lists_[index({x, y, z})];
            column.insert(column.end(), list.begin(), list.end());
        }
        std::sort(column.begin(), column.end());
        column.erase(std::unique(column.begin(), column.end()), column.end());
        int last = -1; // of a cube without triangles below, whether it is within; those above it are likewise
        for (int z = 0; z < dims_.z; ++z) {
            const std::size_t i = index({x, y, z});
            if (lists_[i].empty()) {
                if (last < 0)
                    last = bodies(column, corner({x, y, z}) + 0.5 * found_.edge) > 0 ? 1 : 0;
                found_.words[INSIDE_HEAD + i] = static_cast<std::uint32_t>(last);
                found_.cells.bounds[i] = static_cast<float>(last);
            } else {
                last = -1;
                record({x, y, z}, column);
            }
        }
    }

    void record(const glm::ivec3& cell, std::span<const std::uint32_t> column) {
        const std::size_t i = index(cell);
        const std::vector<std::uint32_t>& listed = lists_[i];
        found_.longest = std::max(found_.longest, static_cast<std::uint32_t>(listed.size()));
        found_.cells.bounds[i] = 1.0f;
        const glm::dvec3 point = point_apart(cell, listed);
        found_.words[INSIDE_HEAD + i] = static_cast<std::uint32_t>(found_.words.size());
        found_.words.push_back(static_cast<std::uint32_t>(listed.size()));
        found_.words.push_back(static_cast<std::uint32_t>(bodies(column, point)));
        append(point);
        found_.words.insert(found_.words.end(), listed.begin(), listed.end());
    }

    // One of the cube's that is apart from all triangles, as far as some are; in single precision.
    glm::dvec3 point_apart(const glm::ivec3& cell, std::span<const std::uint32_t> listed) const {
        glm::dvec3 best(0.0);
        double farthest = -1.0;
        for (int k = 0; k < most_tries && farthest < far_enough * far_enough * found_.edge * found_.edge; ++k) {
            const glm::dvec3 point(glm::vec3(corner(cell) + found_.edge * point_of_cube(k)));
            double nearest = std::numeric_limits<double>::infinity();
            for (const std::uint32_t i : listed)
                nearest = std::min(nearest, squared_distance(point, triangles_[i]));
            if (nearest > farthest) {
                farthest = nearest;
                best = point;
            }
        }
        return best;
    }

    InsideLattice found_;
    std::vector<Triangle> triangles_;
    std::vector<std::vector<std::uint32_t>> lists_; // by cube, of triangles
    glm::ivec3 dims_{0};
    double reach_ = 0.0;  // farthest coordinate
    double margin_ = 0.0; // that cubes are enlarged by
};

} // namespace

InsideLattice make_inside_lattice(std::span<const glm::vec3> triangles) {
    return Builder(triangles).build();
}

} // namespace vkvol
