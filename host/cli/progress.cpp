#include "progress.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <sys/ioctl.h>
#include <unistd.h>

#include "messages.h"

namespace vkvol {

namespace {

std::string duration_text(double seconds) {
    const long long s = std::llround(std::min(seconds, 3.6e6));
    if (s >= 3600)
        return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
    return fmt::format("{}:{:02}", s / 60, s % 60);
}

int terminal_width(std::FILE* out) {
    winsize size{};
    return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

} // namespace

Progress::Progress(ProgressStyle style, bool quiet, std::uint32_t total, std::optional<double> time_limit,
                   std::optional<double> noise_goal, std::FILE* out)
    : total_(total), time_limit_(time_limit), noise_goal_(noise_goal), out_(out), start_(Clock::now()),
      last_draw_(start_) {
    if (quiet || style == ProgressStyle::none)
        mode_ = Mode::none;
    else if (style == ProgressStyle::json)
        mode_ = Mode::json;
    else
        mode_ = isatty(fileno(out)) ? Mode::bar : Mode::lines;
}

Progress::~Progress() {
    finish();
}

// Noise falls as 1 / sqrt(samples), and is looked at when these are a power of two. Without a goal, or before anything
// is known of it: all samples.
std::uint32_t Progress::samples_to_goal() const {
    if (!noise_goal_ || !noise_)
        return total_;
    const double ratio = *noise_ / *noise_goal_;
    const double needed = std::exp2(std::ceil(std::log2(noise_samples_ * ratio * ratio)));
    return static_cast<std::uint32_t>(std::clamp(needed, 1.0, double(total_)));
}

void Progress::update(double samples, std::optional<double> noise) {
    if (mode_ == Mode::none)
        return;
    const Clock::time_point now = Clock::now();
    if (!begun_at_) {
        begun_at_ = samples;
        start_ = now;
    }
    const double seconds = std::chrono::duration<double>(now - start_).count();
    if (noise) {
        noise_ = noise;
        noise_samples_ = samples;
    }
    const std::uint32_t total = samples_to_goal();
    const double of_samples = total > 0 ? samples / total : 0.0;
    const double of_time = time_limit_ && *time_limit_ > 0.0 ? seconds / *time_limit_ : 0.0;
    const double fraction = std::min(std::max(of_samples, of_time), 1.0);
    double remaining = std::numeric_limits<double>::infinity();
    if (samples > *begun_at_ && (noise_ || !noise_goal_))
        remaining = seconds * (total - std::min(samples, double(total))) / (samples - *begun_at_);
    if (time_limit_)
        remaining = std::min(remaining, std::max(*time_limit_ - seconds, 0.0));
    const bool foresees = std::isfinite(remaining);

    if (mode_ == Mode::json) {
        tell(out_, R"({{"progress": {:.4f}, "samples": {}, "total": {}, "seconds": {:.3f}, "remaining": {:.1f}, )",
             fraction, std::floor(samples), total, seconds, foresees ? remaining : 0.0);
        tell(out_, "\"noise\": {}}}\n", noise_ ? fmt::format("{:.6g}", *noise_) : "null");
        std::fflush(out_);
        return;
    }
    const bool is_known = of_time <= of_samples && (!noise_goal_ || noise_);
    const std::string of_total = is_known ? fmt::format("/{}", total) : "";
    const std::string status =
        fmt::format("{}{} samples, {} left{}", std::floor(samples), of_total, foresees ? duration_text(remaining) : "?",
                    noise_ ? fmt::format(", noise {:.2g} %", 100.0 * *noise_) : "");
    if (mode_ == Mode::lines) {
        if (const int tenth = static_cast<int>(fraction * 10.0); tenth > last_tenth_) {
            last_tenth_ = tenth;
            tell(out_, "{:3.0f} %  {}\n", 100.0 * fraction, status);
            std::fflush(out_);
        }
        return;
    }
    // Ten redraws a second are enough for eyes and cheap over slow connections.
    if (drawn_ && fraction < 1.0 && now - last_draw_ < std::chrono::milliseconds(100))
        return;
    last_draw_ = now;
    draw_bar(fraction, status);
}

void Progress::draw_bar(double fraction, const std::string& status) {
    const int room = terminal_width(out_) - static_cast<int>(status.size()) - 10;
    std::string line = fmt::format("\r\033[K{:3.0f} % ", 100.0 * fraction);
    if (room >= 10) {
        const int cells = std::min(room, 40);
        const int full = static_cast<int>(fraction * cells);
        line += fmt::format("[{:#<{}}{:.<{}}] ", "", full, "", cells - full);
    }
    line += status.substr(0, std::size_t(std::max(0, terminal_width(out_) - 8)));
    put(out_, line);
    std::fflush(out_);
    drawn_ = true;
}

void Progress::finish() {
    if (drawn_) {
        put(out_, "\r\033[K");
        std::fflush(out_);
    }
    drawn_ = false;
}

} // namespace vkvol
