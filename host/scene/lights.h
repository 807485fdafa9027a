// The lights of a scene as they are written. World space; colours are linear Rec.709, >= 0.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace vkvol {

using Rgb = glm::dvec3;

// No colour of a light times its multiplier is more, nor radiance of what is seen: it is squared and summed over the
// samples in single precision, which ends at 3e38.
inline constexpr double brightest_light = 1e12;

// Every light may be in a group, by name, for layers of the picture; or in none.

// Infinitely far away and without extent.
struct DirectionalLight {
    glm::dvec3 direction{0.0, 1.0, 0.0}; // unit, from the scene towards the light
    Rgb irradiance{0.0};                 // on a plane perpendicular to `direction`
    std::string group = {};
};

// A disc in the sky, a ball far away, which the camera sees. From middle to rim its radiance falls by the linear law of
// limb darkening, I(mu) = I(1) (1 - u (1 - mu)), with mu the cosine at which light leaves the ball (Milne, "Radiative
// Equilibrium in the Outer Layers of a Star", 1921: 0.6 of the sun in visible light).
struct SunLight {
    glm::dvec3 direction{0.0, 1.0, 0.0}; // unit, towards its middle
    Rgb irradiance{0.0};                 // of all of it, on a plane perpendicular to `direction`
    double angle = 0.53;                 // degrees, its whole diameter, in (0, 180]
    double limb_darkening = 0.0;         // u, in [0, 1]; 0: even radiance
    std::string group = {};
};

// Radiance of the disc's middle, where it is brightest.
Rgb peak_radiance(const SunLight& sun);

struct PointLight {
    glm::dvec3 position{0.0};
    Rgb intensity{0.0}; // per steradian
    std::string group = {};
};

// A point that shines into a cone. Within `angle * (1 - blend)` it has its intensity, beyond `angle` none; in between
// that falls off as a smooth step of the cosine.
struct SpotLight {
    glm::dvec3 position{0.0};
    glm::dvec3 direction{0.0, -1.0, 0.0}; // unit, of the cone's axis
    Rgb intensity{0.0};                   // per steradian, on the axis
    double angle = 45.0;                  // degrees, the cone's whole opening, in (0, 180]
    double blend = 0.2;                   // in [0, 1]
    std::string group = {};
};

// Lamps shine and stop nothing: what passes through them goes on. The camera sees them. One that is a surface's light
// has that as its body, a place in Scene::surfaces.
inline constexpr int no_body = -1;

// A ball that shines outwards, evenly.
struct SphereLight {
    glm::dvec3 center{0.0};
    double radius = 1.0; // > 0
    Rgb radiance{0.0};
    std::string group = {};
    int body = no_body;
};

// A disk that shines evenly from the side of its normal.
struct DiskLight {
    glm::dvec3 center{0.0};
    glm::dvec3 normal{0.0, -1.0, 0.0}; // unit
    double radius = 1.0;               // > 0
    Rgb radiance{0.0};
    std::string group = {};
    int body = no_body;
};

// A rectangle that does.
struct RectangleLight {
    glm::dvec3 center{0.0};
    glm::dvec3 edge_u{0.5, 0.0, 0.0}, edge_v{0.0, 0.0, 0.5}; // halves of its edges, across each other
    Rgb radiance{0.0};
    std::string group = {};
    int body = no_body;

    glm::dvec3 normal() const { return glm::normalize(glm::cross(edge_u, edge_v)); }
};

// A surface of any shape that shines, and is looked for by points of it, while flights go on to meet it: no lamp, and
// the surface goes on to shine.
struct SurfaceLight {
    Rgb radiance{0.0};
    std::string group = {};
    int body = no_body;
};

// A ball or box of even density that glows evenly, and is looked for by points of it, while flights go on to meet it.
struct GlowLight {
    Rgb intensity{0.0}; // of a unit of volume, per steradian
    std::string group = {};
    int medium = 0; // a place in Scene::volumes
};

// A sky by day, as assets/daylight.h makes it.
struct Daylight {
    glm::dvec3 sun{0.0, 1.0, 0.0}; // unit, towards it; above the horizon
    double turbidity = 3.0;        // haze: 2 is very clear, 10 hazy
    double ground = 0.2;           // albedo of what is below the horizon, in [0, 1]
    bool operator==(const Daylight&) const = default;
};

// What directions the places of a map are.
enum class SkyMapping {
    // Columns are longitudes, rows latitudes, the zenith (y) on top. The middle column is where a camera looks that is
    // not turned, and the map is seen from within: further right is further to that camera's right.
    equirectangular,
    // Square, of texels that all take the same solid angle, as pbrt-v4's (Clarberg, "Fast Equal-Area Mapping of the
    // (Hemi)Sphere Using SIMD", 2008). The zenith is its middle, the nadir its corners, and the horizon the diamond
    // between the middles of its edges: -z at the top, +x at the right. pbrt's coordinates are left-handed and its maps
    // have z upwards: their (x, y, z) is (x, z, y) here, which is `Rotate -90 1 0 0` seen along pbrt's +z.
    equal_area
};

// A map of the radiance that comes from every direction. Between the middles of texels radiance is interpolated
// linearly.
struct SkyLight {
    std::filesystem::path file;
    std::string place;                // of the element, "file:line:column", for messages; or empty
    std::optional<Daylight> daylight; // in place of the file
    SkyMapping mapping = SkyMapping::equirectangular;
    double rotation = 0.0; // degrees, positive turns it counter-clockwise as seen from above
    bool mirror = false;   // right for left, before it is turned
    Rgb scale{1.0};        // multiplies the map
    std::string group = {};
};

using Light = std::variant<DirectionalLight, SunLight, PointLight, SpotLight, SkyLight, SphereLight, DiskLight,
                           RectangleLight, SurfaceLight, GlowLight>;

// The name of the element that makes it; of a surface that shines, `surface`.
const char* kind_of(const Light& light);

inline const std::string& group_of(const Light& light) {
    return std::visit([](const auto& kind) -> const std::string& { return kind.group; }, light);
}

inline int body_of(const Light& light) {
    return std::visit(
        [](const auto& kind) {
            if constexpr (requires { kind.body; })
                return kind.body;
            return no_body;
        },
        light);
}

// What a light sends out in all, for each unit of its intensity or radiance: the solid angle into which it shines, of a
// spot with half of its rim, times the area that does, seen from each direction as it is [world units squared].
double power_per_unit(const PointLight& light);
double power_per_unit(const SpotLight& light);
double power_per_unit(const SphereLight& light);
double power_per_unit(const DiskLight& light);
double power_per_unit(const RectangleLight& light);

// The light if there is but one and it has neither place nor extent: such a scene needs no choice of lights.
inline const DirectionalLight* only_directional(const std::vector<Light>& lights) {
    return lights.size() == 1 ? std::get_if<DirectionalLight>(&lights.front()) : nullptr;
}

// One that flights meet when they leave, since it has an extent.
inline bool is_met_by_chance(const Light& light) {
    return std::holds_alternative<SunLight>(light) || std::holds_alternative<SkyLight>(light);
}

inline bool is_shining_surface(const Light& light) {
    return std::holds_alternative<SurfaceLight>(light);
}

// One that flights go on to meet where it is, and which has no place but its points.
inline bool is_met_on_the_way(const Light& light) {
    return is_shining_surface(light) || std::holds_alternative<GlowLight>(light);
}

// One with a shape and a place, which the camera sees by looks.
inline bool is_lamp(const Light& light) {
    return std::holds_alternative<SphereLight>(light) || std::holds_alternative<DiskLight>(light) ||
           std::holds_alternative<RectangleLight>(light);
}

// Middle of a light that is somewhere, near or far; none of one infinitely far, or that flights meet on their way.
std::optional<glm::dvec3> place_of(const Light& light);

inline bool has_place(const Light& light) {
    return is_met_on_the_way(light) || place_of(light).has_value();
}

} // namespace vkvol
