// What a bench prints when it is done: a table of the integrators, best first, and what follows from it.
#pragma once

#include "bench.h"

namespace vkvol {

// To standard output.
void print_bench(const BenchOptions& options, const BenchResult& result);

} // namespace vkvol
