// What a scene's media are made of, read from their files.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bvh.h"
#include "density_field.h"
#include "field_cache.h"
#include "inside_lattice.h"
#include "majorant_grid.h"
#include "method.h"
#include "sky_map.h"
#include "superposition.h"

namespace vkvol {

// As walks have them: scaled.
struct Majorants : MajorantGrid {
    explicit Majorants(MajorantGrid grid);
    double mean = 0.0, most = 0.0; // of the bounds
};

// A grid with its majorants, layers with theirs, or a mesh. Empty for other spheres, boxes and what is everywhere, no
// volume, or a grid without voxels. What is large in it is shared by all that have the same.
struct LoadedMedium {
    std::optional<DensityField> field;
    std::shared_ptr<const Majorants> majorants; // of several media chosen as suits the first that has the grid
    std::vector<shared::ControlCell> controls;  // per majorant cell, for the estimators that use them
    std::optional<DensityField> temperature;    // or colours, only if the scene wants their glow
    std::optional<DensityField> albedo;         // likewise of what multiplies the albedo
    float largest_temperature = 0.0f;           // or channel of a colour, as the grid has it
    SharedArray<glm::vec4> blackbody;           // BLACKBODY_ENTRIES colours between 0 and the hottest kelvin, or none
    double hottest = 0.0;                       // kelvin
    SharedArray<shared::PhaseNode> phase_nodes; // of a phase function that is a table
    SharedArray<shared::MapKnot> map_knots;     // of a map from the grid's values; all of a scene's are as long
    bool is_layered = false;                    // whose majorants are across layers: see layers.h
    std::optional<Mesh> mesh;
    std::optional<Bvh> bvh;                      // about the middle of the mesh, which is alone
    std::shared_ptr<const InsideLattice> inside; // of a mesh among several media, likewise
    std::vector<std::string> warnings;           // what the scene asks for and its files do not hold
};

// Those it has.
std::vector<const DensityField*> grids_of(const LoadedMedium& medium);

// The scene's volumes as loaded, in their order.
using Media = std::span<const LoadedMedium>;

// What its grid of temperatures or colours reaches, in the brightest channel; 0 without one, infinite if single
// precision has no such number.
double hottest_radiance(const Volume& volume, const LoadedMedium& loaded);

// Each grid that any of them has, once, in the order in which they first come: the same bytes are the same grid,
// wherever media have put it.
std::vector<const DensityField*> distinct_grids(Media media);

struct Assets {
    std::vector<LoadedMedium> media;
    std::optional<Superposition> superposition; // of them, if there are several
    std::shared_ptr<const SkyMap> sky;          // the map of it, if the scene has one
    std::vector<std::string> warnings;
};

// Null where there is at most one medium.
inline const Superposition* whole_of(const Assets& assets) {
    return assets.superposition ? &*assets.superposition : nullptr;
}

// Opens the files, if the scene has any. Throws InputError, also for what is not supported. `kept`: grids that need not
// be read again; those of the scene are among them then, and no others. `skies`: likewise for its map of the sky.
Assets load_assets(const Scene& scene, const Method& method, FieldCache* kept = nullptr, SkyCache* skies = nullptr);

// Grids that they may be asked for.
std::vector<GridFile> grid_files(const Scene& scene);

// Extinction at density 1 [1 / world unit]. `field`: null but for grids.
Rgb world_sigma_t(const Volume& volume, const DensityField* field);

double largest(const Rgb& color);

// Walks over cells, of flights and of shadow rays, pass empty ones together; but not those voxel by voxel, nor over
// residuals.
bool leaps(const Method& method);

// Lowest corner and middle of the box around a mesh, world space.
glm::dvec3 lowest_corner(const Mesh& mesh);
glm::dvec3 box_center(const Mesh& mesh);

} // namespace vkvol
