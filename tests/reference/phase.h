// Phase functions. mu is the cosine between the directions of propagation before and after the
// scattering, so that Henyey and Greenstein's g > 0 scatters forward and g = E[mu].
#pragma once

#include <glm/glm.hpp>

namespace reference {

double hg_eval(double g, double mu); // [1/sr]
double hg_pdf(double g, double mu);  // the density of hg_sample per solid angle; equal to hg_eval

double hg_sample_cosine(double g, double u); // inverse of the distribution function of mu, rising with u

// The new direction of propagation.
glm::dvec3 hg_sample(double g, const glm::dvec3& direction, double u, double v);

// Rayleigh's, after one and after two scatterings [1/sr]; and the inverse of its distribution function, found by
// halving.
double rayleigh_eval(double mu);
double rayleigh_eval_twice(double mu);
double rayleigh_sample_cosine(double u);

// The direction of cosine mu to `direction` and azimuth 2 pi v.
glm::dvec3 turned(const glm::dvec3& direction, double mu, double v);

} // namespace reference
