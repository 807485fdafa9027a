// What a scene's media are made of, read from their files.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bvh.h"
#include "density_field.h"
#include "field_cache.h"
#include "majorant_grid.h"
#include "method.h"
#include "sky_map.h"
#include "superposition.h"

namespace vkvol {

// A grid with its majorants, or a mesh. Empty for spheres, boxes, no
// volume, or a grid without voxels.
struct LoadedMedium {
    std::optional<DensityField> field;
    std::optional<MajorantGrid> majorants;
    std::vector<shared::ControlCell> controls;  // per majorant cell, for the estimators that use them
    std::optional<DensityField> temperature;    // or colours, only if the scene wants their glow
    std::optional<DensityField> albedo;         // likewise of what multiplies the albedo
    std::vector<glm::vec3> blackbody;           // BLACKBODY_ENTRIES colours between 0 and the hottest kelvin, or none
    double hottest = 0.0;                       // kelvin
    std::vector<shared::PhaseNode> phase_nodes; // of a phase function that is a table
    std::optional<Mesh> mesh;
    std::optional<Bvh> bvh;            // about the middle of the mesh
    std::vector<std::string> warnings; // what the scene asks for and its files do not hold
};

// Those it has, in the order in which they lie in the device's buffers.
std::vector<const DensityField*> grids_of(const LoadedMedium& medium);

// Of each of the scene's volumes, in their order.
using Media = std::span<const LoadedMedium>;
struct Assets {
    std::vector<LoadedMedium> media;
    std::optional<Superposition> superposition; // of them, if there are several
    std::optional<SkyMap> sky;                  // the map of it, if the scene has one
    std::vector<std::string> warnings;
};

// Null where there is at most one medium.
inline const Superposition* whole_of(const Assets& assets) {
    return assets.superposition ? &*assets.superposition : nullptr;
}

// Opens the files, if the scene has any. Throws InputError, also for what is not supported. `kept`: grids that need not
// be read again.
Assets load_assets(const Scene& scene, const Method& method, FieldCache* kept = nullptr);

// For the next load_assets, of what is on the device now.
void keep_fields(FieldCache& kept, const Scene& scene, Assets assets);

// Extinction at density 1 [1 / world unit]. `field`: null but for grids.
Rgb world_sigma_t(const Volume& volume, const DensityField* field);

double largest(const Rgb& color);

// Walks over cells, of flights and of shadow rays, pass empty ones together; but not those voxel by voxel, nor over
// residuals.
bool leaps(const Method& method);

// Of the box around a mesh, world space.
glm::dvec3 lowest_corner(const Mesh& mesh);
glm::dvec3 box_center(const Mesh& mesh);

} // namespace vkvol
