#include "quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "phase.h"

namespace reference {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Where the density along the ray ceases to be a polynomial: the ends of the interval and the crossings of voxel cells.
std::vector<double> breaks(const Medium& medium, const Ray& index_ray, const Interval& interval) {
    std::vector<double> t{interval.t0, interval.t1};
    const Grid& grid = *medium.grid();
    const double shift = medium.filter == vkvol::Filter::nearest ? 0.5 : 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        if (index_ray.direction[axis] == 0.0)
            continue;
        for (int plane = 0; plane < grid.size[axis]; ++plane) {
            const double position = grid.lower[axis] + plane + shift;
            const double crossing = (position - index_ray.origin[axis]) / index_ray.direction[axis];
            if (crossing > interval.t0 && crossing < interval.t1)
                t.push_back(crossing);
        }
    }
    std::sort(t.begin(), t.end());
    return t;
}

// Optical depth over [a, b], which lies inside one voxel cell: two Gauss points.
double cell_depth(const Medium& medium, const Ray& index_ray, double a, double b) {
    const double middle = 0.5 * (a + b), half = 0.5 * (b - a), x = half / std::sqrt(3.0);
    const double sum = medium.density(index_ray.at(middle - x)) + medium.density(index_ray.at(middle + x));
    return medium.sigma_t * half * sum;
}

struct GaussPoint {
    double x, weight; // on [-1, 1]
};
constexpr std::array<GaussPoint, 5> gauss5{{{-0.9061798459386640, 0.2369268850561891},
                                            {-0.5384693101056831, 0.4786286704993665},
                                            {0.0, 0.5688888888888889},
                                            {0.5384693101056831, 0.4786286704993665},
                                            {0.9061798459386640, 0.2369268850561891}}};

} // namespace

double optical_depth(const Medium& medium, const Ray& ray, double t0, double t1) {
    const Interval inside = clip(support(medium, ray), {t0, t1});
    if (inside.empty())
        return 0.0;
    if (!medium.grid())
        return medium.sigma_t * inside.length();
    const Ray index_ray = medium.grid()->to_index(ray);
    const std::vector<double> t = breaks(medium, index_ray, inside);
    double tau = 0.0;
    for (std::size_t i = 0; i + 1 < t.size(); ++i)
        tau += cell_depth(medium, index_ray, t[i], t[i + 1]);
    return tau;
}

double transmittance_quadrature(const Medium& medium, const Ray& ray, double t0, double t1) {
    return std::exp(-optical_depth(medium, ray, t0, t1));
}

vkvol::Rgb single_scattering_quadrature(const Medium& medium, const vkvol::DirectionalLight& light, const Ray& ray,
                                        int panels) {
    const Interval inside = support(medium, ray);
    if (inside.empty())
        return vkvol::Rgb(0.0);
    const Grid* grid = medium.grid();
    const Ray index_ray = grid ? grid->to_index(ray) : ray;
    const std::vector<double> t = grid ? breaks(medium, index_ray, inside) : std::vector{inside.t0, inside.t1};
    const int cuts = grid ? panels : 64 * panels;
    const auto sigma_t = [&](double s) { return medium.sigma_t * (grid ? medium.density(index_ray.at(s)) : 1.0); };
    const auto depth = [&](double a, double b) {
        return grid ? cell_depth(medium, index_ray, a, b) : medium.sigma_t * (b - a);
    };

    double integral = 0.0, tau = 0.0;
    for (std::size_t i = 0; i + 1 < t.size(); ++i) {
        for (int cut = 0; cut < cuts; ++cut) {
            const double a = t[i] + (t[i + 1] - t[i]) * cut / cuts, b = t[i] + (t[i + 1] - t[i]) * (cut + 1) / cuts;
            for (const GaussPoint& point : gauss5) {
                const double s = 0.5 * (a + b) + 0.5 * (b - a) * point.x;
                const Ray to_light{ray.at(s), light.direction};
                const double path = tau + depth(a, s) + optical_depth(medium, to_light, 0.0, infinity);
                integral += 0.5 * (b - a) * point.weight * sigma_t(s) * std::exp(-path);
            }
            tau += depth(a, b);
        }
    }
    const double mu = glm::dot(light.direction, ray.direction);
    return medium.albedo * hg_eval(medium.g, mu) * integral * light.irradiance;
}

vkvol::Rgb unscattered_quadrature(const Medium& medium, const vkvol::Rgb& background, const Ray& ray) {
    // Albedo and Le are constant, so the integral of (1 - albedo) sigma_t T Le is (1 - albedo)(1 - T) Le.
    const double tau = optical_depth(medium, ray, 0.0, infinity);
    return -std::expm1(-tau) * (1.0 - medium.albedo) * medium.emission.constant + std::exp(-tau) * background;
}

} // namespace reference
