#include "phase.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reference {

using std::numbers::pi;

double hg_eval(double g, double mu) {
    // (1 - g)^2 + 2g(1 - mu) is 1 + g^2 - 2g mu without its cancellation near the peak.
    const double d = (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - mu);
    return (1.0 - g * g) / (4.0 * pi * d * std::sqrt(d));
}

double hg_pdf(double g, double mu) {
    return hg_eval(g, mu);
}

double hg_sample_cosine(double g, double u) {
    // The textbook inverse (1 + g^2 - ((1 - g^2) / (1 + g s))^2) / 2g, s = 2u - 1, with the division by g carried
    // out: continuous through g = 0, where mu = s.
    const double s = 2.0 * u - 1.0;
    const double numerator = s + g * ((3.0 + s * s) / 2.0 + g * (s + g * (s * s - 1.0) / 2.0));
    const double denominator = (1.0 + g * s) * (1.0 + g * s);
    return std::clamp(numerator / denominator, -1.0, 1.0);
}

glm::dvec3 hg_sample(double g, const glm::dvec3& direction, double u, double v) {
    const double mu = hg_sample_cosine(g, u);
    const double sine = std::sqrt(std::max(0.0, 1.0 - mu * mu));
    const double phi = 2.0 * pi * v;

    // Any two unit vectors that complete `direction` to an orthonormal basis.
    const glm::dvec3 aside = std::abs(direction.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 e1 = glm::normalize(glm::cross(aside, direction));
    const glm::dvec3 e2 = glm::cross(direction, e1);
    return glm::normalize(sine * std::cos(phi) * e1 + sine * std::sin(phi) * e2 + mu * direction);
}

} // namespace reference
