#include "session.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <new>
#include <stdexcept>
#include <utility>

#include "camera_rays.h"
#include "error.h"
#include "vulkan_error.h"

namespace vkvol {

namespace {

constexpr double noise_seconds = 3.0;         // between two figures of noise
constexpr double least_pause = 0.2;           // seconds between two previews at least
constexpr double preview_share = 1.0 / 100.0; // of the time, for previews,
constexpr double preview_allowance = 0.3;     // and seconds for the first of them
constexpr double preview_growth = 0.15;       // of the time so far, between two: noise has fallen by a fifteenth then
constexpr double patience = 5.0;              // seconds, for paths that will not end
constexpr double least_samples = 16.0;        // per pixel, before noise is checked
constexpr double surely_black = 1 << 22; // samples of all pixels: a picture without any light by then will have none

void add_counts(RenderCounts& total, const shared::Counters& c) {
    total.paths += c.paths;
    total.real_collisions += c.real_collisions;
    total.null_collisions += c.null_collisions;
    total.lookups += c.lookups;
    total.cells += c.cells;
    total.shadow_rays += c.shadow_rays;
    total.room += c.room;
    total.steps += c.steps;
    total.depth_caps += c.depth_caps;
    total.step_caps += c.step_caps;
    total.majorant_violations += c.majorant_violations;
    total.non_finite += c.non_finite;
    total.queue_overflows += c.queue_overflows;
}

} // namespace

// Runs batches of samples over all bands until the samples, the time or the user's patience is used up.
void Session::render(std::uint32_t samples) {
    if (gave_up_)
        throw RenderError(
            "this render cannot be continued: paths were abandoned, because they did not end or a device failed");
    check_ready();
    for (const auto& follower : followers_)
        follower->session->check_ready();
    wanted_ = samples;
    if (next_ == 0) { // nothing was rendered yet
        if (job_.resume)
            resume(*job_.resume);
        next_ = first_batch();
    }
    watch_.lap();
    next_noise_ = noise_seconds;
    next_preview_ = 0.0;
    checkpoint_at_ = 0.0;
    stopped_ = result_.interrupted = result_.time_is_over = false;
    stopped_at_.reset();
    if (job_.progress)
        job_.progress(done_, std::nullopt);
    while (goes_on()) {
        if (batch_ == 0)
            batch_ = std::min({next_, most_batch_, wanted_ - done_, until_next_check(), until_next_moment()});
        const double begun = watch_.seconds();
        try {
            while (band_ < bands_.size() && !stopped_)
                run_band(bands_[band_]);
        } catch (...) { // of this batch the film has some, and nobody knows what
            gave_up_ = true;
            end_rendering();
            result_.interrupted = true;
            throw;
        }
        if (band_ == bands_.size()) {
            const std::uint32_t after = next_batch(batch_, watch_.seconds() - begun);
            const bool was_cut = batch_ < next_ && after >= batch_; // to be looked at, not to be quick
            next_ = was_cut ? std::max(next_, after) : after;
            done_ += std::exchange(batch_, 0);
            band_ = 0;
        }
    }
    end_rendering();
    if (job_.checkpoint && done_ < wanted_ && !result_.reached_goal && !gave_up_)
        save_checkpoint();
    if (done_ >= wanted_ || result_.reached_goal) // what ended it came too late
        result_.interrupted = false;
}

// Between two batches: whether there is another, whose moment is then entered.
bool Session::goes_on() {
    try {
        report_noise();
        if (done_ >= wanted_ || is_good_enough() || stopping())
            return false;
        enter_moments();
        return true;
    } catch (const std::exception&) { // what was rendered outlives a moment that cannot be made ready, say
        end_rendering();
        result_.interrupted = true;
        if (job_.checkpoint)
            save_checkpoint();
        throw;
    }
}

void Session::end_rendering() {
    result_.render_seconds += watch_.lap();
    result_.samples = done_;
}

void Session::begin_again() {
    if (moving_ || job_.checkpoint || job_.resume || !followers_.empty() || gave_up_)
        throw std::logic_error("Session::begin_again: a session of another kind");
    check_ready();
    device_scene_->set_seed(job_.seed);
    for (const Band& band : bands_)
        clear(commands_, band);
    done_ = batch_ = band_ = next_ = 0;
    pixels_ = std::nullopt;
    const std::uint64_t cleaned = result_.counts.cleaned_voxels;
    result_.counts = {};
    result_.counts.cleaned_voxels = cleaned;
    result_.non_finite.clear();
    result_.passes.clear();
    result_.rounds = 0;
    result_.samples = 0;
    result_.render_seconds = preview_seconds_ = 0.0;
    result_.interrupted = result_.reached_goal = false;
}

RenderResult& Session::result() {
    if (!job_.dry_run)
        develop_film();
    if (trace_)
        result_.trace = trace_->records(commands_);
    return result_;
}

// A staged render has a path in each slot from the beginning. Of a fused one few samples of each pixel are worth a
// batch's beginning and end, unless a whole picture is wanted soon; so few that a user can stop them even if they are
// slow.
std::uint32_t Session::first_batch() const {
    const std::uint64_t pixels = std::uint64_t{bands_.front().rows} * width();
    const bool is_urgent = job_.preview || job_.time_limit || !followers_.empty() || method_.paths != PATHS_CAMERA;
    std::uint64_t wanted = 1;
    if (result_.plan.schedule == Schedule::staged)
        wanted = 8 * result_.plan.slots / pixels;
    else if (!is_urgent)
        wanted = std::min<std::uint64_t>((1u << 18) / pixels, 4);
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(wanted, 1, most_batch_));
}

// Long enough that its tail, when few paths are left in flight, matters little, and that lanes have many samples of
// a pixel; short enough for the user: a second, by what the last took.
std::uint32_t Session::next_batch(std::uint32_t batch, double seconds) const {
    if (seconds > 4.0)
        return std::max(batch / 2, 1u);
    const double growth = seconds < 0.1 ? std::min(0.8 / seconds, 64.0) : seconds < 1.0 ? 2.0 : 1.0;
    return static_cast<std::uint32_t>(std::min(batch * growth, double(most_batch_)));
}

void Session::check_resume(std::uint32_t samples) const {
    if (job_.resume && job_.resume->done + job_.resume->batch > samples)
        throw InputError(fmt::format("--resume: the checkpoint has {} samples per pixel already, more than the {} "
                                     "asked for; ask for more with --spp",
                                     job_.resume->done + job_.resume->batch, samples));
}

void Session::resume(const Checkpoint& from) {
    check_resume(wanted_);
    write_bands(commands_, bands_, width(), from.film);
    write_sums(commands_, bands_, width(), from.sums);
    write_layers(commands_, bands_, width(), film_layers_, from.layers);
    done_ = from.done;
    batch_ = from.batch;
    band_ = from.band;
    pixels_ = from.pixels;
    result_.counts = from.counts;
    paths_before_ = from.counts.paths;
    result_.non_finite = from.non_finite;
    result_.render_seconds = from.seconds;
    if (from.schedule == result_.plan.schedule) { // the other has other passes
        result_.passes = from.passes;
        result_.rounds = from.rounds;
    }
}

// One that there is no room for is left out, and the render goes on: pictures take less.
void Session::save_checkpoint() {
    bring_home();
    try {
        make_checkpoint();
    } catch (const std::bad_alloc&) {
        warn_of_checkpoint();
    } catch (const VulkanError& error) {
        if (!error.lacks_memory())
            throw;
        warn_of_checkpoint();
    }
    checkpoint_at_ = watch_.seconds();
}

void Session::warn_of_checkpoint() {
    const std::string warning = "a checkpoint was left out: there is no memory for it; --crop renders parts of a "
                                "picture, which need less";
    if (std::find(result_.warnings.begin(), result_.warnings.end(), warning) == result_.warnings.end())
        result_.warnings.push_back(warning);
}

void Session::make_checkpoint() {
    Checkpoint checkpoint{identity_,
                          done_,
                          batch_,
                          band_,
                          pixels_,
                          read_bands(commands_, bands_, width()),
                          read_sums(commands_, bands_, width()),
                          read_layers(commands_, bands_, width(), film_layers_),
                          result_.counts,
                          result_.non_finite,
                          result_.render_seconds + watch_.seconds(),
                          result_.plan.schedule,
                          result_.passes,
                          result_.rounds};
    job_.checkpoint(checkpoint);
}

bool Session::checkpoint_due() const {
    return job_.checkpoint && watch_.seconds() - checkpoint_at_ >= job_.checkpoint_seconds;
}

// Developing the film takes a while, so not more often than every few seconds.
void Session::report_noise() {
    if (!job_.progress || watch_.seconds() < next_noise_)
        return;
    next_noise_ = watch_.seconds() + noise_seconds;
    develop_pixels();
    job_.progress(done_, relative_noise(result_.film));
}

// Amid a batch some pixels have samples that others wait for: long paths come last. Of several devices the film is only
// whole once all rest.
void Session::offer_preview() {
    if (!job_.preview || watch_.seconds() < next_preview_)
        return;
    const double begun = watch_.seconds();
    try {
        develop_film();
    } catch (const VulkanError& error) { // of a device that has no room for a copy; later there may be
        if (!error.lacks_memory())
            throw;
        next_preview_ = begun + least_pause;
        return;
    } catch (const std::bad_alloc&) { // nor has the host
        next_preview_ = begun + least_pause;
        return;
    }
    result_.samples = done_;
    result_.render_seconds += begun;
    job_.preview(result_);
    result_.render_seconds -= begun;
    preview_seconds_ += watch_.seconds() - begun;
    const double passed = result_.render_seconds + begun;
    next_preview_ = begun + std::max({least_pause, (preview_seconds_ - preview_allowance) / preview_share - passed,
                                      preview_growth * passed});
}

// Where noise is checked: at powers of two of the samples. The fewer checks, the less often one of them ends a render
// that by chance looks better than it is, which is a bias, and which it is does not depend on the machine.
std::uint32_t Session::until_next_check() const {
    return job_.noise_goal ? std::bit_ceil(std::max(done_ + 1, first_check())) - done_ : most_batch_;
}

// What none of N samples met brings less than 3 / N of their paths, at 95 % ("the rule of three"): so many, and more,
// that what is rare, and was met by none, is no more than the noise that is asked for. Else single readings, which a
// sample is but one path of, would often end as constants without noise.
std::uint32_t Session::first_check() const {
    const double pixels = double(width()) * (job_.crop.y1 - job_.crop.y0);
    const double samples = 4.0 / (*job_.noise_goal * pixels);
    return std::bit_ceil(std::uint32_t(std::ceil(std::clamp(samples, least_samples, double(1u << 31)))));
}

bool Session::is_good_enough() {
    if (!job_.noise_goal || batch_ > 0 || done_ < first_check() || !std::has_single_bit(done_))
        return false;
    develop_pixels();
    const std::optional<double> noise = relative_noise(result_.film);
    if (job_.progress)
        job_.progress(done_, noise);
    result_.reached_goal =
        noise ? *noise <= *job_.noise_goal : done_ * double(result_.film.pixel_count()) >= surely_black;
    return result_.reached_goal;
}

bool Session::stopping() {
    if (job_.interrupted && job_.interrupted())
        result_.interrupted = stopped_ = true;
    else if (job_.time_limit && watch_.seconds() >= *job_.time_limit)
        result_.time_is_over = stopped_ = true;
    return stopped_;
}

// Paths begun are finished, as a rule in no time; not if that takes a user's patience. What is missing from the
// picture then is what is long.
bool Session::out_of_patience() {
    const double now = watch_.seconds();
    stopped_at_ = stopped_at_.value_or(now);
    return now - *stopped_at_ >= patience;
}

void Session::begin_band(const Band& band, Rows rows) {
    device_scene_->set_rows(static_cast<std::uint32_t>(job_.crop.y0) + band.first_row, band.rows);
    wavefront_->bind_film(band);
    const std::uint32_t begin = job_.sample_offset + done_;
    if (pixels_)
        wavefront_->begin_batch(begin, begin + batch_, *pixels_);
    else
        wavefront_->begin_batch(begin, begin + batch_, rows.begin * width(), rows.end * width());
}

// A submit, if anything is in flight here. True when nothing is any more, on any device.
bool Session::advance() {
    if (!rests_) {
        rests_ = wavefront_->advance();
        gather();
        share_seconds_ = share_watch_.seconds();
    } else {
        wait_for_followers();
    }
    return rests_ && followers_rest();
}

// The batch under way in one band, or what is left of it. Ends early if the render does, with what is then left in
// pixels_. For a checkpoint it comes to rest in between: a path in flight is nothing that could be kept.
void Session::run_band(const Band& band) {
    if (stopping())
        return;
    if (checkpoint_due())
        save_checkpoint();
    if (method_.paths != PATHS_CAMERA)
        return run_particles(band);
    divide(band);
    const Following following = start_followers();
    share_watch_.lap();
    begin_band(band, rows_of(0));
    rests_ = false;
    for (bool resting = false; !resting;) {
        resting = advance();
        if (job_.progress)
            job_.progress(progress_of(band), std::nullopt);
        if (followers_.empty())
            offer_preview();
        if (!resting && stopping()) {
            give_order(Order::rest);
            gave_up_ = resting = out_of_patience();
            result_.counts.abandoned += gave_up_ ? wavefront_->in_flight() : 0;
        } else if (!resting && checkpoint_due()) {
            give_order(Order::rest);
        }
    }
    pixels_ = wavefront_->pixels_left();
    if (!followers_.empty()) {
        join_followers();
        offer_preview();
    }
    if (pixels_->empty() && !gave_up_) {
        pixels_.reset();
        ++band_;
    }
}

// Likewise where every pixel waits for all particles: a batch is done, or it was not.
void Session::run_particles(const Band& band) {
    const auto counts = result_.counts;
    const std::vector<NonFiniteSample> non_finite = result_.non_finite;
    begin_band(band, {0, band.rows});
    bool over = false;
    while (!over && !(stopping() && out_of_patience())) {
        over = wavefront_->advance();
        gather();
        if (job_.progress)
            job_.progress(progress_of(band), std::nullopt);
    }
    if (over) {
        wavefront_->collect(band.rows * width());
        ++band_;
        offer_preview();
    } else { // nothing of it is in the film
        result_.counts = counts;
        result_.non_finite = non_finite;
    }
}

double Session::progress_of(const Band& band) const {
    const double rows = band.first_row + band.rows * wavefront_->handed_out();
    return done_ + batch_ * rows / (job_.crop.y1 - job_.crop.y0);
}

void Session::gather() {
    const shared::Counters& counters = wavefront_->counters();
    add_counts(result_.counts, counters);
    if (counters.queue_overflows > 0)
        throw RenderError(fmt::format("{} queue items were dropped: this is a defect of vkvol; please report the scene",
                                      counters.queue_overflows));
    for (const PassFigures& pass : wavefront_->passes()) { // some are not there at all moments of what moves
        const auto is_same = [&](const PassFigures& known) { return known.name == pass.name; };
        const auto known = std::find_if(result_.passes.begin(), result_.passes.end(), is_same);
        if (known == result_.passes.end()) {
            result_.passes.push_back(pass);
            continue;
        }
        known->seconds += pass.seconds;
        known->queued += pass.queued;
    }
    result_.rounds += wavefront_->rounds();
    for (std::uint32_t i = 0; i < std::min<std::uint32_t>(counters.non_finite_records, NON_FINITE_RECORDS); ++i) {
        const std::uint32_t place = counters.non_finite_place[i];
        if (result_.non_finite.size() < most_examples)
            result_.non_finite.push_back(
                {static_cast<int>(place & 0xffffu), static_cast<int>(place >> 16u), counters.non_finite_sample[i]});
    }
}

void Session::develop_film() {
    develop_pixels();
    result_.film.layers = develop_layers(film_scene_.plan, read_layers(commands_, bands_, width(), film_scene_.layers),
                                         result_.film.samples, film_scene_.origin);
}

// Without layers, which noise is not judged by.
void Session::develop_pixels() {
    bring_home();
    Film& film = result_.film;
    film.is_premultiplied = scene_.holds_out;
    film.is_correlated = moving_ || method_.paths != PATHS_CAMERA;
    film.picture_width = scene_.picture.width;
    film.picture_height = scene_.picture.height;
    film.crop = job_.crop;
    film.places = reading_places(moving_ ? moving_->camera : scene_.camera, scene_.picture, job_.crop);
    develop(commands_, bands_, width(), film);
    film.sum_variance.reset();
    if (method_.paths != PATHS_CAMERA && !moving_ && done_ > 0)
        if (const auto of_sample = variance_of_sums(read_sums(commands_, bands_, width())))
            film.sum_variance = *of_sample / double(done_);
}

RenderResult render(const Device& device, const Scene& scene, const RenderJob& job) {
    Session session(device, scene, job);
    if (!job.dry_run)
        session.render(scene.settings.spp);
    return std::move(session.result());
}

} // namespace vkvol
