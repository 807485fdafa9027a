// Rough boundaries, by walks among facets whose heights and normals are drawn not as the renderer draws them.
#pragma once

#include <complex>
#include <glm/glm.hpp>

#include "rng.h"
#include "surfaces.h"

namespace reference {

// Unpolarised light that a boundary reflects: Fresnel's equations. `index`: of what is beyond it over that before it.
double reflected(double cosine, std::complex<double> index);

// Unit directions away from the boundary; the normal is on `wo`'s side. `eta`: of a dielectric, as of `reflected`.
struct FacetSample {
    glm::dvec3 direction;
    vkvol::Rgb weight; // of energy: where it crosses radiance is worth eta^-2 of it
};
FacetSample facets_scatter(const vkvol::Material& material, double eta, const glm::dvec3& normal, const glm::dvec3& wo,
                           Rng& rng);

// An estimate of what is scattered of radiance along -wi into wo, times the cosine of wi: by a walk the other way.
vkvol::Rgb facets_value(const vkvol::Material& material, double eta, const glm::dvec3& normal, const glm::dvec3& wo,
                        const glm::dvec3& wi, Rng& rng);

} // namespace reference
