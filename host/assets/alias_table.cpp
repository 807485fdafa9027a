#include "alias_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vkvol {

namespace {

// The 32-bit number that a random word is below with this probability.
std::uint32_t threshold(double probability) {
    return static_cast<std::uint32_t>(std::clamp(std::round(probability * 4294967296.0), 0.0, 4294967295.0));
}

} // namespace

std::vector<shared::AliasEntry> make_alias_table(std::span<const double> weights) {
    const double mean = std::accumulate(weights.begin(), weights.end(), 0.0) / double(weights.size());
    std::vector<double> left(weights.size()); // share of an entry's own number, over the mean
    std::vector<std::uint32_t> poor, rich;
    for (std::uint32_t i = 0; i < weights.size(); ++i) {
        left[i] = weights[i] / mean;
        (left[i] < 1.0 ? poor : rich).push_back(i);
    }
    std::vector<shared::AliasEntry> table(weights.size());
    for (std::uint32_t i = 0; i < table.size(); ++i)
        table[i] = {0xffffffffu, i};
    while (!poor.empty() && !rich.empty()) {
        const std::uint32_t i = poor.back(), from = rich.back();
        poor.pop_back();
        table[i] = {threshold(left[i]), from};
        left[from] -= 1.0 - left[i];
        if (left[from] < 1.0) {
            rich.pop_back();
            poor.push_back(from);
        }
    }
    return table; // what is left over is 1 but for rounding
}

std::vector<double> defensive_chances(std::span<const double> weights) {
    constexpr double least_share = 0.1;
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0), even = 1.0 / double(weights.size());
    std::vector<double> chances;
    for (const double weight : weights)
        chances.push_back(sum > 0.0 ? (1.0 - least_share) * weight / sum + least_share * even : even);
    return chances;
}

} // namespace vkvol
