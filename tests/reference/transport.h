// Media that scatter isotropically, by the integral equation of their fluence (Peierls; Davison, "Neutron Transport
// Theory", 1957, ch. V). Lengths are mean free paths. Piecewise constant in cells, whose integrals of the kernel are
// exact: what is left falls with the square of the cells' width.
#pragma once

#include <functional>
#include <vector>

namespace reference {

// A plane slab of optical depth tau, lit from the side where the depth is 0.
struct SlabSolution {
    std::vector<double> fluence; // of cells, evenly
    double reflected = 0.0;      // irradiance out of the lit side
    double transmitted = 0.0;    // out of the other, what was not scattered included
};
// By a beam of irradiance 1 across itself, at the cosine mu0 to the normal.
SlabSolution slab_in_beam(double albedo, double tau, double mu0, int cells);
// By radiance 1 from half of all directions.
SlabSolution slab_in_half_sky(double albedo, double tau, int cells);

// Fluence at the middle of a ball of optical radius R which emits (1 - albedo) [radiance per mean free path], nothing
// else shining.
double fluence_amid_ball(double albedo, double radius, int cells);

} // namespace reference
