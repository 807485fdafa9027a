#include "reference_lights.h"

#include <OpenImageIO/imagebuf.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "phase.h"

using std::numbers::pi;

namespace reference {

using vkvol::Rgb;

namespace {

double radians(double degrees) {
    return degrees * pi / 180.0;
}

struct Ask {
    const glm::dvec3& p;
    double u, v;

    std::optional<Towards> operator()(const vkvol::DirectionalLight& light) const {
        return Towards{{p, light.direction}, light.irradiance};
    }
    // Evenly over the disc's solid angle, by the cosine.
    std::optional<Towards> operator()(const vkvol::SunLight& sun) const {
        const double rim = std::cos(radians(0.5 * sun.angle));
        const glm::dvec3 direction = turned(sun.direction, 1.0 - u * (1.0 - rim), v);
        return Towards{{p, direction}, disc_radiance(sun, direction) * (2.0 * pi * (1.0 - rim))};
    }
    std::optional<Towards> operator()(const vkvol::PointLight& light) const {
        const double distance = glm::distance(light.position, p);
        return Towards{{p, (light.position - p) / distance, distance}, light.intensity / (distance * distance)};
    }
    std::optional<Towards> operator()(const vkvol::SpotLight& spot) const {
        const auto found = (*this)(vkvol::PointLight{spot.position, spot.intensity});
        const double none = std::cos(radians(0.5 * spot.angle));
        const double full = std::cos(radians(0.5 * spot.angle * (1.0 - spot.blend)));
        const double cosine = glm::dot(-found->ray.direction, spot.direction);
        if (cosine <= none)
            return std::nullopt;
        const double t = cosine >= full ? 1.0 : (cosine - none) / (full - none);
        return Towards{found->ray, found->light * (3.0 * t * t - 2.0 * t * t * t)};
    }
    // Lamps by an even choice of a point of their surface; a ball's far side does not shine at p.
    std::optional<Towards> operator()(const vkvol::SphereLight& ball) const {
        const glm::dvec3 normal = turned({0.0, 0.0, 1.0}, 1.0 - 2.0 * u, v);
        return from_point(ball.center + ball.radius * normal, normal, 4.0 * pi * ball.radius * ball.radius,
                          ball.radiance);
    }
    std::optional<Towards> operator()(const vkvol::DiskLight& disk) const {
        const glm::dvec3 at = disk.radius * std::sqrt(u) * turned(disk.normal, 0.0, v); // a right angle to the normal
        return from_point(disk.center + at, disk.normal, pi * disk.radius * disk.radius, disk.radiance);
    }
    std::optional<Towards> operator()(const vkvol::RectangleLight& r) const {
        const double area = 4.0 * glm::length(glm::cross(r.edge_u, r.edge_v));
        return from_point(r.center + (2.0 * u - 1.0) * r.edge_u + (2.0 * v - 1.0) * r.edge_v, r.normal(), area,
                          r.radiance);
    }
    std::optional<Towards> from_point(const glm::dvec3& point, const glm::dvec3& normal, double area,
                                      const Rgb& radiance) const {
        const double distance = glm::distance(point, p);
        const glm::dvec3 direction = (point - p) / distance;
        const double cosine = -glm::dot(direction, normal);
        if (cosine <= 0.0)
            return std::nullopt;
        return Towards{{p, direction, distance}, radiance * (area * cosine / (distance * distance))};
    }
    std::optional<Towards> operator()(const vkvol::SkyLight&) const { return std::nullopt; }
    std::optional<Towards> operator()(const vkvol::SurfaceLight&) const { return std::nullopt; } // it has no surfaces
    std::optional<Towards> operator()(const vkvol::GlowLight&) const { return std::nullopt; } // flights meet all of it
};

} // namespace

std::optional<Towards> towards(const vkvol::Light& light, const glm::dvec3& p, double u, double v) {
    return std::visit(Ask{p, u, v}, light);
}

Rgb disc_radiance(const vkvol::Light& light, const glm::dvec3& direction) {
    const auto* sun = std::get_if<vkvol::SunLight>(&light);
    if (!sun)
        return Rgb(0.0);
    // Where a line of sight meets a ball of radius sin(half) at a distance of 1, and at what angle to its surface.
    const double radius = std::sin(radians(0.5 * sun->angle));
    const double miss = glm::length(glm::cross(direction, sun->direction)) / radius;
    if (miss >= 1.0 || glm::dot(direction, sun->direction) <= 0.0)
        return Rgb(0.0);
    const double mu = std::cos(std::asin(miss)), u = sun->limb_darkening;
    // With u = 1 a disc gives two thirds of what an even one of its middle's radiance does.
    const Rgb even = sun->irradiance / (pi * radius * radius);
    return even * ((1.0 - u + u * mu) / std::lerp(1.0, 2.0 / 3.0, u));
}

std::optional<double> lamp_distance(const vkvol::Light& light, const Ray& ray) {
    const auto plane = [&](const glm::dvec3& center, const glm::dvec3& normal) {
        const double facing = -glm::dot(ray.direction, normal);
        return facing > 0.0 ? glm::dot(ray.origin - center, normal) / facing : -1.0;
    };
    double t = -1.0;
    if (const auto* ball = std::get_if<vkvol::SphereLight>(&light))
        t = intersect(vkvol::Sphere{ball->center, ball->radius}, ray).empty()
                ? -1.0
                : intersect(vkvol::Sphere{ball->center, ball->radius}, ray).t0;
    if (const auto* disk = std::get_if<vkvol::DiskLight>(&light)) {
        t = plane(disk->center, disk->normal);
        t = glm::distance(ray.at(t), disk->center) < disk->radius ? t : -1.0;
    }
    if (const auto* r = std::get_if<vkvol::RectangleLight>(&light)) {
        t = plane(r->center, r->normal());
        const glm::dvec3 at = ray.at(t) - r->center;
        const bool on = std::abs(glm::dot(at, r->edge_u)) < glm::dot(r->edge_u, r->edge_u) &&
                        std::abs(glm::dot(at, r->edge_v)) < glm::dot(r->edge_v, r->edge_v);
        t = on ? t : -1.0;
    }
    return t > 0.0 ? std::optional(t) : std::nullopt;
}

Rgb lamp_radiance(const vkvol::Light& light) {
    if (const auto* ball = std::get_if<vkvol::SphereLight>(&light))
        return ball->radiance;
    if (const auto* disk = std::get_if<vkvol::DiskLight>(&light))
        return disk->radiance;
    return std::get<vkvol::RectangleLight>(light).radiance;
}

// By eighths of the sphere: in each the mapping is the same but for signs (Clarberg 2008, sections 3 and 4).
glm::dvec2 equal_area_place(const glm::dvec3& direction) {
    const glm::dvec3 a = glm::abs(direction);
    const double r = std::sqrt(std::max(1.0 - a.z, 0.0));
    const double quarter = a.x + a.y > 0.0 ? std::atan2(a.y, a.x) / (0.5 * pi) : 0.0;
    glm::dvec2 q(r * (1.0 - quarter), r * quarter);
    if (direction.z < 0.0)
        q = {1.0 - q.y, 1.0 - q.x};
    return 0.5 + 0.5 * glm::dvec2(std::copysign(q.x, direction.x), std::copysign(q.y, direction.y));
}

glm::dvec3 equal_area_direction(const glm::dvec2& place) {
    const glm::dvec2 signs = 2.0 * place - 1.0;
    glm::dvec2 q = glm::abs(signs);
    const bool below = q.x + q.y > 1.0;
    if (below)
        q = {1.0 - q.y, 1.0 - q.x};
    const double r = q.x + q.y, phi = r > 0.0 ? 0.5 * pi * q.y / r : 0.0, cosine = 1.0 - r * r;
    const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
    return {std::copysign(sine * std::cos(phi), signs.x), std::copysign(sine * std::sin(phi), signs.y),
            below ? -cosine : cosine};
}

namespace {

// The place of the neighbour's middle, if need be beyond the map's edge, is wrapped as a place.
Rgb equal_area_radiance(const Sky& sky, const glm::dvec3& direction) {
    const double angle = radians(sky.rotation);
    const glm::dvec3 turned_back(direction.x * std::cos(angle) - direction.z * std::sin(angle), direction.y,
                                 direction.z * std::cos(angle) + direction.x * std::sin(angle));
    const glm::dvec2 place =
        equal_area_place({turned_back.x, turned_back.z, turned_back.y}) * double(sky.width) - glm::dvec2(0.5);
    const glm::dvec2 corner = glm::floor(place), f = place - corner;
    Rgb sum(0.0);
    for (const glm::dvec2 next : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(1, 1)}) {
        glm::dvec2 at = (corner + next + 0.5) / double(sky.width);
        for (const int axis : {0, 1})
            if (at[axis] < 0.0 || at[axis] > 1.0) {
                at[axis] = at[axis] < 0.0 ? -at[axis] : 2.0 - at[axis];
                at[1 - axis] = 1.0 - at[1 - axis];
            }
        const glm::dvec2 weights = next * f + (1.0 - next) * (1.0 - f), texel = glm::floor(at * double(sky.width));
        sum += weights.x * weights.y * sky.texels[static_cast<std::size_t>(texel.y * sky.width + texel.x)];
    }
    return sum;
}

} // namespace

Rgb Sky::radiance(const glm::dvec3& direction) const {
    if (mapping == vkvol::SkyMapping::equal_area)
        return equal_area_radiance(*this, direction);
    const double longitude = std::atan2(direction.x, -direction.z) + radians(rotation); // of the map's middle: 0
    const double latitude = std::acos(std::clamp(direction.y, -1.0, 1.0));
    const double x = (longitude / (2.0 * pi) + 0.5) * width - 0.5, y = latitude / pi * height - 0.5;
    const auto texel = [&](double column, double row) {
        const int i = static_cast<int>(column - width * std::floor(column / width)) % width;
        const int j = std::clamp(static_cast<int>(row), 0, height - 1);
        return texels[static_cast<std::size_t>(j) * width + i];
    };
    const double left = std::floor(x), top = std::floor(y), f = x - left, g = y - top;
    return (1.0 - g) * ((1.0 - f) * texel(left, top) + f * texel(left + 1.0, top)) +
           g * ((1.0 - f) * texel(left, top + 1.0) + f * texel(left + 1.0, top + 1.0));
}

std::optional<Sky> load_sky(const std::vector<vkvol::Light>& lights) {
    for (const vkvol::Light& light : lights)
        if (const auto* authored = std::get_if<vkvol::SkyLight>(&light)) {
            OIIO::ImageBuf image(authored->file.string());
            if (!image.read(0, 0, true, OIIO::TypeDesc::FLOAT))
                throw std::runtime_error(image.geterror());
            Sky sky{image.spec().width, image.spec().height, {}, authored->rotation, authored->mapping};
            for (int y = 0; y < sky.height; ++y)
                for (int x = 0; x < sky.width; ++x) {
                    float texel[3];
                    image.getpixel(authored->mirror ? sky.width - 1 - x : x, y, 0, texel, 3);
                    sky.texels.push_back(Rgb(texel[0], texel[1], texel[2]) * authored->scale);
                }
            return sky;
        }
    return std::nullopt;
}

} // namespace reference
