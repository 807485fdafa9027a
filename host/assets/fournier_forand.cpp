#include "fournier_forand.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "phase_table.h"

namespace vkvol {

namespace {

using std::numbers::pi;

// By x = 1 - mu, with the exponent nu, from -1 to 0, and delta = 2 x / 3 (index - 1)^2. The papers' terms, in which
// numerators and denominators vanish where delta is 1, are put together of
//     a = (1 - delta^nu) / (1 - delta) and b = (nu - a) / (1 - delta).
class FournierForand {
public:
    FournierForand(double index, double backscatter)
        : scale_(2.0 / (3.0 * (index - 1.0) * (index - 1.0))),
          nu_(-std::log1p(2.0 * backscatter * (scale_ - 1.0)) / std::log(scale_)),
          back_((std::pow(2.0 * scale_, -nu_) - 1.0) / (16.0 * pi * (2.0 * scale_ - 1.0))) {}

    // Per steradian.
    double value(double x) const {
        const Terms t = terms(scale_ * x);
        return t.power * (t.b - 2.0 / x * (t.a + t.b)) / (4.0 * pi) + back_ * (3.0 * (1.0 - x) * (1.0 - x) - 1.0);
    }

    // Of the light that is scattered at smaller x.
    double share(double x) const {
        const Terms t = terms(scale_ * x);
        return t.power * (1.0 + t.a * (scale_ - 0.5) * x) + 2.0 * pi * back_ * (1.0 - x) * x * (2.0 - x);
    }

private:
    struct Terms {
        double a, b;
        double power; // delta^-nu
    };

    Terms terms(double delta) const {
        const double off = 1.0 - delta, exponent = nu_ * std::log(delta), power = std::exp(-exponent);
        if (std::abs(off) < 1e-3) { // by the series of (1 - off)^nu
            const double second = nu_ * (nu_ - 1.0) / 2.0, third = second * (nu_ - 2.0) / 3.0;
            const double b = second - off * third + off * off * third * (nu_ - 3.0) / 4.0;
            return {nu_ - off * b, b, power};
        }
        const double a = -std::expm1(exponent) / off;
        return {a, (nu_ - a) / off, power};
    }

    double scale_, nu_, back_;
};

} // namespace

std::vector<shared::PhaseNode> fournier_forand_nodes(double index, double backscatter) {
    const FournierForand phase(index, backscatter);
    // Of the first segment the end, and the value at 0 by which it scatters what the closed form does there.
    constexpr double nearest = 1e-9, ratio = 1.01, even_from = 0.4, even_step = 4e-3;
    std::vector<double> angles{0.0}, values{phase.share(nearest) / (pi * nearest) - phase.value(nearest)};
    for (double x = nearest; x < 2.0; x = std::min(x < even_from ? ratio * x : x + even_step, 2.0)) {
        angles.push_back(2.0 * std::asin(std::sqrt(0.5 * x)));
        values.push_back(phase.value(x));
    }
    angles.push_back(pi);
    values.push_back(phase.value(2.0));
    return make_phase_nodes(angles, values);
}

} // namespace vkvol
