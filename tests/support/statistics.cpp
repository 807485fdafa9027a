#include "statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vkvol {

void RunningMean::add(double x) {
    count_ += 1.0;
    const double delta = x - mean_;
    mean_ += delta / count_;
    squares_ += delta * (x - mean_);
}

double RunningMean::variance() const {
    return squares_ / (count_ - 1.0);
}

double RunningMean::standard_error() const {
    return std::sqrt(variance() / count_);
}

double normal_p(double z) {
    return std::erfc(std::abs(z) / std::sqrt(2.0));
}

namespace {

// Regularised incomplete beta function I_x(a, b) by its continued fraction (DLMF 8.17.22), evaluated with Lentz's
// algorithm; converges fast for x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x) {
    constexpr double tiny = 1e-300;
    double c = 1.0, d = 1.0 / std::max(1.0 - (a + b) * x / (a + 1.0), tiny), f = d;
    for (int m = 1; m < 10000; ++m) {
        const auto advance = [&](double term) {
            d = 1.0 + term * d;
            c = 1.0 + term / c;
            d = 1.0 / (std::abs(d) < tiny ? tiny : d);
            c = std::abs(c) < tiny ? tiny : c;
            f *= c * d;
            return std::abs(c * d - 1.0);
        };
        advance(m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m)));
        if (advance(-(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))) < 1e-15)
            break;
    }
    return f;
}

double incomplete_beta(double a, double b, double x) {
    if (x <= 0.0 || x >= 1.0)
        return x <= 0.0 ? 0.0 : 1.0;
    const double front =
        std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
    return x < (a + 1.0) / (a + b + 2.0) ? front * beta_fraction(a, b, x) / a
                                         : 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

// Regularised upper incomplete gamma function Q(a, x): 1 - the series DLMF 8.11.4 for x < a + 1, else the continued
// fraction DLMF 8.9.2, evaluated with Lentz's algorithm.
double upper_gamma(double a, double x) {
    if (x <= 0.0)
        return 1.0;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1.0) {
        double term = 1.0 / a, sum = term;
        for (int n = 1; n < 100000 && term > 1e-17 * sum; ++n)
            sum += term *= x / (a + n);
        return 1.0 - front * sum;
    }
    double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, f = d;
    for (int n = 1; n < 100000; ++n) {
        const double term = -n * (n - a);
        b += 2.0;
        d = 1.0 / (term * d + b);
        c = b + term / c;
        f *= c * d;
        if (std::abs(c * d - 1.0) < 1e-15)
            break;
    }
    return front * f;
}

} // namespace

double t_test_p(const RunningMean& mean, double expected, double rounding) {
    const double difference = std::abs(mean.mean() - expected);
    if (difference <= rounding)
        return 1.0;
    if (!(mean.standard_error() > 0.0))
        return 0.0; // NaN too
    // P(|t| > T) = I_{n / (n + T^2)}(n / 2, 1 / 2) (Abramowitz & Stegun 26.7.1)
    const double t = difference / mean.standard_error(), n = mean.count() - 1.0;
    return incomplete_beta(n / 2.0, 0.5, n / (n + t * t));
}

double chi_square_p(double statistic, double degrees_of_freedom) {
    return upper_gamma(degrees_of_freedom / 2.0, statistic / 2.0);
}

double chi_square_test_p(std::span<const double> observed, std::span<const double> expected) {
    std::vector<double> o, e;
    double o_sum = 0.0, e_sum = 0.0;
    for (std::size_t i = 0; i < observed.size(); ++i) {
        o_sum += observed[i];
        e_sum += expected[i];
        if (e_sum >= 5.0) {
            o.push_back(o_sum);
            e.push_back(e_sum);
            o_sum = e_sum = 0.0;
        }
    }
    if (e.size() < 2)
        return std::numeric_limits<double>::quiet_NaN(); // nothing to test: fails every comparison
    o.back() += o_sum;
    e.back() += e_sum;
    double statistic = 0.0;
    for (std::size_t i = 0; i < e.size(); ++i)
        statistic += (o[i] - e[i]) * (o[i] - e[i]) / e[i];
    return chi_square_p(statistic, static_cast<double>(e.size()) - 1.0);
}

double kolmogorov_smirnov_p(std::vector<double> uniforms) {
    std::sort(uniforms.begin(), uniforms.end());
    const double n = static_cast<double>(uniforms.size());
    double distance = 0.0;
    for (std::size_t i = 0; i < uniforms.size(); ++i)
        distance = std::max({distance, uniforms[i] - i / n, (i + 1) / n - uniforms[i]});
    // Kolmogorov's limit distribution with Stephens' correction for finite n (J. R. Stat. Soc. B 32, 1970).
    const double lambda = (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * distance;
    if (lambda < 0.2)
        return 1.0; // the series converges slowly, to 1 - 1e-12
    double sum = 0.0;
    for (int j = 1; j <= 100; ++j)
        sum += (j % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * j * j * lambda * lambda);
    return std::clamp(sum, 0.0, 1.0);
}

double sidak(double alpha, double n) {
    return -std::expm1(std::log1p(-alpha) / n);
}

} // namespace vkvol
