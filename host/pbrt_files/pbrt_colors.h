// What pbrt's parameters of spectra are in red, green and blue.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pbrt_scene.h"
#include "pbrt_spectra.h"

namespace vkvol {

class PbrtColors {
public:
    explicit PbrtColors(std::filesystem::path folder) : folder_(std::move(folder)) {}

    // Coefficients, shares of light and indices. Nothing if there is no such parameter. Throws InputError for what is
    // no spectrum.
    std::optional<glm::dvec3> share(const PbrtThing& thing, const std::string& name) const;
    // Colours of "rgb" values, three to each.
    std::vector<glm::dvec3> colors(const PbrtThing& thing, const std::string& name) const;
    // Radiance or intensity in the unit of pbrt's pictures: colours as they are, all other spectra with luminance 1.
    std::optional<glm::dvec3> light(const PbrtThing& thing, const std::string& name) const;

private:
    std::optional<glm::dvec3> color(const PbrtThing& thing, const PbrtParameter& parameter) const;
    Spectrum spectrum(const PbrtParameter& parameter) const;
    template <class Named, class Whole>
    glm::dvec3 of_spectrum(const PbrtParameter& parameter, const Named& named, const Whole& whole) const;

    std::filesystem::path folder_;                             // of files
    mutable std::map<std::string, std::vector<double>> files_; // read once, however many shapes name them
};

} // namespace vkvol
