// What a bench says of figures that are known.
#include <catch2/catch.hpp>

#include <cmath>
#include <fmt/ranges.h>

#include "bench_findings.h"

using namespace vkvol;
using Catch::Contains;

namespace {

// Eight runs of each of 4, 8, ..., 64 samples, relMSE = floor + variance / samples with a little scatter, at a second a
// sample.
Measurement measured(const std::string& name, double variance, double floor = 0.0, int runs = 8) {
    Measurement measurement;
    measurement.estimator.integrator = name;
    for (std::uint32_t samples = 4; samples <= 64; samples *= 2)
        for (int i = 0; i < runs; ++i) {
            const double own = variance / samples, scatter = 1.0 + 0.01 * (i % 2 ? 1 : -1);
            measurement.runs.push_back({samples, 0, double(samples), floor + own * scatter, own, std::sqrt(own)});
            measurement.results.emplace_back();
        }
    return measurement;
}

Measurement default_of(Measurement measurement) {
    measurement.estimator.is_default = true;
    return measurement;
}

Measurement biased(Measurement measurement, const std::string& why) {
    for (RenderResult& result : measurement.results)
        result.biased = why;
    return measurement;
}

// One run of one sample, as from a bench of seconds.
Measurement hasty(const std::string& name) {
    Measurement measurement = measured(name, 1.0 / 48.0);
    measurement.runs.resize(2);
    measurement.results.resize(2);
    measurement.runs[0].relmse *= 4.0;
    return measurement;
}

BenchResult bench_of(std::vector<Measurement> measurements, double own = 1e-6) {
    BenchResult result;
    result.measurements = std::move(measurements);
    result.reference.integrator = "regularTracking";
    result.reference.samples = 1000;
    result.reference.relmse = own;
    return result;
}

std::vector<std::string> said_of(const BenchResult& result) {
    BenchRequest options;
    options.render.scene = "scenes/cloud.xml";
    options.seconds = 60.0;
    return findings_of(options, result, ranked(rows_of(result)));
}

std::string all_of(const std::vector<std::string>& said) {
    return fmt::format("{}", fmt::join(said, "\n"));
}

} // namespace

TEST_CASE("rows are ranked: unbiased, judged, efficient", "[cpu][bench]") {
    const BenchResult result =
        bench_of({hasty("hasty"), default_of(measured("usual", 1.0)), biased(measured("march", 0.01, 0.1), "steps"),
                  measured("good", 0.5), measured("poor", 3.0)});
    std::vector<std::string> names;
    for (const Row& row : ranked(rows_of(result)))
        names.push_back(row.name());
    CHECK(names == std::vector<std::string>{"good", "usual", "poor", "hasty", "march"});
}

TEST_CASE("the last sentence says what to use", "[cpu][bench]") {
    const Measurement usual = default_of(measured("usual", 1.0));
    SECTION("what is measurably better than the default") {
        const std::string last = said_of(bench_of({usual, measured("good", 0.5), measured("poor", 3.0)})).back();
        CHECK_THAT(last, Contains("For cloud use good: 2 (") && Contains("times the efficiency of usual, its default"));
    }
    SECTION("the default, if nothing is") {
        CHECK_THAT(said_of(bench_of({usual, measured("like", 0.999)})).back(),
                   Contains("stay with usual") && Contains("no measurable difference from like"));
        CHECK_THAT(said_of(bench_of({usual, measured("poor", 3.0)})).back(),
                   Contains("use usual, its default: 3 (") && Contains("the next best, poor"));
        CHECK_THAT(said_of(bench_of({usual})).back(), Contains("the only unbiased integrator that was judged"));
    }
    SECTION("never a biased one, and no other of a bench too short") {
        const std::vector<std::string> said =
            said_of(bench_of({usual, hasty("hasty"), biased(measured("march", 0.01, 0.1), "steps")}));
        CHECK_THAT(said.back(), Contains("use usual"));
        CHECK_THAT(all_of(said), Contains("Too short to judge hasty: give --time ") && !Contains("48"));
        CHECK_THAT(all_of(said), Contains("march is biased (steps): no number of samples brings its relMSE below 0.1"));
        CHECK_THAT(said_of(bench_of({default_of(hasty("usual")), hasty("other")})).back(),
                   Contains("Too short to choose an integrator for cloud: give --time "));
        CHECK_THAT(said_of(bench_of({default_of(hasty("usual")), measured("good", 1.0)})).back(),
                   Contains("use good") && Contains("until a longer bench judges usual"));
    }
    SECTION("without the default, all that may be the best") {
        CHECK_THAT(said_of(bench_of({measured("good", 1.0), measured("like", 0.999), measured("poor", 3.0)})).back(),
                   Contains("use one of like, good, whose efficiencies do not differ measurably"));
        CHECK_THAT(said_of(bench_of({measured("good", 1.0), measured("poor", 3.0)})).back(),
                   Contains("use good, the most efficient unbiased integrator of those measured"));
    }
    SECTION("none by a reference that is noisier than what it judges") {
        const std::vector<std::string> said = said_of(bench_of({usual, measured("good", 0.5)}, 0.01));
        CHECK_THAT(said.back(), Contains("too noisy to rank"));
        CHECK_THAT(all_of(said), Contains("noisier than what is marked with !"));
        CHECK(rows_of(bench_of({usual}, 0.01)).front().figures.judged);
    }
}

TEST_CASE("renders that mostly start up are called that", "[cpu][bench]") {
    Measurement slow = default_of(measured("slow to start", 1.0));
    CHECK_THAT(all_of(said_of(bench_of({slow}))), !Contains("Starting up"));
    for (BenchRun& run : slow.runs)
        run.seconds += 20.0; // a third of the longest
    CHECK_THAT(all_of(said_of(bench_of({slow}))),
               Contains("Starting up was much of these renders' time: slow to start."));
}

TEST_CASE("what else there is to know of the rows is said", "[cpu][bench]") {
    Measurement usual = default_of(measured("usual", 1.0));
    usual.estimator.same = {"alike", "too"};
    usual.estimator.stands_for = "march";
    BenchResult result = bench_of({usual, measured("floored", 1.0, 0.02)});
    result.reference.integrator = "floored";
    const std::string said = all_of(said_of(result));
    CHECK_THAT(said, Contains("measured once: usual = alike = too."));
    CHECK_THAT(said, Contains("The scene names march, which is biased."));
    CHECK_THAT(said, Contains("Counted as unbiased, yet more samples would leave a relMSE: floored 0.02"));
    CHECK_THAT(said, Contains("rendered by floored, which is itself measured"));
}

TEST_CASE("a bench's numbers hold what they promise", "[cpu][bench]") {
    CHECK(number_text(12345.6) == "12300");
    CHECK(number_text(1.8449) == "1.84");
    CHECK(number_text(4.06e-6) == "4.06e-06");
    CHECK(number_text(std::nullopt) == "-");
    CHECK(interval_text(Interval{2.0, 1.23956, 2.71128}) == "2 (1.23 to 2.72)");
    CHECK(interval_text(Interval{-1.0, -1.2345, -0.98765}) == "-1 (-1.24 to -0.987)");
    CHECK_FALSE(excludes_one(Interval{1.05, 1.0004, 1.1})); // would be printed 1 to 1.1
    CHECK(excludes_one(Interval{1.05, 1.012, 1.1}));
    CHECK(excludes_one(Interval{0.9, 0.8, 0.98}));
    CHECK(round_duration(0.5) == "1s");
    CHECK(round_duration(46.0) == "1m");
    CHECK(round_duration(100.0) == "2m");
    CHECK(round_duration(3000.0) == "1h");
    CHECK(round_duration(9000.0) == "3h");
    CHECK(duration_text(61.2) == "62 s");
    CHECK(duration_text(190.0) == "3.2 min");
    CHECK(duration_text(9000.0) == "2.5 h");
}
