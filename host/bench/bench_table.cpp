#include "bench_table.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "bench_findings.h"
#include "messages.h"

namespace vkvol {

namespace {

constexpr std::size_t columns = 8;
using Cells = std::array<std::string, columns>;

std::string name_cell(const Row& row) {
    return row.name() + (row.is_default() ? ", default" : "") + (row.biased().empty() ? "" : ", biased");
}

std::string floor_cell(const Figures& figures) {
    return !figures.floor ? "-" : figures.has_floor() ? interval_text(figures.floor) : "none seen";
}

Cells cells_of(const Row& row, bool default_is_judged) {
    const Figures& figures = row.figures;
    const BenchPoint last = points_of(row.measurement->runs).back();
    std::string efficiency = "too short to judge";
    if (figures.judged) // beside a ratio and its interval the value will do
        efficiency = default_is_judged ? number_text(figures.efficiency->value) : interval_text(figures.efficiency);
    return {name_cell(row),
            number_text(figures.samples_per_second),
            fmt::format("{}", last.samples),
            number_text(last.relmse) + (figures.below_reference ? " !" : ""),
            efficiency,
            row.is_default() && figures.judged ? "1" : interval_text(figures.ratio),
            floor_cell(figures),
            number_text(figures.seconds_to_one_percent)};
}

void print_cells(const std::vector<Cells>& table) {
    std::array<std::size_t, columns> widths{};
    for (const Cells& cells : table)
        for (std::size_t i = 0; i < columns; ++i)
            widths[i] = std::max(widths[i], cells[i].size());
    for (const Cells& cells : table) {
        std::string line;
        for (std::size_t i = 0; i < columns; ++i)
            line += fmt::format("{:<{}}{}", cells[i], i + 1 < columns ? widths[i] : 0, i + 1 < columns ? "  " : "\n");
        tell(stdout, "{}", line);
    }
}

} // namespace

void print_bench(const BenchRequest& request, const BenchResult& result) {
    const std::vector<Row> rows = ranked(rows_of(result));
    const bool default_is_judged =
        std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.is_default() && row.figures.judged; });
    std::vector<Cells> table = {
        {"integrator", "samples/s", "spp", "relMSE", "efficiency", "ratio to default", "bias floor", "s to 1 %"}};
    for (const Row& row : rows)
        table.push_back(cells_of(row, default_is_judged));
    print_cells(table);
    tell(stdout, "relMSE: error at the most samples per pixel (spp). efficiency: 1 / (relMSE x seconds), the geometric "
                 "mean\nof the runs; twice of it is the same picture in half the time. s to 1 %: of rendering, until "
                 "the noise is 1 %. In brackets: 95 % "
                 "confidence.\n\n");
    for (const std::string& finding : findings_of(request, result, rows))
        tell(stdout, "{}\n", finding);
}

} // namespace vkvol
