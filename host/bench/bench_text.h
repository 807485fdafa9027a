// Numbers and times as a bench prints them.
#pragma once

#include <optional>
#include <string>

#include "bench_statistics.h"

namespace vkvol {

// Three digits: 12300, 1.84, 4.06e-06; "-" if there is none.
std::string number_text(std::optional<double> value);

// 1.84 (1.52 to 2.23), the ends rounded outward: what is printed holds what was found.
std::string interval_text(const std::optional<Interval>& interval);

// Judged as printed: a sentence is to be borne out by the numbers beside it.
bool excludes_one(const std::optional<Interval>& interval);

// 45 s, 3 min, 2.5 h.
std::string duration_text(double seconds);

// No less than so many seconds, as --time takes it: 30s, 2m, 1h.
std::string round_duration(double seconds);

} // namespace vkvol
