// Random numbers: bit by bit what the specification says, uniform, and independent of their neighbours.
// Seeds are fixed. Each case states its significance; a case of n comparisons divides it by Sidak's formula.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "kernels/test_items.h"
#include "rng.spv.h"
#include "support/kernel_runner.h"
#include "support/statistics.h"
#include "tests/reference/rng.h"

using namespace vkvol;
using shared::RngOutput;

namespace {

std::vector<RngOutput> draw_on_device(const std::vector<glm::uvec4>& keys) {
    return KernelRunner(rng_spv).run<RngOutput>(keys);
}

// Pixels of a 32 x 32 square, 16 samples, 8 draws: keys as neighbourly as a render's.
constexpr std::uint32_t side = 32, samples = 16, draws = 8;
std::size_t key_index(std::uint32_t x, std::uint32_t y, std::uint32_t sample, std::uint32_t draw) {
    return ((y * side + x) * samples + sample) * draws + draw;
}
std::vector<RngOutput> draw_neighbours(std::uint32_t seed = 7) {
    std::vector<glm::uvec4> keys;
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x)
            for (std::uint32_t sample = 0; sample < samples; ++sample)
                for (std::uint32_t draw = 0; draw < draws; ++draw)
                    keys.emplace_back(x | y << 16, sample, draw, seed);
    return draw_on_device(keys);
}

// The numbers of a draw: u, then tap.
constexpr int components = 7;
double component(const RngOutput& o, int i) {
    return i < 4 ? o.u[i] : o.tap[i - 4];
}

// p-value of the correlation of a and b: for independent uniforms z = sqrt(n) * 12 * mean((a - 1/2)(b - 1/2)) is
// standard normal, since the product has variance 1 / 144.
class Correlation {
public:
    void add(double a, double b) {
        sum_ += (a - 0.5) * (b - 0.5);
        count_ += 1.0;
    }
    double p() const { return normal_p(12.0 * sum_ / std::sqrt(count_)); }

private:
    double sum_ = 0.0, count_ = 0.0;
};

} // namespace

TEST_CASE("random numbers equal the reference bit by bit", "[gpu][rng]") {
    std::mt19937 engine(1);
    std::vector<glm::uvec4> keys = {{0, 0, 0, 0}, {~0u, ~0u, ~0u, ~0u}, {0, 0, ~0u, 0}};
    while (keys.size() < 100000)
        keys.emplace_back(engine(), engine(), engine(), engine());
    const std::vector<RngOutput> outputs = draw_on_device(keys);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const glm::uvec4 k = keys[i];
        const reference::Draw draw{reference::pcg4d({k.x, k.y, k.z, k.w})};
        const RngOutput& o = outputs[i];
        INFO("key " << k.x << ' ' << k.y << ' ' << k.z << ' ' << k.w);
        REQUIRE((o.words == glm::uvec4(draw.words[0], draw.words[1], draw.words[2], draw.words[3])));
        for (int c = 0; c < 4; ++c) // floats hold multiples of 2^-24 exactly
            REQUIRE(double(o.u[c]) == draw.uniform(c));
        REQUIRE((glm::dvec3(o.tap) == draw.tap()));
        REQUIRE(std::abs(o.event - draw.event()) <= 0x1p-25); // rounded
        REQUIRE(o.draw == k.z + 1u);
        // Vulkan lets log err by 3 ulp outside [0.5, 2] and by 2^-21 within it; the complement is a float, rounded.
        REQUIRE(std::abs(o.exponential - draw.exponential(0)) <= 0x1p-21 + 4 * 0x1p-23 * o.exponential);
    }
}

// A medium of optical depth tau is hit with the probability P(e < tau), which for this variate is a count of words: the
// largest U of which e < tau, found by bisection of its 48 free bits, must be 1 - exp(-tau). A variate of 24 bits would
// hit one of 1e-9 sixty times too often. The tolerance is a step of U, and the rounding of U, the series and tau: 4
// times 2^-24; beyond the series 2^-21 for the log's error near 1.
TEST_CASE("media as thin as 1e-12 are hit as often as they should be", "[gpu][rng][hard]") {
    const auto exponential = [](std::uint64_t U) { // U: 32 bits of x, the low byte of w, that of y
        const glm::uvec4 words(U >> 16, U & 255u, 0u, U >> 8 & 255u);
        return draw_on_device({words}).front().of_key;
    };
    for (const float tau : {1e-12f, 1e-9f, 1e-7f, 1e-6f, 1e-3f, 0.015f, 0.3f}) {
        std::uint64_t below = 0; // exponential(below) < tau
        for (int bit = 47; bit >= 0; --bit)
            if (const std::uint64_t candidate = below | std::uint64_t{1} << bit; exponential(candidate) < tau)
                below = candidate;
        const double hit = double(below + 1) * 0x1p-48;
        const double expected = -std::expm1(-double(tau));
        CAPTURE(tau);
        CHECK(std::abs(hit - expected) <= 0x1p-48 + (tau < 0x1p-6f ? 0x1p-22 * expected : 0x1p-21));
    }
    CHECK(exponential(0) == 0.0f);
    CHECK(exponential((std::uint64_t{1} << 48) - 1) == Approx(56.0 * std::log(2.0)));
}

// Of tentative collisions a part r is real, which is a count of words as well.
TEST_CASE("collisions that are real once in 10^7 times are so as often as they should be", "[gpu][rng][hard]") {
    const auto event = [](std::uint32_t word) { // 24 bits of y, the low byte of z
        return draw_on_device({glm::uvec4(0u, word & ~255u, word & 255u, 0u)}).front().event_of_key;
    };
    for (const float r : {1e-7f, 1e-6f, 1e-5f, 1e-3f, 0.3f}) {
        std::uint32_t below = 0; // event(below) < r
        for (int bit = 31; bit >= 0; --bit)
            if (const std::uint32_t candidate = below | 1u << bit; event(candidate) < r)
                below = candidate;
        CAPTURE(r);
        CHECK(std::abs((below + 1.0) * 0x1p-32 - double(r)) <= 0x1p-32 + 0x1p-24 * r);
    }
    CHECK(event(0) == 0.0f);
    CHECK(event(~0u) < 1.0f);
}

TEST_CASE("random numbers are uniform in [0, 1)", "[gpu][rng]") {
    const std::vector<RngOutput> outputs = draw_neighbours();
    constexpr int bins = 256;
    const double significance = sidak(1e-3, components);
    for (int c = 0; c < components; ++c) {
        std::vector<double> observed(bins, 0.0);
        for (const RngOutput& o : outputs) {
            const double u = component(o, c);
            REQUIRE((u >= 0.0 && u < 1.0));
            observed[static_cast<int>(u * bins)] += 1.0;
        }
        const std::vector<double> expected(bins, outputs.size() / double(bins));
        CAPTURE(c);
        CHECK(chi_square_test_p(observed, expected) > significance);
    }
}

TEST_CASE("the numbers of one draw are independent of each other", "[gpu][rng]") {
    const std::vector<RngOutput> outputs = draw_neighbours();
    const double significance = sidak(1e-3, 2 * components * (components - 1) / 2);
    for (int a = 0; a < components; ++a)
        for (int b = a + 1; b < components; ++b) {
            // u.z and tap.x are the same bits, and u.w and tap.y: no use takes both (see the order of draws).
            if ((a == 2 && b == 4) || (a == 3 && b == 5))
                continue;
            Correlation correlation;
            std::vector<double> observed(16 * 16, 0.0);
            for (const RngOutput& o : outputs) {
                const double u = component(o, a), v = component(o, b);
                correlation.add(u, v);
                observed[static_cast<int>(16 * u) * 16 + static_cast<int>(16 * v)] += 1.0;
            }
            CAPTURE(a, b);
            CHECK(correlation.p() > significance);
            CHECK(chi_square_test_p(observed, std::vector<double>(256, outputs.size() / 256.0)) > significance);
        }
}

// The low bits of words know nothing of the upper bits of a key. By the reference, which the kernels equal bit by bit.
TEST_CASE("pixels, samples and seeds that are far apart are independent", "[cpu][rng]") {
    using Key = std::array<std::uint32_t, 4>;
    struct Step {
        const char* name;
        Key by;
    };
    const std::vector<Step> steps = {{"64 rows", {64u << 16, 0, 0, 0}},     {"128 rows", {128u << 16, 0, 0, 0}},
                                     {"256 rows", {256u << 16, 0, 0, 0}},   {"512 rows", {512u << 16, 0, 0, 0}},
                                     {"256 columns", {256, 0, 0, 0}},       {"2^16 samples", {0, 1u << 16, 0, 0}},
                                     {"2^23 samples", {0, 1u << 23, 0, 0}}, {"2^24 samples", {0, 1u << 24, 0, 0}},
                                     {"2^28 samples", {0, 1u << 28, 0, 0}}, {"2^24 seeds", {0, 0, 0, 1u << 24}}};
    const auto number = [](const reference::Draw& draw, int i) { return i < 4 ? draw.uniform(i) : draw.tap()[i - 4]; };
    const double significance = sidak(1e-3, double(steps.size()) * components * components);
    for (const Step& step : steps)
        for (int a = 0; a < components; ++a)
            for (int b = 0; b < components; ++b) {
                Correlation correlation;
                for (std::uint32_t i = 0; i < 1u << 15; ++i) {
                    const Key key = {(i & 31u) | (i >> 5 & 31u) << 16, i >> 10, 3, 7};
                    const Key far = {key[0] + step.by[0], key[1] + step.by[1], key[2] + step.by[2],
                                     key[3] + step.by[3]};
                    correlation.add(number({reference::pcg4d(key)}, a), number({reference::pcg4d(far)}, b));
                }
                INFO(step.name << ", components " << a << ' ' << b);
                CHECK(correlation.p() > significance);
            }
}

TEST_CASE("neighbouring pixels, samples, draws and seeds are independent", "[gpu][rng]") {
    const std::vector<RngOutput> outputs = draw_neighbours(), of_next_seed = draw_neighbours(8);
    struct Step {
        const char* name;
        std::uint32_t x, y, sample, draw, seed = 0;
    };
    const Step step =
        GENERATE(Step{"x", 1, 0, 0, 0}, Step{"y", 0, 1, 0, 0}, Step{"diagonal", 1, 1, 0, 0}, Step{"sample", 0, 0, 1, 0},
                 Step{"draw", 0, 0, 0, 1}, Step{"two draws", 0, 0, 0, 2}, Step{"seed", 0, 0, 0, 0, 1});
    const double significance = sidak(1e-3, 7 * components * components);
    for (int a = 0; a < components; ++a)
        for (int b = 0; b < components; ++b) {
            Correlation correlation;
            for (std::uint32_t y = 0; y + step.y < side; ++y)
                for (std::uint32_t x = 0; x + step.x < side; ++x)
                    for (std::uint32_t s = 0; s + step.sample < samples; ++s)
                        for (std::uint32_t d = 0; d + step.draw < draws; ++d)
                            correlation.add(component(outputs[key_index(x, y, s, d)], a),
                                            component((step.seed ? of_next_seed : outputs)[key_index(
                                                          x + step.x, y + step.y, s + step.sample, d + step.draw)],
                                                      b));
            INFO("step in " << step.name << ", components " << a << ' ' << b);
            CHECK(correlation.p() > significance);
        }
}
