// The authored scene as plain data: what the XML says, before any grid is opened or any device chosen.
// World space is right-handed with y up. Lengths are world units, angles degrees, radiance linear Rec.709.
// The CPU reference reads these structs too, so nothing here may depend on Vulkan.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "aovs.h"
#include "lights.h"
#include "motion_blur.h"
#include "surfaces.h"

namespace vkvol {

// World units. Far beyond any scene, and small enough that products of three stay finite on the device.
inline constexpr double largest_length = 1e11;

// What is hotter is no flame but a slip of the unit.
inline constexpr double hottest_kelvin = 1e9;

// How directions become places in the picture. Equirectangular: longitude across it, latitude down it, the middle of
// the reference frame straight ahead. Kernels tell more of them apart, SENSOR_... of shaders/shared/constants.h: a
// perspective one with a lens is one of its own there.
// Three read flux in place of radiance. Irradiance: what arrives through a rectangle from the side that the
// camera looks to, a pixel being a patch of it: the integral of radiance times cosine over that hemisphere. Fluence:
// what arrives at points from everywhere, a pixel each: the integral of radiance over all directions. Both include
// light that comes straight from its source. Absorption: the power that media absorb in the cells of a box, a pixel
// each, per volume.
enum class Projection { perspective, orthographic, equirectangular, irradiance, fluence, absorption };

// The largest radius of a lens, by the distance of what is sharp: single precision has no directions beyond.
inline constexpr double widest_lens = 1000.0;

// What single precision can tell from 0 and 180 degrees.
inline constexpr double narrowest_fov = 1e-30, widest_fov = 179.9999;

// A thin lens across the eye, in its plane. Perspective only.
struct Lens {
    double radius = 0.0; // world units, >= 0; 0: a pinhole
    double focus = 0.0;  // distance along the view of what is sharp, > 0 if the radius is
    int blades = 0;      // of its aperture, a regular polygon within the circle: 0 (the circle itself), or from 3 on
    double rotation =
        0.0; // degrees, of the polygon: at 0 it has a corner on the right; + counter-clockwise as seen from behind
};

// How a camera would be set. Without effect on radiance: it says which is white in pictures for looking at.
struct Exposure {
    double iso = 100.0;          // > 0
    double shutter = 0.0;        // seconds, > 0
    double f_number = 0.0;       // > 0; of no lens that is traced
    double luminance_unit = 1.0; // cd/m^2 of radiance 1, > 0
};

// Looks along -z at zero rotation. Direction of a camera-space d: Rz(roll) * Ry(yaw) * Rx(pitch) * d.
struct Camera {
    Projection projection = Projection::perspective;
    glm::dvec3 position{0.0};
    double pitch = 0.0; // degrees, + looks up
    double yaw = 0.0;   // degrees, + turns left
    double roll = 0.0;  // degrees, + counter-clockwise about world z
    double fov =
        90.0; // degrees, the full vertical angle of the reference frame, narrowest_fov to widest_fov; perspective
    double view_height = 10.0; // world units, of the reference frame, > 0; orthographic only
    Lens lens;
    std::optional<Exposure> exposure;
    glm::dvec2 size{1.0};              // irradiance: world units, of the rectangle that is the reference frame, > 0
    std::vector<glm::dvec3> points;    // fluence: row by row, as many as the picture has pixels
    std::filesystem::path points_file; // where they were read; or empty
    glm::dvec3 edges{1.0};             // absorption: world units, of the box about `position`, > 0
    glm::ivec3 cells{1};               // in it, > 0; in the picture x goes across, y up, and z down, slice after slice

    // Cells in which absorption is read, world space.
    glm::dvec3 cell_size() const { return edges / glm::dvec3(cells); }
    glm::dvec3 cell_low(glm::ivec3 cell) const { return position - 0.5 * edges + glm::dvec3(cell) * cell_size(); }
    glm::ivec3 cell_of_pixel(int x, int y) const { return {x, cells.y - 1 - y % cells.y, y / cells.y}; }
};

inline bool reads_flux(const Camera& camera) {
    const Projection p = camera.projection;
    return p == Projection::irradiance || p == Projection::fluence || p == Projection::absorption;
}

// What a sensor reads where the same radiance comes from everywhere, per unit of that [sr].
inline double reading_of_unit_radiance(const Camera& camera) {
    return camera.projection == Projection::irradiance ? std::numbers::pi
           : camera.projection == Projection::fluence  ? 4.0 * std::numbers::pi
                                                       : 1.0;
}

// The picture is a window of `width` x `height` pixels at (start_x, start_y) of a virtual reference frame.
// Pixel (i, j) of the picture, row 0 on top, has its centre at u = (start_x + i + 1/2) / reference_width, likewise v.
// Starts and references are real numbers so that a picture can be resized without changing its view.
struct Picture {
    int width = 400;
    int height = 400;
    double start_x = 0.0;
    double start_y = 0.0;
    double reference_width = 400.0;
    double reference_height = 400.0;
};

struct Sphere {
    glm::dvec3 center{0.0};
    double radius = 1.0; // > 0
};

struct Box {
    glm::dvec3 center{0.0};
    glm::dvec3 size{1.0}; // full edge lengths, > 0
};

// All of space, but for what its layers leave out.
struct Everywhere {};

// World units: so far single precision takes what is everywhere, a billion times as far as anything else may be.
inline constexpr double everywhere_reach = 1e20;

// Closed surfaces from .obj and .ply files, in world space; the medium fills what any of them encloses.
struct MeshFiles {
    std::vector<std::filesystem::path> paths;
};

struct MemoryGrids;

struct GridFile {
    std::filesystem::path path; // .nvdb or .vdb
    std::string grid = "density";
    std::shared_ptr<const MemoryGrids> memory = {}; // instead of a file; `path` is then its name alone

    GridFile beside(const std::string& other) const { return {path, other, memory}; } // another grid of it
};

// Velocities of what is in a grid, beside it in its file, and how much later than the file it is seen.
struct Drift {
    std::string grid;     // of vectors, world units per second; or none
    double seconds = 0.0; // may be negative

    bool exists() const { return !grid.empty() && seconds != 0.0; }
};

// What "per length" in sigma_a and sigma_s means: per index-space unit of the grid, or per world unit.
// For a grid whose transform is M (index -> world) one voxel is |det M|^(1/3) world units long.
enum class CoefficientUnit { voxel, world };

// How a temperature grid glows: `color` times the grid's value (the original's model), or `color` times a black body's
// colour at kelvin = scale * value + offset, 0 below the cutoff, relative to luminance 1 at `reference` kelvin.
struct TemperatureEmission {
    enum class Model { color, blackbody };
    Model model = Model::color;
    Rgb color{0.0};                   // 0: no such emission
    std::string grid = "temperature"; // in the density field's file; a file without it does not glow. Of colours: not
                                      // for black bodies
    double scale = 1.0;
    double offset = 0.0;       // kelvin
    double cutoff = 0.0;       // kelvin
    double reference = 1500.0; // kelvin, > 0; or 0: each spectrum is divided by its own maximum, as in pbrt-v4
};

// Procedural density max(0, (1 + fbm(x)) / 2) with fbm(x) = sum over octaves k of gain^k perlin(frequency lacunarity^k
// x), x in world space, and Perlin's improved noise ("Improving Noise", 2002).
struct Noise {
    double frequency = 1.8;  // > 0 [1 / world unit]
    int octaves = 1;         // 1 to 16
    double gain = 0.5;       // in [0, 1]
    double lacunarity = 2.0; // >= 1
};

// A density by height alone, along an axis of the volume's own space, as it is before it is moved; there is none beyond
// `bottom` and `top`. Exponential, exp(-(height - reference) / scale_height), or by the volume's map, whose values are
// heights above the bottom.
struct Layers {
    int axis = 1;        // 0 to 2: x, y, z
    double bottom = 0.0; // world units, below `top`
    double top = 1.0;
    double scale_height = 0.0; // > 0; or 0: by the map
    double reference = 0.0;    // height of density 1
};

// As PHASE_... of shaders/shared/constants.h; the last is a table to kernels.
enum class PhaseFunction {
    henyey_greenstein,
    rayleigh,
    double_henyey_greenstein,
    draine,
    droplets,
    table,
    fournier_forand
};

// What phase functions have besides g, those that have it.
struct PhaseDetails {
    double g2 = 0.0;                 // double: mean cosine of the second, in (-1, 1)
    double share = 0.5;              // double: part of the light that goes by it, in [0, 1]
    double alpha = 1.0;              // Draine: weight of the square of the cosine, in [0, 250]
    double diameter = 10.0;          // droplets: micrometres, in [0.01, 50]
    double depolarization = 0.0;     // Rayleigh: in [0, 6/7], of unpolarised light scattered by a right angle, the
                                     // intensities along and across the plane of scattering, one over the other
    double index = 1.1;              // Fournier and Forand: of refraction, relative to water's, in [1.001, 1.6]
    double backscatter = 0.0183;     // Fournier and Forand: part that goes backward, in [0.0001, 0.49]
    std::filesystem::path file = {}; // table
};

// What a medium is where its grid has a value.
struct MapPoint {
    double value = 0.0;   // >= 0
    double density = 0.0; // >= 0
    Rgb albedo{1.0};      // in [0, 1], multiplies the medium's
    Rgb emission{0.0};    // radiance per absorption event, adds to the medium's
};

// From the values of a grid, as interpolated, to densities, and by a transfer function to colours as well. Linear
// between points, and beyond them as at the first and the last; two points of one value are a step, at which the latter
// counts.
struct ValueMap {
    std::vector<MapPoint> points; // their values ascending; none: the values are densities
    double rise = 0.0;            // of the density per value beyond the last point
    bool is_transfer = false;     // has albedos and emission

    bool exists() const { return !points.empty(); }
};

// A participating medium filling a shape. Coefficients multiply the density: that of the grid, of the noise, or 1.
struct Volume {
    std::variant<Sphere, Box, MeshFiles, GridFile, Everywhere> shape;
    std::string name = {};        // of its layer; or empty
    glm::dmat4 transform{1.0};    // of the shape with all that is in it, in world space; affine, with an inverse
    std::string place;            // of the shape, "file:line:column", for messages; or empty
    Drift drift = {};             // of a grid, and of all that is in its file
    std::optional<Noise> noise;   // not for grids, nor everywhere
    std::optional<Layers> layers; // for boxes and everywhere
    ValueMap map;                 // for grids and layers
    Rgb sigma_a{0.5};             // absorption, >= 0 [1/unit]
    Rgb sigma_s{0.5};             // scattering, >= 0 [1/unit]
    CoefficientUnit unit = CoefficientUnit::voxel; // without meaning but for grids: else always world
    double density_scale = 1.0;                    // >= 0, multiplies the density
    PhaseFunction phase = PhaseFunction::henyey_greenstein;
    double g = 0.0; // Henyey and Greenstein's, the first of two, and Draine's: in (-1, 1), + is forward
    PhaseDetails phase_details;
    std::string
        albedo_grid; // in the density field's file: its colours or numbers, at most 1, multiply the albedo; or none
    Rgb Le{0.0};     // radiance emitted per absorption event: emission is sigma_a * Le
    TemperatureEmission temperature; // adds to Le
};

inline bool is_everywhere(const Volume& volume) {
    return std::holds_alternative<Everywhere>(volume.shape);
}

// Whether its albedo differs from place to place.
inline bool has_albedo_of_place(const Volume& volume) {
    return !volume.albedo_grid.empty() || volume.map.is_transfer;
}

// sigma_a where it is largest, at density 1.
inline Rgb most_sigma_a(const Volume& volume) {
    return has_albedo_of_place(volume) ? volume.sigma_a + volume.sigma_s : volume.sigma_a;
}

// The most that its map has, channel by channel.
inline Rgb most_map_albedo(const Volume& volume) {
    Rgb most(volume.map.is_transfer ? 0.0 : 1.0);
    for (const MapPoint& point : volume.map.points)
        most = glm::max(most, point.albedo);
    return most;
}
inline Rgb most_map_emission(const Volume& volume) {
    Rgb most(0.0);
    for (const MapPoint& point : volume.map.points)
        most = glm::max(most, point.emission);
    return most;
}

// How the density between voxel centres is looked up. `stochastic` takes one of the eight corners with the
// probability of its trilinear weight: exact in expectation wherever the density enters linearly.
enum class Filter { nearest, trilinear, stochastic };

// The weight of a point of the picture in a pixel, by its distance from the pixel's middle along each axis; drawn from,
// so that samples count alike. Box: 1 up to the radius. Tent: falls to 0 there. Gaussian: of deviation radius / 3.
// Blackman and Harris's window of four terms, as wide.
enum class PixelFilter { box, tent, gaussian, blackman_harris };

// Choices along the axes of an integrator, as numbered in shaders/shared/constants.h. Set ones replace the preset's.
struct AxisChoices {
    std::optional<int> scattering;        // SCATTERING_...
    std::optional<int> free_flight;       // FREE_FLIGHT_...
    std::optional<int> transmittance;     // TRANSMITTANCE_...
    std::optional<int> nee;               // NEE_...
    std::optional<int> emission;          // EMISSION_AT_...
    std::optional<int> mis = {};          // MIS_...
    std::optional<int> distance = {};     // DISTANCE_...
    std::optional<int> paths = {};        // PATHS_...
    std::optional<int> first_flight = {}; // FIRST_FLIGHT_...
};

// Ray marching. Lengths in world units, or in voxels of a grid.
struct March {
    double step = 0.0;         // > 0; 0: half a voxel in a grid, 0.2 world units elsewhere, as in the original
    double shadow_step = 0.0;  // of shadow rays, > 0; 0: as step; of telescoping ones 16 times that
    double optical_step = 0.1; // of adaptive marches: the majorant's optical depth per step, > 0
    bool jitter = true;        // sample points at random in their step, not in its middle
    CoefficientUnit unit = CoefficientUnit::voxel; // of the steps; always world but for grids
};

struct RenderSettings {
    std::string integrator; // empty: the best unbiased choice for the scene
    AxisChoices choices;    // beyond what the integrator's name says
    March march;
    std::uint32_t spp = 1;                  // samples per pixel, >= 1
    std::optional<std::uint32_t> max_depth; // scattering events per path; none: a million
    double roulette_threshold = 0.1;        // path weight below which Russian roulette is played; 0: never
    std::optional<Filter> filter;           // none: stochastic, or trilinear where that would be biased
    PixelFilter pixel_filter = PixelFilter::box;
    double pixel_filter_radius = 0.5; // pixels, > 0
    double majorant_scale = 1.0; // >= 1 leaves every unbiased estimator unbiased; < 1 violates the majorant on purpose
    int majorant_cell = 0;       // voxels along an edge of a majorant cell; 0: automatic
};

// A box as wide as the pixel, which is what a picture has unless another filter is asked for.
inline bool has_plain_pixels(const RenderSettings& settings) {
    return settings.pixel_filter == PixelFilter::box && settings.pixel_filter_radius == 0.5;
}

// A domain that repeats without end along some axes of the world. What is outside it is cut off.
struct Periodic {
    glm::dvec3 low{0.0};
    glm::dvec3 high{0.0}; // world units; as `low` along axes that do not repeat

    glm::dvec3 size() const { return high - low; }
};

// What the mean of the picture must be, for scenes that are tests: derived in the scene file, without effect on the
// picture.
struct Expected {
    Rgb mean{0.0};
    Rgb bias{0.0};      // >= 0, how far the true mean may be from `mean`: truncation and rounding, derived as well
    bool exact = false; // every sample has this value, so noise is no excuse
};

// An element that could give light and is black: what it lacks, nobody may have meant to leave out.
struct BlackElement {
    std::string name;
    std::string place;      // "file:line:column"
    std::string group = {}; // of a light, and not of the background: it has its layer also in frames in which it is out
    std::size_t before = 0; // how many of the scene's lights come before it
};

struct Scene {
    Camera camera;
    bool has_camera = true; // false: nobody said where it is
    Picture picture;
    std::vector<Volume> volumes; // the media
    std::vector<Light> lights;
    std::vector<Surface> surfaces;
    std::optional<Periodic> periodic;
    std::shared_ptr<const MotionBlur> motion_blur = {}; // none: nothing moves
    Rgb background{0.0};                                // constant radiance from every direction
    std::string background_group = {};                  // as of lights
    unsigned layers = 0;                                // Aovs, besides radiance
    bool holds_out = false; // what is behind the media, light that was not scattered, stays out of the picture
    RenderSettings settings;
    std::string units = {}; // of its readings, if they are parts of what the light brings; or empty
    std::optional<Expected> expected;
    std::vector<BlackElement> black;             // without effect on the picture
    std::vector<std::filesystem::path> included; // files of the scene itself, beside the one that was named
    std::vector<std::string> warnings;           // "file:line:column: ..." for what was understood but is not honoured
};

// The light if there is but one, that has neither place nor extent, and only media look at it: then there is no choice
// of lights.
inline const DirectionalLight* lone_directional(const Scene& scene) {
    return reads_flux(scene.camera) ? nullptr : only_directional(scene.lights);
}

// The medium if there is but one: what is asked of it alone has no other's to mix with.
inline const Volume* lone_volume(const Scene& scene) {
    return scene.volumes.size() == 1 ? &scene.volumes[0] : nullptr;
}

// Names of the groups that lights are in, black ones too, and the background, in the order of the lights. Their layers
// follow that of what is in none.
std::vector<std::string> light_groups(const Scene& scene);

// Names of the layers of media: those of volumes, or "volume1", "volume2", ... by their order. Volumes of one name
// share a layer.
std::vector<std::string> medium_names(const Scene& scene);
std::string medium_name(const Scene& scene, std::size_t volume);

// What of the layers asked for makes no sense, and what would; empty: nothing.
std::string trouble_with_layers(const Scene& scene);

// Place of a name among names; how many there are if it is none of them.
std::uint32_t place_among(const std::vector<std::string>& names, const std::string& name);

// Whether one of its media is such.
template <class Is> bool any_medium(const Scene& scene, const Is& is) {
    return std::any_of(scene.volumes.begin(), scene.volumes.end(), is);
}

} // namespace vkvol
