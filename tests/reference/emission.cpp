#include "emission.h"

#include <algorithm>
#include <cmath>

namespace reference {

namespace {

using vkvol::Rgb;

constexpr double cie[][4] = {
// data, which the host has as well
#include "host/fields/cie_1931.inc"
};

// Tristimulus values of Planck's spectrum, wavelengths in metres; the constants h and c scale all temperatures alike.
Rgb tristimulus(double kelvin) {
    constexpr double h = 6.62607015e-34, c = 299792458.0, k = 1.380649e-23;
    Rgb sum(0.0);
    for (int i = 0; i < 2350; ++i) { // midpoints of fifths of nanometres
        const double nm = 360.0 + (i + 0.5) * 0.2, metre = nm * 1e-9;
        const double radiance = 2.0 * h * c * c / std::pow(metre, 5) / (std::exp(h * c / (metre * k * kelvin)) - 1.0);
        const int row = i / 25;
        const double part = (nm - cie[row][0]) / 5.0;
        for (int c = 0; c < 3; ++c)
            sum[c] += radiance * ((1.0 - part) * cie[row][c + 1] + part * cie[row + 1][c + 1]);
    }
    return sum;
}

} // namespace

Rgb blackbody(double kelvin, double reference) {
    if (kelvin <= 0.0)
        return Rgb(0.0);
    // Columns: what X, Y and Z give to red, green and blue (IEC 61966-2-1).
    const glm::dmat3 to_rgb(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.0415560,
                            1.0572252);
    const Rgb xyz = tristimulus(kelvin) / tristimulus(reference).y, shown = glm::max(to_rgb * xyz, Rgb(0.0));
    const double luminance = (glm::inverse(to_rgb) * shown).y;
    return luminance > 0.0 ? shown * (xyz.y / luminance) : shown;
}

Rgb Emission::at(const glm::dvec3& world, bool nearest_voxel) const {
    if (!colors.empty())
        return constant + temperature.color * colors.looked_up(world, nearest_voxel);
    if (grid.empty())
        return constant;
    const double value = grid.looked_up(grid.to_index(world), nearest_voxel);
    if (temperature.model == vkvol::TemperatureEmission::Model::color)
        return constant + value * temperature.color;
    const double kelvin = temperature.scale * value + temperature.offset;
    if (kelvin < temperature.cutoff)
        return constant;
    const double x = std::max(kelvin, 0.0) / spacing;
    const auto i = std::min(static_cast<std::size_t>(x), blackbodies.size() - 2);
    return constant + temperature.color * glm::mix(blackbodies[i], blackbodies[i + 1], x - static_cast<double>(i));
}

Emission load_emission(const vkvol::Volume& volume, const vkvol::GridFile* file) {
    Emission emission{volume.Le, volume.temperature, {}, {}, {}};
    if (!file || volume.temperature.color == Rgb(0.0) || !has_grid(file->path, volume.temperature.grid))
        return emission;
    if (has_colors(file->path, volume.temperature.grid)) {
        emission.colors = load_color_grid(file->path, volume.temperature.grid);
        return emission;
    }
    if (emission.temperature.model == vkvol::TemperatureEmission::Model::blackbody &&
        !(volume.temperature.reference > 0.0))
        throw std::runtime_error("the reference knows black bodies by the luminance at one temperature alone");
    emission.grid = load_grid(file->path, volume.temperature.grid);
    if (emission.temperature.model == vkvol::TemperatureEmission::Model::blackbody && !emission.grid.empty()) {
        const double warmest = *std::max_element(emission.grid.values.begin(), emission.grid.values.end());
        const double hottest =
            std::max(volume.temperature.scale * warmest + volume.temperature.offset, volume.temperature.offset);
        for (double kelvin = 0.0; kelvin < hottest + 2.0 * Emission::spacing; kelvin += Emission::spacing)
            emission.blackbodies.push_back(blackbody(kelvin, volume.temperature.reference));
    }
    return emission;
}

} // namespace reference
