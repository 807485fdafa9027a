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

using std::numbers::pi;

// A map as its texels lie: which is next to which, and what part of the sky each takes.
struct Layout {
    int width, height;
    SkyMapping mapping;

    // Index of a texel, or of the one that is next over the map's edge.
    std::size_t at(int x, int y) const {
        if (mapping == SkyMapping::equal_area) {
            // Over an edge is the same edge again, the other way around.
            if (x < 0 || x == width) {
                x = std::clamp(x, 0, width - 1);
                y = height - 1 - y;
            }
            if (y < 0 || y == height) {
                x = width - 1 - x;
                y = std::clamp(y, 0, height - 1);
            }
        } else {
            x = (x + width) % width;
            y = std::clamp(y, 0, height - 1);
        }
        return std::size_t(y) * width + x;
    }

    // Solid angle of a texel in this row.
    double solid_angle(int row) const {
        if (mapping == SkyMapping::equal_area)
            return largest_angle();
        return 2.0 * pi / width * (std::cos(pi * row / height) - std::cos(pi * (row + 1) / height));
    }

    // Solid angle of a texel where texels take most: at the horizon of an equirectangular map.
    double largest_angle() const {
        return (mapping == SkyMapping::equal_area ? 4.0 * pi : 2.0 * pi * pi) / (double(width) * height);
    }
};

// Mean over each texel of what is interpolated between the middles of texels: across a texel a neighbour counts for an
// eighth.
std::vector<double> interpolated_means(const std::vector<double>& values, const Layout& layout) {
    const auto across = [&](int x, int y) {
        return 0.75 * values[layout.at(x, y)] + 0.125 * (values[layout.at(x + 1, y)] + values[layout.at(x - 1, y)]);
    };
    std::vector<double> means;
    means.reserve(values.size());
    for (int y = 0; y < layout.height; ++y)
        for (int x = 0; x < layout.width; ++x)
            means.push_back(0.75 * across(x, y) + 0.125 * (across(x, y - 1) + across(x, y + 1)));
    return means;
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
    if (light.mapping == SkyMapping::equal_area && map.width != map.height)
        throw InputError(
            fmt::format("{}: has {} x {} texels, but a map of equal areas, as .pbrt scenes have them, is square; "
                        "pbrt's imgtool makeequiarea makes one, and in an .xml scene mapping=\"equalArea\" is "
                        "to be left out if columns are longitudes and rows latitudes",
                        light.file.string(), map.width, map.height));
}

} // namespace

SkyMap make_sky(const RadianceMap& map, const Rgb& scale, SkyMapping mapping) {
    const Layout layout{map.width, map.height, mapping};
    SkyMap sky;
    sky.width = static_cast<std::uint32_t>(map.width);
    sky.height = static_cast<std::uint32_t>(map.height);
    sky.mended = map.mended;
    sky.warnings = map.warnings;
    std::vector<double> values;
    values.reserve(map.texels.size());
    for (const glm::vec3& texel : map.texels) {
        const Rgb radiance = Rgb(texel) * scale;
        sky.texels.emplace_back(glm::vec3(radiance), 0.0f);
        values.push_back((radiance.x + radiance.y + radiance.z) / 3.0);
    }
    std::vector<double> weights = interpolated_means(values, layout), rows;
    double sum = 0.0, first = 0.0, second = 0.0; // moments of the radiance
    for (int y = 0; y < map.height; ++y) {
        const double angle = layout.solid_angle(y);
        double row = 0.0;
        for (int x = 0; x < map.width; ++x) {
            double& weight = weights[std::size_t(y) * map.width + x];
            const double value = values[std::size_t(y) * map.width + x];
            first += angle * value;
            second += angle * value * value;
            weight *= angle;
            row += weight;
            sky.fluence += angle * Rgb(sky.texels[std::size_t(y) * map.width + x]);
        }
        rows.push_back(row);
        sum += row;
    }
    sky.unevenness = first > 0.0 ? 4.0 * pi * second / (first * first) : 1.0;
    append(sky.alias, rows);
    for (int y = 0; y < map.height; ++y)
        append(sky.alias, std::span(weights).subspan(std::size_t(y) * map.width, map.width));
    for (std::size_t i = 0; i < weights.size(); ++i)
        sky.texels[i].w = static_cast<float>(weights[i] / sum / layout.largest_angle());
    return sky;
}

SkyMap load_sky(const SkyLight& light) {
    RadianceMap map = light.daylight ? make_daylight(*light.daylight) : read_radiance_map(light.file);
    check(map, light);
    if (light.mirror)
        for (auto row = map.texels.begin(); row != map.texels.end(); row += map.width)
            std::reverse(row, row + map.width);
    return make_sky(map, light.scale, light.mapping);
}

// Turning it, and the layer that it goes to, are no part of it.
std::shared_ptr<const SkyMap> SkyCache::take(const SkyLight& light) {
    std::error_code ignored;
    const auto bytes = light.daylight ? 0 : std::filesystem::file_size(light.file, ignored);
    const auto changed =
        light.daylight ? std::filesystem::file_time_type{} : std::filesystem::last_write_time(light.file, ignored);
    const bool is_here = map_ && light_.file == light.file && light_.daylight == light.daylight &&
                         light_.mapping == light.mapping && light_.mirror == light.mirror &&
                         light_.scale == light.scale && bytes_ == bytes && changed_ == changed;
    if (!is_here) {
        map_.reset(); // before there is another
        map_ = std::make_shared<const SkyMap>(load_sky(light));
        light_ = light;
        bytes_ = bytes;
        changed_ = changed;
    }
    return map_;
}

} // namespace vkvol
