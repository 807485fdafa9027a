#include "bench_render.h"

#include <utility>

#include "interrupt.h"
#include "loaded_medium.h"

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
    workshop.set_next(grid_files(estimator.scene));
    Session session(workshop.device(request.render.device), estimator.scene, job);
    session.render(samples);
    return std::move(session.result());
}

// What moves is made ready for each moment anyway.
bool BenchSessions::can_keep(const Estimator& estimator) const {
    return !estimator.scene.motion_blur && bytes_ < most_bytes;
}

RenderResult BenchSessions::render(const Estimator& estimator, std::uint32_t samples, std::uint32_t seed,
                                   std::optional<double> time_limit) {
    auto found = kept_.find(estimator.integrator);
    if (found == kept_.end()) {
        if (!can_keep(estimator))
            return render_whole(request_, estimator, workshop_, samples, seed, time_limit);
        Kept kept{job_of(request_, estimator, workshop_), nullptr};
        found = kept_.emplace(estimator.integrator, std::move(kept)).first;
    }
    Kept& kept = found->second;
    kept.job.seed = seed;
    kept.job.time_limit = time_limit;
    const bool is_new = !kept.session;
    if (is_new) {
        workshop_.set_next(grid_files(estimator.scene));
        kept.session = std::make_unique<Session>(workshop_.device(request_.render.device), estimator.scene, kept.job);
    } else {
        kept.session->begin_again();
    }
    kept.session->render(samples);
    RenderResult result = kept.session->result();
    bytes_ += is_new ? result.device_bytes : 0;
    return result;
}

} // namespace vkvol
