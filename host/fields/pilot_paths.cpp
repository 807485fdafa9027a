#include "pilot_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "cell_walk.h"
#include "empty_space.h"
#include "value_map.h"

namespace vkvol {

namespace {

constexpr int paths = 256;
constexpr int most_collisions = 64; // of a path
constexpr int most_steps = 1 << 21; // of all: where majorants are far too high, or cells very many, fewer paths will do

class Pilot {
public:
    Pilot(const DensityField& field, const MajorantGrid& cells, const PilotScene& scene)
        : field_(field), cells_(cells), scene_(scene), low_(field.voxel_min - 1), high_(field.voxel_max + 1) {}

    std::vector<PilotSegment> follow_all() {
        for (int i = 0; i < paths && steps_left_ > 0; ++i)
            follow();
        return std::move(segments_);
    }

private:
    // In [0, 1). The standard leaves its distributions to each library, and the plan is to be the same with all of
    // them.
    double uniform() {
        const double low = engine_(), high = engine_();
        return std::min((high * 4294967296.0 + low) / 18446744073709551616.0, 1.0 - 0x1p-53);
    }

    // Distances at which the ray enters and leaves the box, the former 0 from within.
    glm::dvec2 crossing(glm::dvec3 origin, glm::dvec3 direction) const {
        glm::dvec2 t(0.0, std::numeric_limits<double>::max());
        for (int i = 0; i < 3; ++i) {
            if (direction[i] == 0.0)
                continue;
            const double a = (low_[i] - origin[i]) / direction[i], b = (high_[i] - origin[i]) / direction[i];
            t = {std::max(t.x, std::min(a, b)), std::min(t.y, std::max(a, b))};
        }
        return t;
    }

    // How far the flight goes within the box; `collides` if that is to a real collision.
    double fly(glm::dvec3 origin, glm::dvec3 direction, double length, bool& collides) {
        double tau = -std::log1p(-uniform()), gone = length;
        collides = false;
        walk_cells(cells_, {}, origin, direction, length, [&](double bound, double t0, double t1) {
            const double sigma_maj = scene_.sigma_t * bound;
            if (--steps_left_ < 0)
                return false;
            while (tau < sigma_maj * (t1 - t0)) {
                t0 += tau / sigma_maj;
                tau = -std::log1p(-uniform());
                if (--steps_left_ < 0)
                    return false;
                const glm::ivec3 voxel(glm::floor(origin + t0 * direction + 0.5));
                if (uniform() * bound < mapped_density(scene_.map, field_.value(voxel))) {
                    gone = t0;
                    collides = true;
                    return false;
                }
            }
            tau -= sigma_maj * (t1 - t0);
            return true;
        });
        return gone;
    }

    // Henyey and Greenstein's, about a direction.
    glm::dvec3 scatter(glm::dvec3 d) {
        const double u = uniform(), g = scene_.g, phi = 2.0 * std::acos(-1.0) * uniform();
        const double q = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
        const double mu = std::abs(g) < 1e-3 ? 2.0 * u - 1.0 : std::clamp((1.0 + g * g - q * q) / (2.0 * g), -1.0, 1.0);
        const glm::dvec3 aside = std::abs(d.x) > 0.5 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
        const glm::dvec3 a = glm::normalize(glm::cross(d, aside)), b = glm::cross(d, a);
        return glm::normalize(mu * d + std::sqrt(1.0 - mu * mu) * (std::cos(phi) * a + std::sin(phi) * b));
    }

    void follow() {
        const glm::dvec3 target = low_ + (high_ - low_) * glm::dvec3(uniform(), uniform(), uniform());
        const glm::dvec3 apart = target - scene_.eye;
        if (!(glm::length(apart) > 0.0))
            return;
        glm::dvec3 direction = glm::normalize(apart);
        glm::dvec3 origin = scene_.eye + crossing(scene_.eye, direction).x * direction;
        for (int depth = 0; depth < most_collisions; ++depth) {
            bool collides;
            const double length = std::max(crossing(origin, direction).y, 0.0);
            const double gone = fly(origin, direction, length, collides);
            segments_.push_back({origin, direction, gone, collides});
            if (!collides || uniform() >= scene_.albedo)
                return;
            origin += gone * direction;
            if (scene_.light) {
                segments_.push_back({origin, *scene_.light, std::max(crossing(origin, *scene_.light).y, 0.0)});
                steps_left_ -= segments_.back().length / cells_.cell;
            }
            direction = scatter(direction);
        }
    }

    const DensityField& field_;
    const MajorantGrid& cells_;
    const PilotScene& scene_;
    const glm::dvec3 low_, high_;
    std::mt19937 engine_{1};
    double steps_left_ = most_steps;
    std::vector<PilotSegment> segments_;
};

} // namespace

std::vector<PilotSegment> pilot_paths(const DensityField& field, const MajorantGrid& cells, const PilotScene& scene) {
    return Pilot(field, cells, scene).follow_all();
}

std::vector<double> pilot_steps(const std::vector<PilotSegment>& segments, const MajorantGrid& cells, double sigma_t) {
    const std::vector<std::uint8_t> reaches = cells.leaps ? empty_reaches(cells) : std::vector<std::uint8_t>();
    std::vector<double> all_steps;
    for (const PilotSegment& s : segments) {
        double steps = s.collides ? -1.0 : 0.0; // the last cell is not crossed
        walk_cells(cells, reaches, s.origin, s.direction, s.length, [&](double bound, double t0, double t1) {
            steps += sigma_t * bound * (t1 - t0) + 1.0;
            return true;
        });
        all_steps.push_back(std::max(steps, 1.0));
    }
    return all_steps;
}

std::uint32_t best_steps_per_turn(const std::vector<double>& segment_steps) {
    constexpr double look = 2.0; // steps; with it the best counts are those measured
    std::uint32_t best = 4;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t steps = 4; steps >= 2; --steps) {
        double cost = 0.0;
        for (const double n : segment_steps)
            cost += std::ceil(n / steps) * (look + steps);
        if (cost < least) {
            least = cost;
            best = steps;
        }
    }
    return best;
}

} // namespace vkvol
