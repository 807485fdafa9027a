// Thermal emission: Planck's law seen by the CIE 1931 observer, in linear Rec.709.
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace vkvol {

// Responses of the CIE 1931 standard observer at a wavelength, linear between steps of 5 nm, 0 beyond 360 to 830 nm.
// The integral over the second is 106.9 nm.
glm::dvec3 observer(double nanometre);
constexpr double observer_integral = 106.8569; // of the second, nanometres

// Colour of a black body at `kelvin`, in units where one at `reference` kelvin has luminance 1; or, at reference 0, of
// its spectrum divided by that's maximum and integrated over nanometres, as pbrt-v4 has it. Channels that Rec.709
// cannot show (blue below some 1900 K, green below some 900 K) are clipped at 0, and the others keep the luminance (at
// reference 0 their values). Zero for kelvin <= 0; finite for all
// finite arguments.
glm::dvec3 blackbody_rgb(double kelvin, double reference);

// blackbody_rgb at `count` temperatures spaced evenly over [low, high], as texels of four numbers. Between neighbours
// dT kelvin apart linear interpolation is off by a fraction of at most (1.44e7 nm K / 400 nm / T^2 * dT)^2 / 8.
std::vector<glm::vec4> make_blackbody_table(double low, double high, double reference, int count);

} // namespace vkvol
