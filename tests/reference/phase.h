// Henyey-Greenstein phase function. mu is the cosine between the directions of propagation before and after the
// scattering, so that g > 0 scatters forward and g = E[mu].
#pragma once

#include <glm/glm.hpp>

namespace reference {

double hg_eval(double g, double mu); // [1/sr]
double hg_pdf(double g, double mu);  // the density of hg_sample per solid angle; equal to hg_eval

double hg_sample_cosine(double g, double u); // inverse of the distribution function of mu, rising with u

// The new direction of propagation.
glm::dvec3 hg_sample(double g, const glm::dvec3& direction, double u, double v);

} // namespace reference
