// Phase functions. mu is the cosine between the directions of propagation before and after the
// scattering, so that Henyey and Greenstein's g > 0 scatters forward and g = E[mu].
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace reference {

double hg_eval(double g, double mu); // [1/sr]
double hg_pdf(double g, double mu);  // the density of hg_sample per solid angle; equal to hg_eval

double hg_sample_cosine(double g, double u); // inverse of the distribution function of mu, rising with u

// The new direction of propagation.
glm::dvec3 hg_sample(double g, const glm::dvec3& direction, double u, double v);

// Rayleigh's, after one and after two scatterings [1/sr]; and the inverse of its distribution function, found by
// halving.
double rayleigh_eval(double share, double mu);
double rayleigh_eval_twice(double share, double mu);
double rayleigh_sample_cosine(double share, double u);

// Draine's [1/sr]: Henyey and Greenstein's times 1 + alpha mu^2. Sampled by halving its distribution function, which is
// known in closed form; of |g| >= 0.01, or 0.
double draine_eval(double g, double alpha, double mu);
double draine_sample_cosine(double g, double alpha, double u);

// Water by the diameter of its droplets in micrometres, 0.01 to 50: Henyey and Greenstein's, and with weight w_d
// Draine's (Jendersie and d'Eon 2023, in the paper's names).
struct Droplets {
    double g_hg, g_d, alpha, w_d;
};
Droplets droplets(double d);

// Values at falling cosines from 1 to -1, linear between them, of any scale.
struct TableNode {
    double mu;
    double value;
};
std::vector<TableNode> normalised(std::vector<TableNode> table); // [1/sr]
double table_eval(const std::vector<TableNode>& table, double mu);
double table_sample_cosine(const std::vector<TableNode>& table, double u); // by halving

// Fournier and Forand's [1/sr], and the part of the light that goes below an angle of cosine mu, as their papers state
// them. Without bound towards mu = 1: there as at 1e-10 from it.
double fournier_forand_exponent(double index, double backscatter); // (3 - the power of the sizes) / 2
double fournier_forand_eval(double index, double backscatter, double mu);
double fournier_forand_share(double index, double backscatter, double mu);
double fournier_forand_sample_cosine(double index, double backscatter, double u); // by halving

// The direction of cosine mu to `direction` and azimuth 2 pi v.
glm::dvec3 turned(const glm::dvec3& direction, double mu, double v);

} // namespace reference
