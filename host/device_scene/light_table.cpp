#include "light_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "alias_table.h"

namespace vkvol {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double least_share = 0.1; // of an even choice

double mean(const Rgb& color) {
    return (color.x + color.y + color.z) / 3.0;
}

double radians(double degrees) {
    return degrees * pi / 180.0;
}

// 1 - cos, with all digits where the angle is small.
double versine(double angle) {
    return 2.0 * std::pow(std::sin(0.5 * angle), 2.0);
}

struct Entry {
    shared::LightRow row{};
    double fluence = 0.0; // amid the media, roughly
    bool met = false;     // by flights that leave
};

// One light as a row.
class Rows {
public:
    Rows(const Assets& assets, const glm::dvec3& origin, double radius)
        : assets_(assets), origin_(origin), radius_(radius) {}

    Entry operator()(const DirectionalLight& light) const {
        Entry entry = begin(LIGHT_DIRECTIONAL, light.irradiance);
        entry.row.direction = light.direction;
        entry.fluence = mean(light.irradiance);
        return entry;
    }

    // The irradiance of a disc of radiance L and half angle a is pi L sin^2 a.
    Entry operator()(const SunLight& light) const {
        const double half = radians(0.5 * light.angle);
        Entry entry = begin(LIGHT_DISC, light.irradiance / (pi * std::pow(std::sin(half), 2.0)));
        entry.row.direction = light.direction;
        entry.row.extent = static_cast<float>(versine(half));
        entry.fluence = mean(light.irradiance);
        entry.met = true;
        return entry;
    }

    Entry operator()(const PointLight& light) const {
        Entry entry = begin(LIGHT_POINT, light.intensity);
        entry.row.position = light.position - origin_;
        entry.fluence = mean(light.intensity) / square_distance(light.position);
        return entry;
    }

    Entry operator()(const SpotLight& light) const {
        Entry entry = begin(LIGHT_SPOT, light.intensity);
        const double half = radians(0.5 * light.angle);
        entry.row.position = light.position - origin_;
        entry.row.direction = light.direction;
        entry.row.cos_full = static_cast<float>(std::cos(half * (1.0 - light.blend)));
        entry.row.cos_none = static_cast<float>(std::cos(half));
        entry.fluence = mean(light.intensity) / square_distance(light.position);
        return entry;
    }

    Entry operator()(const SkyLight&) const {
        Entry entry = begin(LIGHT_MAP, Rgb(0.0));
        entry.fluence = mean(assets_.sky->fluence);
        entry.met = true;
        return entry;
    }

private:
    static Entry begin(int kind, const Rgb& radiance) {
        Entry entry;
        entry.row.kind = static_cast<std::uint32_t>(kind);
        entry.row.radiance = radiance;
        return entry;
    }

    // From a light to the media; of one among them, to half of their way out.
    double square_distance(const glm::dvec3& position) const {
        const double distance = std::max(glm::length(position - origin_), 0.5 * radius_);
        return std::max(distance * distance, 1e-300);
    }

    const Assets& assets_;
    glm::dvec3 origin_;
    double radius_;
};

void set_chances(std::vector<Entry>& entries) {
    double sum = 0.0;
    for (const Entry& entry : entries)
        sum += entry.fluence;
    std::vector<double> chances;
    for (const Entry& entry : entries)
        chances.push_back((sum > 0.0 ? (1.0 - least_share) * entry.fluence / sum : 0.0) +
                          least_share / double(entries.size()));
    const double total = sum > 0.0 ? 1.0 : least_share;
    const std::vector<shared::AliasEntry> alias = make_alias_table(chances);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        entries[i].row.chance = static_cast<float>(chances[i] / total);
        entries[i].row.alias = alias[i];
    }
}

} // namespace

int lights_kind(const std::vector<Light>& lights) {
    if (std::any_of(lights.begin(), lights.end(), is_met_by_chance))
        return LIGHTS_SKY;
    return lights.empty() || only_directional(lights) ? LIGHTS_SUN : LIGHTS_TABLE;
}

LightTable make_light_table(const Scene& scene, const Assets& assets, const glm::dvec3& origin, double radius) {
    std::vector<Entry> entries;
    for (const Light& light : scene.lights)
        entries.push_back(std::visit(Rows(assets, origin, radius), light));
    std::stable_partition(entries.begin(), entries.end(), [](const Entry& entry) { return entry.met; });
    set_chances(entries);
    LightTable table;
    for (const Entry& entry : entries) {
        table.rows.push_back(entry.row);
        table.sky_count += entry.met ? 1 : 0;
    }
    return table;
}

shared::SkyParams make_sky_params(const Scene& scene, const Assets& assets) {
    shared::SkyParams params{};
    for (const Light& light : scene.lights)
        if (const auto* sky = std::get_if<SkyLight>(&light)) {
            params.width = assets.sky->width;
            params.height = assets.sky->height;
            const double turns = sky->rotation / 360.0;
            params.turn = static_cast<float>(turns - std::floor(turns));
        }
    return params;
}

} // namespace vkvol
