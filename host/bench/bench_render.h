// One render of a bench.
#pragma once

#include "bench_estimators.h"
#include "session.h"

namespace vkvol {

// The whole picture. Throws InputError or RenderError.
RenderResult render_whole(const BenchRequest& request, const Estimator& estimator, const Device& device,
                          std::uint32_t samples, std::uint32_t seed, std::optional<double> time_limit);

} // namespace vkvol
