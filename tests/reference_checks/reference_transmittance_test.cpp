// The scalar reference: every estimator of the transmittance against the quadrature.
#include <catch2/catch.hpp>

#include <vector>

#include "tests/reference/test_media.h"

using namespace reference;
using vkvol::Rgb;

namespace {

RgbMean estimate(const Sample& sample, int estimator, int count, std::uint32_t seed) {
    RgbMean mean;
    Rng rng = stream(seed);
    for (int i = 0; i < count; ++i)
        mean.add(estimate_transmittance(sample.medium, estimator, sample.ray, sample.march, rng));
    return mean;
}

// What a march of n steps, jittered or not, has as its mean: steps are independent, so the product of theirs.
Rgb march_mean(const Sample& sample, int n, bool jitter) {
    constexpr int points = 1000; // midpoints per step: the density is smooth, and the error far below the bias
    const DensityAlong density(sample.medium, sample.ray);
    Rgb product(1.0);
    for (const Interval& interval : support(sample.medium, sample.ray)) {
        const double length = interval.length() / n;
        for (int k = 0; k < n; ++k) {
            Rgb mean(0.0);
            for (int i = 0; i < points && jitter; ++i) {
                const double t = interval.t0 + (k + (i + 0.5) / points) * length;
                mean += glm::exp(-sample.medium.sigma_t * density(t) * length) / double(points);
            }
            product *=
                jitter ? mean : glm::exp(-sample.medium.sigma_t * density(interval.t0 + (k + 0.5) * length) * length);
        }
    }
    return product;
}

vkvol::March steps(const Sample& sample, int n, bool jitter) {
    vkvol::March march = sample.march;
    // A little longer than the n-th part, lest rounding makes it n + 1.
    march.step = march.shadow_step = support(sample.medium, sample.ray).front().length() / n * (1.0 + 1e-9);
    march.jitter = jitter;
    return march;
}

} // namespace

TEST_CASE("tracking estimates the transmittance without bias", "[cpu][reference]") {
    const Kind kind = GENERATE(Kind::rough_grid, Kind::chromatic_grid, Kind::noise_sphere, Kind::chromatic_noise,
                               Kind::noise_mesh, Kind::box, Kind::chromatic_box);
    const double scale = GENERATE(0.5, 1.0, 2.0);
    CAPTURE(int(kind), scale);
    const Sample sample = make_sample(kind, scale);
    const Rgb T = chromatic_transmittance(sample.medium, sample.ray);
    REQUIRE(T.x > 0.05);
    REQUIRE(T.x < 0.95);
    for (const int estimator : {TRANSMITTANCE_DELTA, TRANSMITTANCE_RATIO, TRANSMITTANCE_RESIDUAL}) {
        // Below the density a majorant makes weights negative, which delta tracking does not have.
        if (estimator == TRANSMITTANCE_DELTA && scale < 1.0)
            continue;
        CAPTURE(estimator);
        CHECK(estimate(sample, estimator, 10000, 101).z(T) < 4.0);
    }
}

TEST_CASE("neither majorant cells nor the filter change the transmittance", "[cpu][reference]") {
    const int cell = GENERATE(as<int>{}, one_cell, 1, 2, 8);
    const auto filter = GENERATE(vkvol::Filter::trilinear, vkvol::Filter::nearest);
    const double dense = GENERATE(0.5, 1.5); // the latter with much roulette
    CAPTURE(cell, int(filter), dense);
    Sample sample = make_sample(Kind::chromatic_grid);
    sample.medium.sigma_t *= dense;
    sample.medium.filter = filter;
    build_majorants(std::get<Grid>(sample.medium.shape), cell);
    const Rgb T = chromatic_transmittance(sample.medium, sample.ray);
    REQUIRE(std::min({T.x, T.y, T.z}) > 0.01); // enough estimates other than 0
    for (const int estimator :
         {TRANSMITTANCE_DELTA, TRANSMITTANCE_RATIO, TRANSMITTANCE_RESIDUAL, TRANSMITTANCE_TELESCOPING}) {
        CAPTURE(estimator);
        CHECK(estimate(sample, estimator, 10000, 137).z(T) < 4.0);
    }
}

TEST_CASE("telescoping estimates the transmittance without bias", "[cpu][reference]") {
    const Kind kind = GENERATE(Kind::rough_grid, Kind::chromatic_grid, Kind::noise_sphere, Kind::chromatic_noise,
                               Kind::noise_mesh, Kind::box);
    const int n = GENERATE(1, 5); // steps of the base
    CAPTURE(int(kind), n);
    Sample sample = make_sample(kind);
    sample.march = steps(sample, n, true);
    const Rgb T = chromatic_transmittance(sample.medium, sample.ray);
    const RgbMean mean = estimate(sample, TRANSMITTANCE_TELESCOPING, 20000, 103);
    CHECK(mean.z(T) < 4.0);
    // The correction matters: the march alone would be seen to be biased, but where it is exact.
    if (kind == Kind::rough_grid && n == 1)
        CHECK(std::abs(march_mean(sample, n, true).x - T.x) > 8.0 * mean.channel[0].standard_error());
    if (kind == Kind::box)
        CHECK(mean.channel[0].standard_error() < 1e-12);
}

TEST_CASE("the jackknife removes most of a march's bias", "[cpu][reference]") {
    Sample sample = make_sample(Kind::rough_grid);
    sample.march = steps(sample, 4, true);
    const Rgb T = chromatic_transmittance(sample.medium, sample.ray);
    const RgbMean mean = estimate(sample, TRANSMITTANCE_JACKKNIFE, 40000, 109);
    const double bias = march_mean(sample, 4, true).x - T.x;
    REQUIRE(bias > 8.0 * mean.channel[0].standard_error()); // Jensen: too bright
    CHECK(std::abs(mean.channel[0].mean() - T.x) < 0.25 * bias + 4.0 * mean.channel[0].standard_error());
}

TEST_CASE("regular and analytic transmittance are exact", "[cpu][reference]") {
    const Kind kind = GENERATE(Kind::rough_grid, Kind::chromatic_grid, Kind::box, Kind::chromatic_box);
    const Sample sample = make_sample(kind);
    const int estimator = is_grid(kind) ? TRANSMITTANCE_REGULAR : TRANSMITTANCE_ANALYTIC;
    Rng rng = stream(107);
    const Rgb T = estimate_transmittance(sample.medium, estimator, sample.ray, sample.march, rng);
    CHECK(rng.draw == (is_grid(kind) ? 1u : 0u));
    // An independent way: the mean of a march of tiny steps, whose error falls with their square.
    Sample fine = sample;
    fine.march = steps(fine, 100000, false);
    const Rgb expected = march_transmittance(fine.medium, fine.ray, fine.march, rng);
    for (int i = 0; i < 3; ++i)
        CHECK(T[i] == Approx(expected[i]).epsilon(1e-7));
}

TEST_CASE("a march errs by the square of its step, jittered by the cube", "[cpu][reference]") {
    Sample sample = make_sample(GENERATE(Kind::noise_sphere, Kind::chromatic_noise));
    const Rgb T = chromatic_transmittance(sample.medium, sample.ray);
    for (const bool jitter : {false, true}) {
        CAPTURE(jitter);
        std::vector<double> errors;
        // Unjittered errors have either sign and cancel before the steps are much shorter than the noise's waves.
        for (const int n : jitter ? std::vector{32, 64, 128} : std::vector{1024, 2048, 4096}) {
            sample.march = steps(sample, n, jitter);
            const Rgb mean = march_mean(sample, n, jitter);
            if (!jitter) {
                Rng rng = stream(109);
                const Rgb once = march_transmittance(sample.medium, sample.ray, sample.march, rng);
                CHECK(rng.draw == std::uint32_t(n));
                CHECK(once.x == Approx(mean.x).epsilon(1e-8)); // up to the step's 1e-9
            }
            errors.push_back(mean.x - T.x);
        }
        // Twice the steps: a quarter or an eighth of the error, but for the next order's share.
        const double order = jitter ? 8.0 : 4.0;
        CHECK(errors[0] / errors[1] == Approx(order).epsilon(0.15));
        CHECK(errors[1] / errors[2] == Approx(order).epsilon(0.1));
    }
    for (const int n : {1, 3}) { // where the bias shows
        CAPTURE(n);
        sample.march = steps(sample, n, true);
        const Rgb expected = march_mean(sample, n, true);
        const RgbMean mean = estimate(sample, TRANSMITTANCE_MARCH, 20000, 113);
        CHECK(mean.z(expected) < 4.0);
        if (n == 1)
            CHECK(mean.z(T) > 4.0);
    }
}

TEST_CASE("residual tracking needs no collisions where the density is constant", "[cpu][reference]") {
    const Sample sample = make_sample(GENERATE(Kind::box, Kind::chromatic_box));
    Rng rng = stream(127);
    const Rgb T = estimate_transmittance(sample.medium, TRANSMITTANCE_RESIDUAL, sample.ray, sample.march, rng);
    const Rgb expected = analytic_transmittance(sample.medium, sample.ray);
    for (int i = 0; i < 3; ++i)
        CHECK(T[i] == Approx(expected[i]).epsilon(1e-12));
    CHECK(rng.draw == 1u);
}

TEST_CASE("estimators refuse media that they cannot know", "[cpu][reference]") {
    const Sample sample = make_sample(GENERATE(Kind::rough_grid, Kind::noise_sphere));
    Rng rng = stream(131);
    CHECK_THROWS(estimate_transmittance(sample.medium, TRANSMITTANCE_ANALYTIC, sample.ray, sample.march, rng));
    CHECK_THROWS(estimate_transmittance(sample.medium, TRANSMITTANCE_COUNT, sample.ray, sample.march, rng));
    CHECK_THROWS(fly(sample.medium, FREE_FLIGHT_ANALYTIC, sample.ray, 1.0, 0.0, Rgb(1.0), sample.march, rng));
    CHECK_THROWS(fly(sample.medium, FREE_FLIGHT_COUNT, sample.ray, 1.0, 0.0, Rgb(1.0), sample.march, rng));
}
