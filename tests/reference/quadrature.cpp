#include "quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "mapped.h"
#include "phase.h"
#include "reference_lights.h"

namespace reference {

using vkvol::Rgb;

namespace {

struct GaussPoint {
    double x, weight; // on [-1, 1]
};
constexpr std::array<GaussPoint, 5> gauss5{{{-0.9061798459386640, 0.2369268850561891},
                                            {-0.5384693101056831, 0.4786286704993665},
                                            {0.0, 0.5688888888888889},
                                            {0.5384693101056831, 0.4786286704993665},
                                            {0.9061798459386640, 0.2369268850561891}}};

// Where the ray crosses the planes x = `first` + k `spacing`, likewise y and z, within the interval.
void add_crossings(std::vector<double>& t, const Ray& ray, const Interval& interval, const glm::dvec3& first,
                   double spacing) {
    for (int axis = 0; axis < 3; ++axis) {
        const double d = ray.direction[axis];
        if (d == 0.0)
            continue;
        const auto plane = [&](double at) { return (ray.origin[axis] + at * d - first[axis]) / spacing; };
        const auto [low, high] = std::minmax({plane(interval.t0), plane(interval.t1)});
        for (double k = std::ceil(low); k <= high; k += 1.0) {
            const double crossing = (first[axis] + k * spacing - ray.origin[axis]) / d;
            if (crossing > interval.t0 && crossing < interval.t1)
                t.push_back(crossing);
        }
    }
}

// Integral over the ray of sigma_t T source(t), where `smooth` are the breaks of each interval.
Rgb attenuated_integral(const Medium& medium, const Ray& ray, int panels,
                        const std::function<std::vector<double>(const Interval&)>& smooth,
                        const std::function<Rgb(double)>& source) {
    const DensityAlong density(medium, ray);
    const int cuts = medium.homogeneous() ? 64 * panels : panels;
    Rgb integral(0.0);
    double D = 0.0;
    for (const Interval& interval : support(medium, ray)) {
        const std::vector<double> t = smooth(interval);
        for (std::size_t i = 0; i + 1 < t.size(); ++i) {
            for (int cut = 0; cut < cuts; ++cut) {
                const double length = (t[i + 1] - t[i]) / cuts, a = t[i] + cut * length, b = a + length;
                for (const GaussPoint& point : gauss5) {
                    const double s = 0.5 * (a + b) + 0.5 * length * point.x;
                    const Rgb T = glm::exp(-medium.sigma_t * (D + piece_integral(medium, density, a, s)));
                    integral += 0.5 * length * point.weight * density(s) * medium.sigma_t * T * source(s);
                }
                D += piece_integral(medium, density, a, b);
            }
        }
    }
    return integral;
}

} // namespace

namespace {

// Within each voxel the values along the ray are a cubic.
void add_map_breaks(std::vector<double>& t, const Medium& medium, const Ray& index_ray) {
    std::sort(t.begin(), t.end());
    const std::size_t faces = t.size();
    for (std::size_t i = 0; i + 1 < faces; ++i) {
        const double length = t[i + 1] - t[i];
        double v[4]; // at points within, where no rounding takes them into the voxel next to it
        for (int k = 0; k < 4; ++k)
            v[k] = medium.grid_value(index_ray.at(t[i] + (k + 0.5) / 4.0 * length));
        const auto cubic = [&v](double s) { // Lagrange's, x counted in spacings from the first of them
            const double x = 4.0 * s - 0.5;
            return -(x - 1) * (x - 2) * (x - 3) / 6 * v[0] + x * (x - 2) * (x - 3) / 2 * v[1] -
                   x * (x - 1) * (x - 3) / 2 * v[2] + x * (x - 1) * (x - 2) / 6 * v[3];
        };
        const double ends[4] = {cubic(0.0), cubic(1.0 / 3.0), cubic(2.0 / 3.0), cubic(1.0)};
        for (const double at : map_breaks(medium.map, ends))
            t.push_back(t[i] + at * length);
    }
}

} // namespace

std::vector<double> breaks(const Medium& medium, const Ray& field_ray, const Interval& interval) {
    std::vector<double> t{interval.t0, interval.t1};
    if (const Grid* grid = medium.grid()) {
        const double shift = medium.filter == vkvol::Filter::nearest ? 0.5 : 0.0;
        add_crossings(t, field_ray, interval, glm::dvec3(grid->lower) + shift, 1.0);
        if (medium.map.exists() && shift == 0.0)
            add_map_breaks(t, medium, field_ray);
    } else if (medium.noise) {
        double frequency = medium.noise->frequency;
        for (int octave = 0; octave < medium.noise->octaves; ++octave, frequency *= medium.noise->lacunarity)
            add_crossings(t, field_ray, interval, glm::dvec3(0.0), 1.0 / frequency);
    }
    std::sort(t.begin(), t.end());
    return t;
}

double piece_integral(const Medium& medium, const DensityAlong& density, double a, double b) {
    if (medium.homogeneous())
        return b - a;
    if (medium.grid()) {
        const double middle = 0.5 * (a + b), half = 0.5 * (b - a), x = half / std::sqrt(3.0);
        return half * (density(middle - x) + density(middle + x));
    }
    constexpr int panels = 4;
    const double half = 0.5 * (b - a) / panels;
    double sum = 0.0;
    for (int panel = 0; panel < panels; ++panel)
        for (const GaussPoint& point : gauss5)
            sum += half * point.weight * density(a + (2 * panel + 1 + point.x) * half);
    return sum;
}

double density_integral(const Medium& medium, const Ray& ray, double t0, double t1) {
    const DensityAlong density(medium, ray);
    double D = 0.0;
    for (const Interval& part : support(medium, ray)) {
        const Interval inside = clip(part, {t0, t1});
        if (inside.empty())
            continue;
        const std::vector<double> t = breaks(medium, density.ray(), inside);
        for (std::size_t i = 0; i + 1 < t.size(); ++i)
            D += piece_integral(medium, density, t[i], t[i + 1]);
    }
    return D;
}

double optical_depth(const Medium& medium, const Ray& ray, double t0, double t1) {
    return medium.largest() * density_integral(medium, ray, t0, t1);
}

double transmittance_quadrature(const Medium& medium, const Ray& ray, double t0, double t1) {
    return std::exp(-optical_depth(medium, ray, t0, t1));
}

Rgb chromatic_transmittance(const Medium& medium, const Ray& ray, double t0, double t1) {
    return glm::exp(-medium.sigma_t * density_integral(medium, ray, t0, t1));
}

Rgb single_scattering_quadrature(const Medium& medium, const vkvol::Light& light, const Ray& ray, int panels) {
    const Ray field_ray = DensityAlong(medium, ray).ray();
    const Rgb integral = attenuated_integral(
        medium, ray, panels, [&](const Interval& interval) { return breaks(medium, field_ray, interval); },
        [&](double t) {
            const auto found = towards(light, ray.at(t), 0.5, 0.5);
            if (!found)
                return Rgb(0.0);
            const double mu = glm::dot(found->ray.direction, ray.direction);
            return chromatic_transmittance(medium, found->ray, 0.0, found->ray.reach) * phase_eval(medium, mu) *
                   found->light;
        });
    return medium.albedo * integral;
}

Rgb unscattered_quadrature(const Medium& medium, const Rgb& background, const Ray& ray, int panels) {
    const Rgb tau = medium.sigma_t * density_integral(medium, ray), T = glm::exp(-tau);
    const Rgb absorbed(-std::expm1(-tau.x), -std::expm1(-tau.y), -std::expm1(-tau.z));
    const Emission& emission = medium.emission;
    if (emission.grid.empty()) // the integral of (1 - albedo) sigma_t T Le with constant albedo and Le
        return absorbed * (1.0 - medium.albedo) * emission.constant + T * background;
    const Ray field_ray = DensityAlong(medium, ray).ray(), emission_ray = emission.grid.to_index(ray);
    const auto smooth = [&](const Interval& interval) {
        std::vector<double> t = breaks(medium, field_ray, interval);
        add_crossings(t, emission_ray, interval, glm::dvec3(0.0), 1.0);
        std::sort(t.begin(), t.end());
        return t;
    };
    return (1.0 - medium.albedo) *
               attenuated_integral(
                   medium, ray, panels, smooth,
                   [&](double t) { return emission.at(ray.at(t), medium.filter == vkvol::Filter::nearest); }) +
           T * background;
}

} // namespace reference
