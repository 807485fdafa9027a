// Every transmittance estimator, in every kind of medium it can cross: the unbiased ones have the exact mean, in each
// colour channel; regular tracking is exact; marches err as they should. Significance 1e-3 for each test case (Sidak),
// fixed seeds.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "support/numbers.h"
#include "support/statistics.h"
#include "support/test_medium.h"
#include "tests/reference/quadrature.h"

using namespace vkvol;
using shared::FlightOutput;
using test_numbers::left;
using test_numbers::u;

namespace {

// Telescoping may ask for more steps than a test allows, in at most one of 2^13 estimates even of a short ray. Such
// estimates are left out: what is left are those with refinements below some J, whose mean is the T of a march with 2^J
// times as many steps, off by less than 2^-2J.
std::vector<RgbMean> estimate(const TestMedium& medium, const std::vector<reference::Ray>& rays, std::uint32_t count,
                              bool telescoping) {
    std::vector<RgbMean> means(rays.size());
    const auto outputs = medium.see(rays, count, 10);
    double cut = 0.0;
    for (std::size_t i = 0; i < outputs.size(); ++i)
        if (outputs[i].event == left)
            means[i / count].add(outputs[i].weight);
        else
            cut += 1.0;
    REQUIRE(cut <= (telescoping ? 10.0 + outputs.size() / 8192.0 : 0.0));
    return means;
}

// Each ray by itself, and all together for a bias too small for any one ray. `comparisons`: of the whole test case.
void check_means(const TestMedium& medium, const std::vector<reference::Ray>& rays, const std::vector<RgbMean>& means,
                 int channels, double comparisons) {
    const double significance = sidak(1e-3, comparisons * channels * (double(rays.size()) + 1.0));
    for (int c = 0; c < channels; ++c) {
        double difference = 0.0, variance = 0.0, worst = 1.0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const double T = std::exp(-medium.reference().sigma_t[c] * medium.density_integral(rays[i]));
            const RunningMean& mean = means[i].channel[c];
            worst = std::min(worst, t_test_p(mean, T, 1e-5 * T)); // products of a few dozen single-precision factors
            difference += mean.mean() - T;
            variance += mean.standard_error() * mean.standard_error();
        }
        CAPTURE(c, difference / rays.size(), std::sqrt(variance) / rays.size());
        CHECK(worst > significance);
        if (variance > 0.0) // else, in a channel of no extinction, every mean was 1
            CHECK((std::abs(difference) < 1e-5 * rays.size() ||
                   normal_p(difference / std::sqrt(variance)) > significance));
    }
}

MediumRecipe transmittance_recipe(MediumKind kind, int transmittance, Filter filter, double majorant_scale) {
    MediumRecipe recipe;
    recipe.kind = kind;
    recipe.filter = filter;
    recipe.majorant_scale = majorant_scale;
    recipe.estimators.transmittance = transmittance;
    recipe.estimators.settings.march = {1.0, 1.0, 0.1, true, CoefficientUnit::world};
    recipe.grid.linear = skewed;
    return recipe;
}

struct Case {
    MediumKind kind;
    Filter filter;
    double majorant_scale;
    bool is_mapped = false;
};

// Limits to the rays' density integrals, at extinction 1: T of 0.1 to 0.9. Below, roulette leaves too few estimates
// other than 0 for a t-test; above, the few that are not 1 are no normal sample either.
constexpr double least = 0.11, most = 2.3;

} // namespace

TEST_CASE("unbiased transmittance has the mean of the quadrature in every medium", "[gpu][transmittance]") {
    const std::vector<Case> cases = {
        {MediumKind::grid, Filter::trilinear, 1.0},         {MediumKind::grid, Filter::trilinear, 2.0},
        {MediumKind::grid, Filter::trilinear, 8.0},         {MediumKind::grid, Filter::stochastic, 1.0},
        {MediumKind::grid, Filter::nearest, 2.0},           {MediumKind::noise_sphere, Filter::trilinear, 1.0},
        {MediumKind::noise_sphere, Filter::trilinear, 8.0}, {MediumKind::cubes, Filter::trilinear, 2.0},
        {MediumKind::noise_cubes, Filter::trilinear, 1.0},  {MediumKind::grid, Filter::trilinear, 1.0, true},
        {MediumKind::grid, Filter::nearest, 2.0, true}};
    const int estimator = GENERATE(TRANSMITTANCE_REGULAR, TRANSMITTANCE_DELTA, TRANSMITTANCE_RATIO,
                                   TRANSMITTANCE_RESIDUAL, TRANSMITTANCE_TELESCOPING);
    for (const Case& c : cases) {
        MediumRecipe recipe = transmittance_recipe(c.kind, estimator, c.filter, c.majorant_scale);
        recipe.is_mapped = c.is_mapped;
        if (!sees(estimator, recipe) || (!is_null_transmittance(estimator) && c.majorant_scale > 2.0))
            continue;
        CAPTURE(estimator, int(c.kind), int(c.filter), c.majorant_scale, c.is_mapped);
        const TestMedium medium(recipe);
        const auto rays = medium.random_rays(50, 1, least, most);
        const auto means =
            estimate(medium, rays, c.majorant_scale > 1.0 ? 300 : 1000, estimator == TRANSMITTANCE_TELESCOPING);
        check_means(medium, rays, means, 1, 5 * 11);
    }
}

TEST_CASE("chromatic transmittance has the mean of the quadrature in every channel", "[gpu][transmittance][long]") {
    const Rgb sigma_t = GENERATE(Rgb(0.3, 0.6, 1.0), Rgb(1.0, 0.0, 0.5));
    const int estimator =
        GENERATE(TRANSMITTANCE_ANALYTIC, TRANSMITTANCE_REGULAR, TRANSMITTANCE_MARCH, TRANSMITTANCE_DELTA,
                 TRANSMITTANCE_RATIO, TRANSMITTANCE_RESIDUAL, TRANSMITTANCE_TELESCOPING);
    for (const MediumKind kind : {MediumKind::grid, MediumKind::noise_sphere, MediumKind::cubes}) {
        MediumRecipe recipe = transmittance_recipe(kind, estimator, Filter::trilinear, 1.0);
        recipe.sigma_t = sigma_t;
        if (estimator == TRANSMITTANCE_MARCH) // so fine that the bias is below 1e-5: see the order below
            recipe.estimators.settings.march.shadow_step = 0.02;
        if (!sees(estimator, recipe))
            continue;
        CAPTURE(estimator, int(kind), sigma_t.y);
        const TestMedium medium(recipe);
        REQUIRE(medium.scene().chromatic);
        const bool exact = estimator == TRANSMITTANCE_ANALYTIC || estimator == TRANSMITTANCE_REGULAR;
        const auto rays = medium.random_rays(25, 2, least, most);
        const int count = exact ? 2 : estimator == TRANSMITTANCE_MARCH ? 100 : 1000;
        const auto means = estimate(medium, rays, count, estimator == TRANSMITTANCE_TELESCOPING);
        check_means(medium, rays, means, 3, 2 * 7 * 3);
    }
}

TEST_CASE("ratio and residual estimates bear majorants that do not bound", "[gpu][transmittance][hard]") {
    const int estimator = GENERATE(TRANSMITTANCE_DELTA, TRANSMITTANCE_RATIO, TRANSMITTANCE_RESIDUAL);
    const MediumKind kind = GENERATE(MediumKind::grid, MediumKind::noise_sphere);
    CAPTURE(estimator, int(kind));
    // Delta loses what exceeds; at half the majorants that is little in this grid.
    const double scale = estimator == TRANSMITTANCE_DELTA ? 0.2 : 0.5;
    const TestMedium medium(transmittance_recipe(kind, estimator, Filter::trilinear, scale));
    const auto rays = medium.random_rays(100, 3, 0.3, 1.5);
    shared::Counters counters{};
    medium.see(rays, 100, 1, &counters);
    CHECK(counters.majorant_violations > 0u);
    const auto means = estimate(medium, rays, 1000, false);
    if (estimator != TRANSMITTANCE_DELTA)
        return check_means(medium, rays, means, 1, 2 * 2);
    double difference = 0.0, variance = 0.0; // what exceeds the majorants is lost
    for (std::size_t i = 0; i < rays.size(); ++i) {
        difference += means[i].channel[0].mean() - std::exp(-medium.density_integral(rays[i]));
        variance += means[i].channel[0].standard_error() * means[i].channel[0].standard_error();
    }
    CHECK(difference > 10.0 * std::sqrt(variance));
}

// The roundings of tau are those derived in flight_estimators_test.cpp; exp adds 3 + 2 tau ulp (Vulkan's bound), and
// the product that is its argument another 2 u tau.
TEST_CASE("regular transmittance is exact to rounding", "[gpu][transmittance]") {
    const Filter filter = GENERATE(Filter::trilinear, Filter::nearest);
    const double sigma_t = 1.5, rho_max = 2.0;
    MediumRecipe recipe = transmittance_recipe(MediumKind::grid, TRANSMITTANCE_REGULAR, filter, 1.0);
    recipe.sigma_t = Rgb(sigma_t);
    const TestMedium medium(recipe);
    const auto rays = medium.random_rays(1000, 4, 0.0, 20.0);
    const auto outputs = medium.see(rays, 1, 1);
    double worst = 0.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        REQUIRE(outputs[i].event == left);
        const auto parts = reference::support(medium.reference(), rays[i]);
        const reference::Ray in_index = medium.reference().grid()->to_index(rays[i]);
        const double R = std::max(13.0, glm::length(in_index.origin)), length = parts.empty() ? 0 : parts[0].length();
        const double displaced = 3.0 * 8.0 * u * R * rho_max * (length + 2.0 / glm::length(in_index.direction));
        const double tau = sigma_t * medium.density_integral(rays[i]);
        const double tau_error = sigma_t * (displaced + 64.0 * u * rho_max * length);
        const double tolerance = std::exp(-tau) * (tau_error + (6.0 + 6.0 * tau) * u);
        worsen(worst, std::abs(outputs[i].weight.x - std::exp(-tau)) / tolerance);
    }
    CAPTURE(worst);
    CHECK(worst <= 1.0);
    CHECK(worst > 1e-4); // the bound is not idle
}

namespace {

MediumRecipe march_recipe(double step, bool jitter) {
    MediumRecipe recipe = transmittance_recipe(MediumKind::noise_sphere, TRANSMITTANCE_MARCH, Filter::trilinear, 1.0);
    recipe.estimators.settings.march = {step, step, 0.1, jitter, CoefficientUnit::world};
    recipe.noise = {1.0, 1, 0.5, 2.0}; // smooth over the longest step
    recipe.sigma_t = Rgb(2.0);
    return recipe;
}

// The mean of a march: sample points are independent and uniform in their steps, so it is the product over steps of the
// mean of exp(-sigma_t rho h), here by the midpoint rule with 100 points each. Without jitter each has but one.
double march_mean(const TestMedium& medium, const reference::Ray& ray, double step, int points) {
    const reference::Interval inside = reference::support(medium.reference(), ray).front();
    const reference::DensityAlong density(medium.reference(), ray);
    const int n = std::max(1, int(std::ceil(inside.length() / step)));
    const double h = inside.length() / n;
    double product = 1.0;
    for (int k = 0; k < n; ++k) {
        double sum = 0.0;
        for (int i = 0; i < points; ++i)
            sum += std::exp(-medium.reference().largest() * h * density(inside.t0 + (k + (i + 0.5) / points) * h));
        product *= sum / points;
    }
    return product;
}

} // namespace

// Without jitter a march is the midpoint rule, of order 2. With it the optical depth has the right mean, and per step
// of length h a variance of sigma_t^2 h^2 (rho' h)^2 / 12, of which there are 1 / h: exp makes half their sum a bias
// (Jensen), upward, of order 3. Halved steps divide such biases by 4 and by 8; within a factor of sqrt(2), since
// lengths are no multiples of a step.
TEST_CASE("marched transmittance has the bias of its order", "[gpu][transmittance]") {
    const bool jitter = GENERATE(false, true);
    CAPTURE(jitter);
    double before = 0.0;
    for (const double step : {0.4, 0.2, 0.1}) {
        const TestMedium medium(march_recipe(step, jitter));
        const auto rays = medium.random_rays(100, 5, 0.3, 1.5);
        const auto means = estimate(medium, rays, jitter ? 1500 : 2, false);
        double difference = 0.0, variance = 0.0, squares = 0.0, bias = 0.0, worst = 0.0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const double T = std::exp(-2.0 * medium.density_integral(rays[i]));
            const double expected = march_mean(medium, rays[i], step, jitter ? 100 : 1);
            const RunningMean& mean = means[i].channel[0];
            worsen(worst, std::abs(mean.mean() - expected));
            difference += mean.mean() - expected;
            variance += mean.standard_error() * mean.standard_error();
            bias += expected - T;
            squares += (expected - T) * (expected - T);
        }
        CAPTURE(step, worst, difference, std::sqrt(variance), bias);
        if (jitter)
            CHECK(normal_p(difference / std::sqrt(variance)) > sidak(1e-3, 3));
        else
            CHECK(worst < 2e-5); // 34 roundings of 2 u at positions up to 5, a slope up to 9, times sigma_t
        const double size = jitter ? bias : std::sqrt(squares), ratio = before / size, order = jitter ? 8.0 : 4.0;
        CAPTURE(size, ratio);
        CHECK(size > 0.0);
        if (before > 0.0) {
            CHECK(ratio > order / std::sqrt(2.0));
            CHECK(ratio < order * std::sqrt(2.0));
        } else if (jitter) {
            CHECK(bias > 10.0 * std::sqrt(variance)); // the first shows
        }
        before = size;
    }
}

// Whatever the refinement: where it is 10 the difference of the two marches is multiplied by 5e4, so that two sums
// which are rounded by 1e-6 would be off by more than what they are to tell. The bound is of the coarsest march, of a
// few hundred steps that are each rounded by u.
TEST_CASE("telescoping knows a constant density by each estimate", "[gpu][transmittance]") {
    MediumRecipe recipe = transmittance_recipe(MediumKind::sphere, TRANSMITTANCE_TELESCOPING, Filter::trilinear, 1.0);
    recipe.estimators.settings.march.shadow_step = 0.05;
    const TestMedium medium(recipe);
    const auto rays = medium.random_rays(4, 7, least, most);
    constexpr std::uint32_t count = 50000;
    const auto outputs = medium.see(rays, count, 10);
    double worst = 0.0;
    std::uint32_t longest = 0;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        if (outputs[i].event != left)
            continue;
        const double T = std::exp(-medium.density_integral(rays[i / count]));
        worsen(worst, std::abs(outputs[i].weight.x / T - 1.0));
        longest = std::max(longest, outputs[i].steps);
    }
    CHECK(longest > 256 * 20);
    CHECK(worst < 500 * u);
}

TEST_CASE("telescoping begins anywhere and has the same mean", "[gpu][transmittance]") {
    const double step = GENERATE(0.3, 1.0, 100.0); // the last: one step per part, the largest bias to take away
    const MediumKind kind = GENERATE(MediumKind::grid, MediumKind::noise_cubes);
    CAPTURE(step, int(kind));
    MediumRecipe recipe = transmittance_recipe(kind, TRANSMITTANCE_TELESCOPING, Filter::trilinear, 1.0);
    recipe.estimators.settings.march.shadow_step = step;
    const TestMedium medium(recipe);
    const auto rays = medium.random_rays(80, 6, least, most);
    check_means(medium, rays, estimate(medium, rays, 1000, true), 1, 3 * 2);
}
