// From the authored scene to what the kernels see. The only place that fills the shared structs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compute_pass.h"
#include "density_field.h"
#include "integrators.h"
#include "majorant_grid.h"
#include "shared/scene.h"

namespace vkvol {

// The grid of a scene's volume with its majorants; empty for spheres, boxes, no volume, or a grid without voxels.
struct LoadedVolume {
    std::optional<DensityField> field;
    std::optional<MajorantGrid> majorants;
    std::optional<DensityField> temperature; // only if the scene wants its glow
    std::vector<glm::vec3> blackbody;        // BLACKBODY_ENTRIES colours between 0 and the hottest kelvin, or none
    double hottest = 0.0;                    // kelvin
    std::vector<std::string> warnings;       // what the scene asks for and its files do not hold
};

// Opens the grid, if the scene has one. Throws InputError.
LoadedVolume load_volume(const Scene& scene);

// Value of every specialization constant. What the scene lacks is switched off here and compiles to nothing.
Specialization specialize(const Scene& scene, const LoadedVolume& volume, const Integrator& integrator);

// All but the fields that change during a render (crop_y) or belong to the queues.
shared::FrameParams make_frame(const Scene& scene, const LoadedVolume& volume, Crop crop, std::uint32_t seed);

} // namespace vkvol
