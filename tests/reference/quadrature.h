// Deterministic integrals along a ray: no majorants, no random numbers.
#pragma once

#include "medium.h"

namespace reference {

// Integral of sigma_t over [t0, t1]: exact up to rounding. Inside one voxel cell the trilinear density along a ray is
// a cubic in t (and the nearest one a constant), which two Gauss points integrate exactly.
double optical_depth(const Medium& medium, const Ray& ray, double t0, double t1);
double transmittance_quadrature(const Medium& medium, const Ray& ray, double t0, double t1);

// Radiance of light scattered exactly once, from one directional light: the integral over t of
// sigma_t albedo p T(0, t) T(t, light) E. Every voxel cell is cut into `panels` (a homogeneous medium into 64 times as
// many) with five Gauss points each.
vkvol::Rgb single_scattering_quadrature(const Medium& medium, const vkvol::DirectionalLight& light, const Ray& ray,
                                        int panels = 1);

// Radiance emitted along the ray and not scattered, plus the background seen straight through.
vkvol::Rgb unscattered_quadrature(const Medium& medium, const vkvol::Rgb& background, const Ray& ray);

} // namespace reference
