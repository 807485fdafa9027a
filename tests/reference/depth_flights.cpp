#include <cmath>
#include <limits>
#include <stdexcept>

#include "cells.h"
#include "free_flight.h"
#include "quadrature.h"

namespace reference {

using vkvol::Rgb;

namespace {

void report(const FlightEvents& events, double t0, double t1, const Rgb& beta) {
    if (events.piece)
        events.piece(t0, t1, beta);
}

} // namespace

DepthSample::DepthSample(const Medium& medium, double exponential, double select, const Rgb& beta)
    : sigma_t_(medium.sigma_t), beta_(beta), probability_(1.0, 0.0, 0.0) {
    int channel = 0;
    const Rgb size = glm::abs(beta);
    if (const double sum = size.x + size.y + size.z; !medium.grey() && sum > 0.0) {
        probability_ = size / sum;
        channel = select < probability_.x ? 0 : select < probability_.x + probability_.y ? 1 : 2;
    }
    depth_ = sigma_t_[channel] > 0.0 ? exponential / sigma_t_[channel] : std::numeric_limits<double>::infinity();
}

Flight DepthSample::collided(double t, double D) const {
    if (sigma_t_ == Rgb(sigma_t_.x))
        return {t, beta_};
    const Rgb density = sigma_t_ * glm::exp(-sigma_t_ * D);
    return {t, beta_ * density / glm::dot(probability_, density)};
}

Flight DepthSample::escaped(double D) const {
    if (sigma_t_ == Rgb(sigma_t_.x))
        return {{}, beta_};
    const Rgb T = glm::exp(-sigma_t_ * D);
    return {{}, beta_ * T / glm::dot(probability_, T)};
}

namespace {

// Length of the part's beginning in which the integral of the density is `depth`, by bisection.
double fading_length(const Medium& medium, const Ray& ray, const Interval& part, double depth) {
    double low = 0.0, high = 1.0;
    const auto integral = [&](double length) { return medium.fading_integral(ray, {part.t0, part.t0 + length}); };
    while (integral(high) < depth && high < part.length())
        high *= 2.0;
    for (int bisection = 0; bisection < 80; ++bisection) {
        const double middle = 0.5 * (low + high);
        (integral(middle) < depth ? low : high) = middle;
    }
    return high;
}

} // namespace

Flight analytic_flight(const Medium& medium, const Ray& ray, const DepthSample& sample, const FlightEvents& events) {
    if (!medium.homogeneous() && !medium.fades())
        throw std::runtime_error("analytic flights are for homogeneous media and exponentials");
    double D = 0.0;
    for (const Interval& interval : support(medium, ray)) {
        const double left = sample.depth() - D;
        const double through = medium.fades() ? medium.fading_integral(ray, interval) : interval.length();
        const bool collides = left < through;
        const double t = interval.t0 + (medium.fades() ? fading_length(medium, ray, interval, left) : left);
        report(events, interval.t0, collides ? t : interval.t1, sample.escaped(D).beta);
        if (collides)
            return sample.collided(t, sample.depth());
        D += through;
    }
    return sample.escaped(D);
}

Flight regular_flight(const Medium& medium, const Ray& ray, const DepthSample& sample, const FlightEvents& events) {
    if (medium.noise)
        throw std::runtime_error("regular flights are for grids");
    const DensityAlong density(medium, ray);
    CellWalk walk(medium, ray);
    Cell cell;
    double D = 0.0;
    while (walk.next(cell)) {
        if (cell.majorant == 0.0)
            continue;
        const std::vector<double> t = breaks(medium, density.ray(), {cell.t0, cell.t1});
        for (std::size_t i = 0; i + 1 < t.size(); ++i) {
            const double through = D + piece_integral(medium, density, t[i], t[i + 1]);
            const bool collides = sample.depth() < through;
            double low = t[i], high = t[i + 1];
            for (int bisection = 0; collides && bisection < 60; ++bisection) {
                const double middle = 0.5 * (low + high);
                (D + piece_integral(medium, density, t[i], middle) < sample.depth() ? low : high) = middle;
            }
            if (t[i] < high)
                report(events, t[i], high, sample.escaped(D).beta);
            if (collides)
                return sample.collided(high, sample.depth());
            D = through;
        }
    }
    return sample.escaped(D);
}

Flight march_flight(const Medium& medium, const Ray& ray, const DepthSample& sample, const vkvol::March& march,
                    bool adaptive, Rng& rng, const FlightEvents& events) {
    const DensityAlong density(medium, ray);
    double D = 0.0;
    std::optional<double> collision;
    const Step step = [&](double t, double length) {
        const double offset = rng.next().x();
        const double rho = density(t + (march.jitter ? offset : 0.5) * length);
        const double left = sample.depth() - D;
        if (left < rho * length)
            collision = t + left / rho;
        report(events, t, collision.value_or(t + length), sample.escaped(D).beta);
        D += rho * length;
        return !collision;
    };
    if (adaptive)
        for_each_adaptive_step(medium, ray, march.optical_step, step);
    else
        for_each_step(medium, ray, march.step, step);
    return collision ? sample.collided(*collision, sample.depth()) : sample.escaped(D);
}

} // namespace reference
