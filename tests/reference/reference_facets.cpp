#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "reference_facets.h"

using std::numbers::pi;

namespace reference {

using vkvol::Rgb;

namespace {

constexpr int most_facets = 1000; // longer walks are lost

// Facets' heights are distributed exponentially, below 0 without end: a share exp(h) of them is below h. Nothing that
// is measured depends on that.
struct Place {
    glm::dvec3 travel; // z: outward, on this side
    double height;
};

// Smith's Lambda of directions that go up.
double lambda(const glm::dvec3& w, double alpha) {
    const double slope = w.z / std::hypot(w.x, w.y);
    return 0.5 * (std::sqrt(1.0 + alpha * alpha / (slope * slope)) - 1.0);
}

// From there to a height, if no facet is in the way; up to infinity as well.
double chance_to_pass(const glm::dvec3& w, double alpha, double from, double to) {
    return std::exp((std::min(from, 0.0) - std::min(to, 0.0)) * lambda(w, alpha));
}

// Where it meets a facet, or false: it leaves. On its way down it does not pass h with chance (share below h)^(1 + L).
bool go_to_facet(Place& place, double alpha, double u) {
    const bool up = place.travel.z > 0.0;
    const double L = lambda(up ? place.travel : -place.travel, alpha);
    const double exponent = -std::log(1.0 - u) / (up ? L : 1.0 + L);
    place.height += up ? exponent : -exponent;
    return place.height <= 0.0;
}

// One of the facets' normals seen along -wi: a point of the half of an ellipsoid whose shadow along wi is uniform.
glm::dvec3 seen_normal(const glm::dvec3& wi, double alpha, Rng& rng) {
    const glm::dvec3 s = glm::normalize(glm::dvec3(alpha * wi.x, alpha * wi.y, wi.z));
    const glm::dvec3 across =
        glm::normalize(glm::cross(s, std::abs(s.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    for (int i = 0; i < 100000; ++i) {
        const Draw draw = rng.next();
        const double r = std::sqrt(draw.x()), phi = 2.0 * pi * draw.y();
        const glm::dvec3 n =
            r * std::cos(phi) * across + r * std::sin(phi) * glm::cross(s, across) + std::sqrt(1.0 - r * r) * s;
        if (n.z > 0.0)
            return glm::normalize(glm::dvec3(alpha * n.x, alpha * n.y, n.z));
    }
    return {0.0, 0.0, 1.0}; // from straight below: once in a long time
}

Rgb mirrored(const vkvol::Material& material, double cosine) {
    Rgb F;
    for (int i = 0; i < 3; ++i)
        F[i] = reflected(cosine, {material.eta[i], material.k[i]});
    return F;
}

double distribution(const glm::dvec3& m, double alpha) {
    const double tan2 = (1.0 - m.z * m.z) / (m.z * m.z);
    return m.z <= 0.0 ? 0.0 : alpha * alpha / (pi * std::pow(m.z, 4) * std::pow(alpha * alpha + tan2, 2));
}

double visible_area(const glm::dvec3& wi, double alpha) {
    return wi.z > 0.0 ? wi.z * (1.0 + lambda(wi, alpha)) : -wi.z * lambda(-wi, alpha);
}

// Density of what facets send on from -wi to wo, in the same frame.
Rgb phase(const vkvol::Material& material, double eta, const glm::dvec3& wi, const glm::dvec3& wo, bool crosses) {
    const double alpha = material.roughness;
    glm::dvec3 m = glm::normalize(crosses ? wi + eta * wo : wi + wo);
    m *= m.z < 0.0 ? -1.0 : 1.0;
    const double before = glm::dot(wi, m), after = glm::dot(wo, m);
    if (before <= 0.0 || (crosses ? after >= 0.0 : after <= 0.0))
        return Rgb(0.0);
    const double density = distribution(m, alpha) * before / visible_area(wi, alpha);
    if (material.kind == vkvol::MaterialKind::conductor)
        return mirrored(material, before) * (density / (4.0 * before));
    const double F = reflected(before, eta);
    if (!crosses)
        return Rgb(F * density / (4.0 * before));
    return Rgb((1.0 - F) * density * eta * eta * std::abs(after) / std::pow(before + eta * after, 2));
}

struct Frame {
    glm::dvec3 x, y, z;

    explicit Frame(const glm::dvec3& normal)
        : x(glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)))),
          y(glm::cross(normal, x)), z(normal) {}
    glm::dvec3 in(const glm::dvec3& w) const { return {glm::dot(x, w), glm::dot(y, w), glm::dot(z, w)}; }
    glm::dvec3 out(const glm::dvec3& w) const { return w.x * x + w.y * y + w.z * z; }
};

// `at_facet(place, eta, side, weight)` is told of every facet on the way.
using AtFacet = std::function<void(const Place&, double, double, const Rgb&)>;

FacetSample walk(const vkvol::Material& material, double eta, const glm::dvec3& wo, Rng& rng, const AtFacet& at_facet) {
    Place place{-wo, 0.0};
    Rgb weight(1.0);
    double side = 1.0;
    for (int i = 0; i < most_facets; ++i) {
        const Draw draw = rng.next();
        if (!go_to_facet(place, material.roughness, draw.x()))
            return {side * place.travel, weight};
        at_facet(place, eta, side, weight);
        const glm::dvec3 wi = -place.travel, m = seen_normal(wi, material.roughness, rng);
        const double cosine = std::min(glm::dot(wi, m), 1.0);
        if (material.kind == vkvol::MaterialKind::conductor)
            weight *= mirrored(material, cosine);
        else if (draw.y() >= reflected(cosine, eta)) {
            place.travel = -glm::refract(place.travel, m, 1.0 / eta);
            place.height = std::log1p(-std::exp(place.height)); // what was lower is higher
            side = -side;
            eta = 1.0 / eta;
            continue;
        }
        place.travel = glm::reflect(place.travel, m);
    }
    return {{0.0, 0.0, side}, Rgb(0.0)};
}

} // namespace

// As they are in books, with the angle beyond by Snell's law, complex if need be.
double reflected(double cosine, std::complex<double> index) {
    const std::complex<double> sine = std::sqrt(1.0 - cosine * cosine) / index;
    const std::complex<double> beyond = std::sqrt(1.0 - sine * sine);
    const std::complex<double> across = (cosine - index * beyond) / (cosine + index * beyond);
    const std::complex<double> parallel = (index * cosine - beyond) / (index * cosine + beyond);
    return 0.5 * (std::norm(across) + std::norm(parallel));
}

FacetSample facets_scatter(const vkvol::Material& material, double eta, const glm::dvec3& normal, const glm::dvec3& wo,
                           Rng& rng) {
    const Frame frame(normal);
    FacetSample sample = walk(material, eta, frame.in(wo), rng, [](const auto&...) {});
    sample.direction = glm::normalize(frame.out(sample.direction));
    return sample;
}

// Helmholtz: what goes one way, over the cosine and the square of the index there, is what goes the other.
Rgb facets_value(const vkvol::Material& material, double eta, const glm::dvec3& normal, const glm::dvec3& wo,
                 const glm::dvec3& wi, Rng& rng) {
    const bool crosses = glm::dot(normal, wi) < 0.0;
    const Frame frame(crosses ? -normal : normal); // on wi's side
    const glm::dvec3 from = frame.in(wi), target = frame.in(wo);
    Rgb sent(0.0);
    walk(material, crosses ? 1.0 / eta : eta, from, rng,
         [&](const Place& place, double index, double side, const Rgb& weight) {
             const glm::dvec3 to = side * target;
             const double height = to.z > 0.0 ? place.height : std::log1p(-std::exp(place.height));
             const double leaves = chance_to_pass(to.z > 0.0 ? to : -to, material.roughness, height, 0.0);
             if (to.z > 0.0 || material.kind == vkvol::MaterialKind::dielectric)
                 sent += weight * leaves * phase(material, index, -place.travel, to, to.z < 0.0);
         });
    return sent * std::abs(from.z / target.z);
}

} // namespace reference
