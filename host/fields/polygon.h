// Polygons of mesh files, as triangles.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace vkvol {

// Numbers of its corners, three at least, for two triangles less than that, turned as it is. Where it is convex, a fan
// about its first corner; else ears are cut off it one by one, so that none is folded over another (Meisters, "Polygons
// have ears", 1975). One that crosses itself, or that is not convex and has more corners than `most_to_cut`, is a fan,
// of which some triangles face the other way: their signed sum is the polygon still.
std::vector<glm::uvec3> triangles_of_polygon(std::span<const glm::dvec3> corners);

inline constexpr std::size_t most_to_cut = 4096; // which takes a second at most

} // namespace vkvol
