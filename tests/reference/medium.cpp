#include "medium.h"

#include "phase.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace reference {

using vkvol::Rgb;

namespace {

template <typename Shape>
Medium with_shape(Shape shape, const vkvol::Volume& volume, std::optional<vkvol::Filter> filter) {
    const Rgb sigma_t = volume.sigma_a + volume.sigma_s;
    Medium medium;
    medium.shape = std::move(shape);
    medium.noise = volume.noise;
    medium.sigma_t = sigma_t * volume.density_scale;
    for (int i = 0; i < 3; ++i)
        medium.albedo[i] = sigma_t[i] > 0.0 ? volume.sigma_s[i] / sigma_t[i] : 0.0;
    medium.g = volume.g;
    medium.phase = volume.phase;
    medium.emission.constant = volume.Le;
    medium.filter = filter.value_or(vkvol::Filter::trilinear);
    if (const Grid* grid = medium.grid()) {
        if (volume.noise)
            throw std::runtime_error("a grid's density is its own: noise is for other shapes");
        if (volume.unit == vkvol::CoefficientUnit::voxel)
            medium.sigma_t /= grid->voxel_length();
    }
    return medium;
}

} // namespace

double Medium::density(const glm::dvec3& p) const {
    if (const Grid* values = grid())
        return filter == vkvol::Filter::nearest ? values->nearest(p) : values->trilinear(p);
    return noise ? noise_density(*noise, p) : 1.0;
}

double Medium::largest() const {
    return std::max({sigma_t.x, sigma_t.y, sigma_t.z});
}

Medium load(const vkvol::Volume& volume, std::optional<vkvol::Filter> filter) {
    if (const auto* sphere = std::get_if<vkvol::Sphere>(&volume.shape))
        return with_shape(*sphere, volume, filter);
    if (const auto* box = std::get_if<vkvol::Box>(&volume.shape))
        return with_shape(*box, volume, filter);
    if (const auto* files = std::get_if<vkvol::MeshFiles>(&volume.shape))
        return with_shape(load_mesh(*files), volume, filter);
    const auto& file = std::get<vkvol::GridFile>(volume.shape);
    Medium medium = with_shape(load_grid(file.path, file.grid), volume, filter);
    medium.emission = load_emission(volume, &file);
    return medium;
}

Medium with_grid(Grid grid, const vkvol::Volume& volume, std::optional<vkvol::Filter> filter) {
    return with_shape(std::move(grid), volume, filter);
}

std::vector<Interval> support(const Medium& medium, const Ray& ray) {
    if (medium.largest() == 0.0)
        return {};
    std::vector<Interval> parts;
    if (const auto* sphere = std::get_if<vkvol::Sphere>(&medium.shape))
        parts = {intersect(*sphere, ray)};
    else if (const auto* box = std::get_if<vkvol::Box>(&medium.shape))
        parts = {intersect(*box, ray)};
    else if (const auto* mesh = std::get_if<Mesh>(&medium.shape))
        parts = intersect(*mesh, ray);
    else
        parts = {medium.grid()->support(medium.grid()->to_index(ray))};

    std::vector<Interval> ahead;
    for (const Interval& part : parts)
        if (const Interval clipped = clip(part, {0.0, ray.reach}); !clipped.empty())
            ahead.push_back(clipped);
    return ahead;
}

double phase_eval(const Medium& medium, double mu) {
    return medium.phase == vkvol::PhaseFunction::rayleigh ? rayleigh_eval(mu) : hg_eval(medium.g, mu);
}

double phase_eval_twice(const Medium& medium, double mu) {
    return medium.phase == vkvol::PhaseFunction::rayleigh ? rayleigh_eval_twice(mu) : hg_eval(medium.g * medium.g, mu);
}

glm::dvec3 phase_sample(const Medium& medium, const glm::dvec3& direction, double u, double v) {
    const bool rayleigh = medium.phase == vkvol::PhaseFunction::rayleigh;
    return turned(direction, rayleigh ? rayleigh_sample_cosine(u) : hg_sample_cosine(medium.g, u), v);
}

} // namespace reference
