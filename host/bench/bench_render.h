// Renders of a bench.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "bench_estimators.h"
#include "session.h"
#include "workshop.h"

namespace vkvol {

// The whole picture. Grids stay in the workshop for the next render. Throws InputError or RenderError.
RenderResult render_whole(const BenchRequest& request, const Estimator& estimator, Workshop& workshop,
                          std::uint32_t samples, std::uint32_t seed, std::optional<double> time_limit);

// The same of estimators that render again and again. What the first render of each read, uploaded and compiled serves
// further ones, as long as that of all together is little.
class BenchSessions {
public:
    BenchSessions(const BenchRequest& request, Workshop& workshop) : request_(request), workshop_(workshop) {}

    RenderResult render(const Estimator& estimator, std::uint32_t samples, std::uint32_t seed,
                        std::optional<double> time_limit);

private:
    struct Kept {
        RenderJob job;
        std::unique_ptr<Session> session; // refers to the job
    };

    bool can_keep(const Estimator& estimator) const;

    const BenchRequest& request_;
    Workshop& workshop_;
    std::map<std::string, Kept> kept_; // by integrator
    std::uint64_t bytes_ = 0;          // theirs, on the device
};

} // namespace vkvol
