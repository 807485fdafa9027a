#include "planck_band.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace vkvol {

namespace {

using std::numbers::pi;
constexpr double stefan_boltzmann = 5.670374419e-8;       // W / (m^2 K^4)
constexpr double second_radiation_constant = 14387.76877; // micrometres times kelvin

// 15 / pi^4 of the integral of t^3 / (exp(t) - 1) over t >= x: the sum of exp(-n t) t^3, or one less what is below x,
// by Bernoulli's numbers (Chang and Rhee, "Blackbody Radiation Functions", Int. Comm. Heat Mass Transfer 11, 1984).
double part_above(double x) {
    constexpr double all = pi * pi * pi * pi / 15.0;
    if (x < 1.0) {
        const double y = x * x;
        return 1.0 - x * y / all *
                         (1.0 / 3.0 - x / 8.0 +
                          y * (1.0 / 60.0 - y * (1.0 / 5040.0 - y * (1.0 / 272160.0 - y / 13305600.0))));
    }
    double sum = 0.0;
    for (double n = 1.0; n * x < 60.0; ++n)
        sum += std::exp(-n * x) * (((x + 3.0 / n) * x + 6.0 / (n * n)) * x + 6.0 / (n * n * n)) / n;
    return sum / all;
}

} // namespace

double planck_band(const std::vector<double>& arguments) {
    const double kelvin = arguments[0], from = arguments[1], to = arguments[2];
    if (!(kelvin > 0.0 && from >= 0.0 && to > from))
        return std::numeric_limits<double>::quiet_NaN();
    const auto below = [&](double wavelength) { // whose photons have more energy
        return wavelength > 0.0 ? part_above(second_radiation_constant / (wavelength * kelvin)) : 0.0;
    };
    return stefan_boltzmann / pi * std::pow(kelvin, 4.0) * (below(to) - below(from));
}

} // namespace vkvol
