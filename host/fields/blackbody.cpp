#include "blackbody.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace vkvol {

namespace {

// Spectral radiance up to a constant factor; c2 = h c / k in nm K. exp() overflows to infinity, which gives 0.
double planck(double nanometre, double kelvin) {
    constexpr double c2 = 1.438776877e7;
    return 1e15 / (std::pow(nanometre, 5) * std::expm1(c2 / (nanometre * kelvin)));
}

constexpr double observer_rows[][4] = {
#include "cie_1931.inc"
};
constexpr double first_nm = 360.0, row_nm = 5.0;
constexpr int rows = std::size(observer_rows);

glm::dvec3 observer_row(int row) {
    return {observer_rows[row][1], observer_rows[row][2], observer_rows[row][3]};
}

// Over nanometres, by Simpson's rule between rows, where the observer is linear: off by less than 1e-6.
glm::dvec3 blackbody_xyz(double kelvin) {
    glm::dvec3 sum(0.0);
    for (int row = 0; row + 1 < rows; ++row) {
        const double nm = first_nm + row_nm * row;
        const glm::dvec3 here = observer_row(row), next = observer_row(row + 1);
        sum += row_nm / 6.0 *
               (planck(nm, kelvin) * here + 2.0 * planck(nm + 0.5 * row_nm, kelvin) * (here + next) +
                planck(nm + row_nm, kelvin) * next);
    }
    return sum;
}

// The most that Planck's law has at any wavelength, by Wien's displacement law.
double largest_planck(double kelvin) {
    return planck(2.897771955e6 / kelvin, kelvin);
}

} // namespace

glm::dvec3 observer(double nm) {
    const double along = (nm - first_nm) / row_nm;
    if (!(along >= 0.0 && along <= rows - 1))
        return glm::dvec3(0.0);
    const int row = std::min(static_cast<int>(along), rows - 2);
    return glm::mix(observer_row(row), observer_row(row + 1), along - row);
}

glm::dvec3 blackbody_rgb(double kelvin, double reference) {
    if (!(kelvin > 0.0))
        return glm::dvec3(0.0);
    const double unit = reference > 0.0 ? blackbody_xyz(reference).y : largest_planck(kelvin);
    if (!(unit > 0.0)) { // nothing of it is to be seen, and any other glow is beyond all numbers beside it
        const bool is_seen = reference > 0.0 && blackbody_xyz(kelvin).y > 0.0;
        return glm::dvec3(is_seen ? std::numeric_limits<double>::infinity() : 0.0);
    }
    const glm::dvec3 xyz = blackbody_xyz(kelvin) / unit;
    const glm::dvec3 rgb(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                         -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                         0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
    // What is redder than Rec.709 has room for loses its negative green and blue, and keeps its luminance.
    const glm::dvec3 shown = glm::max(rgb, glm::dvec3(0.0));
    const double luminance = glm::dot(shown, glm::dvec3(0.2126729, 0.7151522, 0.0721750));
    return reference > 0.0 && luminance > 0.0 ? shown * (xyz.y / luminance) : shown;
}

std::vector<glm::vec4> make_blackbody_table(double low, double high, double reference, int count) {
    std::vector<glm::vec4> table(count);
    for (int i = 0; i < count; ++i)
        table[i] = glm::vec4(blackbody_rgb(low + (high - low) * i / (count - 1), reference), 0.0f);
    return table;
}

} // namespace vkvol
