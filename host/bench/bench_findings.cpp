#include "bench_findings.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vkvol {

namespace {

using Sentences = std::vector<std::string>;

const Row* find_default(const std::vector<Row>& rows) {
    const auto found = std::find_if(rows.begin(), rows.end(), [](const Row& row) { return row.is_default(); });
    return found == rows.end() ? nullptr : &*found;
}

// Unbiased and judged, best first.
std::vector<const Row*> eligible(const std::vector<Row>& rows) {
    std::vector<const Row*> list;
    for (const Row& row : rows)
        if (row.biased().empty() && row.figures.judged)
            list.push_back(&row);
    return list;
}

Interval inverse(const Interval& x) {
    return {1.0 / x.value, 1.0 / x.high, 1.0 / x.low};
}

void say_default(Sentences& said, const std::vector<Row>& rows) {
    const Row* usual = find_default(rows);
    if (usual && !usual->measurement->estimator.stands_for.empty())
        said.push_back(
            fmt::format("The scene names {}, which is biased. {}, which scenes get that name none, stands for "
                        "it as the default.",
                        usual->measurement->estimator.stands_for, usual->name()));
}

void say_same(Sentences& said, const std::vector<Row>& rows) {
    for (const Row& row : rows)
        if (const std::vector<std::string>& same = row.measurement->estimator.same; !same.empty())
            said.push_back(fmt::format("One and the same in this scene, and measured once: {} = {}.", row.name(),
                                       fmt::join(same, " = ")));
}

void say_reference(Sentences& said, const Reference& reference, const std::vector<Row>& rows) {
    std::string text = "Reference: " + (reference.integrator.empty() ? reference.file : reference.integrator);
    if (reference.samples > 0)
        text += fmt::format(", {} samples per pixel", reference.samples);
    text += reference.relmse ? ", its own relMSE " + number_text(reference.relmse) : ", its own error not known";
    const bool below =
        std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.figures.below_reference; });
    said.push_back(text + (below ? "; it is noisier than what is marked with !." : "."));
    for (const Row& row : rows)
        if (row.name() == reference.integrator)
            said.push_back(fmt::format("The reference was rendered by {}, which is itself measured: an error that it "
                                       "always makes would not show.",
                                       row.name()));
}

void say_bias(Sentences& said, const Row& row) {
    const std::optional<Interval>& floor = row.figures.floor;
    const std::string who = fmt::format("{} is biased ({})", row.name(), row.biased());
    if (!floor || floor->high <= 0.0)
        said.push_back(who + "; how much was not measured.");
    else if (row.figures.has_floor())
        said.push_back(fmt::format("{}: no number of samples brings its relMSE below {}, an error of {} %.", who,
                                   interval_text(floor), number_text(100.0 * std::sqrt(floor->value))));
    else
        said.push_back(fmt::format("{}, by less than shows here: at most a relMSE of {}, an error of {} %.", who,
                                   number_text(floor->high), number_text(100.0 * std::sqrt(floor->high))));
}

void say_floors(Sentences& said, const std::vector<Row>& rows) {
    Sentences floors;
    for (const Row& row : rows)
        if (!row.biased().empty())
            say_bias(said, row);
        else if (row.figures.has_floor())
            floors.push_back(fmt::format("{} {}", row.name(), interval_text(row.figures.floor)));
    if (!floors.empty())
        said.push_back(
            fmt::format("Counted as unbiased, yet more samples would leave a relMSE: {}. A bias, rare bright "
                        "samples, or an error of the reference.",
                        fmt::join(floors, ", ")));
}

// The error of independent samples falls as 1 / seconds. Where it fell faster, each doubling of the samples took less
// than twice the seconds: what every render costs at least was much of its time.
void say_short_renders(Sentences& said, const std::vector<Row>& rows) {
    constexpr double steep = -1.1; // 7 % more than half the error in twice the time
    Sentences names;
    for (const Row& row : rows)
        if (row.figures.judged && row.figures.slope && row.figures.slope->high < steep)
            names.push_back(row.name());
    if (!names.empty())
        said.push_back(
            fmt::format("Starting up was much of these renders' time: {}. Longer ones are more efficient than "
                        "the figures say; a longer --time measures them.",
                        fmt::join(names, ", ")));
}

// Part of the smallest squared difference that was measured.
double reference_share(const Reference& reference, const std::vector<Row>& rows) {
    const double own = reference.relmse.value_or(0.0);
    double share = 0.0;
    for (const Row& row : rows)
        if (own > 0.0)
            share = std::max(share, own / (own + std::max(points_of(row.measurement->runs).back().relmse, 0.0)));
    return share;
}

// The most efficient of `list`, which were judged, best first, and all that may well be as efficient.
std::string most_efficient(const std::vector<const Row*>& list, const Reference& reference) {
    Sentences names;
    for (const Row* row : list)
        if (row == list.front() ||
            !excludes_one(efficiency_ratio(row->measurement->runs, list.front()->measurement->runs,
                                           reference.offset_error, probability_of_each(list.size() - 1))))
            names.push_back(row->name());
    return names.size() == 1 ? fmt::format("use {}, the most efficient unbiased integrator of those", names.front())
                             : fmt::format("use one of {}, whose efficiencies do not differ measurably, the most "
                                           "efficient unbiased integrators of those",
                                           fmt::join(names, ", "));
}

std::string compare_with_others(const std::string& scene, const Row& usual, const std::vector<const Row*>& others) {
    if (others.empty())
        return fmt::format("For {} use {}, its default, the only unbiased integrator that was judged.", scene,
                           usual.name());
    const Row& next = *others.front();
    const std::optional<Interval>& ratio = next.figures.ratio;
    if (!ratio)
        return fmt::format("For {} stay with {}, its default: too few runs to compare it with {}.", scene, usual.name(),
                           next.name());
    if (!excludes_one(ratio))
        return fmt::format("For {} stay with {}, its default: no measurable difference from {} ({} times its "
                           "efficiency).",
                           scene, usual.name(), next.name(), interval_text(ratio));
    return fmt::format("For {} use {}, its default: {} times the efficiency of the next best, {}.", scene, usual.name(),
                       interval_text(inverse(*ratio)), next.name());
}

std::string verdict(const std::string& scene, const Reference& reference, const std::vector<Row>& rows,
                    const std::string& longer) {
    const std::vector<const Row*> list = eligible(rows);
    if (const double share = reference_share(reference, rows); share > 0.5)
        return fmt::format("For {} the reference is too noisy to rank the integrators: {} % of the smallest squared "
                           "difference is its own error. Give a longer --time, or a better --reference.",
                           scene, number_text(100.0 * share));
    if (std::none_of(rows.begin(), rows.end(), [](const Row& row) { return row.biased().empty(); }))
        return fmt::format("All that was measured for {} is biased; name an unbiased integrator too.", scene);
    if (list.empty())
        return fmt::format("Too short to choose an integrator for {}: give --time {} or more.", scene, longer);
    const Row* usual = find_default(rows);
    if (!usual)
        return fmt::format("For {} {} measured; the scene's default is not among them.", scene,
                           most_efficient(list, reference));
    if (!usual->figures.judged)
        return fmt::format("For {} {} judged, until a longer bench judges {}, its default, too.", scene,
                           most_efficient(list, reference), usual->name());
    std::vector<const Row*> others, better;
    for (const Row* row : list) {
        if (row->is_default())
            continue;
        others.push_back(row);
        if (excludes_one(row->figures.ratio) && row->figures.ratio->value > 1.0)
            better.push_back(row);
    }
    if (!better.empty())
        return fmt::format("For {} use {}: {} times the efficiency of {}, its default.", scene, better.front()->name(),
                           interval_text(better.front()->figures.ratio), usual->name());
    return compare_with_others(scene, *usual, others);
}

} // namespace

std::vector<std::string> findings_of(const BenchRequest& request, const BenchResult& result,
                                     const std::vector<Row>& rows) {
    Sentences said, unjudged;
    say_default(said, rows);
    say_same(said, rows);
    say_reference(said, result.reference, rows);
    say_floors(said, rows);
    say_short_renders(said, rows);
    for (const Row& row : rows)
        if (!row.figures.judged)
            unjudged.push_back(row.name());
    const std::string longer = round_duration(seconds_to_judge(rows, request.seconds).value_or(0.0));
    if (!unjudged.empty() && unjudged.size() < rows.size())
        said.push_back(
            fmt::format("Too short to judge {}: give --time {} or more.", fmt::join(unjudged, ", "), longer));
    said.push_back(verdict(request.render.scene.stem().string(), result.reference, rows, longer));
    return said;
}

} // namespace vkvol
