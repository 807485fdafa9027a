#include "bench_render.h"

#include "interrupt.h"
#include "loaded_medium.h"

namespace vkvol {

RenderResult render_whole(const BenchRequest& request, const Estimator& estimator, Workshop& workshop,
                          std::uint32_t samples, std::uint32_t seed, std::optional<double> time_limit) {
    Scene scene = estimator.scene;
    scene.settings.spp = samples;
    RenderJob job;
    job.crop = {0, scene.picture.width, 0, scene.picture.height};
    job.seed = seed;
    job.time_limit = time_limit;
    job.disk_cache = !request.render.no_cache;
    job.interrupted = interrupted;
    job.workshop = &workshop;
    workshop.set_next(grid_files(scene));
    return render(workshop.device(request.render.device), scene, job);
}

} // namespace vkvol
