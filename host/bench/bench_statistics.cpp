#include "bench_statistics.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "student_t.h"

namespace vkvol {

namespace {

constexpr double epsilon = 0.01; // as in compare

// Calls visit(pixel, channel, 1 / (R^2 + epsilon)) for what counts, and returns how many that were.
template <typename Visit> double visit_values(const Film& image, const Film& reference, const Visit& visit) {
    const bool counted = std::any_of(reference.samples.begin(), reference.samples.end(), [](auto n) { return n > 0; });
    double count = 0.0;
    for (std::size_t i = 0; i < reference.pixel_count(); ++i) {
        if (counted && reference.samples[i] < 2)
            continue;
        for (int c = 0; c < 3; ++c) {
            const double r = reference.mean[i][c];
            if (!std::isfinite(r) || !std::isfinite(reference.variance[i][c]) || !std::isfinite(image.mean[i][c]))
                continue;
            visit(i, c, 1.0 / (r * r + epsilon));
            count += 1.0;
        }
    }
    return count;
}

double square(double x) {
    return x * x;
}

bool all_positive(std::span<const BenchRun> runs) {
    return std::all_of(runs.begin(), runs.end(), [](const BenchRun& r) { return r.relmse > 0.0 && r.seconds > 0.0; });
}

// Mean of log 1 / (relMSE seconds), weighted by seconds, and its standard error; and by how much it falls where all
// relMSE are larger by 1, the mean of 1 / relMSE.
struct LogEfficiency {
    double mean = 0.0, error = 0.0, freedom = 0.0, slope = 0.0;
};

std::optional<LogEfficiency> log_efficiency(std::span<const BenchRun> runs) {
    if (runs.size() < 2 || !all_positive(runs))
        return std::nullopt;
    double sum = 0.0;
    for (const BenchRun& run : runs)
        sum += run.seconds;
    LogEfficiency result;
    double squares = 0.0; // of the weights
    for (const BenchRun& run : runs) {
        result.mean -= run.seconds / sum * std::log(run.relmse * run.seconds);
        result.slope += run.seconds / sum / run.relmse;
        squares += square(run.seconds / sum);
    }
    double scatter = 0.0;
    for (const BenchRun& run : runs)
        scatter += run.seconds / sum * square(-std::log(run.relmse * run.seconds) - result.mean);
    // E[sum w (y - mean)^2] = sigma^2 (1 - sum w^2), and the mean has variance sigma^2 sum w^2.
    result.error = std::sqrt(scatter / (1.0 - squares) * squares);
    result.freedom = 1.0 / squares - 1.0;
    return result;
}

Interval exponential(double mean, double half_width) {
    return {std::exp(mean), std::exp(mean - half_width), std::exp(mean + half_width)};
}

} // namespace

double relative_mse(const Film& image, const Film& reference) {
    double sum = 0.0;
    const double count = visit_values(image, reference, [&](std::size_t i, int c, double weight) {
        sum += (square(double(image.mean[i][c]) - reference.mean[i][c]) - reference.variance[i][c]) * weight;
    });
    return sum / std::max(count, 1.0);
}

double relative_variance(const Film& image, const Film& reference) {
    double sum = 0.0;
    const double count = visit_values(
        image, reference, [&](std::size_t i, int c, double weight) { sum += image.variance[i][c] * weight; });
    return sum / std::max(count, 1.0);
}

double reference_offset_error(const Film& reference) {
    std::vector<double> of_pixel(reference.pixel_count(), 0.0);
    const double count = visit_values(reference, reference, [&](std::size_t i, int c, double weight) {
        of_pixel[i] += reference.variance[i][c] * weight;
    });
    double squares = 0.0;
    for (const double r : of_pixel)
        squares += 2.0 * r * r;
    return std::sqrt(squares) / std::max(count, 1.0);
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

std::uint32_t largest_count(std::span<const BenchRun> runs) {
    std::uint32_t most = 0;
    for (const BenchRun& run : runs)
        most = std::max(most, run.samples);
    return most;
}

std::vector<BenchPoint> points_of(std::span<const BenchRun> runs) {
    std::map<std::uint32_t, std::vector<const BenchRun*>> by_samples;
    for (const BenchRun& run : runs)
        by_samples[run.samples].push_back(&run);
    std::vector<BenchPoint> points;
    for (const auto& [samples, group] : by_samples) {
        const double n = double(group.size());
        BenchPoint point;
        point.samples = samples;
        point.runs = group.size();
        std::vector<double> seconds;
        double predicted = 0.0;
        bool has_variance = true;
        for (const BenchRun* run : group) {
            seconds.push_back(run->seconds);
            point.relmse += run->relmse / n;
            has_variance = has_variance && run->relmse_from_variance;
            predicted += run->relmse_from_variance.value_or(0.0) / n;
        }
        double squares = 0.0;
        for (const BenchRun* run : group)
            squares += square(run->relmse - point.relmse);
        if (group.size() > 1)
            point.relmse_error = std::sqrt(squares / (n - 1.0) / n);
        if (has_variance)
            point.relmse_from_variance = predicted;
        point.seconds = median(seconds);
        const auto [low, high] = std::minmax_element(seconds.begin(), seconds.end());
        point.seconds_low = *low;
        point.seconds_high = *high;
        points.push_back(point);
    }
    return points;
}

std::optional<Interval> error_slope(std::span<const BenchRun> runs) {
    if (runs.size() < 3 || !all_positive(runs))
        return std::nullopt;
    std::map<std::uint32_t, double> log_seconds;
    for (const BenchPoint& point : points_of(runs))
        log_seconds[point.samples] = std::log(point.seconds);
    double sum = 0.0, mean_x = 0.0, mean_y = 0.0;
    for (const BenchRun& run : runs) {
        sum += run.samples;
        mean_x += run.samples * log_seconds[run.samples];
        mean_y += run.samples * std::log(run.relmse);
    }
    mean_x /= sum;
    mean_y /= sum;
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (const BenchRun& run : runs) {
        const double x = log_seconds[run.samples] - mean_x, y = std::log(run.relmse) - mean_y;
        xx += run.samples * x * x;
        xy += run.samples * x * y;
        yy += run.samples * y * y;
    }
    if (!(xx > 0.0))
        return std::nullopt; // one count
    const double slope = xy / xx;
    const double freedom = double(runs.size()) - 2.0;
    const double residuals = std::max(0.0, yy - slope * xy);
    const double half_width = student_t95(freedom) * std::sqrt(residuals / freedom / xx);
    return Interval{slope, slope - half_width, slope + half_width};
}

double probability_of_each(std::size_t count) {
    return std::pow(0.95, 1.0 / double(std::max<std::size_t>(1, count)));
}

namespace {

// Of a weighted mean whose parts scatter by no known law: each by its own square (MacKinnon and White 1985, HC2).
// Beside a bias b a run's error e adds 2 b e to its difference, with variance in proportion to 1 / n: of so many runs,
// as far as these are alike, the scatter is known. Weights are n (n - 1).
double half_width_beside_floor(std::span<const double> differences, std::span<const double> weights, double mean,
                               double probability) {
    double sum = 0.0, scatter = 0.0, parts = 0.0, squares = 0.0;
    for (const double weight : weights)
        sum += weight;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        scatter += square(weights[i] * (differences[i] - mean)) / std::max(1.0 - weights[i] / sum, 1e-9);
        const double part = std::pow(weights[i], 1.5); // weight^2 / n, n about sqrt(weight)
        parts += part;
        squares += square(part);
    }
    const double freedom = std::max(square(parts) / squares - 1.0, 1.0);
    return student_two_sided(freedom, probability) * std::sqrt(scatter) / sum;
}

} // namespace

std::optional<Interval> bias_floor(std::span<const BenchRun> runs, double offset_error, double probability) {
    std::vector<double> differences, weights;
    for (const BenchRun& run : runs)
        if (run.relmse_from_variance) {
            differences.push_back(run.relmse - *run.relmse_from_variance);
            weights.push_back(double(run.samples) * (run.samples - 1.0));
        }
    if (differences.size() < 2)
        return std::nullopt;
    double sum = 0.0, mean = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < differences.size(); ++i) {
        sum += weights[i];
        mean += weights[i] * differences[i];
    }
    mean /= sum;
    for (std::size_t i = 0; i < differences.size(); ++i)
        squares += weights[i] * square(differences[i] - mean);
    const double freedom = double(differences.size()) - 1.0;
    double half_width = student_two_sided(freedom, probability) * std::sqrt(squares / freedom / sum);
    if (mean > half_width) // there is a floor
        half_width = std::max(half_width, half_width_beside_floor(differences, weights, mean, probability));
    half_width = std::hypot(half_width, normal_two_sided(probability) * offset_error);
    return Interval{mean, mean - half_width, mean + half_width};
}

std::optional<Interval> efficiency(std::span<const BenchRun> runs, double offset_error) {
    const std::optional<LogEfficiency> log = log_efficiency(runs);
    if (!log)
        return std::nullopt;
    return exponential(log->mean, std::hypot(student_t95(log->freedom) * log->error,
                                             normal_two_sided(0.95) * offset_error * log->slope));
}

std::optional<Interval> efficiency_ratio(std::span<const BenchRun> runs, std::span<const BenchRun> base,
                                         double offset_error, double probability) {
    const std::optional<LogEfficiency> a = log_efficiency(runs), b = log_efficiency(base);
    if (!a || !b)
        return std::nullopt;
    const double variance = square(a->error) + square(b->error);
    const double spread = square(square(a->error)) / a->freedom + square(square(b->error)) / b->freedom;
    const double freedom = spread > 0.0 ? square(variance) / spread : std::min(a->freedom, b->freedom);
    return exponential(a->mean - b->mean,
                       std::hypot(student_two_sided(freedom, probability) * std::sqrt(variance),
                                  normal_two_sided(probability) * offset_error * (a->slope - b->slope)));
}

double times_to_judge(std::span<const BenchRun> runs) {
    constexpr double fewest = 4.0, wanted = 5.0; // effective runs
    const std::optional<LogEfficiency> log = log_efficiency(runs);
    if (!log) // one run, or the reference is no better than the runs: it grows with the bench
        return std::max(2.0, wanted / std::max(1.0, double(runs.size())));
    const double most = std::log(3.0), half_width = student_t95(log->freedom) * log->error;
    const double effective = log->freedom + 1.0;
    if (effective >= fewest && half_width <= most)
        return 1.0;
    const double then = student_t95(std::max(log->freedom, wanted - 1.0)) * log->error;
    return std::max({1.0 + 1e-6, wanted / effective, square(then / most)});
}

std::optional<double> seconds_to_noise(double target, std::span<const BenchRun> runs) {
    std::vector<double> seconds;
    for (const BenchRun& run : runs)
        if (run.samples == largest_count(runs) && run.noise)
            seconds.push_back(square(*run.noise / target) * run.seconds);
    return seconds.empty() ? std::nullopt : std::optional(median(std::move(seconds)));
}

} // namespace vkvol
