// The part of Session that shares bands among devices. Each other device has a session of its own, which follows the
// first: it renders rows of each band for as many samples, in a thread of its own, and keeps what it has rendered. Rows
// go from one device to another only where shares change, and to the first where the whole film is asked for.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <future>
#include <iterator>
#include <numeric>
#include <system_error>
#include <thread>
#include <utility>

#include "error.h"
#include "session.h"
#include "workshop.h"

namespace vkvol {

namespace {

// A machine that has too many threads may have fewer in a moment.
std::future<void> begin_thread(const std::function<void()>& work) {
    constexpr int most = 20;
    constexpr std::chrono::milliseconds pause(100);
    for (int i = 1;; ++i)
        try {
            return std::async(std::launch::async, work);
        } catch (const std::system_error&) {
            if (i == most)
                throw;
            std::this_thread::sleep_for(pause);
        }
}

std::vector<std::uint32_t> rows_of_bands(const std::vector<Band>& bands) {
    std::vector<std::uint32_t> rows;
    for (const Band& band : bands)
        rows.push_back(band.rows);
    return rows;
}

// From which row on each of several members has its share of `rows`, by their speeds, and the end. All have something
// to do, so that their speeds are known, as far as there are rows enough.
std::vector<std::uint32_t> edges_by(const std::vector<double>& speeds, std::uint32_t rows) {
    const double total = std::accumulate(speeds.begin(), speeds.end(), 0.0);
    const bool is_known = std::all_of(speeds.begin(), speeds.end(), [](double speed) { return speed > 0.0; });
    std::vector<std::uint32_t> edges{0};
    double sum = 0.0;
    for (std::size_t i = 0; i < speeds.size(); ++i) {
        sum += is_known ? speeds[i] / total : 1.0 / double(speeds.size());
        const std::size_t after = speeds.size() - 1 - i;
        const auto edge = static_cast<std::uint32_t>(std::lround(rows * std::min(sum, 1.0)));
        const auto most = static_cast<std::uint32_t>(rows > after ? rows - after : 1);
        edges.push_back(std::min(std::max(std::min(edge, most), edges.back() + 1), rows));
    }
    edges.back() = rows;
    return edges;
}

} // namespace

void Session::make_followers(const Scene& scene) {
    if (job_.others.empty())
        return;
    if (method_.paths != PATHS_CAMERA)
        throw InputError("--device: light particles reach any pixel, and pixels are what several devices share; render "
                         "with one, or ranges of samples (--sample-offset) on each, and merge them");
    for (const Device* device : job_.trace ? std::vector<const Device*>{} : job_.others) {
        auto follower = std::make_unique<Follower>();
        RenderJob& job = follower->job;
        job.crop = job_.crop;
        job.seed = job_.seed;
        job.sample_offset = job_.sample_offset;
        job.disk_cache = job_.disk_cache;
        job.workshop = job_.workshop;
        job.dry_run = job_.dry_run;
        job.plan = job_.plan;
        job.plan.band_rows = bands_.front().rows; // whatever room each device's records of paths leave
        job.plan.waiting = std::max(job.plan.waiting, job_.resume ? job_.resume->batch : 0);
        job.plan.schedule = wish_.schedule;
        follower->session.reset(new Session(*device, scene, job, false));
        if (rows_of_bands(follower->session->bands_) != rows_of_bands(bands_))
            throw InputError(fmt::format("--device: \"{}\" holds less of the film than \"{}\"; name it first, or ask "
                                         "for fewer layers",
                                         device->info().name, device_.info().name));
        follower->session->result_.counts = {};
        result_.others.push_back({device->info(), 0.0});
        followers_.push_back(std::move(follower));
    }
    release_grids();
    speeds_.assign(followers_.size() + 1, 0.0);
    for (const Band& band : bands_) { // all the first member's
        edges_.emplace_back(followers_.size() + 2, band.rows);
        edges_.back().front() = 0;
    }
}

// Devices of the first one's kind have its schedule, whose bits another one may not have there, and so wait for it.
void Session::compile_all() {
    compile();
    std::vector<std::future<void>> compiling;
    for (const auto& follower : followers_) {
        Session& session = *follower->session;
        if (session.device_.info().name == device_.info().name &&
            session.device_.info().driver == device_.info().driver) {
            session.wish_.schedule = result_.plan.schedule;
            session.result_.plan = session.plan_by(result_.plan.schedule);
        }
        compiling.push_back(std::async(std::launch::async, [&session] { session.compile(); }));
    }
    for (std::future<void>& kernels : compiling)
        kernels.get();
    agree();
}

void Session::enter_moments() {
    enter_moment();
    for (const auto& follower : followers_) {
        follower->session->done_ = done_;
        follower->session->enter_moment();
    }
    agree();
}

void Session::agree() {
    result_.device_bytes = device_bytes_;
    for (const auto& follower : followers_) {
        most_batch_ = std::min(most_batch_, follower->session->most_batch_);
        result_.device_bytes += follower->session->device_bytes_;
    }
}

Session& Session::member(std::size_t i) {
    return i == 0 ? *this : *followers_[i - 1]->session;
}

// Rows that member `i` has of the band under way.
Rows Session::rows_of(std::size_t i) const {
    return followers_.empty() ? Rows{0, bands_[band_].rows} : Rows{edges_[band_][i], edges_[band_][i + 1]};
}

// By the speeds of the batches before. Pixels left over stay where their rows are.
void Session::divide(const Band& band) {
    divided_ = !pixels_;
    const bool is_shared = !followers_.empty() && edges_[band_][1] < band.rows;
    if (followers_.empty() || (pixels_ && is_shared))
        return;
    const std::vector<std::uint32_t>& before = edges_[band_];
    const std::vector<std::uint32_t> now = edges_by(speeds_, band.rows);
    for (std::size_t from = 0; from + 1 < before.size(); ++from)
        for (std::size_t to = 0; to + 1 < now.size(); ++to)
            if (from != to)
                move_rows(member(from), member(to), band_,
                          {std::max(before[from], now[to]), std::min(before[from + 1], now[to + 1])});
    edges_[band_] = now;
}

void Session::move_rows(Session& from, Session& to, std::size_t band, Rows rows) {
    if (!rows.empty())
        copy_rows({from.commands_, from.bands_[band], from.film_layers_},
                  {to.commands_, to.bands_[band], to.film_layers_}, rows, width());
}

// Those left over, to the members whose rows they are in.
void Session::split_pixels() {
    const std::vector<std::uint32_t> all = *std::exchange(pixels_, std::nullopt);
    for (std::size_t i = 0; i <= followers_.size(); ++i) {
        const Rows rows = rows_of(i);
        std::copy_if(all.begin(), all.end(), std::back_inserter(member(i).pixels_.emplace()),
                     [&](std::uint32_t pixel) { return pixel >= rows.begin * width() && pixel < rows.end * width(); });
    }
}

Session::Following Session::start_followers() {
    order_ = Order::go_on;
    Following following{*this};
    if (!divided_ && !followers_.empty())
        split_pixels();
    for (std::size_t i = 0; i < followers_.size(); ++i) {
        Session& session = *followers_[i]->session;
        const Rows rows = rows_of(i + 1);
        session.done_ = done_;
        session.batch_ = batch_;
        session.band_ = band_;
        session.share_seconds_ = 0.0;
        if (divided_)
            session.pixels_.reset();
        if (divided_ ? !rows.empty() : !session.pixels_->empty())
            followers_[i]->work = begin_thread([this, &session, rows] { session.follow(rows, order_); });
    }
    return following;
}

// All that they still do comes to nothing if it was not joined.
Session::Following::~Following() {
    leader.order_ = Order::abandon;
    for (const auto& follower : leader.followers_)
        if (follower->work.valid()) {
            follower->work.wait();
            leader.gave_up_ = true;
        }
}

// A follower's share of a band, in its thread.
void Session::follow(Rows rows, const std::atomic<Order>& order) {
    share_watch_.lap();
    begin_band(bands_[band_], rows);
    for (bool resting = false; !resting;) {
        resting = wavefront_->advance();
        gather();
        if (!resting && order != Order::go_on)
            wavefront_->stop_handing_out();
        if (!resting && order == Order::abandon) {
            resting = true;
            result_.counts.abandoned += wavefront_->in_flight();
        }
    }
    pixels_ = wavefront_->pixels_left();
    share_seconds_ = share_watch_.seconds();
}

// Hands out no further pixels, here and elsewhere.
void Session::give_order(Order order) {
    wavefront_->stop_handing_out();
    order_ = order;
}

bool Session::followers_rest() const {
    return std::all_of(followers_.begin(), followers_.end(), [](const auto& follower) {
        return !follower->work.valid() || follower->work.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
}

// For a moment: the user may want something.
void Session::wait_for_followers() const {
    for (const auto& follower : followers_)
        if (follower->work.valid())
            follower->work.wait_for(std::chrono::milliseconds(20));
}

// What they came to. An error of one is thrown once all have ended.
void Session::join_followers() {
    if (gave_up_)
        give_order(Order::abandon);
    const bool gave_up = std::exchange(gave_up_, true); // unless none has failed
    for (const auto& follower : followers_)
        if (follower->work.valid())
            follower->work.wait();
    for (std::size_t i = 0; i < followers_.size(); ++i)
        if (followers_[i]->work.valid()) {
            followers_[i]->work.get();
            take_from(*followers_[i]);
        }
    gave_up_ = gave_up;
    const std::uint64_t paths = std::max<std::uint64_t>(result_.counts.paths - paths_before_, 1);
    for (std::size_t i = 0; i < followers_.size(); ++i)
        result_.others[i].part = double(followers_[i]->paths) / double(paths);
    measure_speeds();
}

void Session::take_from(Follower& follower) {
    Session& session = *follower.session;
    const RenderCounts counts = std::exchange(session.result_.counts, {});
    add_counts(result_.counts, counts);
    follower.paths += counts.paths;
    std::vector<NonFiniteSample>& examples = session.result_.non_finite;
    result_.non_finite.insert(result_.non_finite.end(), examples.begin(), examples.end());
    result_.non_finite.resize(std::min(result_.non_finite.size(), most_examples));
    examples.clear();
    const std::vector<std::uint32_t> left = *std::exchange(session.pixels_, std::nullopt);
    pixels_->insert(pixels_->end(), left.begin(), left.end());
}

// Measures batches of whole rows alone: the pixels left over tell nothing.
void Session::measure_speeds() {
    if (!divided_ || !pixels_->empty())
        return;
    for (std::size_t i = 0; i <= followers_.size(); ++i) {
        const Rows rows = rows_of(i);
        const double seconds = member(i).share_seconds_;
        const double speed = double(rows.end - rows.begin) * batch_ / std::max(seconds, 1e-6);
        if (!rows.empty())
            speeds_[i] = speeds_[i] > 0.0 ? std::sqrt(speeds_[i] * speed) : speed;
    }
}

// So that the session's own film is whole, as far as no device is at work.
void Session::bring_home() {
    if (std::any_of(followers_.begin(), followers_.end(), [](const auto& f) { return f->work.valid(); }))
        return;
    for (std::size_t band = 0; band < edges_.size(); ++band)
        for (std::size_t i = 1; i <= followers_.size(); ++i)
            move_rows(member(i), *this, band, {edges_[band][i], edges_[band][i + 1]});
}

} // namespace vkvol
