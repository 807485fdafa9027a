#include "medium.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "mapped.h"

namespace reference {

using vkvol::Rgb;

namespace {

// Pairs of degrees and values; comments are lines of their own.
std::vector<TableNode> load_table(const std::filesystem::path& file) {
    std::vector<TableNode> table;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        std::replace(line.begin(), line.end(), ',', ' ');
        double degrees, value;
        if (line[0] != '#' && std::istringstream(line) >> degrees >> value)
            table.push_back({std::cos(degrees * std::numbers::pi / 180.0), value});
    }
    return normalised(table);
}

void load_phase(const vkvol::Volume& volume, Medium& medium) {
    medium.phase = volume.phase;
    medium.g = volume.g;
    medium.g2 = volume.phase_details.g2;
    medium.share = volume.phase_details.share;
    medium.alpha = volume.phase_details.alpha;
    medium.index = volume.phase_details.index;
    medium.backscatter = volume.phase_details.backscatter;
    if (volume.phase == vkvol::PhaseFunction::rayleigh) { // as (1 + d) + (1 - d) mu^2
        const double d = volume.phase_details.depolarization;
        medium.share = 2.0 * (1.0 - d) / (2.0 + d);
    }
    if (volume.phase == vkvol::PhaseFunction::table)
        medium.table = load_table(volume.phase_details.file);
    if (volume.phase == vkvol::PhaseFunction::droplets) {
        const Droplets fit = droplets(volume.phase_details.diameter);
        medium.g = fit.g_hg;
        medium.g2 = fit.g_d;
        medium.share = fit.w_d;
        medium.alpha = fit.alpha;
    }
}

template <typename Shape>
Medium with_shape(Shape shape, const vkvol::Volume& volume, std::optional<vkvol::Filter> filter) {
    const Rgb sigma_t = volume.sigma_a + volume.sigma_s;
    Medium medium;
    medium.shape = std::move(shape);
    medium.noise = volume.noise;
    medium.to_unmoved = glm::inverse(volume.transform);
    medium.sigma_t = sigma_t * volume.density_scale;
    for (int i = 0; i < 3; ++i)
        medium.albedo[i] = sigma_t[i] > 0.0 ? volume.sigma_s[i] / sigma_t[i] : 0.0;
    load_phase(volume, medium);
    medium.emission.constant = volume.Le;
    medium.map = volume.map;
    medium.layers = volume.layers;
    medium.filter = filter.value_or(vkvol::Filter::trilinear);
    if (Grid* grid = std::get_if<Grid>(&medium.shape)) {
        grid->move(volume.transform);
        if (volume.noise)
            throw std::runtime_error("a grid's density is its own: noise is for other shapes");
        if (volume.unit == vkvol::CoefficientUnit::voxel)
            medium.sigma_t /= grid->voxel_length();
    }
    return medium;
}

} // namespace

double Medium::density(const glm::dvec3& p) const {
    if (grid())
        return mapped(map, grid_value(p)).density;
    if (!layers)
        return noise ? noise_density(*noise, p) : 1.0;
    const double above = height(p);
    if (above < 0.0 || above > layers->top - layers->bottom)
        return 0.0;
    if (layers->scale_height > 0.0)
        return std::exp((layers->reference - p[layers->axis]) / layers->scale_height);
    return mapped(map, above).density;
}

// rho is rho0 exp(-k (t - t0)) along the ray.
double Medium::fading_integral(const Ray& ray, const Interval& part) const {
    if (part.empty())
        return 0.0;
    const Ray along = unmoved(ray);
    const double k = along.direction[layers->axis] / layers->scale_height, length = part.length();
    const double rho0 = std::exp((layers->reference - along.origin[layers->axis]) / layers->scale_height - k * part.t0);
    return k == 0.0 ? rho0 * length : -rho0 * std::expm1(-k * length) / k;
}

double Medium::height(const glm::dvec3& unmoved) const {
    return unmoved[layers->axis] - layers->bottom;
}

double Medium::mapped_value(const glm::dvec3& world) const {
    return grid() ? grid_value(grid()->to_index(world)) : height(glm::dvec3(to_unmoved * glm::dvec4(world, 1.0)));
}

double Medium::grid_value(const glm::dvec3& index) const {
    return filter == vkvol::Filter::nearest ? grid()->nearest(index) : grid()->trilinear(index);
}

Rgb Medium::albedo_at(const glm::dvec3& unfolded) const {
    const glm::dvec3 world = folded(*this, unfolded);
    Rgb here = albedo_grid.empty()
                   ? albedo
                   : albedo * glm::min(albedo_grid.clamped(world, filter == vkvol::Filter::nearest), Rgb(1.0));
    if (map.is_transfer)
        here *= mapped(map, mapped_value(world)).albedo;
    return here;
}

Rgb Medium::emission_at(const glm::dvec3& unfolded) const {
    const glm::dvec3 world = folded(*this, unfolded);
    Rgb here = emission.at(world, filter == vkvol::Filter::nearest);
    if (map.is_transfer)
        here += mapped(map, mapped_value(world)).emission;
    return here;
}

Ray Medium::unmoved(const Ray& ray) const {
    return {glm::dvec3(to_unmoved * glm::dvec4(ray.origin, 1.0)), glm::dmat3(to_unmoved) * ray.direction, ray.reach};
}

double Medium::largest() const {
    return std::max({sigma_t.x, sigma_t.y, sigma_t.z});
}

Medium load(const vkvol::Volume& volume, std::optional<vkvol::Filter> filter) {
    if (const auto* sphere = std::get_if<vkvol::Sphere>(&volume.shape))
        return with_shape(*sphere, volume, filter);
    if (const auto* box = std::get_if<vkvol::Box>(&volume.shape))
        return with_shape(*box, volume, filter);
    if (const auto* all = std::get_if<vkvol::Everywhere>(&volume.shape))
        return with_shape(*all, volume, filter);
    if (const auto* files = std::get_if<vkvol::MeshFiles>(&volume.shape))
        return with_shape(load_mesh(*files), volume, filter);
    const auto& file = std::get<vkvol::GridFile>(volume.shape);
    Medium medium = with_shape(load_grid(file.path, file.grid), volume, filter);
    medium.emission = load_emission(volume, &file);
    if (!volume.albedo_grid.empty())
        medium.albedo_grid = load_color_grid(file.path, volume.albedo_grid);
    medium.albedo_grid.move(volume.transform);
    medium.emission.grid.move(volume.transform);
    medium.emission.colors.move(volume.transform);
    return medium;
}

Medium with_grid(Grid grid, const vkvol::Volume& volume, std::optional<vkvol::Filter> filter) {
    return with_shape(std::move(grid), volume, filter);
}

namespace {

// What of each part is at heights that have layers.
std::vector<Interval> between_layers(const Medium& medium, const Ray& ray, const std::vector<Interval>& parts) {
    const Ray unmoved = medium.unmoved(ray);
    const vkvol::Layers& layers = *medium.layers;
    const double from = unmoved.origin[layers.axis], rise = unmoved.direction[layers.axis];
    if (rise == 0.0)
        return from >= layers.bottom && from <= layers.top ? parts : std::vector<Interval>();
    const auto [first, last] = std::minmax({(layers.bottom - from) / rise, (layers.top - from) / rise});
    std::vector<Interval> within;
    for (const Interval& part : parts)
        within.push_back(clip(part, {first, last}));
    return within;
}

} // namespace

std::vector<Interval> support(const Medium& medium, const Ray& ray) {
    if (medium.largest() == 0.0)
        return {};
    std::vector<Interval> parts;
    if (medium.periodic)
        parts = {unfolded_support(medium, ray)};
    else if (const auto* sphere = std::get_if<vkvol::Sphere>(&medium.shape))
        parts = {intersect(*sphere, medium.unmoved(ray))};
    else if (const auto* box = std::get_if<vkvol::Box>(&medium.shape))
        parts = {intersect(*box, medium.unmoved(ray))};
    else if (const auto* mesh = std::get_if<Mesh>(&medium.shape))
        parts = intersect(*mesh, medium.unmoved(ray));
    else if (medium.unbounded())
        parts = {{0.0, std::numeric_limits<double>::infinity()}};
    else
        parts = {medium.grid()->support(medium.grid()->to_index(ray))};

    if (medium.layers && !medium.periodic)
        parts = between_layers(medium, ray, parts);
    std::vector<Interval> ahead;
    for (const Interval& part : parts)
        if (const Interval clipped = clip(part, {0.0, ray.reach}); !clipped.empty())
            ahead.push_back(clipped);
    return ahead;
}

double phase_eval(const Medium& medium, double mu) {
    using enum vkvol::PhaseFunction;
    switch (medium.phase) {
    case rayleigh:
        return rayleigh_eval(medium.share, mu);
    case double_henyey_greenstein:
        return std::lerp(hg_eval(medium.g, mu), hg_eval(medium.g2, mu), medium.share);
    case draine:
        return draine_eval(medium.g, medium.alpha, mu);
    case droplets:
        return std::lerp(hg_eval(medium.g, mu), draine_eval(medium.g2, medium.alpha, mu), medium.share);
    case table:
        return table_eval(medium.table, mu);
    case fournier_forand:
        return fournier_forand_eval(medium.index, medium.backscatter, mu);
    case henyey_greenstein:
        break;
    }
    return hg_eval(medium.g, mu);
}

double phase_eval_twice(const Medium& medium, double mu) {
    using enum vkvol::PhaseFunction;
    if (medium.phase == rayleigh)
        return rayleigh_eval_twice(medium.share, mu);
    if (medium.phase != double_henyey_greenstein)
        return hg_eval(medium.g * medium.g, mu);
    const double s = medium.share, r = 1.0 - s;
    return r * r * hg_eval(medium.g * medium.g, mu) + 2.0 * r * s * hg_eval(medium.g * medium.g2, mu) +
           s * s * hg_eval(medium.g2 * medium.g2, mu);
}

bool has_phase_twice(const Medium& medium) {
    return medium.phase <= vkvol::PhaseFunction::double_henyey_greenstein;
}

namespace {

double sample_cosine(const Medium& medium, double u) {
    using enum vkvol::PhaseFunction;
    const bool second = u < medium.share;
    const double rest = second ? u / medium.share : (u - medium.share) / (1.0 - medium.share);
    switch (medium.phase) {
    case rayleigh:
        return rayleigh_sample_cosine(medium.share, u);
    case double_henyey_greenstein:
        return hg_sample_cosine(second ? medium.g2 : medium.g, rest);
    case draine:
        return draine_sample_cosine(medium.g, medium.alpha, u);
    case droplets:
        return second ? draine_sample_cosine(medium.g2, medium.alpha, rest) : hg_sample_cosine(medium.g, rest);
    case table:
        return table_sample_cosine(medium.table, u);
    case fournier_forand:
        return fournier_forand_sample_cosine(medium.index, medium.backscatter, u);
    case henyey_greenstein:
        break;
    }
    return hg_sample_cosine(medium.g, u);
}

} // namespace

glm::dvec3 phase_sample(const Medium& medium, const glm::dvec3& direction, double u, double v) {
    return turned(direction, sample_cosine(medium, u), v);
}

} // namespace reference
