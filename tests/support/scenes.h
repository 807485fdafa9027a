// Small scenes built in code, and small grids in temporary files that renderer and reference both open.
#pragma once

#include "test_grids.h"
#include "test_meshes.h"
#include "test_sky.h"

namespace vkvol {

// A file of its own, removed when the tests end. The GridFile names the first of the grids.
GridFile write_grids(const std::vector<GridRecipe>& grids);
GridFile write_grid(const GridRecipe& grid);

// Likewise a mesh, as .obj.
MeshFiles write_mesh(const Mesh& mesh);

// Likewise a map of the sky, as .exr.
SkyLight write_sky(const RadianceMap& map, SkyMapping mapping = SkyMapping::equirectangular);

// Likewise a text.
std::filesystem::path write_text(const std::string& text);

// A medium's phase function of every kind, with what it takes, by names.
struct NamedPhase {
    std::string name;
    PhaseFunction kind;
    double g = 0.0;
    PhaseDetails details = {};

    Volume of(Volume volume) const;
};
std::vector<NamedPhase> all_phases();

// Middle of a grid's voxels, in world space.
glm::dvec3 center_of(const GridRecipe& grid);

// Four octaves of value noise, a third of it cut to 0; in [0, 1].
float cloud_noise(glm::ivec3 voxel);

// 32 x 28 x 30 voxels of cloud_noise, index origin negative, voxels 0.3 world units long, about the world's origin.
GridRecipe cloud_grid(Storage storage = Storage::float32);
const GridFile& cloud_file(); // the same in every test

// sigma_t and albedo instead of the two coefficients; per world unit.
Volume medium(decltype(Volume::shape) shape, double sigma_t, double albedo, double g = 0.0);

// A ball with noise in it.
Volume smoke();

// Of cloud_grid().
Volume thin_cloud();

// From z = -1 to 0 and so wide that what it lacks of an endless one is the light within 1e-4 of grazing.
Volume slab(double tau, double albedo);

// The scene, rendered so.
Scene by(Scene scene, const char* integrator);

// A square picture of the volume: the camera looks at `target` from `distance`, turned by the angles, and sees a field
// `width` across at the target.
Scene scene_of(const Volume& volume, double width, int pixels, double distance = 10.0,
               glm::dvec3 target = glm::dvec3(0.0), glm::dvec3 pitch_yaw_roll = glm::dvec3(0.0));

// What is absorbed in each of the cells of a box.
Scene absorption(glm::dvec3 middle, glm::dvec3 edges, glm::ivec3 cells, std::uint32_t spp);

// One of each kind, about a body some 3 across amid the world.
struct LightsAbout {
    PointLight point{{1.2, 1.9, 1.5}, {12.0, 9.0, 6.0}};
    SpotLight spot{{-1.5, 2.5, 1.0}, glm::normalize(glm::dvec3(1.5, -2.5, -1.0)), {30.0, 35.0, 40.0}, 50.0, 0.5};
    SphereLight ball{{1.6, 1.6, 1.2}, 0.4, {9.0, 7.0, 5.0}};
    DiskLight disk{{-1.8, 1.5, 1.0}, glm::normalize(glm::dvec3(1.8, -1.5, -1.0)), 0.5, {5.0, 6.0, 7.0}};
    RectangleLight rectangle{{0.0, 2.4, 0.3}, {0.0, 0.0, 0.5}, {0.6, 0.0, 0.0}, {6.0, 4.0, 8.0}};
    SunLight sun{glm::normalize(glm::dvec3(1.0, 2.0, 0.5)), {2.0, 1.5, 1.0}, 20.0, 0.6};
    DirectionalLight beam{glm::normalize(glm::dvec3(-2.0, 1.0, -0.5)), {0.5, 1.0, 2.0}};
};

inline const glm::dvec3 up_y(0.0, 1.0, 0.0);

// From the upper right, behind the camera.
DirectionalLight sunlight(Rgb irradiance = Rgb(3.0));

// The cloud of cloud_grid() in that light and an even sky. Square.
Scene sunlit_cloud(int pixels, std::uint32_t spp);

} // namespace vkvol
