#include "reference_surfaces.h"

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace reference {

using vkvol::Rgb;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double least = 1e-9; // from where a ray begins, in units of the scene's coordinates

void keep_nearer(std::optional<SurfaceHit>& found, double t, const glm::dvec3& normal, const vkvol::Surface& surface) {
    if (t > least && (!found || t < found->t))
        found = {t, normal, &surface};
}

// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
std::optional<double> meet_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const Ray& ray) {
    const glm::dvec3 u = b - a, v = c - a, p = glm::cross(ray.direction, v);
    const double det = glm::dot(u, p);
    if (det == 0.0)
        return std::nullopt;
    const glm::dvec3 s = ray.origin - a, q = glm::cross(s, u);
    const double x = glm::dot(s, p) / det, y = glm::dot(ray.direction, q) / det;
    return x >= 0.0 && y >= 0.0 && x + y <= 1.0 ? std::optional(glm::dot(v, q) / det) : std::nullopt;
}

void meet(const vkvol::Surface& surface, const Ray& ray, std::optional<SurfaceHit>& found) {
    if (const auto* ball = std::get_if<vkvol::BallSurface>(&surface.shape)) {
        const Interval inside = intersect(vkvol::Sphere{ball->center, ball->radius}, ray);
        if (!inside.empty())
            for (const double t : {inside.t0, inside.t1})
                keep_nearer(found, t, glm::normalize(ray.at(t) - ball->center), surface);
    } else if (const auto* mesh = std::get_if<vkvol::TriangleSurface>(&surface.shape)) {
        for (const glm::uvec3& k : mesh->triangles) {
            const glm::dvec3 a = mesh->vertices[k.x], b = mesh->vertices[k.y], c = mesh->vertices[k.z];
            if (const auto t = meet_triangle(a, b, c, ray))
                keep_nearer(found, *t, glm::normalize(glm::cross(b - a, c - a)), surface);
        }
    } else if (const auto* disk = std::get_if<vkvol::DiskSurface>(&surface.shape)) {
        const double t = glm::dot(disk->center - ray.origin, disk->normal) / glm::dot(ray.direction, disk->normal);
        if (glm::distance(ray.at(t), disk->center) <= disk->radius)
            keep_nearer(found, t, disk->normal, surface);
    } else if (const auto* r = std::get_if<vkvol::RectangleSurface>(&surface.shape)) {
        const glm::dvec3 normal = glm::normalize(glm::cross(r->edge_u, r->edge_v));
        const double t = glm::dot(r->center - ray.origin, normal) / glm::dot(ray.direction, normal);
        const glm::dvec3 at = ray.at(t) - r->center;
        if (std::abs(glm::dot(at, r->edge_u)) <= glm::dot(r->edge_u, r->edge_u) &&
            std::abs(glm::dot(at, r->edge_v)) <= glm::dot(r->edge_v, r->edge_v))
            keep_nearer(found, t, normal, surface);
    } else if (const auto* plane = std::get_if<vkvol::PlaneSurface>(&surface.shape)) {
        const double t = glm::dot(plane->point - ray.origin, plane->normal) / glm::dot(ray.direction, plane->normal);
        keep_nearer(found, t, plane->normal, surface);
    } else {
        throw std::runtime_error("the reference reads no files of surfaces");
    }
}

// By Fresnel's equations as they are in books, with the angle beyond by Snell's law, complex if need be.
double reflected(double cosine, std::complex<double> index) {
    const std::complex<double> sine = std::sqrt(1.0 - cosine * cosine) / index;
    const std::complex<double> beyond = std::sqrt(1.0 - sine * sine);
    const std::complex<double> across = (cosine - index * beyond) / (cosine + index * beyond);
    const std::complex<double> parallel = (index * cosine - beyond) / (index * cosine + beyond);
    return 0.5 * (std::norm(across) + std::norm(parallel));
}

Scattered through_glass(const vkvol::Material& material, glm::dvec3 normal, const glm::dvec3& travel, double u) {
    const bool inside = glm::dot(normal, travel) > 0.0;
    const double eta = inside ? 1.0 / material.ior : material.ior;
    normal = inside ? -normal : normal;
    const glm::dvec3 beyond = glm::refract(travel, normal, 1.0 / eta);
    const double F = beyond == glm::dvec3(0.0) ? 1.0 : reflected(std::min(-glm::dot(travel, normal), 1.0), eta);
    const double chance = F == 1.0 ? 1.0 : 0.25 + 0.5 * F; // of reflection
    if (u < chance)
        return {glm::reflect(travel, normal), material.color * (F / chance), true};
    return {beyond, material.color * ((1.0 - F) / (1.0 - chance) / (eta * eta)), true};
}

} // namespace

std::optional<SurfaceHit> nearest_surface(const std::vector<vkvol::Surface>& surfaces, const Ray& ray) {
    std::optional<SurfaceHit> found;
    for (const vkvol::Surface& surface : surfaces)
        meet(surface, ray, found);
    return found && found->t < ray.reach ? found : std::nullopt;
}

Rgb scatter_value(const SurfaceHit& hit, const glm::dvec3& travel, const glm::dvec3& direction) {
    const double before = -glm::dot(hit.normal, travel), after = glm::dot(hit.normal, direction);
    if (hit.surface->material.kind != vkvol::MaterialKind::diffuse || before * after <= 0.0)
        return Rgb(0.0);
    return hit.surface->material.color * std::abs(after) / pi;
}

Scattered scatter(const SurfaceHit& hit, const glm::dvec3& travel, const Draw& draw) {
    const vkvol::Material& material = hit.surface->material;
    const glm::dvec3 front = glm::dot(hit.normal, travel) > 0.0 ? -hit.normal : hit.normal;
    switch (material.kind) {
    case vkvol::MaterialKind::diffuse: { // evenly over the hemisphere
        const glm::dvec3 side =
            glm::normalize(glm::cross(front, std::abs(front.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
        const double mu = draw.x(), sine = std::sqrt(1.0 - mu * mu), phi = 2.0 * pi * draw.y();
        const glm::dvec3 direction =
            mu * front + sine * (std::cos(phi) * side + std::sin(phi) * glm::cross(front, side));
        return {direction, scatter_value(hit, travel, direction) * 2.0 * pi, false};
    }
    case vkvol::MaterialKind::mirror:
        return {glm::reflect(travel, front), material.color, true};
    case vkvol::MaterialKind::conductor: {
        Rgb F;
        for (int i = 0; i < 3; ++i)
            F[i] = reflected(-glm::dot(travel, front), {material.eta[i], material.k[i]});
        return {glm::reflect(travel, front), material.color * F, true};
    }
    case vkvol::MaterialKind::dielectric:
        return through_glass(material, hit.normal, travel, draw.x());
    }
    throw std::runtime_error("the reference knows no such material");
}

} // namespace reference
