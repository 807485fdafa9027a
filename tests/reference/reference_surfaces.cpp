#include "reference_surfaces.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "reference_facets.h"

using std::numbers::pi;

namespace reference {

using vkvol::Rgb;

namespace {

constexpr double least = 1e-9; // from where a ray begins, in units of the scene's coordinates

void keep_nearer(std::optional<SurfaceHit>& found, double t, const glm::dvec3& normal, const vkvol::Surface& surface) {
    if (t > least && (!found || t < found->t))
        found = {t, normal, normal, &surface, {}};
}

// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
// Distance, and the shares that b and c have of the point.
std::optional<glm::dvec3> meet_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const Ray& ray) {
    const glm::dvec3 u = b - a, v = c - a, p = glm::cross(ray.direction, v);
    const double det = glm::dot(u, p);
    if (det == 0.0)
        return std::nullopt;
    const glm::dvec3 s = ray.origin - a, q = glm::cross(s, u);
    const double x = glm::dot(s, p) / det, y = glm::dot(ray.direction, q) / det;
    return x >= 0.0 && y >= 0.0 && x + y <= 1.0 ? std::optional(glm::dvec3(glm::dot(v, q) / det, x, y)) : std::nullopt;
}

// Place on what is no mesh, in shares of its texture from the lower left.
glm::dvec2 place_on(const vkvol::Surface& surface, const glm::dvec3& at, const glm::dvec3& normal) {
    const glm::dvec3 own = glm::transpose(surface.axes) * normal;
    if (std::holds_alternative<vkvol::BallSurface>(surface.shape))
        return {0.5 + std::atan2(own.x, own.z) / (2.0 * pi), 0.5 + std::asin(glm::clamp(own.y, -1.0, 1.0)) / pi};
    if (const auto* disk = std::get_if<vkvol::DiskSurface>(&surface.shape))
        return 0.5 + glm::dvec2(glm::transpose(surface.axes) * (at - disk->center)) / (2.0 * disk->radius);
    if (const auto* plane = std::get_if<vkvol::PlaneSurface>(&surface.shape))
        return glm::transpose(surface.axes) * (at - plane->point);
    const auto& r = std::get<vkvol::RectangleSurface>(surface.shape);
    const auto share = [&](const glm::dvec3& edge) {
        return 0.5 + 0.5 * glm::dot(at - r.center, edge) / glm::dot(edge, edge);
    };
    return {share(r.edge_u), share(r.edge_v)};
}

// The sum of all texels' tents, of which four are not 0 there; or of a board its square's.
Rgb texture_color(const vkvol::Material& material, const glm::dvec2& place) {
    const vkvol::Texture& image = *material.image;
    const double x = place.x * material.repeat.x * image.width, y = -place.y * material.repeat.y * image.height;
    const auto texel = [&](double column, double row) {
        const auto wrapped = [](double i, int n) { return static_cast<int>(i - n * std::floor(i / n)); };
        return Rgb(image.colors[std::size_t(wrapped(row, image.height) * image.width + wrapped(column, image.width))]);
    };
    if (image.is_nearest)
        return texel(std::floor(x), std::floor(y));
    Rgb color(0.0);
    for (const double column : {std::floor(x - 0.5), std::floor(x + 0.5)})
        for (const double row : {std::floor(y - 0.5), std::floor(y + 0.5)})
            color += (1.0 - std::abs(x - column - 0.5)) * (1.0 - std::abs(y - row - 0.5)) * texel(column, row);
    return color;
}

vkvol::Material material_at(const SurfaceHit& hit) {
    vkvol::Material material = hit.surface->material;
    if (material.image)
        material.color *= texture_color(material, hit.place);
    return material;
}

void meet(const vkvol::Surface& surface, const Ray& ray, std::optional<SurfaceHit>& found) {
    if (const auto* ball = std::get_if<vkvol::BallSurface>(&surface.shape)) {
        const Interval inside = intersect(vkvol::Sphere{ball->center, ball->radius}, ray);
        if (!inside.empty())
            for (const double t : {inside.t0, inside.t1})
                keep_nearer(found, t, glm::normalize(ray.at(t) - ball->center), surface);
    } else if (const auto* mesh = std::get_if<vkvol::TriangleSurface>(&surface.shape)) {
        for (std::size_t i = 0; i < mesh->triangles.size(); ++i) {
            const glm::uvec3 k = mesh->triangles[i];
            const glm::dvec3 a = mesh->vertices[k.x], b = mesh->vertices[k.y], c = mesh->vertices[k.z];
            const auto at = meet_triangle(a, b, c, ray);
            const double before = found ? found->t : -1.0;
            if (at)
                keep_nearer(found, at->x, glm::normalize(glm::cross(b - a, c - a)), surface);
            if (at && !mesh->places.empty() && found && found->t != before) {
                const glm::dmat3x2 p(mesh->places[i]);
                found->place = p[0] + at->y * (p[1] - p[0]) + at->z * (p[2] - p[0]);
            }
            if (at && !mesh->normals.empty() && found && found->t != before) {
                const glm::dmat3 n(mesh->normals[i]);
                const glm::dvec3 mixed = n[0] + at->y * (n[1] - n[0]) + at->z * (n[2] - n[0]);
                found->smooth = glm::dot(mixed, found->normal) > 0.0 ? glm::normalize(mixed) : found->normal;
            }
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

// The share of even light from within a boundary of index `ior` that it throws back: the mean over angles.
double thrown_back(double ior) {
    constexpr int n = 2000;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
        const double square = (i + 0.5) / n; // of the sine
        sum += std::sqrt(square) * ior >= 1.0 ? 1.0 : reflected(std::sqrt(1.0 - square), 1.0 / ior);
    }
    return sum / n;
}

// Evenly over the hemisphere, or by cosine.
glm::dvec3 about(const glm::dvec3& front, double mu, double u) {
    const glm::dvec3 side =
        glm::normalize(glm::cross(front, std::abs(front.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const double sine = std::sqrt(1.0 - mu * mu), phi = 2.0 * pi * u;
    return mu * front + sine * (std::cos(phi) * side + std::sin(phi) * glm::cross(front, side));
}

// To and fro between the coat and what is diffuse below it.
Scattered through_coat(const vkvol::Material& material, const glm::dvec3& front, const glm::dvec3& travel, double u,
                       Rng& rng) {
    if (u < reflected(std::min(-glm::dot(travel, front), 1.0), material.ior))
        return {glm::reflect(travel, front), Rgb(1.0), true};
    Rgb weight(1.0);
    for (int i = 0; i < 1000; ++i) {
        const Draw draw = rng.next();
        weight *= material.color;
        const glm::dvec3 inside = about(front, std::sqrt(1.0 - draw.x()), draw.y());
        const glm::dvec3 beyond = glm::refract(inside, -front, material.ior);
        if (beyond != glm::dvec3(0.0) && draw.z() >= reflected(glm::dot(inside, front), 1.0 / material.ior))
            return {glm::normalize(beyond), weight, false};
    }
    return {front, Rgb(0.0), false};
}

Scattered through_glass(const vkvol::Material& material, bool inside, const glm::dvec3& normal,
                        const glm::dvec3& travel, double u) {
    const double eta = inside ? 1.0 / material.ior : material.ior;
    const glm::dvec3 beyond = glm::refract(travel, normal, 1.0 / eta);
    const double F = beyond == glm::dvec3(0.0) ? 1.0 : reflected(std::min(-glm::dot(travel, normal), 1.0), eta);
    const double chance = F == 1.0 ? 1.0 : 0.25 + 0.5 * F; // of reflection
    if (u < chance)
        return {glm::reflect(travel, normal), material.color * (F / chance), true};
    return {beyond, material.color * ((1.0 - F) / (1.0 - chance) / (eta * eta)), true};
}

// By the two sides of a pane, one after the other, until light leaves it on one of them.
Scattered through_pane(const vkvol::Material& material, const glm::dvec3& normal, const glm::dvec3& travel, Rng& rng) {
    const double F = reflected(std::min(-glm::dot(travel, normal), 1.0), material.ior);
    bool inside = rng.next().x() >= F, at_far_side = true, passed = false;
    for (; inside; at_far_side = !at_far_side)
        if (rng.next().x() >= F) {
            inside = false;
            passed = at_far_side;
        }
    return {passed ? travel : glm::reflect(travel, normal), material.color, true};
}

// On the side where light travels to: the face, and what it stands for, unless that would be seen from behind.
struct Sides {
    bool behind;
    glm::dvec3 face, front;

    Sides(const SurfaceHit& hit, const glm::dvec3& travel) : behind(glm::dot(hit.normal, travel) > 0.0) {
        face = behind ? -hit.normal : hit.normal;
        front = behind ? -hit.smooth : hit.smooth;
        if (glm::dot(front, travel) >= 0.0)
            front = face;
    }
    // Before one and behind the other.
    bool disagree(const glm::dvec3& w) const { return (glm::dot(face, w) > 0.0) != (glm::dot(front, w) > 0.0); }
};

Rgb value(const vkvol::Material& material, const Sides& sides, const glm::dvec3& travel, const glm::dvec3& direction,
          Rng& rng) {
    const double before = -glm::dot(sides.front, travel), after = glm::dot(sides.front, direction);
    if (material.roughness > 0.0) {
        const bool glass = material.kind == vkvol::MaterialKind::dielectric;
        if (!glass && after <= 0.0)
            return Rgb(0.0);
        return material.color * facets_value(material, sides.behind && glass ? 1.0 / material.ior : material.ior,
                                             sides.front, -travel, direction, rng);
    }
    if (after <= 0.0)
        return Rgb(0.0);
    if (material.kind == vkvol::MaterialKind::diffuse)
        return material.color * after / pi;
    if (material.kind != vkvol::MaterialKind::coated)
        return Rgb(0.0);
    static thread_local double known_ior = 0.0, back = 0.0;
    if (material.ior != known_ior)
        back = thrown_back(known_ior = material.ior);
    const double passes = (1.0 - reflected(before, material.ior)) * (1.0 - reflected(after, material.ior));
    return material.color * (after / pi * passes / (material.ior * material.ior)) / (1.0 - back * material.color);
}

Scattered drawn(const vkvol::Material& material, const Sides& sides, const glm::dvec3& travel, const Draw& draw,
                Rng& rng) {
    const glm::dvec3& front = sides.front;
    if (material.roughness > 0.0) {
        const bool glass = material.kind == vkvol::MaterialKind::dielectric;
        const double eta = glass && sides.behind ? 1.0 / material.ior : material.ior;
        const FacetSample sample = facets_scatter(material, eta, front, -travel, rng);
        const bool crosses = glm::dot(sample.direction, front) < 0.0;
        return {sample.direction, material.color * sample.weight / (crosses ? eta * eta : 1.0), false};
    }
    switch (material.kind) {
    case vkvol::MaterialKind::diffuse:
        return {about(front, draw.x(), draw.y()), material.color * 2.0 * draw.x(), false};
    case vkvol::MaterialKind::mirror:
        return {glm::reflect(travel, front), material.color, true};
    case vkvol::MaterialKind::conductor: {
        Rgb F;
        for (int i = 0; i < 3; ++i)
            F[i] = reflected(-glm::dot(travel, front), {material.eta[i], material.k[i]});
        return {glm::reflect(travel, front), material.color * F, true};
    }
    case vkvol::MaterialKind::dielectric:
        return through_glass(material, sides.behind, front, travel, draw.x());
    case vkvol::MaterialKind::coated:
        return through_coat(material, front, travel, draw.x(), rng);
    case vkvol::MaterialKind::thin_dielectric:
        return through_pane(material, front, travel, rng);
    }
    throw std::runtime_error("the reference knows no such material");
}

} // namespace

std::optional<SurfaceHit> nearest_surface(const std::vector<vkvol::Surface>& surfaces, const Ray& ray) {
    std::optional<SurfaceHit> found;
    for (const vkvol::Surface& surface : surfaces)
        meet(surface, ray, found);
    if (found && !std::holds_alternative<vkvol::TriangleSurface>(found->surface->shape))
        found->place = place_on(*found->surface, ray.at(found->t), found->normal);
    return found && found->t < ray.reach ? found : std::nullopt;
}

Rgb scatter_value(const SurfaceHit& hit, const glm::dvec3& travel, const glm::dvec3& direction, Rng& rng) {
    const Sides sides(hit, travel);
    return sides.disagree(direction) ? Rgb(0.0) : value(material_at(hit), sides, travel, direction, rng);
}

Scattered scatter(const SurfaceHit& hit, const glm::dvec3& travel, const Draw& draw, Rng& rng) {
    const Sides sides(hit, travel);
    Scattered next = drawn(material_at(hit), sides, travel, draw, rng);
    if (sides.disagree(next.direction))
        next.weight = Rgb(0.0);
    return next;
}

} // namespace reference
