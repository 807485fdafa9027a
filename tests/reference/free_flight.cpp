#include "free_flight.h"

#include <stdexcept>

#include "shaders/shared/constants.h"

namespace reference {

bool depth_sampled(int free_flight) {
    return free_flight == FREE_FLIGHT_ANALYTIC || free_flight == FREE_FLIGHT_REGULAR ||
           free_flight == FREE_FLIGHT_MARCH || free_flight == FREE_FLIGHT_ADAPTIVE;
}

Flight fly(const Medium& medium, int free_flight, const Ray& ray, double exponential, double select,
           const vkvol::Rgb& beta, const vkvol::March& march, Rng& rng, const FlightEvents& events) {
    const DepthSample sample(medium, exponential, select, beta);
    switch (free_flight) {
    case FREE_FLIGHT_ANALYTIC:
        return analytic_flight(medium, ray, sample, events);
    case FREE_FLIGHT_REGULAR:
        return regular_flight(medium, ray, sample, events);
    case FREE_FLIGHT_MARCH:
        return march_flight(medium, ray, sample, march, false, rng, events);
    case FREE_FLIGHT_ADAPTIVE:
        return march_flight(medium, ray, sample, march, true, rng, events);
    case FREE_FLIGHT_DELTA:
    case FREE_FLIGHT_DECOMPOSITION:
        return delta_flight(medium, ray, exponential, beta, rng, events);
    case FREE_FLIGHT_WEIGHTED:
        return weighted_flight(medium, ray, exponential, beta, rng, events);
    case FREE_FLIGHT_SPECTRAL:
        return spectral_flight(medium, ray, exponential, beta, rng, events);
    }
    throw std::runtime_error("no such free flight");
}

} // namespace reference
