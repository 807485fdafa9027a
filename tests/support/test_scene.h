// What the renderer would give its kernels for a grid, a sphere or a box, and where render space lies.
#pragma once

#include "kernel_runner.h"

namespace vkvol {

struct TestScene {
    KernelScene kernel;
    Specialization specialization{};
    glm::dvec3 render_origin{0.0}; // in world coordinates

    glm::vec3 to_render(glm::dvec3 world) const { return world - render_origin; }
};

// `loaded`, kept by the caller, takes the place of the volume's shape.
TestScene make_test_scene(const LoadedVolume& loaded, Volume volume = {}, Filter filter = Filter::trilinear);

// A sphere or box.
TestScene make_test_scene(const Volume& volume);

} // namespace vkvol
