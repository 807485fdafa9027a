#include "camera.h"

#include <cmath>
#include <numbers>

namespace reference {

namespace {

// Right-handed rotation by `degrees` about a coordinate axis: turns axis + 1 towards axis + 2.
glm::dvec3 rotate(const glm::dvec3& v, int axis, double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    glm::dvec3 r = v;
    r[a] = std::cos(angle) * v[a] - std::sin(angle) * v[b];
    r[b] = std::sin(angle) * v[a] + std::cos(angle) * v[b];
    return r;
}

// Evenly over a disk, or a regular polygon within it: over one of the parallelograms that two neighbouring corners span
// with the middle, of which the half beyond the edge is folded back.
glm::dvec2 on_aperture(const vkvol::Lens& lens, double u, double v) {
    if (lens.blades == 0)
        return std::sqrt(u) * glm::dvec2(std::cos(2.0 * std::numbers::pi * v), std::sin(2.0 * std::numbers::pi * v));
    const double half = std::numbers::pi / lens.blades, turn = lens.rotation * std::numbers::pi / 180.0;
    const auto corner = [&](double i) {
        return glm::dvec2(std::cos(turn + 2.0 * half * i), std::sin(turn + 2.0 * half * i));
    };
    const double first = std::floor(u * lens.blades), a = u * lens.blades - first;
    return a + v > 1.0 ? (1.0 - a) * corner(first) + (1.0 - v) * corner(first + 1.0)
                       : a * corner(first) + v * corner(first + 1.0);
}

} // namespace

Ray camera_ray(const vkvol::Camera& camera, const vkvol::Picture& picture, double x, double y, double lens_u,
               double lens_v) {
    const double u = (picture.start_x + x) / picture.reference_width;
    const double v = (picture.start_y + y) / picture.reference_height;
    const double aspect = picture.reference_width / picture.reference_height;
    const auto turned = [&](glm::dvec3 d) {
        return rotate(rotate(rotate(d, 0, camera.pitch), 1, camera.yaw), 2, camera.roll);
    };
    if (camera.projection == vkvol::Projection::orthographic) {
        const double h = 0.5 * camera.view_height;
        return {camera.position + turned({(2.0 * u - 1.0) * aspect * h, (1.0 - 2.0 * v) * h, 0.0}),
                turned({0.0, 0.0, -1.0})};
    }
    if (camera.projection == vkvol::Projection::equirectangular) {
        const double longitude = (2.0 * u - 1.0) * std::numbers::pi, latitude = (0.5 - v) * std::numbers::pi;
        return {camera.position, turned({std::cos(latitude) * std::sin(longitude), std::sin(latitude),
                                         -std::cos(latitude) * std::cos(longitude)})};
    }
    const double s = std::tan(0.5 * camera.fov * std::numbers::pi / 180.0);
    const glm::dvec3 pinhole((2.0 * u - 1.0) * aspect * s, (1.0 - 2.0 * v) * s, -1.0);
    const glm::dvec3 through = camera.lens.radius > 0.0
                                   ? camera.lens.radius * glm::dvec3(on_aperture(camera.lens, lens_u, lens_v), 0.0)
                                   : glm::dvec3(0.0);
    const glm::dvec3 towards = (camera.lens.radius > 0.0 ? camera.lens.focus : 1.0) * pinhole - through;
    return {camera.position + turned(through), turned(glm::normalize(towards))};
}

Ray rectangle_point(const vkvol::Camera& camera, const vkvol::Picture& picture, double x, double y) {
    const double u = (picture.start_x + x) / picture.reference_width - 0.5;
    const double v = 0.5 - (picture.start_y + y) / picture.reference_height;
    const auto turned = [&](glm::dvec3 d) {
        return rotate(rotate(rotate(d, 0, camera.pitch), 1, camera.yaw), 2, camera.roll);
    };
    return {camera.position + turned({u * camera.size.x, v * camera.size.y, 0.0}), turned({0.0, 0.0, -1.0})};
}

glm::dvec2 in_pixel(const vkvol::RenderSettings& settings, double u, double v) {
    // Inverts the distribution by bisection of its integral.
    const auto integral = [&](double x) { // from 0
        const double pi = std::numbers::pi;
        switch (settings.pixel_filter) {
        case vkvol::PixelFilter::tent:
            return x - 0.5 * x * std::abs(x);
        case vkvol::PixelFilter::gaussian: // exp(-4.5 x^2)
            return std::sqrt(pi / 18.0) * std::erf(std::sqrt(4.5) * x);
        case vkvol::PixelFilter::blackman_harris:
            return 0.35875 * x + (0.48829 * std::sin(pi * x) + 0.14128 / 2.0 * std::sin(2.0 * pi * x) +
                                  0.01168 / 3.0 * std::sin(3.0 * pi * x)) /
                                     pi;
        default:
            return x;
        }
    };
    const double whole = integral(1.0) - integral(-1.0);
    const auto place = [&](double share) {
        double low = -1.0, high = 1.0;
        const double target = integral(-1.0) + share * whole;
        for (int i = 0; i < 22; ++i)
            (integral(0.5 * (low + high)) < target ? low : high) = 0.5 * (low + high);
        return settings.pixel_filter_radius * low;
    };
    if (settings.pixel_filter == vkvol::PixelFilter::box)
        return settings.pixel_filter_radius * (2.0 * glm::dvec2(u, v) - 1.0);
    return {place(u), place(v)};
}

} // namespace reference
