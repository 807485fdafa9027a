#include "bench.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <fmt/format.h>
#include <stdexcept>
#include <utility>

#include "bench_render.h"
#include "bench_report.h"
#include "bench_schedule.h"
#include "bench_table.h"
#include "bench_text.h"
#include "error.h"
#include "file_uses.h"
#include "image_io.h"
#include "input_file.h"
#include "interrupt.h"
#include "messages.h"
#include "render_notes.h"

namespace vkvol {

namespace {

// Odd multipliers and shifts to the right: each step can be undone, so no two numbers meet (the finaliser of
// MurmurHash3).
std::uint32_t mix(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x85ebca6bu;
    x = (x ^ (x >> 13)) * 0xc2b2ae35u;
    return x ^ (x >> 16);
}

double load_average() {
    double load = 0.0;
    return getloadavg(&load, 1) == 1 ? load : 0.0;
}

class Bench {
public:
    explicit Bench(const BenchRequest& request) : request_(request), device_(workshop_.device(request.render.device)) {}

    BenchResult run(const std::vector<Estimator>& estimators);
    const Device& device() const { return device_; }
    // What ended it before its time, if anything did.
    const std::exception_ptr& failure() const { return failure_; }

private:
    void warm_up(const std::vector<Estimator>& estimators);
    Measurement warm_up(const Estimator& estimator);
    void leave_out_slow();
    void announce(double reference_seconds) const;
    std::uint32_t next_seed() { return seed_of_run(request_.render.seed, ++renders_); }
    void run_rounds_to_failure();
    bool get_reference(const std::vector<Estimator>& estimators);
    std::optional<double> measure(std::size_t index, std::uint32_t samples, double time_limit);

    const BenchRequest& request_;
    Workshop workshop_{true};
    const Device& device_;
    BenchSessions sessions_{request_, workshop_};
    BenchResult result_;
    std::vector<double> seconds_per_sample_, setup_seconds_; // of a render
    std::uint32_t renders_ = 0;                              // number of the next seed; 0 is the reference's
    double spent_ = 0.0;
    std::exception_ptr failure_;
};

// One sample that is not measured, for kernels to be compiled and files to be in memory, and then one for the speed.
Measurement Bench::warm_up(const Estimator& estimator) {
    const double hopeless = std::max(request_.seconds, 10.0); // the second render is spared then
    RenderResult result = render_whole(request_, estimator, workshop_, 1, next_seed(), std::nullopt);
    if (!request_.quiet)
        print_warnings(result.warnings);
    Measurement first{estimator, {}, {}, {}, result.load_seconds, result.upload_seconds, result.pipeline_seconds};
    if (result.render_seconds < hopeless)
        result = sessions_.render(estimator, 1, next_seed(), std::nullopt);
    seconds_per_sample_.push_back(result.render_seconds);
    setup_seconds_.push_back(
        sessions_.keeps(estimator) ? 0.0 : result.load_seconds + result.upload_seconds + result.pipeline_seconds);
    return first;
}

// An estimator that nobody asked for is left out if it cannot be rendered after all.
void Bench::warm_up(const std::vector<Estimator>& estimators) {
    for (const Estimator& estimator : estimators) {
        if (interrupted())
            return;
        try {
            result_.measurements.push_back(warm_up(estimator));
        } catch (const std::runtime_error& error) { // input, or memory
            if (!request_.integrators.empty() || estimator.is_default)
                throw;
            if (!request_.quiet)
                tell(stderr, "vkvol: note: {} is left out: {}\n", estimator.integrator, error.what());
        }
    }
}

// Leaves out the slowest that nobody asked for, as long as its share of the time does not suffice for a figure.
void Bench::leave_out_slow() {
    std::vector<Measurement>& list = result_.measurements;
    while (request_.integrators.empty() && list.size() > 1) {
        std::size_t slowest = 0;
        for (std::size_t i = 0; i < list.size(); ++i)
            if (!list[i].estimator.is_default &&
                (list[slowest].estimator.is_default || seconds_per_sample_[i] > seconds_per_sample_[slowest]))
                slowest = i;
        if (is_worth_measuring(seconds_per_sample_[slowest], request_.seconds / double(list.size())))
            return;
        if (!request_.quiet)
            tell(stderr,
                 "vkvol: note: {} is left out: {:.3g} s a sample are too many; give --time {} or more, or name it\n",
                 list[slowest].estimator.integrator, seconds_per_sample_[slowest],
                 round_duration(share_worth_measuring(seconds_per_sample_[slowest]) * double(list.size())));
        sessions_.forget(list[slowest].estimator);
        list.erase(list.begin() + std::ptrdiff_t(slowest));
        seconds_per_sample_.erase(seconds_per_sample_.begin() + std::ptrdiff_t(slowest));
        setup_seconds_.erase(setup_seconds_.begin() + std::ptrdiff_t(slowest));
    }
}

// What the user is in for, from here on.
void Bench::announce(double reference_seconds) const {
    if (request_.quiet || interrupted())
        return;
    const double rounds = expected_seconds(seconds_per_sample_, setup_seconds_, request_.seconds);
    const std::size_t count = result_.measurements.size();
    tell(stderr, "vkvol: {} integrator{} to measure, {:g} s of rendering; {}with setting up, about {} in all\n", count,
         count == 1 ? "" : "s", request_.seconds,
         reference_seconds > 0.0 ? fmt::format("with a reference of {:.3g} s, and ", reference_seconds) : "",
         duration_text(rounds + reference_seconds));
}

bool Bench::get_reference(const std::vector<Estimator>& estimators) {
    // An estimator's largest renders take up to a seventh of its share of the time. Twenty times as long makes the
    // reference's error a tenth of theirs, even if it is made half as efficiently.
    const double part = std::max(0.5, 3.0 / double(seconds_per_sample_.size()));
    const ReferenceWish wish{part * request_.seconds, seed_of_run(request_.render.seed, 0)};
    std::optional<Reference> kept;
    if (!request_.reference)
        kept = find_reference(request_, estimators, wish);
    announce(request_.reference || kept ? 0.0 : wish.seconds);
    if (!request_.reference)
        result_.reference = kept ? std::move(*kept) : make_reference(request_, estimators, workshop_, wish);
    const Reference& reference = result_.reference;
    if (!request_.quiet && !interrupted())
        tell(stderr, "vkvol: reference {}{}: {} samples per pixel{}\n", reference.cached ? "read" : "rendered",
             reference.file.empty() ? "" : ", " + reference.file, reference.samples,
             reference.relmse ? fmt::format(", its own relMSE {:.3g}", *reference.relmse) : "");
    return !reference.interrupted;
}

// A render that the time limit or a signal cut short has pixels of fewer samples, and is no measurement.
std::optional<double> Bench::measure(std::size_t index, std::uint32_t samples, double time_limit) {
    Measurement& measurement = result_.measurements[index];
    const std::uint32_t seed = next_seed();
    RenderResult result = sessions_.render(measurement.estimator, samples, seed, time_limit);
    if (result.interrupted || result.samples < samples) {
        sessions_.forget(measurement.estimator);
        return std::nullopt;
    }
    const Film& reference = result_.reference.film;
    BenchRun run{samples,
                 seed,
                 result.render_seconds,
                 relative_mse(result.film, reference),
                 std::nullopt,
                 relative_noise(result.film)};
    if (samples > 1 && !measurement.estimator.scene.motion_blur) // of what moves it is not the variance that there is
        run.relmse_from_variance = relative_variance(result.film, reference);
    measurement.runs.push_back(run);
    measurement.last = std::exchange(result.film, {});
    measurement.results.push_back(std::move(result));
    spent_ += run.seconds;
    if (!request_.quiet)
        tell(stderr, "vkvol: {:5.1f} of {:g} s: {}, {} samples, relMSE {:.3g}\n", spent_, request_.seconds,
             measurement.estimator.integrator, samples, run.relmse);
    return run.seconds;
}

// What was measured outlives a render that fails.
void Bench::run_rounds_to_failure() {
    try {
        run_rounds(
            seconds_per_sample_, request_.seconds,
            [this](std::size_t index, std::uint32_t samples, double limit) { return measure(index, samples, limit); },
            interrupted);
    } catch (const std::exception&) {
        failure_ = std::current_exception();
    }
}

BenchResult Bench::run(const std::vector<Estimator>& estimators) {
    if (request_.reference)
        result_.reference = read_reference(*request_.reference, estimators);
    result_.load_before = load_average();
    warm_up(estimators);
    leave_out_slow();
    if (!interrupted() && get_reference(estimators))
        run_rounds_to_failure();
    result_.load_after = load_average();
    result_.interrupted = interrupted() || failure_;
    for (const Measurement& measurement : result_.measurements)
        if (measurement.runs.empty() && !result_.interrupted)
            tell(stderr, "vkvol: warning: {}: no render fitted in --time; raise it\n",
                 measurement.estimator.integrator);
    std::erase_if(result_.measurements, [](const Measurement& m) { return m.runs.empty(); });
    return std::move(result_);
}

// Before any work is done.
void check_request(const BenchRequest& request, const std::vector<Estimator>& estimators) {
    // A relMSE of few pixels is a chi-square of few degrees: what is left of it beyond the reference's own is often
    // none.
    constexpr int least_pixels = 32;
    const Picture& picture = estimators.front().scene.picture;
    const std::int64_t pixels = std::int64_t{picture.width} * picture.height;
    if (pixels < least_pixels)
        throw InputError(
            fmt::format("a picture of {} pixels: a bench judges by the errors of {} at least; give the camera or "
                        "sensor more --width and --height",
                        pixels, least_pixels));
    FileUses uses;
    uses.reads("the scene", request.render.scene);
    uses.reads_files_of(estimators.front().scene);
    if (request.reference)
        uses.reads("the reference", *request.reference);
    for (const char* extension : {".bench.json", ".bench.csv"}) {
        check_directory_writable(request.name.string() + extension);
        uses.writes("a table of the bench", request.name.string() + extension, "-o");
    }
    for (const Estimator& estimator : estimators)
        uses.writes("a picture of the bench", bench_picture(request, estimator.integrator), "-o");
    uses.check();
    const std::filesystem::path pictures = picture_folder(request);
    std::error_code error;
    if (std::filesystem::exists(pictures, error) && !std::filesystem::is_directory(pictures, error))
        throw InputError(
            fmt::format("{}: is no folder, and the pictures are to go into one of that name; move it away, "
                        "or give another name with -o",
                        pictures.string()));
}

void print_notes(const BenchRequest& request, const BenchResult& result) {
    if (request.quiet)
        return;
    for (const Measurement& measurement : result.measurements) {
        const RenderResult& last = measurement.results.back();
        if (!last.counts.any_cap())
            continue;
        tell(stderr, "vkvol: note: {}, in its last render:\n", measurement.estimator.integrator);
        RenderRequest as = request.render;
        as.integrator = measurement.estimator.integrator;
        as.seed = measurement.runs.back().seed;
        print_caps(as, last);
    }
    const std::optional<double> own = result.reference.relmse;
    double best = 0.0;
    for (const Measurement& measurement : result.measurements)
        for (const BenchPoint& point : points_of(measurement.runs))
            if (best == 0.0 || point.relmse < best)
                best = point.relmse;
    if (!own)
        tell(stderr,
             "vkvol: warning: the reference does not know its variance: its error counts as the integrators'\n");
    else if (*own > 0.1 * best)
        tell(stderr,
             "vkvol: warning: the reference's own relMSE, {:.3g}, is more than a tenth of the least measured, {:.3g}; "
             "more --time, or a better --reference, makes the figures surer{}\n",
             *own, best, result.reference.cached && !request.reference ? "; --no-cache renders it anew" : "");
}

} // namespace

std::uint32_t seed_of_run(std::uint32_t seed, std::uint32_t number) {
    return mix(number + mix(seed ^ 0x9e3779b9u));
}

int run_bench(const BenchRequest& request) {
    install_interrupt_handler();
    check_read_again(request.render.scene, "bench reads the scene for each integrator");
    const std::vector<Estimator> estimators = find_estimators(request);
    for (const Estimator& estimator : estimators)
        if (!request.quiet && (estimator.is_default || !request.integrators.empty()))
            print_warnings(estimator.scene.warnings);
    check_request(request, estimators);
    Bench bench(request);
    const BenchResult result = bench.run(estimators);
    if (result.measurements.empty() && bench.failure())
        std::rethrow_exception(bench.failure());
    if (result.measurements.empty()) {
        tell(stderr, "vkvol: {}: nothing is written\n",
             result.interrupted ? "interrupted before the first measured render"
                                : "--time is too short for a single render; raise it, or lower --width");
        return result.interrupted ? exit_interrupted : exit_render_failed;
    }
    print_bench(request, result); // first: files may not take it
    print_notes(request, result);
    write_bench(request, bench.device(), result);
    if (bench.failure()) {
        tell(stderr, "vkvol: note: a render failed; what was measured before is written\n");
        std::rethrow_exception(bench.failure());
    }
    check_validation(bench.device());
    return result.interrupted ? exit_interrupted : exit_done;
}

} // namespace vkvol
