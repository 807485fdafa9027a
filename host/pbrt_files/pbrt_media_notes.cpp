// The part of PbrtTranslator that notes where media end in pbrt and not here.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "pbrt_sides.h"
#include "pbrt_translator.h"
#include "pbrt_voxels.h"

namespace vkvol {

namespace {

// How often a closed mesh winds about p, by the solid angles of its triangles (van Oosterom and Strackee 1983).
double winding(const PbrtTriangles& mesh, const glm::dvec3& p) {
    double angle = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.points[t.x] - p, b = mesh.points[t.y] - p, c = mesh.points[t.z] - p;
        const double u = glm::length(a), v = glm::length(b), w = glm::length(c);
        angle += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                  u * v * w + glm::dot(a, b) * w + glm::dot(b, c) * u + glm::dot(c, a) * v);
    }
    return angle / (4.0 * std::numbers::pi);
}

// Whether the grid's box is within these triangles, by its corners, or they are but a rectangle, one of several.
bool is_about(const PbrtShape& shape, const PbrtThing& medium) {
    if (shape.thing.type != "trianglemesh" && shape.thing.type != "bilinearmesh")
        return false;
    PbrtTriangles mesh = moved(shape.thing.transform, read_triangles(shape.thing), false);
    mesh.normals.clear(); // by which its triangles go round now
    if (as_rectangle(mesh))
        return true;
    const PbrtBounds bounds = bounds_of(medium);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 along = 1e-4 + (1.0 - 2e-4) * glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 p(medium.transform * glm::dvec4(bounds.low + bounds.size * along, 1.0));
        if (std::abs(winding(mesh, p)) < 0.5)
            return false;
    }
    return true;
}

} // namespace

void PbrtTranslator::note_what_is_not_cut(const PbrtShape& shape, const std::string& name, const PbrtThing& medium) {
    if (!is_dense(medium))
        return;
    const std::optional<Region> region = region_of(shape);
    if (!region && is_about(shape, medium))
        return;
    if (!region || region->element.empty())
        return note(shape.thing.place, fmt::format("the grid of medium \"{}\" fills its box, whatever of it is within "
                                                   "this: shapes do not cut grids here",
                                                   name));
    const PbrtBounds bounds = bounds_of(medium);
    const glm::dmat4 to_region = glm::inverse(region->transform) * world_ * medium.transform;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 own = bounds.low + bounds.size * glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 p(to_region * glm::dvec4(own, 1.0));
        const double reach = region->element == "sphere"
                                 ? glm::length(p)
                                 : 2.0 * std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        if (reach > 1.0 + 1e-5)
            return note(shape.thing.place, fmt::format("the grid of medium \"{}\" reaches beyond this, and is there "
                                                       "beyond it too: shapes do not cut grids here",
                                                       name));
    }
}

// Notes what becomes of a homogeneous medium outside of a shape.
void PbrtTranslator::note_beyond(const PbrtShape& shape, const std::string& medium) {
    if (medium != scene_.camera_medium && media_within_.count(medium) == 0)
        note(shape.thing.place,
             fmt::format("medium \"{}\" is outside of this, as its normals point, and neither the camera's nor within "
                         "another shape: it is left out",
                         medium));
    else if (lets_light_in(shape))
        note(shape.thing.place,
             fmt::format("medium \"{}\" goes on within: media add up where they overlap here", medium));
}

// Homogeneous media that are around this region's middle as well, by shapes of their own.
void PbrtTranslator::note_media_around(const PbrtShape& shape, const Region& region) {
    if (region.element.empty() || bounded_.size() > 1000) // which would take long
        return;
    for (const auto& [other, medium, around] : bounded_) {
        const bool is_larger = std::abs(glm::determinant(glm::dmat3(around.transform))) >
                               std::abs(glm::determinant(glm::dmat3(region.transform)));
        if (other != &shape && is_larger && has_point(*other, around, region.transform[3]) &&
            noted_around_.emplace(medium, sides_of(shape).within).second)
            note(shape.thing.place,
                 fmt::format("medium \"{}\" goes on within and beyond this: media add up where they overlap here; "
                             "pbrt's rays leave it here, since the MediumInterface has none outside",
                             medium));
    }
}

} // namespace vkvol
