// Every free flight, in every kind of medium it can cross, follows the exact distribution 1 - exp(-tau(t)): grey media.
// Those of weight 1 are judged as in free_flight_test.cpp; regular tracking, which draws nothing beyond its one
// exponential, is checked flight by flight. Marches are biased: by how much, and how that shrinks, is checked.
// Significance 1e-3 for each test case (Sidak), fixed seeds.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "support/numbers.h"
#include "support/statistics.h"
#include "support/test_medium.h"
#include "tests/reference/quadrature.h"

using namespace vkvol;
using shared::FlightOutput;
using shared::RayInput;
using test_numbers::collided;
using test_numbers::left;
using test_numbers::u;

namespace {

// The most comparisons that a test case here makes, over all that it generates.
constexpr double significance_of(double comparisons) {
    return 1e-3 / comparisons; // Sidak's, to first order and below it
}

// tau(t) of collisions is exponential, cut off at that of the whole ray; escapes are as many as e^-tau says.
void check_flights(const TestMedium& medium, const reference::Ray& ray, const std::vector<FlightOutput>& flights,
                   double significance) {
    const double S = medium.reference().largest(), T = std::exp(-S * medium.density_integral(ray));
    REQUIRE(T > 0.02);
    REQUIRE(T < 0.98);
    const std::vector<double> D = medium.depths(ray, flights);
    std::vector<double> uniforms;
    int escaped = 0, wrong = 0;
    for (std::size_t i = 0; i < flights.size(); ++i) {
        wrong += flights[i].event != collided && flights[i].event != left ? 1 : 0;
        if (flights[i].event == left)
            ++escaped;
        else
            uniforms.push_back(-std::expm1(-S * D[i]) / (1.0 - T));
    }
    REQUIRE(wrong == 0);
    const double n = double(flights.size()), z = (escaped - n * T) / std::sqrt(n * T * (1.0 - T));
    CAPTURE(T, escaped / n);
    CHECK(normal_p(z) > significance);
    CHECK(kolmogorov_smirnov_p(uniforms) > significance);
}

MediumRecipe flight_recipe(MediumKind kind, int free_flight, Filter filter, double majorant_scale) {
    MediumRecipe recipe;
    recipe.kind = kind;
    recipe.filter = filter;
    recipe.majorant_scale = majorant_scale;
    recipe.estimators.free_flight = free_flight;
    recipe.sigma_t = Rgb(kind == MediumKind::grid ? 1.3 : 0.6);
    recipe.grid.linear = skewed; // turned, sheared, mirrored
    recipe.grid.translation = {100.0, -20.0, 3.0};
    return recipe;
}

} // namespace

TEST_CASE("unbiased flights follow the optical depth in every medium", "[gpu][free_flight][long]") {
    struct Case {
        MediumKind kind;
        Filter filter;
        double majorant_scale;
        bool is_mapped = false;
    };
    const std::vector<Case> cases = {
        {MediumKind::grid, Filter::trilinear, 1.0},         {MediumKind::grid, Filter::trilinear, 2.0},
        {MediumKind::grid, Filter::trilinear, 8.0},         {MediumKind::grid, Filter::stochastic, 1.0},
        {MediumKind::grid, Filter::stochastic, 8.0},        {MediumKind::grid, Filter::nearest, 2.0},
        {MediumKind::noise_sphere, Filter::trilinear, 1.0}, {MediumKind::noise_sphere, Filter::trilinear, 8.0},
        {MediumKind::sphere, Filter::trilinear, 2.0},       {MediumKind::cubes, Filter::trilinear, 1.0},
        {MediumKind::cubes, Filter::trilinear, 8.0},        {MediumKind::noise_cubes, Filter::trilinear, 2.0},
        {MediumKind::grid, Filter::trilinear, 1.0, true},   {MediumKind::grid, Filter::nearest, 2.0, true}};
    const int flight = GENERATE(FREE_FLIGHT_ANALYTIC, FREE_FLIGHT_REGULAR, FREE_FLIGHT_DELTA, FREE_FLIGHT_WEIGHTED,
                                FREE_FLIGHT_DECOMPOSITION, FREE_FLIGHT_SPECTRAL);
    for (const Case& c : cases) {
        MediumRecipe recipe = flight_recipe(c.kind, flight, c.filter, c.majorant_scale);
        recipe.is_mapped = c.is_mapped;
        // Those without majorants need not be seen with several.
        if (!flies(flight, recipe) || (!is_null_flight(flight) && c.majorant_scale > 2.0))
            continue;
        CAPTURE(flight, int(c.kind), int(c.filter), c.majorant_scale, c.is_mapped);
        const TestMedium medium(recipe);
        const reference::Ray ray = medium.ray();
        const auto flights = medium.fly(medium.flights_along(ray, 10000, 1));
        check_flights(medium, ray, flights, significance_of(6 * 14 * 2));
        // Majorants that bound leave weights of 1, but for the roundings of each tentative collision's factor: of
        // sigma_n, the sum, a probability and its complement, two products and two quotients, each at most u, some
        // of them seen twice.
        double worst = 0.0;
        for (const FlightOutput& f : flights)
            worsen(worst, std::abs(f.weight.x - 1.0) / (16.0 * u * (f.nulls + 1.0)));
        CHECK(worst <= (is_null_flight(flight) ? 1.0 : 0.0));
    }
}

// With the exponential E that a flight was given, S D(t) = E, to rounding. Of the lengths in play the largest is R, a
// coordinate in index space: positions there take at most 8 roundings each, and displace the density by as many times
// its slope, at most rho_max per voxel along each axis. The polynomial's coefficients are sums of up to 36 f, its
// integral and the density take a dozen roundings more, and bisection ends at 2^-23 = 2 u of the voxel: 64 u rho_max in
// all. Nearest densities do not change with position, but their steps lie where they do, with rho_max on either side.
// E, its sums and the quotient by S: 8 u E.
TEST_CASE("regular tracking collides where the optical depth is the sampled one", "[gpu][free_flight]") {
    const Filter filter = GENERATE(Filter::trilinear, Filter::nearest);
    const double sigma_t = GENERATE(1.0, 8.0);
    MediumRecipe recipe = flight_recipe(MediumKind::grid, FREE_FLIGHT_REGULAR, filter, 1.0);
    recipe.sigma_t = Rgb(sigma_t);
    recipe.grid.translation = glm::dvec3(0.0);
    const TestMedium medium(recipe);
    const auto rays = medium.random_rays(8, 5, 0.1, 10.0);
    double worst = 0.0;
    for (const reference::Ray& ray : rays) {
        const auto inputs = medium.flights_along(ray, 1250, 2);
        const auto flights = medium.fly(inputs);
        const auto D = medium.depths(ray, flights);
        const double D_end = medium.density_integral(ray), rho_max = 2.0;
        const reference::Ray in_index = medium.reference().grid()->to_index(ray);
        const double R = std::max(13.0, glm::length(in_index.origin));
        const double voxels_per_unit = glm::length(in_index.direction);
        const double length = reference::support(medium.reference(), ray).front().length();
        for (std::size_t i = 0; i < flights.size(); ++i) {
            const double E = inputs[i].e;
            const double displaced = 3.0 * 8.0 * u * R * rho_max * (length + 2.0 / voxels_per_unit);
            const double tolerance = sigma_t * (displaced + 64.0 * u * rho_max * length) + 8.0 * u * E;
            const bool escapes = flights[i].event == left;
            REQUIRE((escapes || flights[i].event == collided));
            REQUIRE(flights[i].weight.x == 1.0f);
            const double error = escapes ? std::max(sigma_t * D_end - E, 0.0) : std::abs(sigma_t * D[i] - E);
            worsen(worst, error / tolerance);
        }
    }
    CAPTURE(worst);
    CHECK(worst <= 1.0);
    CHECK(worst > 1e-4); // the bound is not idle
}

TEST_CASE("decomposition tracking flies delta tracking's paths with fewer lookups", "[gpu][free_flight]") {
    const Filter filter = GENERATE(Filter::trilinear, Filter::stochastic, Filter::nearest);
    const double scale = GENERATE(1.0, 2.0);
    const auto fly = [&](int flight, double& lookups) {
        MediumRecipe recipe = flight_recipe(MediumKind::grid, flight, filter, scale);
        recipe.grid.first = glm::ivec3(-3); // cells amid it have a least density of 0.4 or more
        recipe.grid.last = glm::ivec3(18);
        recipe.grid.cell = 4;
        recipe.grid.value = [](glm::ivec3 i) { return static_cast<float>(0.4 + voxel_noise(i, 3)); };
        recipe.sigma_t = Rgb(0.4);
        const TestMedium medium(recipe);
        const auto flights = medium.fly(medium.flights_along(medium.ray(), 20000, 3));
        for (const FlightOutput& f : flights)
            lookups += f.lookups;
        return flights;
    };
    double lookups = 0.0, fewer = 0.0;
    const auto delta = fly(FREE_FLIGHT_DELTA, lookups), decomposition = fly(FREE_FLIGHT_DECOMPOSITION, fewer);
    int different = 0;
    for (std::size_t i = 0; i < delta.size(); ++i)
        different += delta[i].event != decomposition[i].event || delta[i].nulls != decomposition[i].nulls ||
                             std::memcmp(&delta[i].t, &decomposition[i].t, sizeof(float)) != 0
                         ? 1
                         : 0;
    CHECK(different == 0);
    CAPTURE(lookups, fewer);
    CHECK(fewer < 0.95 * lookups); // a fifth of the tentative collisions or more are certain where the ray is inside
}

namespace {

// Root mean square over rays of what the escape probability is off by. Without jitter a ray's optical depth is the same
// for every flight, so with equidistant u the share of escapes is exact to 1 / count.
double escape_error(int flight, MediumKind kind, double step) {
    MediumRecipe recipe = flight_recipe(kind, flight, Filter::trilinear, 1.0);
    recipe.estimators.settings.march = {step, step, 1.5 * step, false, CoefficientUnit::world};
    recipe.sigma_t = Rgb(1.5);
    recipe.noise = {1.5, 1, 0.5, 2.0}; // smooth over the longest step
    const TestMedium medium(recipe);
    const auto rays = medium.random_rays(40, 6, 0.2, 1.5);
    const int count = 16384;
    std::vector<RayInput> inputs;
    for (const reference::Ray& ray : rays) {
        auto some = medium.flights_along(ray, count, 1);
        for (int i = 0; i < count; ++i)
            some[i].e = -std::log1p(-(i + 0.5f) / count);
        inputs.insert(inputs.end(), some.begin(), some.end());
    }
    const auto flights = medium.fly(inputs);
    double squares = 0.0;
    for (std::size_t r = 0; r < rays.size(); ++r) {
        double escaped = 0.0;
        for (int i = 0; i < count; ++i)
            escaped += flights[r * count + i].event == left ? 1.0 / count : 0.0;
        const double error = escaped - std::exp(-1.5 * medium.density_integral(rays[r]));
        squares += error * error / double(rays.size());
    }
    return std::sqrt(squares);
}

} // namespace

// The midpoint rule is of order 2 where the density is smooth: halving the step divides errors by 4, up to terms of the
// next order, which are a quarter as large with each halving; 2.8 to 5.7 is an order of 2 within a half.
TEST_CASE("marches converge with the square of their step", "[gpu][free_flight][long]") {
    const int flight = GENERATE(FREE_FLIGHT_MARCH, FREE_FLIGHT_ADAPTIVE);
    const double first = escape_error(flight, MediumKind::noise_sphere, 0.4);
    const double second = escape_error(flight, MediumKind::noise_sphere, 0.2);
    const double third = escape_error(flight, MediumKind::noise_sphere, 0.1);
    CAPTURE(flight, first, second, third);
    CHECK(third > 5.0 / std::sqrt(12.0) / 16384.0); // a bias, not the share's graininess
    CHECK(first / second > 2.8);
    CHECK(first / second < 5.7);
    CHECK(second / third > 2.8);
    CHECK(second / third < 5.7);
}

// With jitter the optical depth of a step has the right mean, and a variance of the order of step^4. With steps so
// short no bias shows: along 10 units a density that changes by 2 per voxel of 0.5 units makes e^(variance / 2) - 1 <
// 1e-6.
TEST_CASE("marches with tiny steps are as good as unbiased", "[gpu][free_flight][long]") {
    const int flight = GENERATE(FREE_FLIGHT_MARCH, FREE_FLIGHT_ADAPTIVE);
    const MediumKind kind =
        GENERATE(MediumKind::grid, MediumKind::noise_sphere, MediumKind::cubes, MediumKind::noise_cubes);
    CAPTURE(flight, int(kind));
    MediumRecipe recipe = flight_recipe(kind, flight, Filter::trilinear, 1.0);
    recipe.estimators.settings.march = {0.01, 0.01, 0.02, true, CoefficientUnit::world};
    const TestMedium medium(recipe);
    check_flights(medium, medium.ray(), medium.fly(medium.flights_along(medium.ray(), 10000, 7)),
                  significance_of(2 * 4 * 2));
}

TEST_CASE("leaps over empty cells change no flight and no shadow", "[gpu][free_flight][long]") {
    const int flight = GENERATE(FREE_FLIGHT_ADAPTIVE, FREE_FLIGHT_DELTA, FREE_FLIGHT_WEIGHTED,
                                FREE_FLIGHT_DECOMPOSITION, FREE_FLIGHT_SPECTRAL);
    CAPTURE(flight);
    MediumRecipe recipe = flight_recipe(MediumKind::grid, flight, Filter::trilinear, 1.0);
    const auto [linear, translation] = std::pair(recipe.grid.linear, recipe.grid.translation);
    recipe.grid = sparse_recipe();
    recipe.grid.linear = linear;
    recipe.grid.translation = translation;
    recipe.estimators.transmittance = flight == FREE_FLIGHT_DELTA ? TRANSMITTANCE_DELTA : TRANSMITTANCE_RATIO;
    recipe.leaps = false;
    const TestMedium steps(recipe);
    recipe.leaps = true;
    const TestMedium leaps(recipe);
    const std::vector<reference::Ray> rays = steps.random_rays(2000, 3, 0.05, 20.0);
    std::vector<RayInput> inputs;
    for (std::size_t i = 0; i < rays.size(); ++i)
        inputs.push_back(steps.flights_along(rays[i], 1, static_cast<std::uint32_t>(i)).front());
    const std::vector<FlightOutput> a = steps.fly(inputs), b = leaps.fly(inputs);
    const std::vector<FlightOutput> T = steps.see(rays, 1, 4), shadow = leaps.see(rays, 1, 4);
    double steps_taken = 0.0, leaps_taken = 0.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        REQUIRE(a[i].event == b[i].event);
        REQUIRE(a[i].lookups == b[i].lookups);
        REQUIRE(std::abs(a[i].t - b[i].t) < 1e-3f); // world units, of a hundred; rounding at edges
        REQUIRE(glm::length(a[i].weight - b[i].weight) < 1e-3f);
        REQUIRE(glm::length(T[i].weight - shadow[i].weight) < 1e-3f);
        steps_taken += a[i].steps + T[i].steps;
        leaps_taken += b[i].steps + shadow[i].steps;
    }
    CHECK(leaps_taken < 0.7 * steps_taken);
}
