// What the renderer would give its kernels for a grid, a sphere or a box, and where render space lies.
#pragma once

#include "kernel_runner.h"

namespace vkvol {

struct TestScene {
    KernelScene kernel;
    Specialization specialization{};
    glm::dvec3 render_origin{0.0}; // in world coordinates
    bool chromatic = false;

    glm::vec3 to_render(glm::dvec3 world) const { return world - render_origin; }
};

// Estimators that a test kernel is to run, whatever an integrator would make of them. -1: delta and ratio tracking in a
// grid or in noise, analytic else.
struct TestEstimators {
    int free_flight = -1;
    int transmittance = -1;
    RenderSettings settings{};
};

// Control densities, for the estimators that use them; before the majorants are scaled. `volume`: coefficients per
// world unit.
void add_controls(LoadedMedium& loaded, const Volume& volume, const TestEstimators& estimators);

// `loaded`, kept by the caller, takes the place of the volume's shape.
TestScene make_test_scene(const LoadedMedium& loaded, Volume volume = {}, Filter filter = Filter::trilinear,
                          const TestEstimators& estimators = {});

// A sphere, box or mesh; `loaded` holds the mesh.
TestScene make_test_scene(const Volume& volume, const LoadedMedium& loaded = {}, const TestEstimators& estimators = {});

} // namespace vkvol
