// From the authored scene to what the kernels see. The only place that fills the shared structs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bvh.h"
#include "compute_pass.h"
#include "density_field.h"
#include "majorant_grid.h"
#include "method.h"
#include "shared/scene.h"

namespace vkvol {

// What the medium is made of, read from its files: a grid with its majorants, or a mesh. Empty for spheres, boxes, no
// volume, or a grid without voxels.
struct LoadedVolume {
    std::optional<DensityField> field;
    std::optional<MajorantGrid> majorants;
    std::vector<shared::ControlCell> controls; // per majorant cell, for the estimators that use them
    std::optional<DensityField> temperature;   // only if the scene wants its glow
    std::vector<glm::vec3> blackbody;          // BLACKBODY_ENTRIES colours between 0 and the hottest kelvin, or none
    double hottest = 0.0;                      // kelvin
    std::optional<Mesh> mesh;
    std::optional<Bvh> bvh;            // about the middle of the mesh
    std::vector<std::string> warnings; // what the scene asks for and its files do not hold
};

// Opens the files, if the scene has any. Throws InputError.
LoadedVolume load_volume(const Scene& scene, const Method& method);

// Extinction or albedo differs between the colour channels.
bool is_chromatic(const Scene& scene);

// Value of every specialization constant. What the scene lacks is switched off here and compiles to nothing.
Specialization specialize(const Scene& scene, const LoadedVolume& volume, const Method& method);

// All but the fields that change during a render (crop_y) or belong to the queues.
shared::FrameParams make_frame(const Scene& scene, const LoadedVolume& volume, const Method& method, Crop crop,
                               std::uint32_t seed);

} // namespace vkvol
