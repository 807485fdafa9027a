#include "bench_figures.h"

#include <algorithm>
#include <tuple>

namespace vkvol {

double median_at_largest(const Measurement& measurement, const std::function<double(const RenderResult&)>& figure) {
    const std::uint32_t largest = largest_count(measurement.runs);
    std::vector<double> values;
    for (std::size_t i = 0; i < measurement.runs.size(); ++i)
        if (measurement.runs[i].samples == largest)
            values.push_back(figure(measurement.results[i]));
    return median(std::move(values));
}

namespace {

std::optional<double> median_noise(const std::vector<BenchRun>& runs) {
    std::vector<double> values;
    for (const BenchRun& run : runs)
        if (run.samples == largest_count(runs) && run.noise)
            values.push_back(*run.noise);
    return values.empty() ? std::nullopt : std::optional(median(std::move(values)));
}

Figures own_figures(const BenchResult& result, const Measurement& measurement) {
    const std::vector<BenchRun>& runs = measurement.runs;
    Figures figures;
    figures.slope = error_slope(runs);
    figures.efficiency = efficiency(runs, result.reference.offset_error);
    figures.times_to_judge = times_to_judge(runs);
    figures.judged = figures.times_to_judge <= 1.0;
    figures.below_reference = result.reference.relmse.value_or(0.0) > points_of(runs).back().relmse;
    figures.noise = median_noise(runs);
    figures.seconds_to_one_percent = seconds_to_noise(0.01, runs);
    figures.samples_per_second = median_at_largest(measurement, [](const RenderResult& r) {
        return static_cast<double>(r.counts.paths) / std::max(r.render_seconds, 1e-9);
    });
    return figures;
}

void find_floors(std::vector<Row>& rows, double offset_error) {
    const auto floor_of = [&](const Row& row, double probability) {
        return bias_floor(row.measurement->runs, offset_error, probability);
    };
    const auto tested = std::count_if(rows.begin(), rows.end(), [&](const Row& row) { return floor_of(row, 0.95); });
    for (Row& row : rows)
        row.figures.floor = floor_of(row, probability_of_each(std::size_t(tested)));
}

void find_ratios(std::vector<Row>& rows, double offset_error) {
    const auto usual = std::find_if(rows.begin(), rows.end(), [](const Row& row) { return row.is_default(); });
    if (usual == rows.end() || !usual->figures.judged)
        return;
    // The best of many ratios is named: their intervals hold together.
    const auto others =
        std::count_if(rows.begin(), rows.end(), [](const Row& row) { return row.figures.judged && !row.is_default(); });
    for (Row& row : rows)
        if (row.is_default())
            row.figures.ratio = Interval{1.0, 1.0, 1.0};
        else if (row.figures.judged)
            row.figures.ratio = efficiency_ratio(row.measurement->runs, usual->measurement->runs, offset_error,
                                                 probability_of_each(std::size_t(others)));
}

} // namespace

std::vector<Row> rows_of(const BenchResult& result) {
    std::vector<Row> rows;
    for (const Measurement& measurement : result.measurements)
        rows.push_back({&measurement, own_figures(result, measurement)});
    find_floors(rows, result.reference.offset_error);
    find_ratios(rows, result.reference.offset_error);
    return rows;
}

std::vector<Row> ranked(std::vector<Row> rows) {
    const auto rank = [](const Row& row) {
        const double efficiency = row.figures.efficiency ? row.figures.efficiency->value : 0.0;
        return std::tuple(!row.biased().empty(), !row.figures.judged, -efficiency);
    };
    std::stable_sort(rows.begin(), rows.end(), [&](const Row& a, const Row& b) { return rank(a) < rank(b); });
    return rows;
}

std::optional<double> seconds_to_judge(const std::vector<Row>& rows, double seconds) {
    double times = 1.0;
    for (const Row& row : rows)
        times = std::max(times, row.figures.times_to_judge);
    return times > 1.0 ? std::optional(times * seconds) : std::nullopt;
}

} // namespace vkvol
