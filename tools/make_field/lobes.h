// Convex lobes that carry smaller lobes: the skeleton of everything that billows.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace vkvol {

struct Lobe {
    glm::dvec3 center{0.0};
    double radius = 1.0;
};

// How one generation of lobes grows on the surface of the one before.
struct Budding {
    int children = 12;      // tried per parent
    double smallest = 0.35; // radius of a child over that of its parent
    double largest = 0.6;
    double upward = 0.4; // added to the y of a uniform direction: > 0 makes more buds on top
    double sunk = 0.3;   // how far the child's centre lies below the parent's surface, over the child's radius
    double lowest = 0.0; // children with a centre below this height are dropped
};

// Children of all `parents`. A child that lies inside another parent would not show and is dropped.
std::vector<Lobe> bud(const std::vector<Lobe>& parents, const Budding& rule, std::uint32_t seed);

// The union of lobes as a distance field, negative inside, smoothed where lobes meet.
class LobeUnion {
public:
    // `smoothing`: width of the fillet between two lobes over the radius of the smaller one.
    // Distances are good up to `reach` outside of the surface; beyond it they are only known to be larger.
    LobeUnion(const std::vector<Lobe>& lobes, double smoothing, double reach);

    // The lobes that matter in a cube; valid for every point in it.
    std::vector<Lobe> near(glm::dvec3 center, double half_width) const;
    double distance(const std::vector<Lobe>& near, glm::dvec3 p) const;

private:
    std::vector<Lobe> lobes_;
    double smoothing_, reach_;
};

} // namespace vkvol
