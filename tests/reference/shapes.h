// Rays, and the part of a ray inside a convex shape.
#pragma once

#include <glm/glm.hpp>
#include <limits>

#include "scene.h"

namespace reference {

struct Ray {
    glm::dvec3 origin;
    glm::dvec3 direction; // unit in world space; after a map to index space still moves one world unit per t
    double reach = std::numeric_limits<double>::infinity(); // of what is asked: support() ends there

    glm::dvec3 at(double t) const { return origin + t * direction; }
};

// [t0, t1], empty unless t0 < t1.
struct Interval {
    double t0 = 0.0;
    double t1 = 0.0;

    bool empty() const { return !(t0 < t1); }
    double length() const { return empty() ? 0.0 : t1 - t0; }
};

Interval clip(const Interval& a, const Interval& b); // the part common to both

// The part of the whole line, t < 0 included, that is inside.
Interval intersect(const vkvol::Sphere& sphere, const Ray& ray);
Interval intersect(const vkvol::Box& box, const Ray& ray);
Interval intersect(const glm::dvec3& lower, const glm::dvec3& upper, const Ray& ray);

} // namespace reference
