// Deterministic integrals along a ray: no majorants, no random numbers.
#pragma once

#include <limits>

#include "medium.h"

namespace reference {

// Integral of the density over [t0, t1]. Exact up to rounding in grids: inside one voxel cell the trilinear density
// along a ray is a cubic in t (and the nearest one a constant), which two Gauss points integrate exactly. Noise is
// smooth between the lattice planes of its octaves (but where fbm reaches -1): four panels of five Gauss points each.
double density_integral(const Medium& medium, const Ray& ray, double t0 = 0.0,
                        double t1 = std::numeric_limits<double>::infinity());

// Optical depth and transmittance of the channel with the largest extinction.
double optical_depth(const Medium& medium, const Ray& ray, double t0, double t1);
double transmittance_quadrature(const Medium& medium, const Ray& ray, double t0, double t1);
// Transmittance of all channels.
vkvol::Rgb chromatic_transmittance(const Medium& medium, const Ray& ray, double t0 = 0.0,
                                   double t1 = std::numeric_limits<double>::infinity());

// Radiance of light scattered exactly once, from one light without extent: the integral over t of
// sigma_t albedo p T(0, t) T(t, light) E. Every smooth piece is cut into `panels` (a homogeneous medium into 64 times
// as many) with five Gauss points each.
vkvol::Rgb single_scattering_quadrature(const Medium& medium, const vkvol::Light& light, const Ray& ray,
                                        int panels = 1);

// Radiance emitted along the ray and not scattered, plus the background seen straight through.
vkvol::Rgb unscattered_quadrature(const Medium& medium, const vkvol::Rgb& background, const Ray& ray, int panels = 1);

// Where the density along a ray is not smooth: the interval's ends, and the crossings of voxel cells or noise lattices.
// `field_ray` is that of DensityAlong.
std::vector<double> breaks(const Medium& medium, const Ray& field_ray, const Interval& interval);
double piece_integral(const Medium& medium, const DensityAlong& density, double a, double b); // between two breaks

} // namespace reference
