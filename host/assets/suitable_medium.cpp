#include "suitable_medium.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "blackbody.h"
#include "camera_view.h"

namespace vkvol {

namespace {

constexpr int rays_across = 64, rays_down = 48;
constexpr double most_pieces = 512; // across the grid

// The density along the rays of a picture, at the middle of equal steps of about a voxel.
class Rays {
public:
    Rays(const DensityField& field, const Camera& camera, const Picture& picture)
        : field_(field), to_index_(glm::inverse(field.index_to_world)),
          eye_(to_index_ * glm::dvec4(camera.position, 1)), low_(glm::dvec3(field.voxel_min) - 0.5),
          high_(glm::dvec3(field.voxel_max) + 0.5), step_(std::max(1.0, glm::length(high_ - low_) / most_pieces)),
          rotation_(camera_rotation(camera)), window_(view_window(camera, picture)) {}

    // visit(density, length of the step in world units, its middle in the grid's index space), from the eye on; then
    // done(), after each ray.
    template <class Visit, class Done> void follow(const Visit& visit, const Done& done) const {
        for (int j = 0; j < rays_down; ++j)
            for (int i = 0; i < rays_across; ++i) {
                follow(direction((i + 0.5) / rays_across, (j + 0.5) / rays_down), visit);
                done();
            }
    }

private:
    glm::dvec3 direction(double u, double v) const {
        return glm::normalize(rotation_ * glm::dvec3(glm::mix(window_.left, window_.right, u),
                                                     glm::mix(window_.top, window_.bottom, v), -1.0));
    }

    template <class Visit> void follow(glm::dvec3 world, const Visit& visit) const {
        const glm::dvec3 speed = glm::dmat3(to_index_) * world; // voxels per world unit
        double begin = 0.0, end = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (low_[axis] - eye_[axis]) / speed[axis], b = (high_[axis] - eye_[axis]) / speed[axis];
            if (std::isnan(a) || std::isnan(b)) // along a face
                continue;
            begin = std::max(begin, std::min(a, b));
            end = std::min(end, std::max(a, b));
        }
        if (!(begin < end && std::isfinite(end)))
            return;
        // No more than the grid has across, whatever rounding says.
        const double steps = std::clamp(std::ceil((end - begin) * glm::length(speed) / step_), 1.0, 2.0 * most_pieces);
        const double length = (end - begin) / steps;
        for (double i = 0.5; i < steps; ++i) {
            const glm::dvec3 at = glm::clamp(eye_ + (begin + i * length) * speed, low_, high_);
            if (const float value = field_.value(glm::ivec3(glm::round(at))); value > 0.0f)
                visit(double(value), length, at);
        }
    }

    const DensityField& field_;
    const glm::dmat4 to_index_;
    const glm::dvec3 eye_, low_, high_;
    const double step_;
    const glm::dmat3 rotation_;
    const ViewWindow window_;
};

// Per unit of extinction.
double bulk_depth(const Rays& rays) {
    double depth = 0.0, sum = 0.0, squares = 0.0;
    rays.follow([&](double density, double length, glm::dvec3) { depth += density * length; },
                [&] {
                    sum += depth;
                    squares += depth * depth;
                    depth = 0.0;
                });
    return sum > 0.0 ? squares / sum : 0.0;
}

// What the rays see of the glow alone: its brightness where the picture glows, most of it being dark at times.
double typical_glow(const Rays& rays, const DensityField& density, const DensityField& temperature,
                    const SuitableMedium& medium) {
    constexpr int entries = 1024;
    const Kelvin& kelvin = *medium.kelvin;
    const std::vector<glm::vec4> colors = make_blackbody_table(0.0, kelvin.hottest, kelvin.hottest, entries);
    const glm::dmat4 to_temperature = glm::inverse(temperature.index_to_world) * density.index_to_world;
    const auto luminance = [&](glm::dvec3 at) {
        constexpr double far = 1 << 25; // no grid reaches there
        const glm::dvec3 there = glm::clamp(glm::dvec3(to_temperature * glm::dvec4(at, 1.0)), -far, far);
        const double value = kelvin.scale * temperature.value(glm::ivec3(glm::round(there))) + kelvin.offset;
        const double entry = std::clamp(value / kelvin.hottest, 0.0, 1.0) * (entries - 1);
        return double(glm::dot(colors[std::size_t(entry)], glm::vec4(0.2126f, 0.7152f, 0.0722f, 0.0f)));
    };
    double sum = 0.0, squares = 0.0, seen = 0.0, transmittance = 1.0;
    rays.follow(
        [&](double value, double length, glm::dvec3 at) {
            const double passes = std::exp(-medium.sigma_t * value * length);
            seen += transmittance * (1.0 - passes) * (1.0 - medium.albedo) * luminance(at);
            transmittance *= passes;
        },
        [&] {
            sum += seen;
            squares += seen * seen;
            seen = 0.0;
            transmittance = 1.0;
        });
    return sum > 0.0 ? squares / sum : 0.0;
}

} // namespace

std::optional<Kelvin> read_kelvin(double highest) {
    constexpr double room = 300.0, flame = 2100.0;          // kelvin
    constexpr double glows = 700.0, hottest_star = 40000.0; // kelvin
    if (!(highest > 0.0))
        return std::nullopt;
    if (highest >= glows && highest <= hottest_star)
        return Kelvin{1.0, 0.0, highest};
    if (highest >= 250.0 && highest < glows) // kelvin of warm air
        return std::nullopt;
    return Kelvin{(flame - room) / highest, room, flame};
}

SuitableMedium suit_medium(const DensityField& density, const DensityField* temperature, const Camera& camera,
                           const Picture& picture) {
    const Rays rays(density, camera, picture);
    SuitableMedium medium;
    if (temperature)
        medium.kelvin = read_kelvin(temperature->max_value());
    medium.depth = medium.kelvin ? 8.0 : 30.0; // a fire is seen through its smoke
    medium.albedo = medium.kelvin ? 0.5 : 0.985;
    medium.g = medium.kelvin ? 0.2 : 0.3;
    const double bulk = bulk_depth(rays);
    // Too thin for any of these rays to have met it: a single voxel, say.
    const double fallback = density.max_value() * density.voxel_size();
    medium.sigma_t = medium.depth / (bulk > 0.0 ? bulk : fallback);
    if (!medium.kelvin)
        return medium;
    const double seen = typical_glow(rays, density, *temperature, medium);
    constexpr double brightness = 1.5; // above the white of a picture: flames are
    if (seen > 0.0)
        medium.glow = brightness / seen;
    else
        medium.kelvin.reset();
    return medium;
}

} // namespace vkvol
