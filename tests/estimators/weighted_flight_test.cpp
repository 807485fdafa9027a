// Free flights that carry weights: with majorants that do not bound, and in media whose extinction differs between the
// colour channels. In each channel the mean of the weight over flights that collide between two depths is the exact
// probability of a collision there, and over those that escape the exact transmittance. Depths are density integrals D.
// Significance 1e-3 for each test case (Sidak), fixed seeds.
#include <catch2/catch.hpp>
#include <cmath>

#include "support/numbers.h"
#include "support/test_medium.h"

using namespace vkvol;
using shared::FlightOutput;
using test_numbers::collided;
using test_numbers::left;

namespace {

constexpr int bin_count = 6; // of depth; comparisons per channel: one more, the escapes

// Flights that set out with throughput `beta`.
void check_bins(const TestMedium& medium, const reference::Ray& ray, const std::vector<FlightOutput>& flights,
                glm::vec3 beta, double significance) {
    const double D_end = medium.density_integral(ray);
    const std::vector<double> D = medium.depths(ray, flights);
    std::vector<RgbMean> bins(bin_count + 1);
    for (std::size_t i = 0; i < flights.size(); ++i) {
        REQUIRE((flights[i].event == collided || flights[i].event == left));
        const int at = flights[i].event == left ? bin_count : std::min(int(D[i] / D_end * bin_count), bin_count - 1);
        for (int bin = 0; bin <= bin_count; ++bin)
            bins[bin].add(bin == at ? flights[i].weight : glm::vec3(0.0f));
    }
    const Rgb sigma_t = medium.reference().sigma_t;
    for (int bin = 0; bin <= bin_count; ++bin)
        for (int c = 0; c < 3; ++c) {
            const auto T = [&](int edge) { return std::exp(-sigma_t[c] * D_end * edge / bin_count); };
            const double expected = beta[c] * (bin == bin_count ? T(bin) : T(bin) - T(bin + 1));
            const RunningMean& mean = bins[bin].channel[c];
            CAPTURE(bin, c, expected, mean.mean(), mean.standard_error());
            // Weights are products of a few dozen factors in single precision.
            CHECK(t_test_p(mean, expected, 1e-5 * std::abs(expected)) > significance);
        }
}

// In a grid sigma_t(x) exceeds these majorants fivefold at most, in noise fivefold. Where it does, weights grow by
// (2 sigma_t - sigma_maj) / sigma_maj per tentative collision, of which there are sigma_maj per length: the second
// moment by exp of 4 (sigma_t / sigma_maj - 1) per optical depth, hence thin media.
MediumRecipe thin_recipe(MediumKind kind) {
    MediumRecipe recipe;
    recipe.kind = kind;
    recipe.sigma_t = Rgb(kind == MediumKind::grid ? 0.5 : 0.25);
    recipe.grid.linear = skewed;
    return recipe;
}

} // namespace

TEST_CASE("weighted and spectral tracking need no bounding majorants", "[gpu][free_flight]") {
    const int flight = GENERATE(FREE_FLIGHT_WEIGHTED, FREE_FLIGHT_SPECTRAL);
    const MediumKind kind = GENERATE(MediumKind::grid, MediumKind::noise_sphere, MediumKind::noise_cubes);
    const double scale = GENERATE(0.5, 0.2);
    CAPTURE(flight, int(kind), scale);
    MediumRecipe recipe = thin_recipe(kind);
    recipe.estimators.free_flight = flight;
    recipe.majorant_scale = scale;
    const TestMedium medium(recipe);
    const auto flights = medium.fly(medium.flights_along(medium.ray(), 100000, 1));
    if (scale < 0.4) // the rays do meet such densities; null collisions there change the sign
        CHECK(std::any_of(flights.begin(), flights.end(), [](const FlightOutput& f) { return f.weight.x < 0.0f; }));
    check_bins(medium, medium.ray(), flights, glm::vec3(1.0f), sidak(1e-3, 12 * 3 * (bin_count + 1)));
}

TEST_CASE("delta and decomposition tracking lose what exceeds the majorants", "[gpu][free_flight]") {
    const int flight = GENERATE(FREE_FLIGHT_DELTA, FREE_FLIGHT_DECOMPOSITION);
    MediumRecipe recipe = thin_recipe(MediumKind::noise_sphere);
    recipe.estimators.free_flight = flight;
    recipe.majorant_scale = 0.2;
    const TestMedium medium(recipe);
    const int count = 100000;
    double escaped = 0.0;
    for (const FlightOutput& f : medium.fly(medium.flights_along(medium.ray(), count, 1)))
        escaped += f.event == left ? 1.0 : 0.0;
    const double T = std::exp(-recipe.sigma_t.x * medium.density_integral(medium.ray()));
    CAPTURE(flight, escaped / count, T);
    CHECK(escaped / count > T + 10.0 * std::sqrt(T * (1.0 - T) / count));
}

TEST_CASE("in chromatic media every channel has its own distribution of flights", "[gpu][free_flight][chromatic][long]") {
    struct Case {
        int flight;
        MediumKind kind;
        Filter filter;
        double majorant_scale;
    };
    const std::vector<Case> cases = {{FREE_FLIGHT_ANALYTIC, MediumKind::sphere, Filter::trilinear, 1.0},
                                     {FREE_FLIGHT_ANALYTIC, MediumKind::cubes, Filter::trilinear, 1.0},
                                     {FREE_FLIGHT_REGULAR, MediumKind::grid, Filter::trilinear, 1.0},
                                     {FREE_FLIGHT_REGULAR, MediumKind::grid, Filter::nearest, 1.0},
                                     {FREE_FLIGHT_MARCH, MediumKind::noise_sphere, Filter::trilinear, 1.0},
                                     {FREE_FLIGHT_ADAPTIVE, MediumKind::grid, Filter::trilinear, 1.0},
                                     {FREE_FLIGHT_SPECTRAL, MediumKind::grid, Filter::trilinear, 1.0},
                                     {FREE_FLIGHT_SPECTRAL, MediumKind::grid, Filter::stochastic, 2.0},
                                     {FREE_FLIGHT_SPECTRAL, MediumKind::noise_sphere, Filter::trilinear, 1.0},
                                     {FREE_FLIGHT_SPECTRAL, MediumKind::cubes, Filter::trilinear, 2.0},
                                     {FREE_FLIGHT_SPECTRAL, MediumKind::noise_cubes, Filter::trilinear, 2.0}};
    const Rgb sigma_t = GENERATE(Rgb(0.3, 0.6, 1.0), Rgb(1.0, 0.0, 0.5));
    // Throughputs that differ, one of them negative, as spectral and weighted tracking may make them.
    const glm::vec3 beta = sigma_t.y == 0.0 ? glm::vec3(1.0f, -0.5f, 0.25f) : glm::vec3(1.0f);
    for (const Case& c : cases) {
        CAPTURE(c.flight, int(c.kind), int(c.filter), c.majorant_scale, sigma_t.y);
        MediumRecipe recipe;
        recipe.kind = c.kind;
        recipe.filter = c.filter;
        recipe.sigma_t = sigma_t;
        recipe.majorant_scale = c.majorant_scale;
        recipe.estimators.free_flight = c.flight;
        // Marches so fine that their bias, of the order of step^3, is far below the standard errors.
        recipe.estimators.settings.march = {0.05, 0.05, 0.05, true, CoefficientUnit::world};
        recipe.grid.linear = skewed;
        const TestMedium medium(recipe);
        REQUIRE(medium.scene().chromatic);
        const auto flights = medium.fly(medium.flights_along(medium.ray(), 20000, 1, beta));
        check_bins(medium, medium.ray(), flights, beta, sidak(1e-3, 2 * 11 * 3 * (bin_count + 1)));
    }
}
