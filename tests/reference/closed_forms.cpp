#include "closed_forms.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace reference {

using std::numbers::pi;

double sphere_chord(const vkvol::Sphere& sphere, const Ray& ray) {
    const double h = glm::length(glm::cross(sphere.center - ray.origin, ray.direction)); // impact parameter
    return h < sphere.radius ? 2.0 * std::sqrt(sphere.radius * sphere.radius - h * h) : 0.0;
}

double box_chord(const vkvol::Box& box, const Ray& ray) {
    return intersect(box, ray).length();
}

double slab_single_reflection(double albedo, double p, double tau, double mu0, double mu) {
    return albedo * p * mu0 / (mu + mu0) * -std::expm1(-tau * (1.0 / mu + 1.0 / mu0));
}

double slab_single_transmission(double albedo, double p, double tau, double mu0, double mu) {
    const double difference = tau * (1.0 / mu0 - 1.0 / mu);
    if (std::abs(difference) < 1e-8)
        return albedo * p * tau / mu * std::exp(-tau / mu);
    return albedo * p * mu0 / (mu - mu0) * (std::exp(-tau / mu) - std::exp(-tau / mu0));
}

double h_function(double albedo, double mu) {
    // 1/H(mu) = sqrt(1 - albedo) + albedo/2 int_0^1 x H(x) / (x + mu) dx, which converges by plain iteration
    // (Chandrasekhar, Radiative Transfer, ch. V), with x = y^2 for a smooth integrand and the midpoint rule.
    constexpr int n = 400;
    std::vector<double> x(n), weight(n), H(n, 1.0);
    for (int i = 0; i < n; ++i) {
        const double y = (i + 0.5) / n;
        x[i] = y * y;
        weight[i] = 2.0 * y / n;
    }
    const auto evaluate = [&](double m) {
        double sum = 0.0;
        for (int i = 0; i < n; ++i)
            sum += weight[i] * x[i] * H[i] / (x[i] + m);
        return 1.0 / (std::sqrt(1.0 - albedo) + 0.5 * albedo * sum);
    };
    for (int iteration = 0; iteration < 200; ++iteration) {
        std::vector<double> refined(n);
        for (int i = 0; i < n; ++i)
            refined[i] = evaluate(x[i]);
        H = refined;
    }
    return evaluate(mu);
}

double plane_albedo(double albedo) {
    return 1.0 - std::sqrt(1.0 - albedo) * h_function(albedo, 1.0);
}

double normal_reflection(double albedo) {
    const double H = h_function(albedo, 1.0);
    return albedo * H * H / (8.0 * pi);
}

double diffuse_transmission_asymptote(double tau) {
    return 4.0 / 3.0 / (tau + 1.4209);
}

} // namespace reference
