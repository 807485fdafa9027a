// The scalar reference: where every free flight collides, and with which weights.
#include <catch2/catch.hpp>

#include <vector>

#include "tests/reference/test_media.h"

using namespace reference;
using vkvol::Rgb;

namespace {

Flight fly_once(const Sample& sample, int free_flight, const Rgb& beta, Rng& rng) {
    const Draw first = rng.next();
    return fly(sample.medium, free_flight, sample.ray, first.exponential(2), first.select(), beta, sample.march, rng);
}

// The mean weight of the flights that end in each of `bins` stretches of equal optical depth (of the densest channel),
// and, last, of those that escape.
std::vector<RgbMean> weights(const Sample& sample, int free_flight, const Rgb& beta, int bins, int count) {
    const double tau_end = optical_depth(sample.medium, sample.ray, 0.0, infinity);
    std::vector<RgbMean> means(bins + 1);
    Rng rng = stream(151);
    for (int i = 0; i < count; ++i) {
        const Flight flight = fly_once(sample, free_flight, beta, rng);
        int bin = bins;
        if (flight.t)
            bin = std::min(bins - 1, int(bins * optical_depth(sample.medium, sample.ray, 0.0, *flight.t) / tau_end));
        for (int k = 0; k <= bins; ++k)
            means[k].add(k == bin ? flight.beta : Rgb(0.0));
    }
    return means;
}

// Channel i collides with the density sigma_i exp(-sigma_i D), whatever channel was sampled.
void check_weights(const Sample& sample, int free_flight, const Rgb& beta, int count) {
    constexpr int bins = 5;
    const std::vector<RgbMean> means = weights(sample, free_flight, beta, bins, count);
    const double D = density_integral(sample.medium, sample.ray);
    const auto T = [&](int k) { return glm::exp(-sample.medium.sigma_t * D * double(k) / double(bins)); };
    for (int k = 0; k <= bins; ++k) {
        CAPTURE(k);
        CHECK(means[k].z(beta * (k == bins ? T(bins) : T(k) - T(k + 1))) < 4.0);
    }
}

} // namespace

TEST_CASE("free flights follow the exact distribution", "[cpu][reference]") {
    struct Case {
        Kind kind;
        int free_flight;
        double majorant_scale;
    };
    const Case c =
        GENERATE(Case{Kind::box, FREE_FLIGHT_ANALYTIC, 1}, Case{Kind::rough_grid, FREE_FLIGHT_REGULAR, 1},
                 Case{Kind::rough_grid, FREE_FLIGHT_DELTA, 1}, Case{Kind::rough_grid, FREE_FLIGHT_DELTA, 2},
                 Case{Kind::noise_sphere, FREE_FLIGHT_DELTA, 1}, Case{Kind::noise_mesh, FREE_FLIGHT_DELTA, 2},
                 Case{Kind::box, FREE_FLIGHT_DELTA, 2}, Case{Kind::rough_grid, FREE_FLIGHT_DECOMPOSITION, 1},
                 Case{Kind::noise_mesh, FREE_FLIGHT_DECOMPOSITION, 2}, Case{Kind::rough_grid, FREE_FLIGHT_WEIGHTED, 1},
                 Case{Kind::noise_sphere, FREE_FLIGHT_WEIGHTED, 2}, Case{Kind::rough_grid, FREE_FLIGHT_SPECTRAL, 2},
                 Case{Kind::noise_mesh, FREE_FLIGHT_SPECTRAL, 1}, Case{Kind::rough_grid, FREE_FLIGHT_MARCH, 1},
                 Case{Kind::noise_mesh, FREE_FLIGHT_MARCH, 1}, Case{Kind::rough_grid, FREE_FLIGHT_ADAPTIVE, 1},
                 Case{Kind::noise_mesh, FREE_FLIGHT_ADAPTIVE, 2});
    CAPTURE(int(c.kind), c.free_flight, c.majorant_scale);
    Sample sample = make_sample(c.kind, c.majorant_scale);
    sample.march.step *= 0.25; // a march's bias then is far below what so many flights can tell
    sample.march.optical_step = 0.05;
    const auto tau = [&](double t) { return optical_depth(sample.medium, sample.ray, 0.0, t); };
    const double T = std::exp(-tau(infinity));
    constexpr int n = 4000;
    Rng rng = stream(157);
    std::vector<double> uniforms;
    for (int i = 0; i < n; ++i) {
        const Flight flight = fly_once(sample, c.free_flight, Rgb(1.0), rng);
        for (int k = 0; k < 3; ++k) // grey: no flight needs weights
            REQUIRE(flight.beta[k] == Approx(1.0).epsilon(1e-9));
        if (flight.t)
            uniforms.push_back(-std::expm1(-tau(*flight.t)) / (1.0 - T));
    }
    const double escaped = n - double(uniforms.size());
    CHECK(std::abs(escaped - n * T) < 4.0 * std::sqrt(n * T * (1.0 - T)));
    CHECK(vkvol::kolmogorov_smirnov_p(uniforms) > 1e-3);
}

TEST_CASE("neither majorant cells nor the filter move a flight's collisions", "[cpu][reference]") {
    const int cell = GENERATE(as<int>{}, one_cell, 1, 2, 8);
    const auto filter = GENERATE(vkvol::Filter::trilinear, vkvol::Filter::nearest);
    CAPTURE(cell, int(filter));
    Sample sample = make_sample(Kind::chromatic_grid);
    sample.medium.filter = filter;
    build_majorants(std::get<Grid>(sample.medium.shape), cell);
    check_weights(sample, FREE_FLIGHT_SPECTRAL, Rgb(1.0), 10000);
    check_weights(sample, FREE_FLIGHT_REGULAR, Rgb(1.0), 10000);
    sample.medium.sigma_t = Rgb(sample.medium.largest());
    check_weights(sample, FREE_FLIGHT_DELTA, Rgb(1.0), 10000);
    sample.march.optical_step = 0.05;
    check_weights(sample, FREE_FLIGHT_ADAPTIVE, Rgb(1.0), 10000);
}

TEST_CASE("depth-sampled flights weight channels of different extinction", "[cpu][reference][long]") {
    struct Case {
        Kind kind;
        int free_flight;
    };
    const Case c =
        GENERATE(Case{Kind::chromatic_box, FREE_FLIGHT_ANALYTIC}, Case{Kind::chromatic_grid, FREE_FLIGHT_REGULAR},
                 Case{Kind::chromatic_grid, FREE_FLIGHT_MARCH}, Case{Kind::chromatic_grid, FREE_FLIGHT_ADAPTIVE});
    const Rgb beta = GENERATE(Rgb(1.0), Rgb(1.0, 0.3, -0.6), Rgb(0.0, 0.0, 2.0));
    CAPTURE(int(c.kind), c.free_flight, beta.x, beta.y, beta.z);
    Sample sample = make_sample(c.kind);
    sample.march.step *= 0.25;
    sample.march.optical_step = 0.05;
    check_weights(sample, c.free_flight, beta, 20000);
    sample.medium.sigma_t.y = 0.0; // a channel that never collides
    check_weights(sample, c.free_flight, beta, 20000);
}

TEST_CASE("spectral tracking weights channels of different extinction", "[cpu][reference]") {
    const Kind kind = GENERATE(Kind::chromatic_grid, Kind::chromatic_box, Kind::rough_grid);
    const double scale = GENERATE(0.5, 1.0, 2.0);
    const Rgb beta = GENERATE(Rgb(1.0), Rgb(1.0, 0.3, -0.6), Rgb(0.0, 0.0, 2.0));
    CAPTURE(int(kind), scale, beta.x, beta.y, beta.z);
    check_weights(make_sample(kind, scale), FREE_FLIGHT_SPECTRAL, beta, 20000);
}

TEST_CASE("weighted tracking bears densities above the majorant", "[cpu][reference]") {
    const Kind kind = GENERATE(Kind::rough_grid, Kind::box);
    const double scale = GENERATE(0.5, 0.8);
    CAPTURE(int(kind), scale);
    const Sample sample = make_sample(kind, scale);
    check_weights(sample, FREE_FLIGHT_WEIGHTED, Rgb(1.0, 0.5, 0.0), 40000);
    if (kind == Kind::box && scale == 0.5) { // where delta tracking lets too much through: exp(-tau / 2)
        const Rgb T = chromatic_transmittance(sample.medium, sample.ray);
        CHECK(weights(sample, FREE_FLIGHT_DELTA, Rgb(1.0), 1, 20000)[1].z(T) > 4.0);
    }
}

TEST_CASE("decomposition tracking takes the paths of delta tracking", "[cpu][reference]") {
    const Sample sample = make_sample(GENERATE(Kind::rough_grid, Kind::noise_sphere));
    Rng a = stream(163), b = stream(163);
    for (int i = 0; i < 1000; ++i)
        REQUIRE(fly_once(sample, FREE_FLIGHT_DELTA, Rgb(1.0), a).t ==
                fly_once(sample, FREE_FLIGHT_DECOMPOSITION, Rgb(1.0), b).t);
    CHECK(a.draw == b.draw);
}

TEST_CASE("long marches err by their sample points alone", "[cpu][reference]") {
    // The mean over the jitter of exp(-sigma_t rho Delta) per step; steps are independent.
    Sample sample = make_sample(Kind::rough_grid);
    const Interval inside = support(sample.medium, sample.ray).front();
    const int steps = 3, points = 20000;
    sample.march.step = inside.length() / steps * (1.0 + 1e-9);
    const DensityAlong density(sample.medium, sample.ray);
    const double delta = inside.length() / steps;
    double expected = 1.0;
    for (int k = 0; k < steps; ++k) {
        double mean = 0.0;
        for (int i = 0; i < points; ++i)
            mean += std::exp(-sample.medium.sigma_t.x * delta * density(inside.t0 + (k + (i + 0.5) / points) * delta));
        expected *= mean / points;
    }
    const RgbMean escaped = weights(sample, FREE_FLIGHT_MARCH, Rgb(1.0), 1, 40000)[1];
    CHECK(escaped.z(Rgb(expected)) < 4.0);
    CHECK(escaped.z(chromatic_transmittance(sample.medium, sample.ray)) > 4.0); // biased
}

TEST_CASE("pieces of a flight make up its way", "[cpu][reference]") {
    struct Case {
        Kind kind;
        int free_flight;
    };
    const Case c = GENERATE(Case{Kind::box, FREE_FLIGHT_ANALYTIC}, Case{Kind::rough_grid, FREE_FLIGHT_REGULAR},
                            Case{Kind::rough_grid, FREE_FLIGHT_DELTA}, Case{Kind::noise_mesh, FREE_FLIGHT_MARCH},
                            Case{Kind::noise_mesh, FREE_FLIGHT_SPECTRAL}, Case{Kind::rough_grid, FREE_FLIGHT_ADAPTIVE});
    CAPTURE(int(c.kind), c.free_flight);
    const Sample sample = make_sample(c.kind);
    const DensityAlong density(sample.medium, sample.ray);
    Rng rng = stream(167);
    for (int i = 0; i < 500; ++i) {
        double flown = 0.0, position = 0.0;
        FlightEvents events;
        events.piece = [&](double t0, double t1, const Rgb& beta) {
            REQUIRE(glm::distance(beta, Rgb(1.0)) < 1e-12);
            REQUIRE(t0 >= position - 1e-9);
            REQUIRE(t0 <= t1);
            position = t1;
            flown += density_integral(sample.medium, sample.ray, t0, t1);
        };
        const Draw first = rng.next();
        const Flight flight = fly(sample.medium, c.free_flight, sample.ray, first.exponential(2), first.select(),
                                  Rgb(1.0), sample.march, rng, events);
        const double D = density_integral(sample.medium, sample.ray, 0.0, flight.t.value_or(infinity));
        REQUIRE(flown == Approx(D).epsilon(1e-6).margin(1e-9)); // noise: pieces are integrated from other points
    }
}
