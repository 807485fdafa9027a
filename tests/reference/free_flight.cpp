#include "free_flight.h"

namespace reference {

std::optional<double> sample_collision(const Medium& medium, const Ray& ray, double flight, Rng& rng) {
    const Interval inside = support(medium, ray);
    if (inside.empty())
        return {};
    const Grid* grid = medium.grid();
    if (!grid) {
        const double t = inside.t0 + flight / medium.sigma_t;
        return t < inside.t1 ? std::optional(t) : std::nullopt;
    }

    const Ray index_ray = grid->to_index(ray);
    MajorantWalk walk(*grid, index_ray, inside);
    MajorantSegment segment;
    double tau = flight; // majorant optical depth left until the next tentative collision
    while (walk.next(segment)) {
        const double sigma_maj = medium.sigma_t * segment.majorant;
        double t = segment.t0;
        while (tau < sigma_maj * (segment.t1 - t)) {
            t += tau / sigma_maj;
            const Draw draw = rng.next();
            if (draw.y() * segment.majorant < medium.density(index_ray.at(t)))
                return t;
            tau = to_exponential(draw.x());
        }
        tau -= sigma_maj * (segment.t1 - t);
    }
    return {};
}

} // namespace reference
