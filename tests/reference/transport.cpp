#include "transport.h"

#include <cmath>
#include <numbers>

namespace reference {

namespace {

using std::numbers::pi;

// Exponential integrals.
double e1(double x) {
    return -std::expint(-x);
}
double e2(double x) {
    return x > 0.0 ? std::exp(-x) - x * e1(x) : 1.0;
}
double e3(double x) {
    return 0.5 * (std::exp(-x) - x * e2(x));
}

// Integral of E1(|x - y|) over y from a to b.
double kernel_integral(double x, double a, double b) {
    if (x <= a)
        return e2(a - x) - e2(b - x);
    if (x >= b)
        return e2(x - b) - e2(x - a);
    return 2.0 - e2(x - a) - e2(b - x);
}

// f = first + K f, by plain iteration, which converges as albedos below 1, or finite media, have it.
template <class Kernel> std::vector<double> solve(const std::vector<double>& first, const Kernel& kernel) {
    const std::size_t n = first.size();
    std::vector<double> matrix(n * n), f = first;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
            matrix[i * n + j] = kernel(i, j);
    for (double change = 1.0; change > 1e-11;) {
        change = 0.0;
        std::vector<double> next = first;
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j)
                next[i] += matrix[i * n + j] * f[j];
            change = std::max(change, std::abs(next[i] - f[i]));
        }
        f = next;
    }
    return f;
}

// `first(a, b)`: fluence of what was not scattered, its mean over a cell.
template <class First>
SlabSolution solve_slab(double albedo, double tau, int cells, double unscattered, const First& first_in) {
    const double h = tau / cells;
    std::vector<double> first;
    for (int i = 0; i < cells; ++i)
        first.push_back(first_in(i * h, (i + 1) * h));
    SlabSolution slab;
    slab.fluence = solve(first, [&](std::size_t i, std::size_t j) {
        return 0.5 * albedo * kernel_integral((double(i) + 0.5) * h, double(j) * h, (double(j) + 1.0) * h);
    });
    slab.transmitted = unscattered;
    for (int j = 0; j < cells; ++j) {
        const double a = j * h, b = (j + 1) * h, source = 0.5 * albedo * slab.fluence[std::size_t(j)];
        slab.reflected += source * (e3(a) - e3(b));
        slab.transmitted += source * (e3(tau - b) - e3(tau - a));
    }
    return slab;
}

} // namespace

SlabSolution slab_in_beam(double albedo, double tau, double mu0, int cells) {
    return solve_slab(albedo, tau, cells, mu0 * std::exp(-tau / mu0),
                      [&](double a, double b) { return mu0 * (std::exp(-a / mu0) - std::exp(-b / mu0)) / (b - a); });
}

SlabSolution slab_in_half_sky(double albedo, double tau, int cells) {
    return solve_slab(albedo, tau, cells, 2.0 * pi * e3(tau),
                      [](double a, double b) { return 2.0 * pi * (e3(a) - e3(b)) / (b - a); });
}

double fluence_amid_ball(double albedo, double radius, int cells) {
    // For f(r) = r fluence: a slab from -radius to radius whose f is odd.
    const double h = radius / cells;
    const auto kernel = [&](std::size_t i, std::size_t j) {
        const double x = (double(i) + 0.5) * h, a = double(j) * h, b = (double(j) + 1.0) * h;
        return 0.5 * (kernel_integral(x, a, b) - (e2(x + a) - e2(x + b)));
    };
    std::vector<double> first(static_cast<std::size_t>(cells), 0.0);
    const double emitted = 4.0 * pi * (1.0 - albedo);
    for (std::size_t i = 0; i < first.size(); ++i)
        for (std::size_t j = 0; j < first.size(); ++j)
            first[i] += kernel(i, j) * (double(j) + 0.5) * h * emitted;
    const std::vector<double> f = solve(first, [&](std::size_t i, std::size_t j) { return albedo * kernel(i, j); });
    double sum = 0.0;
    for (std::size_t i = 0; i < f.size(); ++i) {
        const double r = (double(i) + 0.5) * h;
        sum += (albedo * f[i] / r + emitted) * (std::exp(-double(i) * h) - std::exp(-(double(i) + 1.0) * h));
    }
    return sum;
}

} // namespace reference
