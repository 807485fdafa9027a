// The bench's statistics on data whose figures are known, and its schedule.
#include <catch2/catch.hpp>

#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <set>

#include "bench.h"
#include "bench_schedule.h"
#include "student_t.h"

using namespace vkvol;

namespace {

// Counts as a bench has them: three runs of the small ones, six of the largest.
std::vector<std::uint32_t> counts() {
    std::vector<std::uint32_t> list;
    for (const std::uint32_t samples : {1u, 2u, 4u, 8u, 16u, 32u})
        list.insert(list.end(), samples < 8 ? 3 : 1, samples);
    list.insert(list.end(), 6, 64u);
    return list;
}

// relMSE = floor + 1 / samples and a second a sample, both exactly or with the scatter that `noise` adds.
std::vector<BenchRun> runs_of(double floor, const std::function<double(std::uint32_t)>& noise = {}) {
    std::vector<BenchRun> runs;
    for (const std::uint32_t samples : counts()) {
        const double own = 1.0 / samples;
        const double relmse = floor + own + (noise ? noise(samples) : 0.0);
        const auto of_several = [&](double figure) { return samples > 1 ? std::optional(figure) : std::nullopt; };
        runs.push_back({samples, 0, double(samples), relmse, of_several(own), of_several(std::sqrt(own))});
    }
    return runs;
}

bool holds(const std::optional<Interval>& interval, double truth) {
    return interval && interval->low <= truth && truth <= interval->high;
}

// That 95 % intervals hold the truth in 95 % of trials. Hits are binomial: four standard deviations are exceeded by
// chance once in 16000 times, and the seed is fixed.
void check_coverage(const std::function<bool()>& trial) {
    constexpr int trials = 4000;
    int hits = 0;
    for (int i = 0; i < trials; ++i)
        hits += trial() ? 1 : 0;
    CHECK(std::abs(hits - 0.95 * trials) <= 4.0 * std::sqrt(trials * 0.95 * 0.05));
}

Film flat_film(int edge, float value, std::uint32_t samples, float variance) {
    Film film;
    film.picture_width = film.picture_height = edge;
    film.crop = {0, edge, 0, edge};
    const auto pixels = std::size_t(edge) * std::size_t(edge);
    film.mean.assign(pixels, glm::vec3(value));
    film.variance.assign(pixels, glm::vec3(variance));
    film.samples.assign(pixels, samples);
    return film;
}

// Every channel of every pixel: the mean of `samples` uniform numbers in [0, 2], and its estimated variance.
Film random_film(std::mt19937_64& random, int edge, std::uint32_t samples) {
    Film film = flat_film(edge, 0.0f, samples, 0.0f);
    std::uniform_real_distribution<double> uniform(0.0, 2.0);
    for (std::size_t i = 0; i < film.pixel_count(); ++i)
        for (int c = 0; c < 3; ++c) {
            double sum = 0.0, squares = 0.0;
            for (std::uint32_t k = 0; k < samples; ++k) {
                const double x = uniform(random);
                sum += x;
                squares += x * x;
            }
            const double n = samples;
            film.mean[i][c] = float(sum / n);
            film.variance[i][c] = n > 1 ? float((squares - sum * sum / n) / (n * (n - 1))) : 0.0f;
        }
    return film;
}

} // namespace

TEST_CASE("Student's t has the quantiles of its table", "[cpu][bench]") {
    for (const auto& [freedom, t] :
         {std::pair{1.0, 12.7062}, {2.0, 4.3027}, {5.0, 2.5706}, {10.0, 2.2281}, {30.0, 2.0423}, {1e7, 1.9600}}) {
        CAPTURE(freedom);
        CHECK(std::abs(student_t95(freedom) - t) < 6e-5); // the table's rounding
    }
    CHECK(std::abs(student_two_sided(1.0, 0.99) - 63.6567) < 6e-5);
    CHECK(std::abs(student_two_sided(5.0, 0.999) - 6.8688) < 6e-5);
    CHECK(std::abs(normal_two_sided(0.99) - 2.5758) < 6e-5);
}

TEST_CASE("a pure decay has slope -1, no floor, and the efficiency it was made with", "[cpu][bench]") {
    const std::vector<BenchRun> runs = runs_of(0.0);
    // Without scatter nothing but the rounding of logarithms and sums is left, about 1e-15 each.
    CHECK(std::abs(error_slope(runs)->value + 1.0) < 1e-12);
    CHECK(std::abs(bias_floor(runs, 0.0)->value) < 1e-12);
    CHECK(std::abs(efficiency(runs)->value - 1.0) < 1e-12);
    CHECK(std::abs(efficiency_ratio(runs, runs)->value - 1.0) < 1e-12);
    CHECK(std::abs(*seconds_to_noise(0.01, runs) - 1e4) < 1e-6);
    CHECK(bias_floor(runs, 0.25)->high == Approx(1.959964 * 0.25));
}

TEST_CASE("a floor is found, and flattens the slope", "[cpu][bench]") {
    const std::vector<BenchRun> runs = runs_of(0.02);
    const Interval floor = *bias_floor(runs, 0.0);
    CHECK(std::abs(floor.value - 0.02) < 1e-12);
    CHECK(error_slope(runs)->high > -0.9); // at 64 samples more than half of the error is the floor
}

TEST_CASE("figures without meaning are not made", "[cpu][bench]") {
    const std::vector<BenchRun> one = {{1, 0, 1.0, 1.0, std::nullopt}};
    CHECK_FALSE(error_slope(one));
    CHECK_FALSE(bias_floor(one, 0.0));
    CHECK_FALSE(efficiency(one));
    std::vector<BenchRun> same(5, BenchRun{4, 0, 1.0, 0.5, 0.5});
    CHECK_FALSE(error_slope(same)); // one count has no slope
    CHECK(bias_floor(same, 0.0));
    same[2].relmse = -0.1;
    CHECK_FALSE(efficiency(same));
    CHECK_FALSE(seconds_to_noise(0.01, one));
}

// All hold with 95 %, so in half of what is left, 2.5 %, some floor of 0 comes out above it: at most 5 %.
TEST_CASE("of many floors of 0 hardly ever one seems to be more", "[cpu][bench]") {
    constexpr int trials = 2000, rows = 10;
    std::mt19937_64 random(19);
    std::normal_distribution<double> normal;
    int together = 0, each = 0;
    for (int i = 0; i < trials; ++i) {
        bool one_together = false, one_each = false;
        for (int row = 0; row < rows; ++row) {
            const auto noise = [&](std::uint32_t n) { return 0.3 / std::sqrt(n * (n - 0.999)) * normal(random); };
            const std::vector<BenchRun> runs = runs_of(0.0, noise);
            one_together = one_together || bias_floor(runs, 0.0, probability_of_each(rows))->low > 0.0;
            one_each = one_each || bias_floor(runs, 0.0)->low > 0.0;
        }
        together += one_together ? 1 : 0;
        each += one_each ? 1 : 0;
    }
    CHECK(together <= 0.05 * trials);
    CHECK(each > 0.1 * trials); // by far what all together may be: without the correction it would be seen
}

TEST_CASE("a bench is called too short until its figures are fit to compare", "[cpu][bench]") {
    const auto runs_with = [](std::size_t count, double spread) {
        std::vector<BenchRun> runs;
        for (std::size_t i = 0; i < count; ++i) // in pairs, so that the mean is 1
            runs.push_back({4, 0, 1.0, std::exp(i % 2 ? spread : -spread), std::nullopt, std::nullopt});
        return runs;
    };
    CHECK(times_to_judge(runs_with(6, 0.01)) == 1.0);
    CHECK(times_to_judge(runs_with(2, 0.0)) >= 2.5); // alike by chance
    CHECK(times_to_judge(runs_with(1, 0.0)) >= 5.0);
    CHECK(times_to_judge({}) >= 5.0);
    // Six runs: the error is spread sqrt(6 / 5) / sqrt(6), and t with 5 degrees of freedom 2.571.
    const double error = 2.0 / std::sqrt(5.0), needed = std::pow(2.5706 * error / std::log(3.0), 2.0);
    CHECK(times_to_judge(runs_with(6, 2.0)) == Approx(needed).epsilon(1e-3));
    CHECK(times_to_judge(runs_with(6 * std::size_t(std::ceil(needed)), 2.0)) == 1.0); // so many it is
    std::vector<BenchRun> below = runs_with(6, 0.01);
    below[3].relmse = -1e-6;
    CHECK(times_to_judge(below) > 1.0);
}

// Each with the scatter that its docstring assumes, where Student's t is exact.
TEST_CASE("95 % intervals of slopes and floors hold the truth in 95 % of benches", "[cpu][bench]") {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    SECTION("slope: log relMSE with variance 0.04 / samples") {
        check_coverage([&] {
            std::vector<BenchRun> runs = runs_of(0.0);
            for (BenchRun& run : runs)
                run.relmse *= std::exp(0.2 / std::sqrt(double(run.samples)) * normal(random));
            return holds(error_slope(runs), -1.0);
        });
    }
    // Where there seems to be a floor the interval is the wider of two.
    SECTION("floor: differences with variance in proportion to 1 / (n (n - 1))") {
        int hits = 0;
        for (int i = 0; i < 4000; ++i) {
            const auto noise = [&](std::uint32_t n) { return 0.3 / std::sqrt(n * (n - 0.999)) * normal(random); };
            hits += holds(bias_floor(runs_of(0.01, noise), 0.0), 0.01) ? 1 : 0;
        }
        CHECK(hits >= 0.936 * 4000);
        CHECK(hits <= 0.985 * 4000);
    }
    // Beside a bias b errors e leave 2 b e, whose variance falls as 1 / n only. At least in 95 % then.
    SECTION("floor: a bias of 0.3 of a standard deviation, 300 pixels, many short runs and few long ones") {
        const auto trial = [&] {
            std::vector<BenchRun> runs;
            for (std::uint32_t n = 2; n <= 512; n *= 2)
                for (int i = 0; i < (n < 256 ? 3 : n == 256 ? 1 : 5); ++i) {
                    const double cross = 2.0 * 0.3 * normal(random) / std::sqrt(300.0 * n),
                                 square = std::sqrt(2.0 / (n * (n - 1.0)) / 300.0) * normal(random);
                    runs.push_back({n, 0, double(n), 0.09 + 1.0 / n + cross + square, 1.0 / n});
                }
            return holds(bias_floor(runs, 0.0), 0.09);
        };
        int hits = 0;
        for (int i = 0; i < 4000; ++i)
            hits += trial() ? 1 : 0;
        CHECK(hits >= 0.936 * 4000);
    }
}

TEST_CASE("95 % intervals of efficiencies hold the truth in 95 % of benches", "[cpu][bench]") {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    SECTION("efficiency: beside a reference whose noise all runs share, of all counts") {
        check_coverage([&] {
            std::vector<BenchRun> runs = runs_of(0.0);
            const double offset = 3e-4 * normal(random);
            for (BenchRun& run : runs)
                run.relmse = run.relmse * std::exp(1e-6 * normal(random)) + offset;
            return holds(efficiency(runs, 3e-4), 1.0);
        });
    }
    SECTION("efficiency: log relMSE with equal variance, equal seconds") {
        check_coverage([&] {
            std::vector<BenchRun> runs(6, BenchRun{4, 0, 2.0, 0.0, std::nullopt});
            for (BenchRun& run : runs)
                run.relmse = std::exp(0.3 * normal(random));
            return holds(efficiency(runs), 0.5);
        });
    }
    SECTION("ratio of efficiencies: likewise, and Welch's t is exact for equal variances and counts") {
        check_coverage([&] {
            std::vector<BenchRun> a(6, BenchRun{4, 0, 1.0, 0.0, std::nullopt}), b = a;
            for (std::size_t i = 0; i < a.size(); ++i) {
                a[i].relmse = std::exp(0.3 * normal(random));
                b[i].relmse = 2.0 * std::exp(0.3 * normal(random));
            }
            return holds(efficiency_ratio(a, b), 2.0);
        });
    }
}

// Where relMSE scatters alike at all counts, the weights are not the best, but the intervals err on the safe side.
TEST_CASE("scatter that does not fall with samples makes slope and efficiency no surer than they are", "[cpu][bench]") {
    std::mt19937_64 random(11);
    std::normal_distribution<double> normal;
    constexpr int trials = 4000;
    int slopes = 0, efficiencies = 0;
    for (int i = 0; i < trials; ++i) {
        std::vector<BenchRun> runs = runs_of(0.0);
        for (BenchRun& run : runs)
            run.relmse *= std::exp(0.05 * normal(random));
        slopes += holds(error_slope(runs), -1.0) ? 1 : 0;
        efficiencies += holds(efficiency(runs), 1.0) ? 1 : 0;
    }
    const double least = 0.95 * trials - 4.0 * std::sqrt(trials * 0.95 * 0.05);
    CHECK(slopes >= least);
    CHECK(efficiencies >= least);
}

TEST_CASE("relMSE against a noisy reference has the expectation of that against the truth", "[cpu][bench]") {
    // Uniform numbers in [0, 2]: mean 1, variance 1/3. Image of 4 samples, reference of 32.
    constexpr int edge = 16, trials = 40;
    const double expected = 1.0 / 3.0 / 4.0 / 1.01;
    std::mt19937_64 random(3);
    double sum = 0.0, squares = 0.0, predicted = 0.0;
    for (int i = 0; i < trials; ++i) {
        const Film reference = random_film(random, edge, 32);
        const Film image = random_film(random, edge, 4);
        const double value = relative_mse(image, reference);
        sum += value / trials;
        squares += value * value / trials;
        predicted += relative_variance(image, reference) / trials;
    }
    const double error = std::sqrt((squares - sum * sum) / (trials - 1));
    // 1 / (R^2 + 0.01) is larger in the mean than at R = 1: by half of its second derivative, 6, times the variance of
    // R, s = 1/96; of ((R - 1)^2 - var_R), which has fourth moment at most 3 s^2, that leaves 6 s^2.
    const double s = 1.0 / 96.0;
    const double curvature = 3.0 * s * expected + 6.0 * s * s;
    CHECK(std::abs(sum - expected) < 4.0 * error + curvature);
    CHECK(std::abs(predicted - expected) < 4.0 * error + curvature);
    CHECK(4.0 * error + curvature < s); // else this would not see a reference whose variance is not subtracted
}

TEST_CASE("the floor of pictures that are off by a tenth is a hundredth", "[cpu][bench]") {
    constexpr int count = 12, edge = 16;
    constexpr std::uint32_t samples = 32;
    std::mt19937_64 random(5);
    const Film exact = flat_film(edge, 1.0f, 0, 0.0f);
    std::vector<BenchRun> runs;
    for (int i = 0; i < count; ++i) {
        Film image = random_film(random, edge, samples);
        for (glm::vec3& mean : image.mean)
            mean += 0.1f;
        runs.push_back({samples, 0, 1.0, relative_mse(image, exact), relative_variance(image, exact)});
    }
    const Interval floor = *bias_floor(runs, 0.0);
    // The difference of one value has variance 2 v^2 / (n (n - 1)) + 4 b^2 v / n, v = 1/3 and b = 0.1.
    const double v = 1.0 / 3.0, n = samples;
    const double variance = (2.0 * v * v / (n * (n - 1.0)) + 4.0 * 0.01 * v / n) / (count * 3.0 * edge * edge);
    CHECK(std::abs(floor.value - 0.01 / 1.01) < 4.0 * std::sqrt(variance) / 1.01);
    CHECK(floor.low > 0.0);
}

TEST_CASE("pixels of too few samples and values that are not finite are left out", "[cpu][bench]") {
    Film reference = flat_film(2, 1.0f, 4, 0.01f), image = flat_film(2, 2.0f, 1, 0.0f);
    image.mean[0] = glm::vec3(100.0f);
    reference.samples[0] = 1;
    image.mean[1].y = std::numeric_limits<float>::quiet_NaN();
    CHECK(relative_mse(image, reference) == Approx((1.0 - 0.01) / 1.01));
    // Eight values of 0.01 / 1.01, those of a pixel together: 3, 3 and 2.
    CHECK(reference_offset_error(flat_film(2, 1.0f, 4, 0.01f)) == Approx(std::sqrt(2.0 * 4 * 9) * 0.01 / 1.01 / 12.0));
}

namespace {

struct Call {
    std::size_t estimator;
    std::uint32_t samples;
};

// What the schedule asks of estimators that take so many seconds a sample, and 0.01 s more.
std::vector<Call> schedule(const std::vector<double>& seconds_per_sample, double budget, double& spent) {
    std::vector<Call> calls;
    spent = 0.0;
    std::vector<double> warm;
    for (const double seconds : seconds_per_sample)
        warm.push_back(seconds + 0.01);
    run_rounds(
        warm, budget,
        [&](std::size_t estimator, std::uint32_t samples, double limit) -> std::optional<double> {
            const double seconds = 0.01 + seconds_per_sample[estimator] * samples;
            CHECK(limit == Approx(budget - spent));
            CHECK(seconds <= limit);
            spent += seconds;
            calls.push_back({estimator, samples});
            return seconds;
        },
        [] { return false; });
    return calls;
}

} // namespace

TEST_CASE("rounds double their samples, share the budget and keep to it", "[cpu][bench]") {
    const std::vector<double> seconds = {0.01, 0.02, 0.3};
    double spent = 0.0;
    const std::vector<Call> calls = schedule(seconds, 60.0, spent);
    CHECK(spent <= 60.0);
    CHECK(spent > 0.75 * 60.0);
    std::vector<std::map<std::uint32_t, int>> runs(seconds.size());
    std::vector<double> share(seconds.size());
    for (const Call& call : calls) {
        ++runs[call.estimator][call.samples];
        share[call.estimator] += 0.01 + seconds[call.estimator] * call.samples;
    }
    for (std::size_t i = 0; i < seconds.size(); ++i) {
        CAPTURE(i);
        std::uint32_t expected = 1;
        for (const auto& [samples, count] : runs[i]) {
            CHECK(samples == expected); // none is left out
            expected *= 2;
        }
        CHECK(runs[i].rbegin()->second >= 5);
        // All counts before, as much as one of this together, and five of this with a fifth to spare fit a share; of
        // twice as many samples they do not.
        const double last = 0.01 + seconds[i] * runs[i].rbegin()->first, next = 2.0 * last - 0.01;
        CHECK(7.0 * last <= 1.1 * 20.0);
        CHECK(7.0 * next > 20.0);
        CHECK(share[i] < 2 * 20.0);
    }
    // Each round begins with another one.
    CHECK(calls[0].estimator == 0);
    CHECK(calls[3].estimator == 1);
}

TEST_CASE("what a bench will take is known before it begins", "[cpu][bench]") {
    const std::vector<double> seconds = {0.01, 0.02, 0.3}, setup = {0.5, 0.1, 2.0};
    double spent = 0.0;
    for (const Call& call : schedule(seconds, 60.0, spent))
        spent += setup[call.estimator];
    // The prediction has each sample 0.01 s dearer, where the renders have that once: fewer of the cheap ones fit.
    CHECK(expected_seconds({0.02, 0.03, 0.31}, setup, 60.0) == Approx(spent).epsilon(0.25));
    CHECK(expected_seconds({0.0}, {1.0}, 1.0) > 1.0); // ends
}

TEST_CASE("the budget ends a bench of slow estimators, and one that is cut short is asked no more", "[cpu][bench]") {
    double spent = 0.0;
    CHECK(schedule({2.0, 3.0, 100.0}, 6.5, spent).size() == 2);
    CHECK(schedule({10.0}, 5.0, spent).empty());
    int asked = 0;
    run_rounds(
        {0.01}, 10.0,
        [&](std::size_t, std::uint32_t, double) -> std::optional<double> {
            ++asked;
            return std::nullopt;
        },
        [] { return false; });
    CHECK(asked == 1);
    CHECK_FALSE(is_worth_measuring(1.0, 5.0));
    CHECK(is_worth_measuring(1.0, 6.1));
}

TEST_CASE("no two runs have the same seed", "[cpu][bench]") {
    for (const std::uint32_t seed : {0u, 1u, 4294967295u}) {
        std::set<std::uint32_t> seeds;
        for (std::uint32_t number = 0; number < 10000; ++number)
            seeds.insert(seed_of_run(seed, number));
        CHECK(seeds.size() == 10000);
    }
}
