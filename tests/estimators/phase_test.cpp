// The Henyey-Greenstein phase function: normalised, with mean cosine g, sampled as it is evaluated, to the digits that
// single precision has, up to sharp peaks on either side.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "hg_eval.spv.h"
#include "kernels/test_items.h"
#include "phase.spv.h"
#include "support/kernel_runner.h"
#include "support/numbers.h"
#include "support/statistics.h"
#include "tests/reference/phase.h"

using namespace vkvol;
using shared::PhaseInput;
using shared::PhaseOutput;
using std::numbers::pi;
using test_numbers::ulp;

namespace {

constexpr float all_g[] = {0.0f,  1e-4f,  -1e-4f, 0.2f,    -0.2f,   0.8f,    -0.8f,
                           0.95f, -0.95f, 0.999f, -0.999f, 0.9999f, -0.9999f};
constexpr float largest_u = 1.0f - 0x1p-24f;

// The density per solid angle at the distance x from the peak, in terms that keep their digits there.
double exact_eval(double g, double x) {
    const double a = std::abs(g), d = (1.0 - a) * (1.0 - a) + 2.0 * a * x;
    return (1.0 - a) * (1.0 + a) / (4.0 * pi * d * std::sqrt(d));
}

// Probability of a distance below x: the integral of 2 pi exact_eval. With d as above,
// (1 - a^2) / 2a (1 / (1 - a) - 1 / sqrt(d)), written without the division by a and without cancellation, using
// d - (1 - a)^2 = 2 a x.
double exact_cdf(double g, double x) {
    const double a = std::abs(g), root = std::sqrt((1.0 - a) * (1.0 - a) + 2.0 * a * x);
    return (1.0 + a) * x / (root * (root + 1.0 - a));
}

std::vector<PhaseInput> random_inputs(float g, int count, std::uint32_t seed) {
    std::mt19937 engine(seed);
    std::normal_distribution<double> normal;
    const auto uniform = [&] { return static_cast<float>((engine() >> 8) * 0x1p-24); };
    std::vector<PhaseInput> inputs;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 d(normal(engine), normal(engine), normal(engine));
        inputs.push_back({g, glm::normalize(d), {uniform(), uniform()}});
    }
    return inputs;
}

std::vector<PhaseOutput> sample(const std::vector<PhaseInput>& inputs) {
    return KernelRunner(phase_spv).run<PhaseOutput>(inputs);
}

// p_g2(after, light) averaged over directions that p_g1 draws from `before`, at the cosine mu of before and light:
// evenly spaced in azimuth, which converges exponentially, and midpoints in the cosine. These err by h^2 / 24 times the
// integrand's slope at its peak, 2 pi p_g1 p_g2 (3 g1 / (1 - g1)^2 + 3 g2 / (1 - g2)^2): for both 0.8, the steepest
// here, by 2.5e-5 of the value.
double average_over_directions(double g1, double g2, double mu) {
    constexpr int cosines = 8000, azimuths = 256;
    double sum = 0.0;
    for (int i = 0; i < cosines; ++i) {
        const double m = -1.0 + 2.0 * (i + 0.5) / cosines, s = std::sqrt((1.0 - m * m) * (1.0 - mu * mu));
        double ring = 0.0;
        for (int j = 0; j < azimuths; ++j)
            ring += reference::hg_eval(g2, m * mu + s * std::cos(2.0 * pi * j / azimuths));
        sum += reference::hg_eval(g1, m) * ring;
    }
    return sum * (2.0 / cosines) * (2.0 * pi / azimuths);
}

} // namespace

TEST_CASE("phase functions one after another are one whose asymmetry is the product", "[cpu][phase]") {
    const double mu = GENERATE(-1.0, -0.4, 0.3, 0.9, 1.0);
    for (const auto& [g1, g2] : {std::pair(0.8, 0.8), {0.8, -0.3}, {-0.7, -0.7}, {0.5, 0.0}})
        CHECK(average_over_directions(g1, g2, mu) == Approx(reference::hg_eval(g1 * g2, mu)).epsilon(5e-5));
}

TEST_CASE("the phase function equals the reference's", "[gpu][phase][hard]") {
    std::vector<glm::vec2> inputs;
    for (const float g : all_g)
        for (int i = 0; i <= 2000; ++i) // dense near the peak, down to 1e-12
            inputs.emplace_back(g, static_cast<float>(i == 0 ? 0.0 : 2.0 * std::pow(10.0, -12.0 * (1.0 - i / 2000.0))));
    const auto outputs = KernelRunner(hg_eval_spv).run<float>(inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double g = inputs[i].x, x = inputs[i].y;
        CAPTURE(g, x);
        // d: 1 - a exact for a >= 1/2, else half an ulp, twice in the square, which rounds, as do the product and the
        // sum: 2.5 ulp, 3.75 after the power 3/2. sqrt and division add 2.5 each (as Vulkan allows), the rest 3.
        REQUIRE(outputs[i] == Approx(exact_eval(g, x)).epsilon(12 * ulp));
        // The reference states the same of mu. Its 1 - mu has lost 2^-53 against d >= 1e-8.
        const double mu = g < 0.0 ? x - 1.0 : 1.0 - x;
        REQUIRE(outputs[i] == Approx(reference::hg_eval(g, mu)).epsilon(12 * ulp + 1e-7));
    }
}

TEST_CASE("the phase function integrates to 1", "[gpu][phase]") {
    // Substituting x = 2 y^8 resolves the sharpest peak, of width 5e-9; the midpoint rule with 40000 panels errs by
    // less than 1e-6 there (found by doubling the panels in double precision).
    constexpr int panels = 40000;
    std::vector<glm::vec2> inputs;
    for (const float g : all_g)
        for (int i = 0; i < panels; ++i)
            inputs.emplace_back(g, static_cast<float>(2.0 * std::pow((i + 0.5) / panels, 8)));
    const auto outputs = KernelRunner(hg_eval_spv).run<float>(inputs);
    for (std::size_t k = 0; k < std::size(all_g); ++k) {
        double integral = 0.0;
        for (int i = 0; i < panels; ++i) {
            const double y = (i + 0.5) / panels;
            integral += outputs[k * panels + i] * 2.0 * pi * 16.0 * std::pow(y, 7) / panels;
        }
        CAPTURE(all_g[k]);
        CHECK(integral == Approx(1.0).margin(12 * ulp + 5e-6));
    }
}

TEST_CASE("sampled distances from the peak equal the exact inverse", "[gpu][phase][hard]") {
    const float g = GENERATE(from_range(std::begin(all_g), std::end(all_g)));
    const double a = std::abs(double(g));
    auto inputs = random_inputs(g, 20000, 1);
    inputs[0].u.x = 0.0f;
    inputs[1].u.x = 0x1p-24f;
    inputs[2].u.x = largest_u;
    const auto outputs = sample(inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double u = inputs[i].u.x, s = g < 0.0f ? 1.0 - 2.0 * u : 2.0 * u - 1.0, q = 1.0 + a * s;
        const double x =
            std::clamp((1.0 - a) * (1.0 - a) * (1.0 - s) * (2.0 + a * (1.0 + s)) / (2.0 * q * q), 0.0, 2.0);
        CAPTURE(g, u);
        // Ten roundings, and q = 1 + a s, which loses 2^-24 absolutely and stands in the square.
        REQUIRE(outputs[i].from_peak == Approx(x).epsilon(10 * ulp + 2.0 * 0x1p-23 / q));
        REQUIRE(outputs[i].from_peak >= 0.0f);
        REQUIRE(outputs[i].from_peak <= 2.0f);
        const double mu = reference::hg_sample_cosine(g, u);
        REQUIRE((g < 0.0f ? x - 1.0 : 1.0 - x) == Approx(mu).margin(1e-9));
        REQUIRE(outputs[i].eval == Approx(exact_eval(g, outputs[i].from_peak)).epsilon(12 * ulp));
    }
}

TEST_CASE("sampled cosines follow the phase function", "[gpu][phase][hard]") {
    const float g = GENERATE(from_range(std::begin(all_g), std::end(all_g)));
    CAPTURE(g);
    const auto outputs = sample(random_inputs(g, 200000, 2));
    const double significance = sidak(1e-3, 3.0 * std::size(all_g));
    // Bins between the distances where the distribution function of the middle |g| is even, none of which depends on
    // the sampler; what each expects is the integral of the density.
    constexpr int bins = 64;
    std::vector<double> observed(bins, 0.0), expected(bins), uniforms;
    const auto edge = [&](int i) { return 2.0 * std::pow(double(i) / bins, 1.0 + 7.0 * std::abs(g)); };
    for (int i = 0; i < bins; ++i)
        expected[i] = outputs.size() * (exact_cdf(g, edge(i + 1)) - exact_cdf(g, edge(i)));
    RunningMean cosine;
    for (const PhaseOutput& o : outputs) {
        const double x = o.from_peak;
        observed[std::min(bins - 1, static_cast<int>(bins * std::pow(x / 2.0, 1.0 / (1.0 + 7.0 * std::abs(g)))))] +=
            1.0;
        uniforms.push_back(exact_cdf(g, x));
        cosine.add(g < 0.0f ? x - 1.0 : 1.0 - x);
    }
    CHECK(chi_square_test_p(observed, expected) > significance);
    CHECK(kolmogorov_smirnov_p(uniforms) > significance);
    CHECK(t_test_p(cosine, g) > significance);
}

TEST_CASE("sampled directions turn by the sampled angle, to all sides alike", "[gpu][phase]") {
    const float g = GENERATE(from_range(std::begin(all_g), std::end(all_g)));
    CAPTURE(g);
    const auto inputs = random_inputs(g, 100000, 3);
    const auto outputs = sample(inputs);
    std::vector<double> angles;
    int forward = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::dvec3 before(inputs[i].direction), after(outputs[i].direction);
        const glm::dvec3 peak = g < 0.0f ? -before : before;
        REQUIRE(std::abs(glm::length(after) - 1.0) < 4 * ulp);
        const double apart = glm::distance(after, peak), x = outputs[i].from_peak;
        // |after - peak| is sqrt(2x); the two vectors' components carry a few ulp each. sine = sqrt(x (2 - x)) loses
        // digits at the far end, where 2 - x has an error of 2^-23: sqrt(2 * 2^-23) sideways at worst.
        REQUIRE(std::abs(apart - std::sqrt(2.0 * x)) < 8 * ulp);
        const double sine = std::sqrt(x * (2.0 - x));
        forward += glm::dot(before, after) > 0.0;
        if (sine > 1e-3) { // else rounding decides the side
            const glm::dvec3 aside = std::abs(before.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
            const glm::dvec3 e1 = glm::normalize(glm::cross(aside, before)), e2 = glm::cross(before, e1);
            angles.push_back(std::atan2(glm::dot(after, e2), glm::dot(after, e1)) / (2.0 * pi) + 0.5);
        }
        // The pdf of a pair of directions: each component of before - after is off by 2 ulp at most, together by
        // delta, so x by |apart| delta + delta^2 / 2.
        const double delta = 4 * ulp, a = std::abs(double(g));
        const double d = (1.0 - a) * (1.0 - a) + 2.0 * a * x;
        const double relative = 1.5 * 2.0 * a * (std::sqrt(2.0 * x) * delta + delta * delta / 2.0) / d;
        if (relative < 0.1) // first order
            REQUIRE(outputs[i].eval_pair == Approx(outputs[i].eval).epsilon(24 * ulp + 2.0 * relative));
    }
    // P(mu > 0) = 1/2 + (1 - g^2) / 2g (1 / (1 - g) - 1 / sqrt(1 + g^2)) - 1/2, by exact_cdf at x = 1.
    const double p = g < 0.0f ? 1.0 - exact_cdf(g, 1.0) : exact_cdf(g, 1.0), n = inputs.size();
    CHECK(normal_p((forward - n * p) / std::sqrt(n * p * (1.0 - p) + 1e-9)) > sidak(1e-3, 2.0 * std::size(all_g)));
    if (g == 0.95f)
        CHECK(forward > 0.97 * n);
    if (angles.size() > 1000)
        CHECK(kolmogorov_smirnov_p(angles) > sidak(1e-3, 2.0 * std::size(all_g)));
}

TEST_CASE("frames are orthonormal and right-handed, poles included", "[gpu][phase]") {
    auto inputs = random_inputs(0.5f, 10000, 4);
    for (const float z : {1.0f, -1.0f, 0.0f, -0.0f})
        for (const float tilt : {0.0f, -0.0f, 1e-30f, 1e-20f, 1e-10f, 1e-7f, 1e-4f, 1e-2f})
            for (const glm::vec2 side : {glm::vec2(1, 0), glm::vec2(0, 1), glm::vec2(-1, 1), glm::vec2(-1, -1)}) {
                const glm::dvec3 n(tilt * side.x, tilt * side.y, z == 0.0f ? 0.0 : z);
                if (glm::length(n) > 0.5)
                    inputs.push_back({0.5f, glm::normalize(n), {0.3f, 0.7f}});
            }
    for (const glm::vec3 axis :
         {glm::vec3(1, 0, 0), glm::vec3(-1, 0, -0.0f), glm::vec3(0, 1, 0), glm::vec3(0, -1, -0.0f)})
        inputs.push_back({0.5f, axis, {0.3f, 0.7f}});
    const auto outputs = sample(inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::dvec3 n(inputs[i].direction), t(outputs[i].tangent), b(outputs[i].bitangent);
        INFO("normal " << n.x << ' ' << n.y << ' ' << n.z);
        // Duff et al. report errors below 1e-6 in single precision; a few ulp of components of at most 1.
        constexpr double eps = 8 * ulp;
        REQUIRE(std::abs(glm::length(t) - 1.0) < eps);
        REQUIRE(std::abs(glm::length(b) - 1.0) < eps);
        REQUIRE(std::abs(glm::dot(n, t)) < eps);
        REQUIRE(std::abs(glm::dot(n, b)) < eps);
        REQUIRE(std::abs(glm::dot(t, b)) < eps);
        REQUIRE(glm::dot(glm::cross(t, b), n) > 0.9);
    }
}

// Where many implementations switch between two formulas. Here there is one, continuous in g; its derivative by g at 0,
// 3 mu / 4 pi in relative terms 3 mu, is at most 3, so |g| of 1e-3 changes the value by 0.3 % (plus second order).
TEST_CASE("the phase function is isotropic at g = 0 and continuous about it", "[gpu][phase][hard]") {
    std::vector<glm::vec2> inputs;
    const std::vector<float> small = {0.0f, -0.0f, 1e-30f, -1e-30f, 1e-7f, -1e-7f, 1e-5f, -1e-5f, 1e-3f, -1e-3f};
    for (const float g : small)
        for (int i = 0; i <= 200; ++i)
            inputs.emplace_back(g, 0.01f * static_cast<float>(i));
    const auto outputs = KernelRunner(hg_eval_spv).run<float>(inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double g = inputs[i].x, relative = outputs[i] * 4.0 * pi - 1.0;
        CAPTURE(g, inputs[i].y);
        REQUIRE(std::abs(relative) <= 3.0 * std::abs(g) + 6.0 * g * g + 12 * ulp);
    }
    for (const float g : small) { // uniform in the distance from the peak: 2 (1 - u), or 2 u seen from the other side
        const auto draws = random_inputs(g, 1000, 5);
        const auto samples = sample(draws);
        for (std::size_t i = 0; i < draws.size(); ++i) {
            const double x = 2.0 * (g < 0.0f ? draws[i].u.x : 1.0 - draws[i].u.x);
            REQUIRE(std::abs(samples[i].from_peak - x) <= 2.0 * std::abs(g) + 12 * ulp);
        }
    }
}
