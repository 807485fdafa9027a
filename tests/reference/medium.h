// A volume ready for tracking: shape, density field and coefficients in world units.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "emission.h"
#include "phase.h"
#include "reference_mesh.h"
#include "reference_noise.h"

namespace reference {

struct Medium {
    std::variant<vkvol::Sphere, vkvol::Box, Mesh, Grid, vkvol::Everywhere> shape;
    glm::dmat4 to_unmoved{1.0};          // world -> where a sphere or a box is, and its noise, before it is moved
    std::optional<vkvol::Noise> noise;   // the density, but for grids; none: 1,
    std::optional<vkvol::Layers> layers; // or by these
    vkvol::Rgb sigma_t{0.0};             // extinction at density 1 [1/world unit], density_scale included
    vkvol::Rgb albedo{0.0};
    ColorGrid albedo_grid; // multiplies it; or empty
    vkvol::ValueMap map;   // of the grid's values, or of heights above the bottom of layers; or none
    vkvol::PhaseFunction phase = vkvol::PhaseFunction::henyey_greenstein;
    double index = 1.0, backscatter = 0.0; // Fournier and Forand's
    double g = 0.0;
    double g2 = 0.0, share = 0.0, alpha = 0.0; // of a second function and its part
    std::vector<TableNode> table;
    Emission emission;
    vkvol::Filter filter = vkvol::Filter::trilinear;
    double majorant_scale = 1.0;
    std::optional<vkvol::Periodic> periodic; // see unfolded.cpp

    const Grid* grid() const { return std::get_if<Grid>(&shape); }
    bool homogeneous() const { return !grid() && !noise && !layers && !periodic; }   // density 1 throughout
    bool fades() const { return layers && layers->scale_height > 0.0 && !periodic; } // exponentially
    double fading_integral(const Ray& ray, const Interval& part) const;              // of that density, world-space ray
    bool unbounded() const { return std::holds_alternative<vkvol::Everywhere>(shape); }
    double density(const glm::dvec3& p) const; // at index coordinates of a grid, else before it is moved

    vkvol::Rgb albedo_at(const glm::dvec3& world) const;
    vkvol::Rgb emission_at(const glm::dvec3& world) const; // per absorption event
    double grid_value(const glm::dvec3& index) const;      // as interpolated, before it is mapped
    double height(const glm::dvec3& unmoved) const;        // above the bottom of layers
    double mapped_value(const glm::dvec3& world) const;    // what its map is of

    double largest() const;            // of sigma_t's channels
    Ray unmoved(const Ray& ray) const; // direction: what one world unit becomes there
    bool grey() const { return sigma_t == vkvol::Rgb(sigma_t.x); }
};

// The medium's phase function [1/sr], that of two scatterings, and a direction drawn from it.
double phase_eval(const Medium& medium, double mu);
double phase_eval_twice(const Medium& medium, double mu); // where there is a closed form of it:
bool has_phase_twice(const Medium& medium);
glm::dvec3 phase_sample(const Medium& medium, const glm::dvec3& direction, double u, double v);

// `stochastic` filtering has the expectation of trilinear, and is taken as trilinear, as is none.
Medium load(const vkvol::Volume& volume, std::optional<vkvol::Filter> filter = {});
Medium with_grid(Grid grid, const vkvol::Volume& volume, std::optional<vkvol::Filter> filter = {});

// The parts of a world-space ray, t >= 0, where the density can be other than 0, in order.
std::vector<Interval> support(const Medium& medium, const Ray& ray);

// Where in the domain that repeats a point of the world is; where nothing does, there.
glm::dvec3 folded(const Medium& medium, const glm::dvec3& world);
// A medium that repeats: the part of a ray where along the other axes there is anything, and the density at a point.
Interval unfolded_support(const Medium& medium, const Ray& ray);
double unfolded_density(const Medium& medium, const glm::dvec3& world);
double largest_density(const Medium& medium);

// The density along a world-space ray.
class DensityAlong {
public:
    DensityAlong(const Medium& medium, const Ray& ray)
        : medium_(medium), ray_(medium.periodic ? ray
                                : medium.grid() ? medium.grid()->to_index(ray)
                                                : medium.unmoved(ray)) {}
    double operator()(double t) const {
        return medium_.periodic ? unfolded_density(medium_, ray_.at(t)) : medium_.density(ray_.at(t));
    }
    const Ray& ray() const { return ray_; } // in index space for a grid, else as before the medium is moved

private:
    const Medium& medium_;
    Ray ray_;
};

} // namespace reference
