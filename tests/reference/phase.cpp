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

double rayleigh_eval(double share, double mu) {
    return share * 3.0 / (16.0 * pi) * (1.0 + mu * mu) + (1.0 - share) / (4.0 * pi);
}

// By the addition theorem, Legendre moments multiply: sum of (2l + 1) f_l^2 P_l / 4 pi with f_0 = 1, f_2 = share / 10.
double rayleigh_eval_twice(double share, double mu) {
    return (1.0 + 5.0 * 0.1 * 0.1 * share * share * (3.0 * mu * mu - 1.0) / 2.0) / (4.0 * pi);
}

double rayleigh_sample_cosine(double share, double u) {
    double low = -1.0, high = 1.0;
    for (int i = 0; i < 60; ++i) {
        const double mu = 0.5 * (low + high);
        (share * (mu * mu * mu + 3.0 * mu + 4.0) / 8.0 + (1.0 - share) * (mu + 1.0) / 2.0 < u ? low : high) = mu;
    }
    return 0.5 * (low + high);
}

double draine_eval(double g, double alpha, double mu) {
    return hg_eval(g, mu) * (1.0 + alpha * mu * mu) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
}

namespace {

// The chance of a cosine below mu, not normalised. With q^2 = 1 + g^2 - 2 g mu the density is a polynomial in q over
// q^2, whose integral is one in q over q.
double draine_integral(double g, double alpha, double mu) {
    if (g == 0.0)
        return mu + alpha * mu * mu * mu / 3.0;
    const double q = std::sqrt(1.0 + g * g - 2.0 * g * mu), c = 1.0 + g * g, s = alpha / (4.0 * g * g);
    return ((1.0 + s * c * c) / q + 2.0 * s * c * q - s * q * q * q / 3.0) / g;
}

template <class Distribution> double by_halving(const Distribution& below, double u) {
    double low = -1.0, high = 1.0;
    for (int i = 0; i < 60; ++i) {
        const double mu = 0.5 * (low + high);
        (below(mu) < u ? low : high) = mu;
    }
    return 0.5 * (low + high);
}

} // namespace

double draine_sample_cosine(double g, double alpha, double u) {
    const double first = draine_integral(g, alpha, -1.0), all = draine_integral(g, alpha, 1.0) - first;
    return by_halving([&](double mu) { return (draine_integral(g, alpha, mu) - first) / all; }, u);
}

Droplets droplets(double d) {
    using std::cos, std::exp, std::log, std::pow, std::sin, std::tan;
    Droplets fit{};
    if (d >= 5.0) {
        fit.g_hg = exp(-0.0990567 / (d - 1.67154));
        fit.g_d = exp(-2.20679 / (d + 3.91029) - 0.428934);
        fit.alpha = exp(3.62489 - 8.29288 / (d + 5.52825));
        fit.w_d = exp(-0.599085 / (d - 0.641583) - 0.665888);
    } else if (d >= 1.5) {
        fit.g_hg = 0.0604931 * log(log(d)) + 0.940256;
        fit.g_d = 0.500411 - 0.081287 / (-2.0 * log(d) + tan(log(d)) + 1.27551);
        fit.alpha = 7.30354 * log(d) + 6.31675;
        fit.w_d = 0.026914 * (log(d) - cos(5.68947 * (log(log(d)) - 0.0292149))) + 0.376475;
    } else if (d > 0.1) {
        fit.g_hg = 0.862 - 0.143 * pow(log(d), 2);
        fit.g_d =
            0.344213 +
            0.379685 * cos(1.19692 * cos((log(d) - 0.238604) * (log(d) + 1.00667) / (0.507522 - 0.15677 * log(d))) +
                           1.37932 * log(d) + 0.0625835);
        fit.alpha = 250.0;
        fit.w_d = 0.316072 + 0.0778917 * log(d) + 0.146209 * cos(3.38707 * log(d) + 2.11193);
    } else {
        fit.g_hg = 13.8 * d * d;
        fit.g_d = 1.1456 * d * sin(9.29044 * d);
        fit.alpha = 250.0;
        fit.w_d = 0.252977 - 312.983 * pow(d, 4.3);
    }
    return fit;
}

std::vector<TableNode> normalised(std::vector<TableNode> table) {
    double sum = 0.0;
    for (std::size_t i = 1; i < table.size(); ++i)
        sum += pi * (table[i - 1].value + table[i].value) * (table[i - 1].mu - table[i].mu);
    for (TableNode& node : table)
        node.value /= sum;
    return table;
}

double table_eval(const std::vector<TableNode>& table, double mu) {
    std::size_t i = 1;
    while (i + 1 < table.size() && table[i].mu > mu)
        ++i;
    const TableNode &a = table[i - 1], &b = table[i];
    return std::lerp(a.value, b.value, (a.mu - mu) / (a.mu - b.mu));
}

double table_sample_cosine(const std::vector<TableNode>& table, double u) {
    const auto below = [&](double mu) {
        double sum = 0.0;
        for (std::size_t i = 1; i < table.size(); ++i) {
            const double low = std::max(table[i].mu, -1.0), high = std::min(table[i - 1].mu, mu);
            if (high > low)
                sum += pi * (high - low) * (table_eval(table, low) + table_eval(table, high));
        }
        return sum;
    };
    return by_halving(below, u);
}

namespace {

// The papers' delta: by the square of an angle's chord, 2 sin(angle / 2).
double ff_delta(double index, double chord_squared) {
    return chord_squared / (3.0 * (index - 1.0) * (index - 1.0));
}

// A chord squared at which the papers' quotients are not 0 / 0.
double ff_chord_squared(double index, double mu) {
    const double chord_squared = 2.0 * std::max(1.0 - mu, 1e-10);
    return std::abs(1.0 - ff_delta(index, chord_squared)) < 1e-5 ? chord_squared * (1.0 + 2e-5) : chord_squared;
}

} // namespace

// From Mobley, Sundman and Boss's statement of the part that goes backward, solved for the exponent.
double fournier_forand_exponent(double index, double backscatter) {
    const double delta = ff_delta(index, 2.0);
    return -std::log(1.0 + 2.0 * backscatter * (delta - 1.0)) / std::log(delta);
}

double fournier_forand_eval(double index, double backscatter, double mu) {
    using std::pow;
    const double nu = fournier_forand_exponent(index, backscatter), u2 = ff_chord_squared(index, mu), delta = ff_delta(index, u2),
                 delta_180 = ff_delta(index, 4.0);
    return (nu * (1.0 - delta) - (1.0 - pow(delta, nu)) +
            4.0 / u2 * (delta * (1.0 - pow(delta, nu)) - nu * (1.0 - delta))) /
               (4.0 * pi * (1.0 - delta) * (1.0 - delta) * pow(delta, nu)) +
           (1.0 - pow(delta_180, nu)) / (16.0 * pi * (delta_180 - 1.0) * pow(delta_180, nu)) * (3.0 * mu * mu - 1.0);
}

double fournier_forand_share(double index, double backscatter, double mu) {
    using std::pow;
    const double nu = fournier_forand_exponent(index, backscatter), u2 = ff_chord_squared(index, mu), delta = ff_delta(index, u2),
                 delta_180 = ff_delta(index, 4.0);
    return (1.0 - pow(delta, nu + 1.0) - u2 / 4.0 * (1.0 - pow(delta, nu))) / ((1.0 - delta) * pow(delta, nu)) +
           (1.0 - pow(delta_180, nu)) / (8.0 * (delta_180 - 1.0) * pow(delta_180, nu)) * mu * (1.0 - mu * mu);
}

double fournier_forand_sample_cosine(double index, double backscatter, double u) {
    return by_halving([&](double mu) { return 1.0 - fournier_forand_share(index, backscatter, mu); }, u);
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
