#include "value_map.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace vkvol {

namespace {

// Where none of a table's values comes to.
constexpr float beyond = std::numeric_limits<float>::max();

// Per value, from a point to the next; 0 across a step.
template <class T> T slope(const T& from, const T& to, double values) {
    return values > 0.0 ? (to - from) / values : T(0.0);
}

} // namespace

double mapped_density(const ValueMap& map, double value) {
    if (!map.exists())
        return value;
    const auto after = std::upper_bound(map.points.begin(), map.points.end(), value,
                                        [](double x, const MapPoint& point) { return x < point.value; });
    if (after == map.points.begin())
        return after->density;
    const MapPoint& before = *std::prev(after);
    if (after == map.points.end())
        return before.density + map.rise * (value - before.value);
    return before.density + (value - before.value) * slope(before.density, after->density, after->value - before.value);
}

DensityRange mapped_range(const ValueMap& map, double low, double high) {
    constexpr double rounding = 1e-6;
    if (!map.exists())
        return {low, high};
    low *= 1.0 - rounding;
    high *= 1.0 + rounding;
    const auto [least, most] = std::minmax({mapped_density(map, low), mapped_density(map, high)});
    DensityRange range{least, most};
    for (const MapPoint& point : map.points)
        if (point.value >= low && point.value <= high)
            range = {std::min(range.least, point.density), std::max(range.most, point.density)};
    return range;
}

std::vector<double> numbers_of(const ValueMap& map) {
    std::vector<double> numbers;
    for (const MapPoint& p : map.points)
        numbers.insert(numbers.end(), {p.value, p.density, p.albedo.x, p.albedo.y, p.albedo.z, p.emission.x,
                                       p.emission.y, p.emission.z});
    if (map.exists())
        numbers.insert(numbers.end(), {map.rise, map.is_transfer ? 1.0 : 0.0});
    return numbers;
}

std::vector<shared::MapKnot> make_knots(const ValueMap& map) {
    if (!map.exists())
        return {};
    std::vector<MapPoint> points = map.points;
    if (points.front().value > 0.0) { // below its first point the map is level
        points.insert(points.begin(), points.front());
        points.front().value = 0.0;
    }
    std::vector<shared::MapKnot> knots;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const MapPoint& from = points[i];
        const MapPoint& to = points[std::min(i + 1, points.size() - 1)];
        // As the kernel sees their places, so that its lines end where they should.
        const double values = double(float(to.value)) - double(float(from.value));
        shared::MapKnot knot{};
        knot.value = static_cast<float>(from.value);
        knot.density = static_cast<float>(from.density);
        knot.density_slope =
            static_cast<float>(i + 1 < points.size() ? slope(from.density, to.density, values) : map.rise);
        knot.albedo = from.albedo;
        knot.albedo_slope = slope(from.albedo, to.albedo, values);
        knot.absorbed = 1.0 - from.albedo;
        knot.absorbed_slope = slope(1.0 - from.albedo, 1.0 - to.albedo, values);
        knot.emission = from.emission;
        knot.emission_slope = slope(from.emission, to.emission, values);
        knots.push_back(knot);
    }
    pad_knots(knots, std::max<std::size_t>(2, std::bit_ceil(knots.size())));
    return knots;
}

void pad_knots(std::vector<shared::MapKnot>& knots, std::size_t count) {
    shared::MapKnot none{};
    none.value = beyond;
    knots.resize(count, none);
}

} // namespace vkvol
