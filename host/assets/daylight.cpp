#include "daylight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "blackbody.h"

namespace vkvol {

namespace {

using std::numbers::pi;
constexpr int map_width = 512, map_height = 256;

using Perez = std::array<double, 5>;

// Appendix A.2 of the paper; T: turbidity.
Perez luminance_terms(double T) {
    return {0.1787 * T - 1.4630, -0.3554 * T + 0.4275, -0.0227 * T + 5.3251, 0.1206 * T - 2.5771, -0.0670 * T + 0.3703};
}
Perez x_terms(double T) {
    return {-0.0193 * T - 0.2592, -0.0665 * T + 0.0008, -0.0004 * T + 0.2125, -0.0641 * T - 0.8989,
            -0.0033 * T + 0.0452};
}
Perez y_terms(double T) {
    return {-0.0167 * T - 0.2608, -0.0950 * T + 0.0092, -0.0079 * T + 0.2102, -0.0441 * T - 1.6537,
            -0.0109 * T + 0.0529};
}

// `theta` from the zenith, `gamma` from the sun.
double perez(const Perez& p, double cos_theta, double gamma) {
    const double cosine = std::cos(gamma);
    return (1.0 + p[0] * std::exp(p[1] / cos_theta)) * (1.0 + p[2] * std::exp(p[3] * gamma) + p[4] * cosine * cosine);
}

// The zenith's, by powers of the sun's angle from it.
double zenith_luminance(double T, double sun) {
    const double chi = (4.0 / 9.0 - T / 120.0) * (pi - 2.0 * sun);
    return (4.0453 * T - 4.9710) * std::tan(chi) - 0.2155 * T + 2.4192;
}
double zenith_x(double T, double s) {
    return T * T * (((0.00166 * s - 0.00375) * s + 0.00209) * s) +
           T * (((-0.02903 * s + 0.06377) * s - 0.03202) * s + 0.00394) +
           (((0.11693 * s - 0.21196) * s + 0.06052) * s + 0.25886);
}
double zenith_y(double T, double s) {
    return T * T * (((0.00275 * s - 0.00610) * s + 0.00317) * s) +
           T * (((-0.04214 * s + 0.08970) * s - 0.04153) * s + 0.00516) +
           (((0.15346 * s - 0.26756) * s + 0.06670) * s + 0.26688);
}

// Rec.709 of chromaticities and luminance; what it cannot show is clipped.
Rgb rgb_of(double x, double y, double Y) {
    const double X = x / y * Y, Z = (1.0 - x - y) / y * Y;
    return glm::max(Rgb(3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z, -0.9692660 * X + 1.8760108 * Y + 0.0415560 * Z,
                        0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z),
                    Rgb(0.0));
}

class Sky {
public:
    explicit Sky(const Daylight& daylight)
        : sun_(daylight.sun), angle_(std::acos(std::clamp(daylight.sun.y, 0.0, 1.0))),
          Y_(luminance_terms(daylight.turbidity)), x_(x_terms(daylight.turbidity)),
          y_(y_terms(daylight.turbidity)), zenith_{zenith_luminance(daylight.turbidity, angle_),
                                                   zenith_x(daylight.turbidity, angle_),
                                                   zenith_y(daylight.turbidity, angle_)} {}

    // Above the horizon.
    Rgb radiance(const glm::dvec3& direction) const {
        const double gamma = std::acos(std::clamp(glm::dot(direction, sun_), -1.0, 1.0));
        const double cosine = std::max(direction.y, 0.01); // at the horizon itself the model has a quotient by 0
        const auto ratio = [&](const Perez& terms) { return perez(terms, cosine, gamma) / perez(terms, 1.0, angle_); };
        return rgb_of(zenith_[1] * ratio(x_), zenith_[2] * ratio(y_), std::max(zenith_[0] * ratio(Y_), 0.0));
    }

private:
    glm::dvec3 sun_;
    double angle_; // from the zenith
    Perez Y_, x_, y_;
    std::array<double, 3> zenith_;
};

// As shaders/lights/sky.glsl lays directions out.
glm::dvec3 direction_of(int column, int row) {
    const double latitude = pi * (row + 0.5) / map_height, longitude = 2.0 * pi * ((column + 0.5) / map_width - 0.5);
    return {std::sin(latitude) * std::sin(longitude), std::cos(latitude), -std::sin(latitude) * std::cos(longitude)};
}

} // namespace

Rgb sun_irradiance(const Daylight& daylight) {
    constexpr double kelvin = 5778.0, illuminance = 133.0;
    const double degrees = std::acos(std::clamp(daylight.sun.y, 0.0, 1.0)) * 180.0 / pi;
    // Kasten's optical mass of the air, and the transmittances of appendix A.1 of air, haze and 0.35 cm of ozone, whose
    // absorption per cm Iqbal has ("An Introduction to Solar Radiation", 1983, p. 127).
    const double mass = 1.0 / (std::max(daylight.sun.y, 0.0) + 0.15 * std::pow(93.885 - degrees, -1.253));
    const double haze = 0.04608 * daylight.turbidity - 0.04586;
    constexpr double micrometres[3] = {0.610, 0.550, 0.465}, ozone[3] = {0.12, 0.085, 0.008};
    Rgb irradiance = illuminance * blackbody_rgb(kelvin, kelvin);
    for (int c = 0; c < 3; ++c)
        irradiance[c] *= std::exp(-mass * (0.008735 * std::pow(micrometres[c], -4.08) +
                                           haze * std::pow(micrometres[c], -1.3) + 0.35 * ozone[c]));
    return irradiance;
}

RadianceMap make_daylight(const Daylight& daylight) {
    RadianceMap map{map_width, map_height, std::vector<glm::vec3>(std::size_t(map_width) * map_height), 0};
    const Sky sky(daylight);
    Rgb irradiance = sun_irradiance(daylight) * std::max(daylight.sun.y, 0.0); // of the ground
    for (int row = 0; row < map_height / 2; ++row)
        for (int column = 0; column < map_width; ++column) {
            const glm::dvec3 direction = direction_of(column, row);
            const Rgb radiance = sky.radiance(direction);
            map.texels[std::size_t(row) * map_width + column] = radiance;
            const double angle =
                2.0 * pi * pi / (double(map_width) * map_height) * std::sin(pi * (row + 0.5) / map_height);
            irradiance += angle * direction.y * radiance;
        }
    const auto ground = map.texels.begin() + std::ptrdiff_t(map_width) * (map_height / 2);
    std::fill(ground, map.texels.end(), glm::vec3(daylight.ground / pi * irradiance));
    return map;
}

} // namespace vkvol
