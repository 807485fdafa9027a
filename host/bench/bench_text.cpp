#include "bench_text.h"

#include <array>
#include <cmath>
#include <fmt/format.h>

namespace vkvol {

namespace {

enum class Direction { down, up };

double rounded(double x, Direction direction) {
    if (x == 0.0 || !std::isfinite(x))
        return x;
    const double unit = std::pow(10.0, std::floor(std::log10(std::abs(x))) - 2.0);
    const double scaled = x / unit;
    if (std::abs(scaled - std::round(scaled)) < 1e-9 * std::abs(scaled)) // 1.1 is not to become 1.11 for its last bit
        return std::round(scaled) * unit;
    return (direction == Direction::down ? std::floor(scaled) : std::ceil(scaled)) * unit;
}

} // namespace

std::string number_text(std::optional<double> value) {
    if (!value)
        return "-";
    const std::string text = fmt::format("{:.3g}", *value);
    const bool large = std::abs(*value) >= 1e3 && std::abs(*value) < 1e7;
    return large ? fmt::format("{:.0f}", std::stod(text)) : text;
}

std::string interval_text(const std::optional<Interval>& interval) {
    if (!interval)
        return "-";
    return fmt::format("{} ({} to {})", number_text(interval->value),
                       number_text(rounded(interval->low, Direction::down)),
                       number_text(rounded(interval->high, Direction::up)));
}

bool excludes_one(const std::optional<Interval>& interval) {
    return interval && (rounded(interval->low, Direction::down) > 1.0 || rounded(interval->high, Direction::up) < 1.0);
}

std::string duration_text(double seconds) {
    if (seconds < 99.5)
        return fmt::format("{:.0f} s", std::ceil(seconds));
    if (seconds < 6000.0)
        return fmt::format("{:.2g} min", seconds / 60.0);
    return fmt::format("{} h", number_text(std::round(seconds / 360.0) / 10.0));
}

std::string round_duration(double seconds) {
    constexpr std::array steps = {1, 2, 3, 5, 10, 15, 20, 30, 45};
    for (const auto& [unit, name] : {std::pair{1.0, 's'}, {60.0, 'm'}})
        for (const int step : steps)
            if (seconds <= step * unit)
                return fmt::format("{}{}", step, name);
    return fmt::format("{:.0f}h", std::ceil(seconds / 3600.0));
}

} // namespace vkvol
