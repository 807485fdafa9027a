#include "medium.h"

#include <limits>

namespace reference {

namespace {

Medium with_shape(std::variant<vkvol::Sphere, vkvol::Box, Grid> shape, const vkvol::Volume& volume,
                  vkvol::Filter filter) {
    const double sigma_t = volume.sigma_a + volume.sigma_s;
    Medium medium;
    medium.shape = std::move(shape);
    medium.sigma_t = sigma_t * volume.density_scale;
    medium.albedo = sigma_t > 0.0 ? volume.sigma_s / sigma_t : 0.0;
    medium.g = volume.g;
    medium.emission.constant = volume.Le;
    medium.filter = filter;
    if (const Grid* grid = medium.grid(); grid && volume.unit == vkvol::CoefficientUnit::voxel)
        medium.sigma_t /= grid->voxel_length();
    return medium;
}

} // namespace

double Medium::density(const glm::dvec3& index) const {
    return filter == vkvol::Filter::nearest ? grid()->nearest(index) : grid()->trilinear(index);
}

Medium load(const vkvol::Volume& volume, vkvol::Filter filter) {
    if (const auto* sphere = std::get_if<vkvol::Sphere>(&volume.shape))
        return with_shape(*sphere, volume, filter);
    if (const auto* box = std::get_if<vkvol::Box>(&volume.shape))
        return with_shape(*box, volume, filter);
    const auto& file = std::get<vkvol::GridFile>(volume.shape);
    Medium medium = with_shape(load_grid(file.path, file.grid), volume, filter);
    medium.emission = load_emission(volume, &file);
    return medium;
}

Medium with_grid(Grid grid, const vkvol::Volume& volume, vkvol::Filter filter) {
    return with_shape(std::move(grid), volume, filter);
}

Interval support(const Medium& medium, const Ray& ray) {
    const Interval ahead{0.0, std::numeric_limits<double>::infinity()};
    if (medium.sigma_t == 0.0)
        return {};
    if (const auto* sphere = std::get_if<vkvol::Sphere>(&medium.shape))
        return clip(ahead, intersect(*sphere, ray));
    if (const auto* box = std::get_if<vkvol::Box>(&medium.shape))
        return clip(ahead, intersect(*box, ray));
    return clip(ahead, medium.grid()->support(medium.grid()->to_index(ray)));
}

} // namespace reference
