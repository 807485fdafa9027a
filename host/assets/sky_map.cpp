#include "sky_map.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "alias_table.h"
#include "daylight.h"
#include "error.h"

namespace vkvol {

namespace {

constexpr double pi = std::numbers::pi;

// Mean over each texel of what is interpolated between the middles of texels: across a texel a neighbour counts for an
// eighth.
std::vector<double> interpolated_means(const std::vector<double>& values, int width, int height) {
    std::vector<double> across(values.size()), means(values.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double* row = &values[std::size_t(y) * width];
            across[std::size_t(y) * width + x] =
                0.75 * row[x] + 0.125 * (row[(x + 1) % width] + row[(x + width - 1) % width]);
        }
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto at = [&](int row) { return across[std::size_t(std::clamp(row, 0, height - 1)) * width + x]; };
            means[std::size_t(y) * width + x] = 0.75 * at(y) + 0.125 * (at(y - 1) + at(y + 1));
        }
    return means;
}

// Of a texel in this row.
double solid_angle(int row, int width, int height) {
    return 2.0 * pi / width * (std::cos(pi * row / height) - std::cos(pi * (row + 1) / height));
}

void append(std::vector<shared::AliasEntry>& table, std::span<const double> weights) {
    // A row without light is never chosen, but has its place.
    const bool dark = std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0.0; });
    const std::vector<double> even(weights.size(), 1.0);
    const std::vector<shared::AliasEntry> entries = make_alias_table(dark ? std::span<const double>(even) : weights);
    table.insert(table.end(), entries.begin(), entries.end());
}

void check(const RadianceMap& map, const SkyLight& light) {
    double most = 0.0;
    for (const glm::vec3& texel : map.texels)
        for (int c = 0; c < 3; ++c)
            most = std::max(most, double(texel[c]) * light.scale[c]);
    if (most == 0.0)
        throw InputError(fmt::format("{}: a map without light: every texel is 0{}; remove the <sky>, or name another "
                                     "file",
                                     light.file.string(), map.mended > 0 ? ", negative or not finite" : ""));
    if (most > brightest_light)
        throw InputError(fmt::format("{}: its brightest texel times multiplier is {:.3g}, but {:g} is the most; lower "
                                     "the multiplier",
                                     light.file.string(), most, brightest_light));
}

} // namespace

SkyMap make_sky(const RadianceMap& map, const Rgb& scale) {
    SkyMap sky;
    sky.width = static_cast<std::uint32_t>(map.width);
    sky.height = static_cast<std::uint32_t>(map.height);
    sky.mended = map.mended;
    std::vector<double> values;
    values.reserve(map.texels.size());
    for (const glm::vec3& texel : map.texels) {
        const Rgb radiance = Rgb(texel) * scale;
        sky.texels.emplace_back(glm::vec3(radiance), 0.0f);
        values.push_back((radiance.x + radiance.y + radiance.z) / 3.0);
    }
    std::vector<double> weights = interpolated_means(values, map.width, map.height), rows;
    double sum = 0.0;
    for (int y = 0; y < map.height; ++y) {
        const double angle = solid_angle(y, map.width, map.height);
        double row = 0.0;
        for (int x = 0; x < map.width; ++x) {
            double& weight = weights[std::size_t(y) * map.width + x];
            weight *= angle;
            row += weight;
            sky.fluence += angle * Rgb(sky.texels[std::size_t(y) * map.width + x]);
        }
        rows.push_back(row);
        sum += row;
    }
    append(sky.alias, rows);
    for (int y = 0; y < map.height; ++y)
        append(sky.alias, std::span(weights).subspan(std::size_t(y) * map.width, map.width));
    const double per_angle = double(map.width) * map.height / (2.0 * pi * pi);
    for (std::size_t i = 0; i < weights.size(); ++i)
        sky.texels[i].w = static_cast<float>(weights[i] / sum * per_angle);
    return sky;
}

SkyMap load_sky(const SkyLight& light) {
    const RadianceMap map = light.daylight ? make_daylight(*light.daylight) : read_radiance_map(light.file);
    check(map, light);
    return make_sky(map, light.scale);
}

} // namespace vkvol
