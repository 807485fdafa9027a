// Textbook results that the estimators are tested against.
#pragma once

#include "shapes.h"

namespace reference {

double sphere_chord(const vkvol::Sphere& sphere, const Ray& ray); // length of the line inside
double box_chord(const vkvol::Box& box, const Ray& ray);

// Radiance per irradiance E0 perpendicular to the beam, scattered once out of a plane slab of vertical optical depth
// tau. mu0, mu > 0: cosines of the directions towards the light and towards the eye with the slab's normal; p: phase
// function [1/sr].
double slab_single_reflection(double albedo, double p, double tau, double mu0, double mu);
double slab_single_transmission(double albedo, double p, double tau, double mu0, double mu); // eye on the far side

// Chandrasekhar's H function for isotropic scattering, mu in [0, 1].
double h_function(double albedo, double mu);

// A semi-infinite isotropically scattering medium lit along the normal. Plane albedo: 1 - sqrt(1 - albedo) H(1).
double plane_albedo(double albedo);
double normal_reflection(double albedo); // radiance per E0, back along the beam: albedo H(1)^2 / 8 pi

// Fraction of isotropic light let through by a conservative isotropic slab, asymptotically for large tau.
double diffuse_transmission_asymptote(double tau);

} // namespace reference
