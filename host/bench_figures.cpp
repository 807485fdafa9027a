#include "bench_figures.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "messages.h"

namespace vkvol {

namespace {

constexpr double one_percent = 1e-4; // relMSE of a root mean square relative error of 1 %

const Measurement* find_default(const BenchResult& result) {
    for (const Measurement& measurement : result.measurements)
        if (measurement.estimator.is_default)
            return &measurement;
    return nullptr;
}

} // namespace

double median_at_largest(const Measurement& measurement, const std::function<double(const RenderResult&)>& figure) {
    const std::uint32_t largest = largest_count(measurement.runs);
    std::vector<double> values;
    for (std::size_t i = 0; i < measurement.runs.size(); ++i)
        if (measurement.runs[i].samples == largest)
            values.push_back(figure(measurement.results[i]));
    return median(std::move(values));
}

double median_of_all(const Measurement& measurement, const std::function<double(const RenderResult&)>& figure) {
    std::vector<double> values;
    for (const RenderResult& result : measurement.results)
        values.push_back(figure(result));
    return median(std::move(values));
}

Figures figures_of(const BenchResult& result, const Measurement& measurement) {
    Figures figures;
    figures.slope = error_slope(measurement.runs);
    figures.floor = bias_floor(measurement.runs, result.reference.offset_error);
    figures.efficiency = efficiency(measurement.runs);
    if (figures.efficiency)
        figures.seconds_to_one_percent = seconds_to(one_percent, *figures.efficiency, figures.floor);
    const Measurement* usual = find_default(result);
    if (usual == &measurement)
        figures.ratio = Interval{1.0, 1.0, 1.0};
    else if (usual)
        figures.ratio = efficiency_ratio(measurement.runs, usual->runs);
    figures.samples_per_second = median_at_largest(measurement, [](const RenderResult& r) {
        return static_cast<double>(r.counts.paths) / std::max(r.render_seconds, 1e-9);
    });
    return figures;
}

namespace {

constexpr std::size_t columns = 9;
using Row = std::array<std::string, columns>;

std::string number_text(std::optional<double> value) {
    return value ? fmt::format("{:.3g}", *value) : "-";
}

std::string interval_text(const std::optional<Interval>& interval) {
    return interval ? fmt::format("{:.3g} ({:.3g} to {:.3g})", interval->value, interval->low, interval->high) : "-";
}

} // namespace

void print_bench(const BenchResult& result) {
    std::vector<Row> rows = {{"integrator", "samples/s", "spp", "relMSE", "slope", "bias floor", "efficiency",
                              "ratio to default", "s to 1 %"}};
    for (const Measurement& measurement : result.measurements) {
        const Figures figures = figures_of(result, measurement);
        const BenchPoint last = points_of(measurement.runs).back();
        rows.push_back({measurement.estimator.integrator, number_text(figures.samples_per_second),
                        fmt::format("{}", last.samples), number_text(last.relmse), interval_text(figures.slope),
                        interval_text(figures.floor), interval_text(figures.efficiency), interval_text(figures.ratio),
                        number_text(figures.seconds_to_one_percent)});
    }
    std::array<std::size_t, columns> widths{};
    for (const Row& row : rows)
        for (std::size_t i = 0; i < columns; ++i)
            widths[i] = std::max(widths[i], row[i].size());
    for (const Row& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < columns; ++i)
            line += fmt::format("{:<{}}{}", row[i], i + 1 < columns ? widths[i] : 0, i + 1 < columns ? "  " : "\n");
        tell(stdout, "{}", line);
    }
    tell(stdout, "relMSE at the most samples per pixel (spp); in brackets 95 % confidence\n");
}

} // namespace vkvol
