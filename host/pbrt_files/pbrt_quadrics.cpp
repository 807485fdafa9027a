#include "pbrt_quadrics.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <numbers>

#include "surfaces.h"

namespace vkvol {

namespace {

using std::numbers::pi;
constexpr int around = 128, along = 64; // triangles' edges of a whole turn, and from pole to pole

struct Point {
    glm::dvec3 position, normal;
};

double radius_of(const PbrtThing& shape) {
    const double radius = shape.parameters->number("radius", 1.0);
    if (!(radius > 0.0 && std::isfinite(radius)))
        fail_at(shape.place, fmt::format("{} of radius {:g}; expected more than 0", shape.type, radius));
    return radius;
}

double turn_of(const PbrtThing& shape) {
    return std::clamp(shape.parameters->number("phimax", 360.0), 0.0, 360.0) * pi / 180.0;
}

// Parts of the radius, from the lower to the upper one.
glm::dvec2 heights_of_sphere(const PbrtThing& shape) {
    const PbrtParameters& p = *shape.parameters;
    const double radius = radius_of(shape), a = p.number("zmin", -radius), b = p.number("zmax", radius);
    return glm::clamp(glm::dvec2(std::min(a, b), std::max(a, b)) / radius, -1.0, 1.0);
}

// A lattice over (u, v), both in [0, 1]; pbrt's normal is on the side from which u and then v go counter-clockwise.
// What goes all around ends where it began, to the last digit.
PbrtTriangles lattice(double turn, int columns, int rows, const std::function<Point(double, double)>& at) {
    PbrtTriangles mesh;
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column <= columns; ++column) {
            const double u = double(column) / columns, v = double(row) / rows;
            const Point point = at(u == 1.0 && turn == 2.0 * pi ? 0.0 : u, v);
            mesh.points.push_back(point.position);
            mesh.normals.push_back(point.normal);
            mesh.places.emplace_back(u, v);
        }
    const auto is_degenerate = [&](const glm::uvec3& t) {
        const auto edge = [&](unsigned from, unsigned to) { return glm::length(mesh.points[to] - mesh.points[from]); };
        const double shortest = std::min({edge(t.x, t.y), edge(t.y, t.z), edge(t.z, t.x)});
        return !(shortest > 1e-12 * glm::length(mesh.points[t.x]));
    };
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const auto corner = static_cast<unsigned>(row * (columns + 1) + column);
            const unsigned next = corner + static_cast<unsigned>(columns) + 1;
            for (const glm::uvec3 t : {glm::uvec3(corner, corner + 1, next + 1), glm::uvec3(corner, next + 1, next)})
                if (!is_degenerate(t))
                    mesh.triangles.push_back(t);
        }
    return mesh;
}

int columns_of(double turn) {
    return std::max(3, static_cast<int>(std::ceil(around * turn / (2.0 * pi))));
}

PbrtTriangles sphere(const PbrtThing& shape) {
    const double radius = radius_of(shape), turn = turn_of(shape);
    const glm::dvec2 heights = heights_of_sphere(shape);
    const double low = std::acos(heights.x), high = std::acos(heights.y); // angles from the upper pole
    const int rows = std::max(2, static_cast<int>(std::ceil(along * (low - high) / pi)));
    return lattice(turn, columns_of(turn), rows, [&](double u, double v) {
        const double theta = low + v * (high - low), phi = u * turn;
        const double across = theta > 0.0 && theta < pi ? std::sin(theta) : 0.0;
        const glm::dvec3 outward(across * std::cos(phi), across * std::sin(phi), std::cos(theta));
        return Point{radius * outward, outward};
    });
}

PbrtTriangles cylinder(const PbrtThing& shape) {
    const PbrtParameters& p = *shape.parameters;
    const double radius = radius_of(shape), turn = turn_of(shape);
    const double a = p.number("zmin", -1.0), b = p.number("zmax", 1.0);
    return lattice(turn, columns_of(turn), 1, [&](double u, double v) {
        const glm::dvec3 outward(std::cos(u * turn), std::sin(u * turn), 0.0);
        return Point{radius * outward + glm::dvec3(0.0, 0.0, std::min(a, b) + v * std::abs(b - a)), outward};
    });
}

PbrtTriangles disk(const PbrtThing& shape) {
    const PbrtParameters& p = *shape.parameters;
    const double radius = radius_of(shape), turn = turn_of(shape), height = p.number("height", 0.0);
    const double inner = std::clamp(p.number("innerradius", 0.0), 0.0, radius);
    return lattice(turn, columns_of(turn), 1, [&](double u, double v) {
        const double r = radius + v * (inner - radius);
        return Point{{r * std::cos(u * turn), r * std::sin(u * turn), height}, {0.0, 0.0, 1.0}};
    });
}

bool is_similarity(const glm::dmat3& map) {
    const glm::dmat3 square = glm::transpose(map) * map;
    const double size = (square[0][0] + square[1][1] + square[2][2]) / 3.0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (!(std::abs(square[i][j] - (i == j ? size : 0.0)) <=
                  0.5 * stretch_of_digits * size)) // with room for another mean
                return false;
    return true;
}

} // namespace

bool is_whole_ball_or_disk(const PbrtThing& shape, const glm::dmat4& map) {
    if (turn_of(shape) < 2.0 * pi || !is_similarity(glm::dmat3(map)))
        return false;
    if (shape.type == "disk")
        return shape.parameters->number("innerradius", 0.0) <= 0.0;
    return shape.type == "sphere" && heights_of_sphere(shape) == glm::dvec2(-1.0, 1.0);
}

PbrtTriangles quadric_triangles(const PbrtThing& shape) {
    PbrtTriangles mesh = shape.type == "sphere" ? sphere(shape) : shape.type == "disk" ? disk(shape) : cylinder(shape);
    if (mesh.triangles.empty())
        fail_at(shape.place, fmt::format("{} has no area; expected heights, radii and angles that differ", shape.type));
    return mesh;
}

} // namespace vkvol
