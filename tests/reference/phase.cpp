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

double rayleigh_eval(double mu) {
    return 3.0 / (16.0 * pi) * (1.0 + mu * mu);
}

// By the addition theorem, Legendre moments multiply: sum of (2l + 1) f_l^2 P_l / 4 pi with f_0 = 1, f_2 = 1 / 10.
double rayleigh_eval_twice(double mu) {
    return (1.0 + 5.0 * 0.1 * 0.1 * (3.0 * mu * mu - 1.0) / 2.0) / (4.0 * pi);
}

double rayleigh_sample_cosine(double u) {
    double low = -1.0, high = 1.0;
    for (int i = 0; i < 60; ++i) {
        const double mu = 0.5 * (low + high);
        ((mu * mu * mu + 3.0 * mu + 4.0) / 8.0 < u ? low : high) = mu;
    }
    return 0.5 * (low + high);
}

glm::dvec3 hg_sample(double g, const glm::dvec3& direction, double u, double v) {
    return turned(direction, hg_sample_cosine(g, u), v);
}

glm::dvec3 turned(const glm::dvec3& direction, double mu, double v) {
    const double sine = std::sqrt(std::max(0.0, 1.0 - mu * mu));
    const double phi = 2.0 * pi * v;

    // Any two unit vectors that complete `direction` to an orthonormal basis.
    const glm::dvec3 aside = std::abs(direction.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 e1 = glm::normalize(glm::cross(aside, direction));
    const glm::dvec3 e2 = glm::cross(direction, e1);
    return glm::normalize(sine * std::cos(phi) * e1 + sine * std::sin(phi) * e2 + mu * direction);
}

} // namespace reference
