#include "blackbody.h"

#include <cmath>

namespace vkvol {

namespace {

// Spectral radiance up to a constant factor; c2 = h c / k in nm K. exp() overflows to infinity, which gives 0.
double planck(double nanometre, double kelvin) {
    constexpr double c2 = 1.438776877e7;
    return 1e15 / (std::pow(nanometre, 5) * std::expm1(c2 / (nanometre * kelvin)));
}

double lobe(double x, double center, double below, double above) {
    const double t = (x - center) * (x < center ? below : above);
    return std::exp(-0.5 * t * t);
}

constexpr double nm_step = 2.0; // the integrand is smooth: steps of 2 nm and of 1 nm agree to 1e-6

glm::dvec3 blackbody_xyz(double kelvin) {
    glm::dvec3 sum(0.0);
    for (double nm = 360.0; nm <= 830.0; nm += nm_step)
        sum += planck(nm, kelvin) * observer(nm);
    return sum;
}

// Of all wavelengths, by Wien's displacement law.
double largest_planck(double kelvin) {
    return planck(2.897771955e6 / kelvin, kelvin);
}

} // namespace

// Wyman, Sloan, Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions", 2013, multi-lobe
// fit.
glm::dvec3 observer(double nm) {
    return {1.056 * lobe(nm, 599.8, 0.0264, 0.0323) + 0.362 * lobe(nm, 442.0, 0.0624, 0.0374) -
                0.065 * lobe(nm, 501.1, 0.0490, 0.0382),
            0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322),
            1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725)};
}

glm::dvec3 blackbody_rgb(double kelvin, double reference) {
    if (!(kelvin > 0.0))
        return glm::dvec3(0.0);
    const double unit = reference > 0.0 ? blackbody_xyz(reference).y : largest_planck(kelvin) / nm_step;
    if (!(unit > 0.0)) // nothing of it is to be seen
        return glm::dvec3(0.0);
    const glm::dvec3 xyz = blackbody_xyz(kelvin) / unit;
    const glm::dvec3 rgb(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                         -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                         0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
    return glm::max(rgb, glm::dvec3(0.0));
}

std::vector<glm::vec3> make_blackbody_table(double low, double high, double reference, int count) {
    std::vector<glm::vec3> table(count);
    for (int i = 0; i < count; ++i)
        table[i] = blackbody_rgb(low + (high - low) * i / (count - 1), reference);
    return table;
}

} // namespace vkvol
