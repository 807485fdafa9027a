#include "mapped.h"

#include <algorithm>
#include <cmath>

namespace reference {

using vkvol::MapPoint;
using vkvol::ValueMap;

MapPoint mapped(const ValueMap& map, double value) {
    if (map.points.empty())
        return {value, value, vkvol::Rgb(1.0), vkvol::Rgb(0.0)};
    const MapPoint* below = nullptr;
    for (const MapPoint& point : map.points) {
        if (value < point.value) {
            if (!below)
                return point;
            const double t = (value - below->value) / (point.value - below->value);
            return {value, std::lerp(below->density, point.density, t), glm::mix(below->albedo, point.albedo, t),
                    glm::mix(below->emission, point.emission, t)};
        }
        below = &point;
    }
    MapPoint last = *below;
    last.density += map.rise * (value - below->value);
    return last;
}

Extremes mapped_extremes(const ValueMap& map, double low, double high) {
    Extremes found{INFINITY, -INFINITY};
    const auto take = [&](double density) { found = {std::min(found.least, density), std::max(found.most, density)}; };
    take(mapped(map, low).density);
    take(mapped(map, high).density);
    for (const MapPoint& point : map.points)
        if (low <= point.value && point.value <= high)
            take(point.density);
    return found;
}

std::vector<double> map_breaks(const ValueMap& map, const double (&samples)[4]) {
    const double a = samples[0], b = samples[1], c = samples[2], d = samples[3];
    // Lagrange's, as a polynomial.
    const double k1 = -5.5 * a + 9.0 * b - 4.5 * c + d, k2 = 9.0 * a - 22.5 * b + 18.0 * c - 4.5 * d;
    const double k3 = -4.5 * a + 13.5 * b - 13.5 * c + 4.5 * d;
    const auto at = [&](double s) { return a + s * (k1 + s * (k2 + s * k3)); };
    std::vector<double> turns{0.0}; // and where its slope, a quadratic, is 0
    const double discriminant = k2 * k2 - 3.0 * k1 * k3;
    if (discriminant > 0.0) {
        const double q = -(k2 + std::copysign(std::sqrt(discriminant), k2));
        for (const double s : {q / (3.0 * k3), k1 / q})
            if (s > 0.0 && s < 1.0)
                turns.push_back(s);
    }
    turns.push_back(1.0);
    std::sort(turns.begin(), turns.end());
    std::vector<double> breaks;
    for (std::size_t i = 0; i + 1 < turns.size(); ++i)
        for (const MapPoint& point : map.points) {
            double low = turns[i], high = turns[i + 1];
            const bool rises = at(low) < at(high);
            if ((at(low) < point.value) == (at(high) < point.value))
                continue;
            for (int bisection = 0; bisection < 50; ++bisection) {
                const double middle = 0.5 * (low + high);
                ((at(middle) < point.value) == rises ? low : high) = middle;
            }
            if (low > 0.0 && high < 1.0)
                breaks.push_back(high);
        }
    std::sort(breaks.begin(), breaks.end());
    return breaks;
}

} // namespace reference
