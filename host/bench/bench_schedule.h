// Which estimator renders when, and how many samples: doubling counts in rounds that all take part in, so that what the
// machine does meanwhile is shared, within a budget of seconds.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace vkvol {

// Renders `samples` per pixel by estimator number `estimator`, for at most `time_limit` seconds. Returns the seconds it
// took, or nothing if it was cut short: that estimator is then asked no more.
using MeasuredRender =
    std::function<std::optional<double>(std::size_t estimator, std::uint32_t samples, double time_limit)>;

// Its share suffices for as many renders of one sample as a figure needs, or the least share that does.
bool is_worth_measuring(double seconds_per_sample, double share);
double share_worth_measuring(double seconds_per_sample);

// Rounds of 1, 2, 4, ... samples, each estimator once a round and each round beginning with another one. Cheap counts
// get three rounds. An estimator stops doubling where five renders of the next count would not fit its share of the
// budget; then come rounds at the count each has reached until the budget is used up. Nothing is begun that is
// predicted to end beyond the budget: a render takes at most twice as long as one of half its samples.
// `seconds_per_sample`: of each estimator, from a render that was not measured.
void run_rounds(const std::vector<double>& seconds_per_sample, double budget, const MeasuredRender& render,
                const std::function<bool()>& interrupted);

// How long such rounds are expected to take in all, if every render of an estimator is set up for so many seconds
// first.
double expected_seconds(const std::vector<double>& seconds_per_sample, const std::vector<double>& setup_seconds,
                        double budget);

} // namespace vkvol
