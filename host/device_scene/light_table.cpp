#include "light_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "alias_table.h"
#include "layer_plan.h"
#include "light_tree.h"
#include "placement.h"
#include "shining_pieces.h"

namespace vkvol {

static_assert(sizeof(shared::LightRow) == LIGHT_ROW_TEXELS * 16, "texels, as row.glsl reads them");

namespace {

using std::numbers::pi;

// 1 - cos, with all digits where the angle is small.
double versine(double angle) {
    return 2.0 * std::pow(std::sin(0.5 * angle), 2.0);
}

struct Entry {
    shared::LightRow row{};
    double fluence = 0.0; // amid the media, roughly
    // In this order rows are laid out.
    enum class Place { sky, far, lamp, point, surface, glow } place = Place::far; // sky: met by flights that leave
    glm::vec3 reach{0.0f};                                                        // from its middle
    double power = 0.0;                                                           // see LightTable
    double size = 1.0; // what its radiance, seen from afar, is times to be an intensity: area, volume, or 1
    double cone = pi;  // radians, the most that its light is off its direction
    // What counts of its intensity for the chance to be chosen, of spots: the fourth root of the share of the media
    // that is in the cone. The square root would have the least noise if all places counted alike; what is lit counts
    // for more.
    double by_cone = 1.0;
};

bool is_somewhere(const Entry& entry) {
    return entry.place >= Entry::Place::lamp;
}

// One light as a row.
class Rows {
public:
    Rows(const Scene& scene, const Assets& assets, const ShiningPieces& pieces, const glm::dvec3& origin, double radius)
        : scene_(scene), assets_(assets), media_layers_(media_layers(scene)), pieces_(pieces), origin_(origin),
          radius_(radius),
          reach_(scene.surfaces.empty() && !any_medium(scene, is_everywhere) && !reads_flux(scene.camera)
                     ? radius
                     : std::numeric_limits<double>::infinity()) {}

    Entry operator()(const DirectionalLight& light) const {
        Entry entry = begin(LIGHT_DIRECTIONAL, light.irradiance);
        entry.row.direction = light.direction;
        entry.fluence = channel_mean(light.irradiance);
        return entry;
    }

    Entry operator()(const SunLight& light) const {
        Entry entry = begin(LIGHT_SUN, peak_radiance(light));
        entry.row.direction = light.direction;
        entry.row.extent = static_cast<float>(versine(glm::radians(0.5 * light.angle)));
        entry.row.darkening = static_cast<float>(light.limb_darkening);
        entry.fluence = channel_mean(light.irradiance);
        entry.place = Entry::Place::sky;
        return entry;
    }

    Entry operator()(const PointLight& light) const {
        Entry entry = begin(LIGHT_POINT, light.intensity);
        entry.row.position = light.position - origin_;
        entry.fluence = channel_mean(light.intensity) / square_distance(light.position);
        entry.place = Entry::Place::point;
        return entry;
    }

    Entry operator()(const SpotLight& light) const {
        Entry entry = begin(LIGHT_SPOT, light.intensity);
        const double half = glm::radians(0.5 * light.angle);
        entry.row.position = light.position - origin_;
        entry.row.direction = light.direction;
        entry.row.full_within = static_cast<float>(versine(half * (1.0 - light.blend)));
        entry.row.none_beyond = static_cast<float>(versine(half));
        entry.by_cone = std::sqrt(std::sqrt(share_in_cone(light.position, light.direction, half)));
        entry.fluence = entry.by_cone * channel_mean(light.intensity) / square_distance(light.position);
        entry.place = Entry::Place::point;
        aim(entry, light.position, light.direction, half);
        return entry;
    }

    Entry operator()(const SphereLight& light) const {
        Entry entry = begin(LIGHT_SPHERE, light.radiance);
        entry.row.position = light.center - origin_;
        entry.row.extent = static_cast<float>(light.radius);
        return lamp(entry, light.radiance, light.center, pi * light.radius * light.radius,
                    static_cast<float>(light.radius));
    }

    Entry operator()(const DiskLight& light) const {
        Entry entry = begin(LIGHT_DISK, light.radiance);
        entry.row.position = light.center - origin_;
        entry.row.direction = light.normal;
        const glm::dvec3 aside = std::abs(light.normal.x) < 0.8 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        const glm::dvec3 u = glm::normalize(glm::cross(light.normal, aside));
        entry.row.edge_u = light.radius * u;
        entry.row.edge_v = light.radius * glm::cross(light.normal, u);
        entry = lamp(entry, light.radiance, light.center, pi * light.radius * light.radius,
                     static_cast<float>(light.radius));
        aim(entry, light.center, light.normal, 0.5 * pi);
        return entry;
    }

    Entry operator()(const RectangleLight& light) const {
        Entry entry = begin(LIGHT_RECTANGLE, light.radiance);
        entry.row.position = light.center - origin_;
        entry.row.direction = light.normal();
        entry.row.edge_u = light.edge_u;
        entry.row.edge_v = light.edge_v;
        entry = lamp(entry, light.radiance, light.center, 4.0 * glm::length(light.edge_u) * glm::length(light.edge_v),
                     static_cast<float>(glm::length(light.edge_u + light.edge_v)));
        aim(entry, light.center, light.normal(), 0.5 * pi);
        return entry;
    }

    // Seen from anywhere it is as large as a ball of its area would be, or both its sides.
    Entry operator()(const SurfaceLight& light) const {
        Entry entry = begin(LIGHT_SURFACE, light.radiance);
        const ShiningSurface& pieces = pieces_.surfaces.at(light.body);
        entry.row.first_piece = pieces.first;
        entry.row.pieces = pieces.count;
        entry.row.sides = pieces.sides;
        entry.row.position = 0.5f * (pieces.low + pieces.high);
        entry = lamp(entry, light.radiance, origin_ + glm::dvec3(entry.row.position), 0.25 * pieces.sides * pieces.area,
                     0.0f);
        entry.row.area = static_cast<float>(pieces.area); // once, where a look goes
        entry.reach = 0.5f * (pieces.high - pieces.low);
        entry.place = Entry::Place::surface;
        return entry;
    }

    // What is thick shows no more than a body of its area would, by what glows a free path deep.
    Entry operator()(const GlowLight& light) const {
        Entry entry = begin(LIGHT_GLOW, light.intensity);
        const auto index = std::size_t(light.medium);
        const Volume& volume = scene_.volumes[index];
        const glm::dmat4 map = medium_to_world(volume, assets_.media[index]);
        const glm::dvec3 u(map[0]), v(map[1]), w(map[2]), middle(map[3]);
        const bool is_ball = std::holds_alternative<Sphere>(volume.shape);
        const double sigma_t = largest(world_sigma_t(volume, nullptr));
        const double whole = std::abs(glm::determinant(glm::dmat3(map))) * (is_ball ? 4.0 / 3.0 * pi : 8.0);
        const double faces =
            8.0 * (glm::length(glm::cross(u, v)) + glm::length(glm::cross(v, w)) + glm::length(glm::cross(w, u)));
        const double area = (is_ball ? pi / 6.0 : 1.0) * faces; // of what is no ball, roughly
        entry.row.first_piece = static_cast<std::uint32_t>(light.medium);
        entry.row.pieces = 1 + media_layer(media_layers_, scene_, index);
        entry.row.sides = is_ball ? 0 : 6;
        entry.row.extent = static_cast<float>(sigma_t);
        entry.row.position = middle - origin_;
        entry.row.edge_u = u;
        entry.row.edge_v = v;
        entry.row.direction = w;
        entry.row.area = static_cast<float>(whole);
        entry.reach = glm::abs(u) + glm::abs(v) + glm::abs(w);
        entry.size = std::min(whole, 0.25 * area / std::max(sigma_t, 1e-30));
        entry.fluence = channel_mean(light.intensity) * entry.size / square_distance(middle);
        entry.place = Entry::Place::glow;
        return entry;
    }

    Entry operator()(const SkyLight&) const {
        Entry entry = begin(LIGHT_MAP, Rgb(0.0));
        entry.fluence = channel_mean(assets_.sky->fluence);
        entry.place = Entry::Place::sky;
        return entry;
    }

private:
    // A light whose cone passes all there is gives nothing there. `half`: radians, from the cone's axis.
    void aim(Entry& entry, const glm::dvec3& from, const glm::dvec3& axis, double half) const {
        entry.cone = half;
        const glm::dvec3 apart = origin_ - from;
        const double distance = glm::length(apart);
        if (distance <= reach_)
            return;
        const double off = std::acos(std::clamp(glm::dot(apart, axis) / distance, -1.0, 1.0));
        if (off > half + std::asin(reach_ / distance))
            entry.fluence = 0.0;
    }

    // Share of the ball about the media that is in a cone, roughly: from without, of the directions under which it is
    // seen.
    double share_in_cone(const glm::dvec3& from, const glm::dvec3& axis, double half) const {
        const glm::dvec3 apart = origin_ - from;
        const double distance = glm::length(apart);
        if (radius_ <= 0.0)
            return 1.0;
        const bool within = distance <= radius_;
        const double seen = within ? pi : std::asin(radius_ / distance);
        const double off = within ? 0.0 : std::acos(std::clamp(glm::dot(apart, axis) / distance, -1.0, 1.0));
        const double overlap = std::clamp((half + seen - off) / (2.0 * std::min(half, seen)), 0.0, 1.0);
        return std::max(overlap * versine(std::min(half, seen)) / versine(seen), 1e-9);
    }

    static Entry begin(int kind, const Rgb& radiance) {
        Entry entry;
        entry.row.kind = static_cast<std::uint32_t>(kind);
        entry.row.radiance = radiance;
        return entry;
    }

    Entry lamp(Entry entry, const Rgb& radiance, const glm::dvec3& center, double area, float reach) const {
        entry.row.area = static_cast<float>(area);
        entry.size = area;
        entry.fluence =
            std::min(channel_mean(radiance) * area / square_distance(center), 2.0 * pi * channel_mean(radiance));
        entry.place = Entry::Place::lamp;
        entry.reach = glm::vec3(reach);
        return entry;
    }

    // From a light to the media, or surfaces; of one among them, to half of their way out. Of planes alone, from the
    // camera, and of one there, a unit of length.
    double square_distance(const glm::dvec3& position) const {
        const double distance = std::max(glm::length(position - origin_), 0.5 * radius_);
        return distance > 0.0 ? distance * distance : 1.0;
    }

    const Scene& scene_;
    const Assets& assets_;
    std::vector<std::string> media_layers_;
    const ShiningPieces& pieces_;
    glm::dvec3 origin_;
    double radius_; // of a ball about the media
    double reach_;  // of one about all that lights may shine on
};

// What it sends out; of what is far, through a unit of area.
double power_of(const Light& light, const Entry& entry) {
    return std::visit(
        [&](const auto& kind) {
            if constexpr (requires { power_per_unit(kind); })
                return channel_mean(entry.row.radiance) * power_per_unit(kind);
            else
                return entry.place >= Entry::Place::surface ? 0.0 : entry.fluence;
        },
        light);
}

// Sets the chances of the first rows, by their fluence.
void set_chances(std::vector<shared::LightRow>& rows, const std::vector<double>& fluences) {
    const std::vector<double> chances = defensive_chances(fluences);
    const std::vector<shared::AliasEntry> alias = make_alias_table(chances);
    for (std::size_t i = 0; i < chances.size(); ++i) {
        rows[i].chance = static_cast<float>(chances[i]);
        rows[i].alias = alias[i];
    }
}

// The brightest first.
std::vector<glm::vec3> find_suns(std::vector<Entry> entries, double fluence) {
    constexpr double least = 0.05; // of all
    std::erase_if(entries, [&](const Entry& entry) {
        return (entry.row.kind != LIGHT_DIRECTIONAL && entry.row.kind != LIGHT_SUN) || entry.fluence < least * fluence;
    });
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.fluence > b.fluence; });
    std::vector<glm::vec3> suns;
    for (std::size_t i = 0; i < std::min<std::size_t>(entries.size(), CACHE_SUNS); ++i)
        suns.push_back(entries[i].row.direction);
    return suns;
}

// Power as seen from a unit of distance, and never none: every light is to have a chance, if little where it passes all
// there is.
PlacedLight placed(const Entry& entry, std::uint32_t row) {
    const glm::vec3 radiance = entry.row.radiance;
    const float mean = (radiance.x + radiance.y + radiance.z) / 3.0f;
    const float power = mean * static_cast<float>(entry.size) * (entry.fluence > 0.0 ? 1.0f : 1e-6f);
    PlacedLight light{entry.row.position - entry.reach, entry.row.position + entry.reach, std::max(power, 1e-30f),
                      std::max(power * static_cast<float>(entry.by_cone), 1e-30f), row};
    if (entry.row.kind & LIGHT_AIMED) {
        light.axis = entry.row.direction;
        light.reach = entry.cone;
    }
    return light;
}

// By area or volume, with the chance that the tree would have if all lights were as far off: see shining.glsl.
void set_look_densities(const std::vector<PlacedLight>& in_tree, std::vector<shared::LightRow>& rows, float placed) {
    double all = 0.0;
    for (const PlacedLight& light : in_tree)
        all += light.power_in_matter;
    const auto set = [&](shared::LightRow& light, double share) {
        if ((light.kind == LIGHT_SURFACE || light.kind == LIGHT_GLOW) && light.area > 0.0f)
            light.look_density = static_cast<float>(std::clamp(placed * share / light.area, 1e-30, 1e30));
    };
    for (const PlacedLight& light : in_tree)
        set(rows[light.row], light.power_in_matter / all);
    if (in_tree.empty() && !rows.empty()) // the last is all that may have a place
        set(rows.back(), 1.0);
}

} // namespace

int lights_kind(const Scene& scene) {
    const std::vector<Light>& lights = scene.lights;
    const auto any = [&](bool (*is)(const Light&)) { return std::any_of(lights.begin(), lights.end(), is); };
    if (lights.empty() || lone_directional(scene))
        return LIGHTS_LONE;
    const auto is_map = [](const Light& light) { return std::holds_alternative<SkyLight>(light); };
    const auto is_glow = [](const Light& light) { return std::holds_alternative<GlowLight>(light); };
    const auto is_square = [](const Light& light) {
        const auto* sky = std::get_if<SkyLight>(&light);
        return sky && sky->mapping == SkyMapping::equal_area;
    };
    const auto somewhere = std::count_if(lights.begin(), lights.end(), has_place);
    const auto is_aimed = [](const Light& light) {
        return std::holds_alternative<SpotLight>(light) || std::holds_alternative<DiskLight>(light) ||
               std::holds_alternative<RectangleLight>(light);
    };
    const bool asks_where = (!scene.surfaces.empty() || reads_flux(scene.camera)) && any(is_aimed);
    const int tree = somewhere > 1 ? LIGHTS_TREE | (asks_where ? LIGHTS_AIMED : 0) : 0;
    return LIGHTS_TABLE | (any(is_met_by_chance) ? LIGHTS_SKY : 0) | (any(is_lamp) ? LIGHTS_LAMPS : 0) | tree |
           (any(is_shining_surface) ? LIGHTS_SURFACES : 0) | (any(is_glow) ? LIGHTS_GLOW : 0) |
           (any(is_map) ? LIGHTS_MAP : 0) | (lights.size() == 1 ? LIGHTS_SOLE : 0) |
           (any(is_square) ? LIGHTS_EQUAL_AREA : 0);
}

std::uint32_t loop_iterations(const Scene& scene) {
    if (lights_kind(scene) == LIGHTS_LONE)
        return 0;
    const std::vector<Light>& lights = scene.lights;
    const auto count = [&](bool (*is)(const Light&)) { return std::count_if(lights.begin(), lights.end(), is); };
    const auto levels = std::bit_width(lights.size()) + 1;
    // The tree is gone down from a collision, a tentative one too, from along a flight, from a surface, and from a
    // sensor of flux.
    const int places = 3 + (scene.surfaces.empty() ? 0 : 1) + (reads_flux(scene.camera) ? 1 : 0);
    // Where a path begins. Among surfaces lamps may hide each other, and paths that leave one look, too: in another
    // lane, but loops count for all of a group.
    const int for_lamps = scene.surfaces.empty() ? 1 : 2 * 2;
    return static_cast<std::uint32_t>(for_lamps * (count(is_lamp) + 1) + count(is_met_by_chance) + 1 +
                                      places * (levels + 1));
}

double reach_of_lamps(const std::vector<Light>& lights, const glm::dvec3& origin) {
    double reach = 0.0;
    for (const Light& light : lights) {
        if (const auto* sphere = std::get_if<SphereLight>(&light))
            reach = std::max(reach, glm::distance(sphere->center, origin) + sphere->radius);
        if (const auto* disk = std::get_if<DiskLight>(&light))
            reach = std::max(reach, glm::distance(disk->center, origin) + disk->radius);
        if (const auto* rectangle = std::get_if<RectangleLight>(&light))
            reach = std::max(reach, glm::distance(rectangle->center, origin) +
                                        glm::length(rectangle->edge_u + rectangle->edge_v));
    }
    return reach;
}

LightTable make_light_table(const Scene& scene, const Assets& assets, const SurfaceTable& surfaces,
                            const glm::dvec3& origin, double radius) {
    std::vector<Entry> entries;
    const std::vector<std::string> groups = plan_layers(scene).groups;
    ShiningPieces pieces = find_shining_pieces(scene.lights, surfaces);
    const Rows rows(scene, assets, pieces, origin, radius);
    for (const Light& light : scene.lights) {
        entries.push_back(std::visit(rows, light));
        entries.back().power = power_of(light, entries.back());
        entries.back().row.group = group_layer(groups, group_of(light));
        // Of a lamp, which looks pass over on their way to it; a surface of any shape may hide itself.
        const bool has_body = body_of(light) != no_body && !is_shining_surface(light);
        entries.back().row.body = has_body ? static_cast<std::uint32_t>(body_of(light)) : NO_SURFACE;
    }
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.place < b.place; });
    LightTable table;
    std::vector<double> fluences;
    std::vector<PlacedLight> somewhere;
    const bool has_tree = (lights_kind(scene) & LIGHTS_TREE) != 0;
    for (const Entry& entry : entries) {
        const auto row = static_cast<std::uint32_t>(table.rows.size());
        table.rows.push_back(entry.row);
        table.powers.push_back(entry.power);
        table.sky_count += entry.place == Entry::Place::sky ? 1 : 0;
        table.lamp_first += entry.place < Entry::Place::lamp ? 1 : 0;
        table.lamp_count += entry.place == Entry::Place::lamp ? 1 : 0;
        if (!has_tree || !is_somewhere(entry))
            fluences.push_back(entry.fluence);
        else if (somewhere.push_back(placed(entry, row)); somewhere.size() == 1)
            fluences.push_back(entry.fluence); // of the tree
        else
            fluences.back() += entry.fluence;
    }
    table.choices = static_cast<std::uint32_t>(fluences.size());
    set_chances(table.rows, fluences);
    table.fluence = static_cast<float>(std::max(std::accumulate(fluences.begin(), fluences.end(), 0.0), 1e-30));
    table.suns = find_suns(entries, table.fluence);
    if (has_tree)
        table.tree = make_light_tree(somewhere);
    if (table.choices > 0)
        set_look_densities(somewhere, table.rows, table.rows[table.choices - 1].chance);
    table.pieces = std::move(pieces.rows);
    return table;
}

void tell_look_densities(const LightTable& table, SurfaceTable& surfaces) {
    for (const shared::LightRow& light : table.rows)
        if (light.kind == LIGHT_SURFACE && light.look_density > 0.0f)
            surfaces.rows[surfaces.primitives[table.pieces[light.first_piece].source].surface].look_density =
                light.look_density;
}

void tell_look_densities(const LightTable& table, std::span<shared::MediumParams> media) {
    for (const shared::LightRow& light : table.rows)
        if (light.kind == LIGHT_GLOW)
            media[light.first_piece].look_density = light.look_density;
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
