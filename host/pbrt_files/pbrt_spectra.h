// pbrt's spectra as colours of linear Rec.709, which is what this renderer computes with.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pbrt_parameters.h"

namespace vkvol {

// (wavelength in nm, value), wavelengths ascending; linear between, 0 beyond.
using Spectrum = std::vector<std::pair<double, double>>;

// The colour spaces of pbrt's ColorSpace directive, as matrices from their colours to Rec.709. Nothing for others.
std::optional<glm::dmat3> to_rec709(const std::string& color_space);

// The white of such a space as light, of luminance 1: pbrt's colours of lights are times its illuminant.
glm::dvec3 white_of_space(const std::string& color_space);

// What a coefficient or a share of light is in each channel: its mean under the illuminant D65, with the weights by
// which light becomes Rec.709. A constant spectrum is that constant.
glm::dvec3 color_of_share(const Spectrum& spectrum);

// Colour of light, divided by its luminance, as pbrt-v4 divides all light spectra but colours.
glm::dvec3 color_of_light(const Spectrum& spectrum);

// A metal's or glass's of its own names, "metal-Au-k" or "glass-BK7", or an illuminant's. Metals in the three channels;
// a glass's index at 588 nm. Nothing for unknown ones.
std::optional<glm::dvec3> named_share(const std::string& name);
std::optional<glm::dvec3> named_light(const std::string& name);

} // namespace vkvol
