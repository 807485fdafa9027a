// The figures that are drawn from an estimator's runs, and the table of them.
#pragma once

#include <functional>

#include "bench.h"

namespace vkvol {

struct Figures {
    std::optional<Interval> slope, floor, efficiency;
    std::optional<Interval> ratio; // of efficiencies, to the default's; nothing if that was not measured
    std::optional<double> seconds_to_one_percent;
    double samples_per_second = 0.0;
};

// `measurement` is one of the result's.
Figures figures_of(const BenchResult& result, const Measurement& measurement);

// Medians over all runs, and over those with the most samples.
double median_of_all(const Measurement& measurement, const std::function<double(const RenderResult&)>& figure);
double median_at_largest(const Measurement& measurement, const std::function<double(const RenderResult&)>& figure);

// To standard output.
void print_bench(const BenchResult& result);

} // namespace vkvol
