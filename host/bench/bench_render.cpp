#include "bench_render.h"

#include <utility>

#include "interrupt.h"

namespace vkvol {

namespace {

constexpr std::uint64_t most_bytes = 1u << 30; // of the device, kept

RenderJob job_of(const BenchRequest& request, const Estimator& estimator, Workshop& workshop) {
    const Picture& picture = estimator.scene.picture;
    RenderJob job;
    job.crop = {0, picture.width, 0, picture.height};
    job.disk_cache = !request.render.no_cache;
    job.interrupted = interrupted;
    job.workshop = &workshop;
    return job;
}

} // namespace

RenderResult render_whole(const BenchRequest& request, const Estimator& estimator, Workshop& workshop,
                          std::uint32_t samples, std::uint32_t seed, std::optional<double> time_limit) {
    RenderJob job = job_of(request, estimator, workshop);
    job.seed = seed;
    job.time_limit = time_limit;
    Session session(workshop.device(request.render.device), estimator.scene, job);
    session.render(samples);
    return std::move(session.result());
}

void BenchSessions::forget(const Estimator& estimator) {
    const auto found = kept_.find(estimator.integrator);
    if (found == kept_.end())
        return;
    bytes_ -= found->second.bytes;
    kept_.erase(found);
}

RenderResult BenchSessions::render_anew(const Estimator& estimator, std::uint32_t samples, std::uint32_t seed,
                                        std::optional<double> time_limit) {
    Kept& kept = kept_[estimator.integrator];
    kept.job = job_of(request_, estimator, workshop_);
    kept.job.seed = seed;
    kept.job.time_limit = time_limit;
    RenderResult result;
    try {
        kept.session = std::make_unique<Session>(workshop_.device(request_.render.device), estimator.scene, kept.job);
        kept.session->render(samples);
        result = kept.session->result();
    } catch (...) {
        kept_.erase(estimator.integrator);
        throw;
    }
    kept.bytes = result.device_bytes;
    bytes_ += kept.bytes;
    if (bytes_ > most_bytes) {
        too_large_.insert(estimator.integrator);
        forget(estimator);
    }
    return result;
}

// What moves is made ready for each moment anyway.
RenderResult BenchSessions::render(const Estimator& estimator, std::uint32_t samples, std::uint32_t seed,
                                   std::optional<double> time_limit) {
    if (estimator.scene.motion_blur || too_large_.count(estimator.integrator) > 0)
        return render_whole(request_, estimator, workshop_, samples, seed, time_limit);
    const auto found = kept_.find(estimator.integrator);
    if (found == kept_.end())
        return render_anew(estimator, samples, seed, time_limit);
    Kept& kept = found->second;
    kept.job.seed = seed;
    kept.job.time_limit = time_limit;
    kept.session->begin_again();
    kept.session->render(samples);
    return kept.session->result();
}

} // namespace vkvol
