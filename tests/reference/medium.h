// A volume ready for tracking: shape, density field and coefficients in world units.
#pragma once

#include <variant>

#include "emission.h"

namespace reference {

struct Medium {
    std::variant<vkvol::Sphere, vkvol::Box, Grid> shape;
    double sigma_t = 0.0; // extinction at density 1 [1/world unit], density_scale included
    double albedo = 0.0;
    double g = 0.0;
    Emission emission;
    vkvol::Filter filter = vkvol::Filter::trilinear;

    const Grid* grid() const { return std::get_if<Grid>(&shape); } // null where the density is 1 throughout
    double density(const glm::dvec3& index) const;                 // of the grid, at index coordinates
};

// `stochastic` filtering has the expectation of trilinear, and is taken as trilinear.
Medium load(const vkvol::Volume& volume, vkvol::Filter filter = vkvol::Filter::trilinear);
Medium with_grid(Grid grid, const vkvol::Volume& volume, vkvol::Filter filter = vkvol::Filter::trilinear);

// The part of a world-space ray, t >= 0, where the density can be other than 0.
Interval support(const Medium& medium, const Ray& ray);

} // namespace reference
