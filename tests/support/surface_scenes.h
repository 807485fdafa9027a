// Small scenes of surfaces, and how their pictures are checked.
#pragma once

#include "support/scenes.h"

namespace vkvol {

Surface ball_surface(const Material& material, glm::dvec3 center = glm::dvec3(0.0), double radius = 1.0);

// That keeps no light.
Material white(MaterialKind kind);

Material matte(double albedo);

// Of a colour; conductors are of gold.
Surface surface_of(SurfaceShape shape, MaterialKind kind, double roughness = 0.0);

// Facets of a metal, or of glass, that keeps no light.
Material frosted(MaterialKind kind, double roughness);

// A closed mesh of a ball, of `n` bands of latitude.
TriangleSurface round_mesh(int n, double radius);

// Nothing, seen from 8 away: the square of this width about the origin.
Scene empty_scene(int pixels = 12, double width = 2.6);

// Rays side by side, straight down onto a square of this width about the origin.
Scene from_above(double width, int pixels = 4);

Volume box_of_fog(double sigma_t, double albedo);

// A ball of noise above a floor, with glass, metal, a mirror and something that glows, under lights of all kinds.
Scene still_life();

// The same with facets, varnish, and a tinted pane.
Scene rough_still_life();

// Of so few pixels that each has its share of particles in every sample.
Scene small_picture(const Volume& volume, double width, std::vector<Light> lights);

inline const RectangleSurface floor_piece{{0.0, -1.3, 0.0}, {2.5, 0.0, 0.0}, {0.0, 0.0, -2.5}};
inline const BallSurface left_ball{{-0.9, -0.6, 0.9}, 0.6}, right_ball{{0.9, -0.6, 0.9}, 0.6};

// Such a picture of these on that floor, before a ball of smoke.
Scene before_smoke(std::vector<Surface> surfaces, std::vector<Light> lights);

// Every pixel, but for `relative` of it.
void check_everywhere(const Scene& scene, const Rgb& expected, double relative);

// Against the reference, and the other schedule's bits.
void check_by_both_schedules(const Scene& scene, const std::string& name);

} // namespace vkvol
