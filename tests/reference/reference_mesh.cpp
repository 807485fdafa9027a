#include "reference_mesh.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace reference {

namespace {

// A corner as the ray sees it: depth along the ray, and position across it.
struct Projected {
    double x, y, depth;
};

class Projection {
public:
    explicit Projection(const Ray& ray) : origin_(ray.origin), d_(ray.direction) {
        // Any two vectors perpendicular to the ray; axis-parallel ones for axis-parallel rays, to round nothing there.
        const glm::dvec3 a = glm::abs(d_);
        const glm::dvec3 aside = a.x <= a.y && a.x <= a.z ? glm::dvec3(1, 0, 0)
                                 : a.y <= a.z             ? glm::dvec3(0, 1, 0)
                                                          : glm::dvec3(0, 0, 1);
        e1_ = glm::cross(aside, d_);
        e2_ = glm::cross(d_, e1_) / glm::dot(d_, d_); // right-handed: e1, e2, direction
    }
    Projected operator()(const glm::dvec3& p) const {
        const glm::dvec3 r = p - origin_;
        return {glm::dot(r, e1_), glm::dot(r, e2_), glm::dot(r, d_) / glm::dot(d_, d_)};
    }

private:
    glm::dvec3 origin_, d_, e1_, e2_;
};

double edge(const Projected& a, const Projected& b) {
    return a.x * b.y - a.y * b.x;
}

// Is the ray to the left of the edge from a to b? A ray that meets the edge is thought to be moved by (epsilon,
// epsilon^2), so that of the triangles that share an edge or a corner it always meets as many from before as from
// behind, and a closed surface stays closed.
bool left(const Projected& a, const Projected& b) {
    const double e = edge(a, b);
    if (e != 0.0)
        return e > 0.0;
    return a.y != b.y ? a.y > b.y : b.x > a.x;
}

struct Crossing {
    double t;
    int winding; // +1 on entering
};

} // namespace

std::vector<Interval> intersect(const Mesh& mesh, const Ray& ray) {
    const Projection project(ray);
    std::vector<Crossing> crossings;
    for (const auto& triangle : mesh.triangles) {
        const Projected a = project(triangle[0]), b = project(triangle[1]), c = project(triangle[2]);
        const bool side = left(a, b);
        if (left(b, c) != side || left(c, a) != side)
            continue;
        const double wa = edge(b, c), wb = edge(c, a), wc = edge(a, b), area = wa + wb + wc;
        const double t =
            area != 0.0 ? (wa * a.depth + wb * b.depth + wc * c.depth) / area : (a.depth + b.depth + c.depth) / 3.0;
        crossings.push_back({t, side ? -1 : 1}); // counterclockwise about the direction of travel: seen from within
    }
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.t != b.t ? a.t < b.t : a.winding > b.winding; });

    std::vector<Interval> inside;
    int winding = 0;
    double entry = 0.0;
    for (const Crossing& crossing : crossings) {
        const int before = winding;
        winding += crossing.winding;
        if (before <= 0 && winding > 0)
            entry = crossing.t;
        if (before > 0 && winding <= 0 && entry < crossing.t)
            inside.push_back({entry, crossing.t});
    }
    return inside;
}

} // namespace reference
