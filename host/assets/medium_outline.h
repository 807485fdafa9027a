// Where the medium is and how dense it is at most: what is kept of it while its picture is rendered, to explain the
// picture by.
#pragma once

#include <memory>
#include <optional>

#include "loaded_medium.h"

namespace vkvol {

struct MediumOutline {
    bool exists = false;  // false: no volume, no voxel, or an extinction of 0, and what follows means nothing
    bool is_ball = false; // the unit ball of medium space; else the box
    bool fills = true;    // the ball or box; meshes are somewhere in theirs
    glm::dmat4 to_world{1.0}, from_world{1.0}; // from medium space, which is a grid's index space
    glm::dvec3 low{-1.0}, high{1.0};
    double sigma_t = 0.0;                      // the largest channel's [1 / world unit], times
    double densest = 1.0;                      // which no density exceeds
    std::shared_ptr<const MajorantGrid> cells; // of grids, times
    double cell_scale = 1.0;                   // which makes their bounds the density's own again
    double voxel = 0.0;                        // world units; 0: no grid
    bool emits = false;                        // uniformly, or by its temperature
    bool has_temperature = false;
    double hottest = 0.0; // kelvin, of black bodies
};

MediumOutline make_outline(const Scene& scene, const Volume& volume, const LoadedMedium& loaded, bool emits);
// Likewise, of several media.
MediumOutline make_outline(const Superposition& whole, bool emits);

struct WorldBox {
    glm::dvec3 low, high;
};
WorldBox world_box(const MediumOutline& outline);

// Of the ball or box, a place in the world.
bool is_within(const MediumOutline& outline, const glm::dvec3& place);
// There: the bound of its cell is above 0.
bool may_have_matter(const MediumOutline& outline, const glm::dvec3& place);

// How far along the ray it enters the ball or box and leaves it, in lengths of `direction`; the former is 0 from
// within. None if it misses.
std::optional<glm::dvec2> crossing(const MediumOutline& outline, glm::dvec3 origin, glm::dvec3 direction);

// No more than this is the optical depth along the ray.
double depth_bound(const MediumOutline& outline, glm::dvec3 origin, glm::dvec3 direction);

} // namespace vkvol
