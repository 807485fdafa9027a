// What a bench prints when it is done: a table of the integrators, best first, and what follows from it.
#pragma once

#include "bench.h"

namespace vkvol {

// To standard output.
void print_bench(const BenchRequest& request, const BenchResult& result);

} // namespace vkvol
