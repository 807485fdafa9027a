#include "mesh_chords.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vkvol {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

Convex convex_box(glm::dvec3 low, glm::dvec3 high) {
    Convex body;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 normal(0.0);
        normal[axis] = 1.0;
        body.planes.emplace_back(normal, high[axis]);
        body.planes.emplace_back(-normal, -low[axis]);
    }
    return body;
}

Convex convex_hull(const Mesh& mesh) {
    Convex body;
    for (const glm::uvec3 t : mesh.triangles) {
        const glm::dvec3 a = mesh.vertices[t.x];
        const glm::dvec3 n = glm::normalize(glm::cross(mesh.vertices[t.y] - a, mesh.vertices[t.z] - a));
        body.planes.emplace_back(n, glm::dot(n, a));
    }
    return body;
}

double chord(const std::vector<Convex>& bodies, const Line& line, double margin) {
    const glm::dvec3 o = line.origin, d = line.direction;
    std::vector<std::pair<double, double>> parts;
    for (const Convex& body : bodies) {
        double t0 = 0.0, t1 = infinity;
        for (const glm::dvec4& plane : body.planes) {
            const double height = plane.w + margin - glm::dot(glm::dvec3(plane), o),
                         speed = glm::dot(glm::dvec3(plane), d);
            if (speed > 0.0)
                t1 = std::min(t1, height / speed);
            else if (speed < 0.0)
                t0 = std::max(t0, height / speed);
            else if (height < 0.0)
                t1 = -infinity;
        }
        if (t0 < t1)
            parts.emplace_back(t0, t1);
    }
    std::sort(parts.begin(), parts.end());
    double length = 0.0, reached = 0.0;
    for (const auto& [t0, t1] : parts) {
        length += std::max(t1 - std::max(t0, reached), 0.0);
        reached = std::max(reached, t1);
    }
    return length;
}

std::vector<Crossing> find_crossings(std::span<const glm::vec3> triangles, const Line& line, double margin,
                                     bool& unsure) {
    const glm::dvec3 o = line.origin, d = line.direction;
    std::vector<Crossing> crossings;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const glm::dvec3 p[3] = {glm::dvec3(triangles[i]) - o, glm::dvec3(triangles[i + 1]) - o,
                                 glm::dvec3(triangles[i + 2]) - o};
        double side[3];
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 a = p[(k + 1) % 3], b = p[(k + 2) % 3];
            side[k] = glm::dot(d, glm::cross(a, b));
            const double length = glm::length(glm::cross(d, b - a)); // of the edge as seen along the ray
            const double along = glm::dot(-(a - glm::dot(a, d) * d), b - a - glm::dot(b - a, d) * d);
            if (std::abs(side[k]) < margin * length && along > -margin * length && along < length * (length + margin))
                unsure = true;
        }
        const double sum = side[0] + side[1] + side[2];
        const bool left = side[0] > 0 && side[1] > 0 && side[2] > 0, right = side[0] < 0 && side[1] < 0 && side[2] < 0;
        if (!left && !right)
            continue;
        const double t = glm::dot(d, side[0] * p[0] + side[1] * p[1] + side[2] * p[2]) / sum;
        const glm::dvec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
        if (std::abs(glm::dot(normal, d)) < 0.01 || std::abs(t) < 100.0 * margin)
            unsure = true;
        if (t > 0.0)
            crossings.push_back({t, left ? 1 : -1});
    }
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
    return crossings;
}

double inside_length(const std::vector<Crossing>& crossings) {
    int winding = 0;
    for (const Crossing& c : crossings)
        winding += c.turn;
    double length = 0.0, before = 0.0;
    for (const Crossing& c : crossings) {
        length += winding > 0 ? c.t - before : 0.0;
        winding -= c.turn;
        before = c.t;
    }
    return length;
}

} // namespace vkvol
