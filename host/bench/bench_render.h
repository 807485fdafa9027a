// Renders of a bench.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "bench_estimators.h"
#include "session.h"
#include "workshop.h"

namespace vkvol {

// The whole picture. Grids stay in the workshop for the next render. Throws InputError or RenderError.
RenderResult render_whole(const BenchRequest& request, const Estimator& estimator, Workshop& workshop,
                          std::uint32_t samples, std::uint32_t seed, std::optional<double> time_limit);

// The same of estimators that render again and again. What the first render of each read, uploaded and compiled serves
// further ones, as long as that of all together takes little of the device's memory.
class BenchSessions {
public:
    BenchSessions(const BenchRequest& request, Workshop& workshop) : request_(request), workshop_(workshop) {}

    RenderResult render(const Estimator& estimator, std::uint32_t samples, std::uint32_t seed,
                        std::optional<double> time_limit);

    bool keeps(const Estimator& estimator) const { return kept_.count(estimator.integrator) > 0; }
    // Frees what the estimator has on the device: it renders no more.
    void forget(const Estimator& estimator);

private:
    struct Kept {
        RenderJob job;
        std::unique_ptr<Session> session; // refers to the job
        std::uint64_t bytes = 0;          // on the device
    };

    RenderResult render_anew(const Estimator& estimator, std::uint32_t samples, std::uint32_t seed,
                             std::optional<double> time_limit);

    const BenchRequest& request_;
    Workshop& workshop_;
    std::map<std::string, Kept> kept_; // by integrator
    std::set<std::string> too_large_;
    std::uint64_t bytes_ = 0; // of all that are kept
};

} // namespace vkvol
