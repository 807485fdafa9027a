// The figures that are drawn from an estimator's runs.
#pragma once

#include <functional>

#include "bench.h"

namespace vkvol {

struct Figures {
    std::optional<Interval> slope, efficiency;
    std::optional<Interval> floor; // all estimators' together hold the truth with 95 %
    std::optional<Interval> ratio; // of efficiencies, to the default's; nothing unless both are judged
    double times_to_judge = 1.0;   // see bench_statistics.h
    bool judged = false;
    bool below_reference = false; // its relMSE, at the most samples, is less than the reference's own
    std::optional<double> noise;  // of a picture of the most samples
    std::optional<double> seconds_to_one_percent;
    double samples_per_second = 0.0;

    bool has_floor() const { return floor && floor->low > 0.0; }
};

struct Row {
    const Measurement* measurement;
    Figures figures;

    const std::string& name() const { return measurement->estimator.integrator; }
    bool is_default() const { return measurement->estimator.is_default; }
    const std::string& biased() const { return measurement->results.back().biased; }
};

// In the order of the result, which is to outlive them.
std::vector<Row> rows_of(const BenchResult& result);

// Unbiased ones first, and of these the judged ones, by efficiency.
std::vector<Row> ranked(std::vector<Row> rows);

// The --time that judges them all, if `seconds` did not.
std::optional<double> seconds_to_judge(const std::vector<Row>& rows, double seconds);

// Median over the runs with the most samples.
double median_at_largest(const Measurement& measurement, const std::function<double(const RenderResult&)>& figure);

} // namespace vkvol
