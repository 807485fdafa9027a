#include "transmittance.h"

#include <algorithm>
#include <cmath>

namespace reference {

double ratio_transmittance(const Medium& medium, const Ray& ray, Rng& rng, double roulette_threshold) {
    const Interval inside = support(medium, ray);
    if (inside.empty())
        return 1.0;
    const Grid* grid = medium.grid();
    if (!grid)
        return std::exp(-medium.sigma_t * inside.length());

    const Ray index_ray = grid->to_index(ray);
    MajorantWalk walk(*grid, index_ray, inside);
    MajorantSegment segment;
    double T = 1.0;
    double tau = to_exponential(rng.next().x());
    while (walk.next(segment)) {
        const double sigma_maj = medium.sigma_t * segment.majorant;
        double t = segment.t0;
        while (tau < sigma_maj * (segment.t1 - t)) {
            t += tau / sigma_maj;
            const Draw draw = rng.next();
            T *= std::max(0.0, 1.0 - medium.density(index_ray.at(t)) / segment.majorant);
            if (T < roulette_threshold) {
                if (draw.y() * roulette_threshold >= T)
                    return 0.0;
                T = roulette_threshold;
            }
            if (T == 0.0)
                return 0.0;
            tau = to_exponential(draw.x());
        }
        tau -= sigma_maj * (segment.t1 - t);
    }
    return T;
}

} // namespace reference
