#include "student_t.h"

#include <algorithm>
#include <cmath>

namespace vkvol {

namespace {

// P(|T| <= t) = integral of cos^(freedom - 1) from 0 to atan(t / sqrt(freedom)), over the same to pi / 2, which is
// sqrt(pi) gamma(freedom / 2) / (2 gamma((freedom + 1) / 2)). Simpson's rule: the integrand is smooth at that scale.
double central_probability(double t, double freedom) {
    constexpr int intervals = 128;
    const double end = std::atan(t / std::sqrt(freedom));
    double sum = 0.0;
    for (int i = 0; i <= intervals; ++i) {
        const double weight = i == 0 || i == intervals ? 1.0 : i % 2 ? 4.0 : 2.0;
        sum += weight * std::pow(std::cos(end * i / intervals), freedom - 1.0);
    }
    const double whole =
        0.5 * std::sqrt(M_PI) * std::exp(std::lgamma(0.5 * freedom) - std::lgamma(0.5 * (freedom + 1.0)));
    return sum * end / (3.0 * intervals) / whole;
}

} // namespace

double student_t(double freedom, double probability) {
    freedom = std::max(freedom, 1.0);
    double low = 0.0, high = 2.0;
    while (high < 1e9 && central_probability(high, freedom) < probability)
        high *= 2.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (central_probability(middle, freedom) < probability ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

} // namespace vkvol
