// What a scene's medium is made of, read from its files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bvh.h"
#include "density_field.h"
#include "field_cache.h"
#include "majorant_grid.h"
#include "method.h"

namespace vkvol {

// A grid with its majorants, or a mesh. Empty for spheres, boxes, no
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

// Opens the files, if the scene has any. Throws InputError. `kept`: grids that need not be read again.
LoadedVolume load_volume(const Scene& scene, const Method& method, FieldCache* kept = nullptr);

// For the next load_volume, of what is on the device now.
void keep_fields(FieldCache& kept, const Scene& scene, LoadedVolume volume);

// The scene's one volume, or null. Throws InputError for several.
const Volume* find_volume(const Scene& scene);

// Extinction at density 1 [1 / world unit]. `field`: null but for grids.
Rgb world_sigma_t(const Volume& volume, const DensityField* field);

double largest(const Rgb& color);

// Of the box around a mesh, world space.
glm::dvec3 lowest_corner(const Mesh& mesh);
glm::dvec3 box_center(const Mesh& mesh);

} // namespace vkvol
