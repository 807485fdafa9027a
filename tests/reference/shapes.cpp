#include "shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reference {

Interval clip(const Interval& a, const Interval& b) {
    return {std::max(a.t0, b.t0), std::min(a.t1, b.t1)};
}

Interval intersect(const vkvol::Sphere& sphere, const Ray& ray) {
    const double a = glm::dot(ray.direction, ray.direction);
    const double middle = glm::dot(sphere.center - ray.origin, ray.direction) / a; // closest approach
    const glm::dvec3 miss = ray.at(middle) - sphere.center;
    const double h2 = sphere.radius * sphere.radius - glm::dot(miss, miss);
    if (h2 <= 0.0)
        return {};
    const double half = std::sqrt(h2 / a);
    return {middle - half, middle + half};
}

Interval intersect(const vkvol::Box& box, const Ray& ray) {
    return intersect(box.center - 0.5 * box.size, box.center + 0.5 * box.size, ray);
}

Interval intersect(const glm::dvec3& lower, const glm::dvec3& upper, const Ray& ray) {
    const double infinity = std::numeric_limits<double>::infinity();
    Interval inside{-infinity, infinity};
    for (int axis = 0; axis < 3; ++axis) {
        const double o = ray.origin[axis], d = ray.direction[axis];
        if (d == 0.0) {
            if (o < lower[axis] || o > upper[axis])
                return {};
            continue;
        }
        const double a = (lower[axis] - o) / d, b = (upper[axis] - o) / d;
        inside = clip(inside, {std::min(a, b), std::max(a, b)});
    }
    return inside.empty() ? Interval{} : inside;
}

} // namespace reference
