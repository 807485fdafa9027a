#include "bench_schedule.h"

#include <algorithm>

namespace vkvol {

namespace {

constexpr double margin = 1.2;                  // a machine that others use is not always equally fast
constexpr double runs_wanted = 5.0;             // at the largest count
constexpr double cheap = 0.02;                  // part of the budget
constexpr std::uint32_t most_samples = 1 << 30; // the next count would not fit an int

struct Entry {
    double seconds_per_sample = 0.0; // of the last render
    double spent = 0.0;
    std::uint32_t samples = 0; // the count it has reached
    bool growing = true;
    bool cut = false;
};

class Rounds {
public:
    Rounds(const std::vector<double>& seconds_per_sample, double budget, const MeasuredRender& render,
           const std::function<bool()>& interrupted)
        : budget_(budget), share_(budget / double(std::max<std::size_t>(1, seconds_per_sample.size()))),
          render_(render), interrupted_(interrupted) {
        for (const double seconds : seconds_per_sample)
            entries_.push_back({seconds});
    }

    void run() {
        for (std::uint32_t samples = 1; samples <= most_samples && grow(samples); samples *= 2)
            if (is_cheap(samples))
                for (int more = 0; more < 2; ++more)
                    round([samples](const Entry& entry) { return entry.samples == samples; });
        const auto fits_share = [this](const Entry& entry) { return seconds_of_next(entry) <= share_ - entry.spent; };
        while (round(fits_share)) {
        }
        // What the shares leave over suffices for some more rounds of all.
        const auto any = [](const Entry&) { return true; };
        while (seconds_of_round() <= left() && round(any)) {
        }
    }

private:
    double left() const {
        double left = budget_;
        for (const Entry& entry : entries_)
            left -= entry.spent;
        return left;
    }
    double seconds_of_next(const Entry& entry) const { return margin * entry.seconds_per_sample * entry.samples; }
    double seconds_of_round() const {
        double sum = 0.0;
        for (const Entry& entry : entries_)
            sum += entry.cut ? 0.0 : seconds_of_next(entry);
        return sum;
    }
    bool is_cheap(std::uint32_t samples) const {
        return std::all_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
            return entry.samples < samples || seconds_of_next(entry) <= cheap * share_;
        });
    }

    // A first round that takes in those whose share allows for the count. One sample is rendered for whatever it costs.
    bool grow(std::uint32_t samples) {
        for (Entry& entry : entries_) {
            const double predicted = margin * entry.seconds_per_sample * samples;
            entry.growing =
                entry.growing && !entry.cut && (samples == 1 || runs_wanted * predicted <= share_ - entry.spent);
            if (entry.growing)
                entry.samples = samples;
        }
        return round([](const Entry& entry) { return entry.growing; });
    }

    // Those that are chosen render once, as far as the budget goes. False if none did.
    template <typename Choose> bool round(const Choose& choose) {
        bool any = false;
        first_ = (first_ + 1) % std::max<std::size_t>(1, entries_.size());
        for (std::size_t i = 0; i < entries_.size(); ++i) {
            const std::size_t index = (first_ + i) % entries_.size();
            Entry& entry = entries_[index];
            if (entry.cut || !choose(entry) || seconds_of_next(entry) > left())
                continue;
            if (interrupted_())
                return false;
            const std::optional<double> seconds = render_(index, entry.samples, left());
            entry.cut = !seconds;
            if (!seconds)
                continue;
            entry.spent += *seconds;
            entry.seconds_per_sample = *seconds / entry.samples;
            any = true;
        }
        return any;
    }

    double budget_, share_;
    const MeasuredRender& render_;
    const std::function<bool()>& interrupted_;
    std::vector<Entry> entries_;
    std::size_t first_ = std::size_t(-1); // so that the first round begins with the first
};

} // namespace

bool is_worth_measuring(double seconds_per_sample, double share) {
    return share_worth_measuring(seconds_per_sample) <= share;
}

double share_worth_measuring(double seconds_per_sample) {
    return margin * runs_wanted * seconds_per_sample;
}

void run_rounds(const std::vector<double>& seconds_per_sample, double budget, const MeasuredRender& render,
                const std::function<bool()>& interrupted) {
    Rounds(seconds_per_sample, budget, render, interrupted).run();
}

double expected_seconds(const std::vector<double>& seconds_per_sample, const std::vector<double>& setup_seconds,
                        double budget) {
    double sum = 0.0;
    const auto render = [&](std::size_t estimator, std::uint32_t samples, double limit) {
        const double seconds = std::max(seconds_per_sample[estimator], 1e-6) * samples;
        sum += setup_seconds[estimator] + std::min(seconds, limit);
        return seconds <= limit ? std::optional(seconds) : std::nullopt;
    };
    run_rounds(seconds_per_sample, budget, render, [] { return false; });
    return sum;
}

} // namespace vkvol
