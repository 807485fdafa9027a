#include "lobes.h"

#include <algorithm>
#include <cmath>

#include "fractal.h"

namespace vkvol {
namespace {

// Polynomial smooth minimum (Quilez): equals min(a, b) where they differ by more than k.
double smooth_min(double a, double b, double k) {
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - h * h * k * 0.25;
}

bool buried(const Lobe& lobe, const std::vector<Lobe>& others) {
    return std::any_of(others.begin(), others.end(), [&](const Lobe& other) {
        return glm::distance(lobe.center, other.center) + 0.8 * lobe.radius < other.radius;
    });
}

} // namespace

std::vector<Lobe> bud(const std::vector<Lobe>& parents, const Budding& rule, std::uint32_t seed) {
    RandomStream random(seed);
    std::vector<Lobe> children;
    for (const Lobe& parent : parents)
        for (int n = 0; n < rule.children; ++n) {
            const glm::dvec3 direction = glm::normalize(random.on_sphere() + glm::dvec3(0.0, rule.upward, 0.0));
            Lobe child;
            child.radius = parent.radius * random.between(rule.smallest, rule.largest);
            child.center = parent.center + direction * (parent.radius - rule.sunk * child.radius);
            if (child.center.y >= rule.lowest && !buried(child, parents))
                children.push_back(child);
        }
    return children;
}

LobeUnion::LobeUnion(const std::vector<Lobe>& lobes, double smoothing, double reach)
    : lobes_(lobes), smoothing_(smoothing), reach_(reach) {
    // Large lobes first: the fillets of small ones then lie on top, and the result depends on no other order.
    std::stable_sort(lobes_.begin(), lobes_.end(), [](const Lobe& a, const Lobe& b) { return a.radius > b.radius; });
}

std::vector<Lobe> LobeUnion::near(glm::dvec3 center, double half_width) const {
    const double around = half_width * std::sqrt(3.0);
    std::vector<Lobe> found;
    for (const Lobe& lobe : lobes_) {
        // A fillet lowers distances by up to k / 4 and acts up to k away, hence the slack of two fillets.
        const double limit = lobe.radius * (1.0 + 2.0 * smoothing_) + reach_ + around;
        const glm::dvec3 d = lobe.center - center;
        if (glm::dot(d, d) < limit * limit)
            found.push_back(lobe);
    }
    return found;
}

double LobeUnion::distance(const std::vector<Lobe>& near, glm::dvec3 p) const {
    double result = 4.0 * reach_;
    for (const Lobe& lobe : near) {
        const glm::dvec3 to = p - lobe.center;
        const double square = glm::dot(to, to), k = smoothing_ * lobe.radius;
        const double limit = result + lobe.radius + k; // from here on the lobe changes nothing
        if (limit > 0.0 && square < limit * limit)
            result = smooth_min(result, std::sqrt(square) - lobe.radius, k);
    }
    return result;
}

} // namespace vkvol
