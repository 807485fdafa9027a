// Stand-ins for the bunny cloud and the fire of the thesis' scenes: a cloud and a fireball of our own, moved and scaled
// so that its cameras see them as large, and as far away, as they saw the originals.
#include "recipes.h"

namespace vkvol {
namespace {

// A point x of the thesis' world is at scale * x + offset in that of `field`.
Field seen_from_thesis(Field field, double scale, glm::dvec3 offset) {
    field.voxel_size /= scale;
    field.origin = (field.origin - offset) / scale;
    return field;
}

} // namespace

Field make_bunny_cloud(int size, std::uint32_t seed) {
    return seen_from_thesis(make_cumulus(size, seed), 1.2, {2.0, -3.8, 2.8});
}

Field make_fire(int size, std::uint32_t seed) {
    return seen_from_thesis(make_explosion(size, seed), 0.45, {0.15, 4.5, 0.0});
}

} // namespace vkvol
