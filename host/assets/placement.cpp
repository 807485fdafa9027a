#include "placement.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "layers.h"

namespace vkvol {

glm::ivec3 index_base(const DensityField& field) {
    const auto longest = [](glm::ivec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); };
    const glm::ivec3 middle = (field.voxel_min >> 1) + (field.voxel_max >> 1);
    const int size = longest(field.voxel_max - field.voxel_min);
    return longest(middle) < std::max(4096, 4 * size) ? glm::ivec3(0) : middle & ~7;
}

glm::dmat4 index_to_world(const DensityField& field) {
    return glm::translate(field.index_to_world, glm::dvec3(index_base(field)));
}

UnmovedShape unmoved_shape(const Volume& volume, const LoadedMedium& loaded) {
    if (const auto* sphere = std::get_if<Sphere>(&volume.shape))
        return {sphere->center, glm::dvec3(sphere->radius)};
    if (const auto* box = std::get_if<Box>(&volume.shape))
        return {box->center, box->size / 2.0};
    if (is_everywhere(volume))
        return {glm::dvec3(0.0), glm::dvec3(everywhere_reach)};
    return loaded.mesh ? UnmovedShape{box_center(*loaded.mesh)} : UnmovedShape{};
}

glm::dmat4 medium_to_world(const Volume& volume, const LoadedMedium& loaded) {
    if (loaded.field)
        return index_to_world(*loaded.field);
    if (loaded.is_layered) {
        const LayerBox box = layer_box(volume);
        return volume.transform *
               glm::scale(glm::translate(glm::dmat4(1.0), box.low), box.size / glm::dvec3(loaded.majorants->dims));
    }
    const UnmovedShape shape = unmoved_shape(volume, loaded);
    const glm::dmat4 placed = glm::scale(glm::translate(glm::dmat4(1.0), shape.center), shape.half);
    return loaded.mesh ? placed : volume.transform * placed; // a mesh's vertices have been moved
}

// What is everywhere reaches so far that heights would be lost if all of its placing were undone at once.
glm::dmat4 world_to_medium(const Volume& volume, const LoadedMedium& loaded) {
    if (!loaded.is_layered)
        return glm::inverse(medium_to_world(volume, loaded));
    const LayerBox box = layer_box(volume);
    return glm::translate(glm::scale(glm::dmat4(1.0), glm::dvec3(loaded.majorants->dims) / box.size), -box.low) *
           glm::inverse(volume.transform);
}

MediumBounds medium_bounds(const LoadedMedium& loaded) {
    if (loaded.is_layered)
        return {glm::dvec3(0.0), glm::dvec3(loaded.majorants->dims)};
    if (loaded.mesh) { // about its middle, in world units
        const glm::dvec3 half = box_center(*loaded.mesh) - lowest_corner(*loaded.mesh);
        return {-half, half};
    }
    if (!loaded.field)
        return {};
    const glm::ivec3 base = index_base(*loaded.field);
    return {glm::dvec3(loaded.field->voxel_min - base) - 1.0, glm::dvec3(loaded.field->voxel_max - base) + 1.0};
}

double diagonal_of(const Volume& volume, const LoadedMedium& loaded) {
    if (loaded.mesh)
        return 2.0 * glm::length(box_center(*loaded.mesh) - lowest_corner(*loaded.mesh));
    const MediumBounds bounds = medium_bounds(loaded);
    const glm::dmat3 to_world(medium_to_world(volume, loaded));
    double longest = 0.0;
    for (const double y : {-1.0, 1.0})
        for (const double z : {-1.0, 1.0})
            longest = std::max(longest, glm::length(to_world * ((bounds.high - bounds.low) * glm::dvec3(1.0, y, z))));
    return longest;
}

double distance_to(const Volume& volume, const LoadedMedium& loaded, const glm::dvec3& position) {
    const glm::dvec3 inside = world_to_medium(volume, loaded) * glm::dvec4(position, 1.0);
    const MediumBounds bounds = medium_bounds(loaded);
    return glm::length(glm::dmat3(medium_to_world(volume, loaded)) *
                       (inside - glm::clamp(inside, bounds.low, bounds.high)));
}

glm::dvec3 middle_of(const Volume& volume, const LoadedMedium& loaded) {
    if (loaded.is_layered) {
        const LayerBox box = layer_box(volume);
        return glm::dvec3(volume.transform * glm::dvec4(box.low + 0.5 * box.size, 1.0));
    }
    const MediumBounds bounds = medium_bounds(loaded);
    return glm::dvec3(medium_to_world(volume, loaded) * glm::dvec4((bounds.low + bounds.high) / 2.0, 1.0));
}

} // namespace vkvol
