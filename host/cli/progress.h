// What is shown on standard error while a render runs.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

#include "options.h"

namespace vkvol {

// automatic: a bar that redraws itself on a terminal, else one line per ten percent. json: one object a line,
// {"progress": 0.25, "samples": 16, "total": 64, "seconds": 1.5, "remaining": 4.5, "noise": 0.03}. none: nothing.
class Progress {
public:
    // `total` in samples per pixel. With a time limit (seconds) or a goal of noise whichever of them is further along
    // counts.
    Progress(ProgressStyle style, bool quiet, std::uint32_t total, std::optional<double> time_limit = std::nullopt,
             std::optional<double> noise_goal = std::nullopt, std::FILE* out = stderr);
    ~Progress(); // finishes

    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // Samples per pixel, which may be fractional. Time counts from the first call. `noise`: the picture's at present,
    // see film.h; the last that was known is shown until the next is.
    void update(double samples, std::optional<double> noise = std::nullopt);

    // Removes the bar, so that other lines can be printed. Called twice it does nothing.
    void finish();

private:
    enum class Mode { bar, lines, json, none };
    using Clock = std::chrono::steady_clock;

    void draw_bar(double fraction, const std::string& status);
    std::uint32_t samples_to_goal() const;

    Mode mode_;
    std::uint32_t total_;
    std::optional<double> time_limit_;
    std::optional<double> noise_goal_;
    std::FILE* out_;
    std::optional<double> begun_at_;
    Clock::time_point start_;
    Clock::time_point last_draw_;
    std::optional<double> noise_;
    double noise_samples_ = 0.0; // of which it is the noise
    int last_tenth_ = -1;
    bool drawn_ = false;
};

} // namespace vkvol
