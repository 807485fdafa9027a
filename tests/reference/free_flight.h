// Free flights: where a path next collides, and what its throughput then is.
#pragma once

#include <functional>
#include <optional>

#include "medium.h"
#include "rng.h"

namespace reference {

struct Flight {
    std::optional<double> t; // of the first real collision; none: the ray leaves the medium
    vkvol::Rgb beta;         // throughput afterwards, the albedo not yet included
};

// What a path may want to know on the way. Either may be empty.
struct FlightEvents {
    // A tentative collision of a null-collision flight, real or not; `weight` is beta sigma_t / sigma_maj before it.
    std::function<void(double t, const vkvol::Rgb& weight)> tentative;
    // A piece of the way, with the throughput of all light from there: exact but in depth-sampled chromatic flights.
    std::function<void(double t0, double t1, const vkvol::Rgb& beta)> piece;
};

// FREE_FLIGHT_... of a path of throughput beta. `exponential` is a unit exponential variate: the first optical depth.
// `select` in [0, 1) chooses the channel that a depth-sampled flight samples. `march`: as resolved.
Flight fly(const Medium& medium, int free_flight, const Ray& ray, double exponential, double select,
           const vkvol::Rgb& beta, const vkvol::March& march, Rng& rng, const FlightEvents& events = {});

bool depth_sampled(int free_flight); // analytic, regular and the marches: no null collisions

// Depth-sampled flights sample an optical depth of one channel and go until it is reached. With D the integral of the
// density flown, the throughput is weighted by the balance heuristic over the channels that could have been chosen.
class DepthSample {
public:
    DepthSample(const Medium& medium, double exponential, double select, const vkvol::Rgb& beta);
    double depth() const { return depth_; } // the density integral to fly
    Flight collided(double t, double D) const;
    Flight escaped(double D) const;

private:
    vkvol::Rgb sigma_t_, beta_, probability_;
    double depth_;
};

Flight analytic_flight(const Medium& medium, const Ray& ray, const DepthSample& sample, const FlightEvents& events);
Flight regular_flight(const Medium& medium, const Ray& ray, const DepthSample& sample, const FlightEvents& events);
Flight march_flight(const Medium& medium, const Ray& ray, const DepthSample& sample, const vkvol::March& march,
                    bool adaptive, Rng& rng, const FlightEvents& events);

// Woodcock et al. 1965; decomposition (Kutz et al. 2017) decides alike, only with fewer lookups.
Flight delta_flight(const Medium& medium, const Ray& ray, double exponential, const vkvol::Rgb& beta, Rng& rng,
                    const FlightEvents& events);
// Weighted tracking (Galtier et al. 2013): bears densities above the majorant.
Flight weighted_flight(const Medium& medium, const Ray& ray, double exponential, const vkvol::Rgb& beta, Rng& rng,
                       const FlightEvents& events);
// Spectral tracking (Kutz et al. 2017): one flight for channels of different extinction.
Flight spectral_flight(const Medium& medium, const Ray& ray, double exponential, const vkvol::Rgb& beta, Rng& rng,
                       const FlightEvents& events);

} // namespace reference
