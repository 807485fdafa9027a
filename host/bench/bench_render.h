// One render of a bench.
#pragma once

#include "bench_estimators.h"
#include "session.h"
#include "workshop.h"

namespace vkvol {

// The whole picture. Grids stay in the workshop for the next render. Throws InputError or RenderError.
RenderResult render_whole(const BenchRequest& request, const Estimator& estimator, Workshop& workshop,
                          std::uint32_t samples, std::uint32_t seed, std::optional<double> time_limit);

} // namespace vkvol
