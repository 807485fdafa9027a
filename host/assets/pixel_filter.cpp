#include "pixel_filter.h"

#include <cmath>
#include <numbers>

namespace vkvol {

namespace {

// At x radii from the middle, in [0, 1].
double weight(PixelFilter filter, double x) {
    switch (filter) {
    case PixelFilter::tent:
        return 1.0 - x;
    case PixelFilter::gaussian:
        return std::exp(-0.5 * 9.0 * x * x);
    case PixelFilter::blackman_harris: { // Harris, "On the use of windows for harmonic analysis", 1978
        const double turn = std::numbers::pi * (x + 1.0);
        return 0.35875 - 0.48829 * std::cos(turn) + 0.14128 * std::cos(2.0 * turn) - 0.01168 * std::cos(3.0 * turn);
    }
    default:
        return 1.0;
    }
}

} // namespace

std::vector<double> filter_quantiles(const RenderSettings& settings, int count) {
    constexpr int steps = 4096; // of the integral, by midpoints
    std::vector<double> sums{0.0};
    for (int i = 0; i < steps; ++i)
        sums.push_back(sums.back() + weight(settings.pixel_filter, (i + 0.5) / steps));
    std::vector<double> quantiles;
    int i = 0;
    for (int q = 0; q < count; ++q) {
        const double rest = 1.0 - double(q) / count;
        const double target = sums.back() * (1.0 - rest * rest);
        while (sums[static_cast<std::size_t>(i) + 1] < target)
            ++i;
        const double part = (target - sums[static_cast<std::size_t>(i)]) /
                            (sums[static_cast<std::size_t>(i) + 1] - sums[static_cast<std::size_t>(i)]);
        quantiles.push_back(settings.pixel_filter_radius * (i + part) / steps);
    }
    quantiles.push_back(settings.pixel_filter_radius);
    return quantiles;
}

} // namespace vkvol
