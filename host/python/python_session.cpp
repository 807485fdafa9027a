#include "python_session.h"

#include <algorithm>
#include <fmt/format.h>

#include "error.h"
#include "explain.h"
#include "render_notes.h"
#include "report.h"
#include "requested_scene.h"
#include "vulkan_error.h"

namespace vkvol::python {

PythonSession::PythonSession(const SceneSource& source, const RenderRequest& request, bool strict, Callbacks callbacks)
    : request_(request), shop_(device_shop(request.device)) {
    request_.scene = source.file;
    const Turn turn(*shop_, callbacks.interrupted);
    ReadScene read = read_scene(source, request_, strict, shop_->workshop.fields());
    assumed_ = std::move(read.assumed);
    work_->scene = std::move(read.scene);
    RenderJob& job = work_->job;
    job.workshop = &shop_->workshop;
    job.crop = resolve_crop(request_.crop, work_->scene.picture);
    job.seed = request_.seed;
    job.sample_offset = request_.sample_offset;
    job.time_limit = request_.time_limit;
    job.noise_goal = request_.noise_goal;
    job.disk_cache = !request_.no_cache;
    job.plan = request_.plan;
    job.others.assign(shop_->devices.begin() + 1, shop_->devices.end());
    job.progress = std::move(callbacks.progress);
    job.interrupted = std::move(callbacks.interrupted);
    on_device([&] { work_->session = std::make_unique<Session>(shop_->device, work_->scene, job); });
    warnings_ = work_->scene.warnings;
    const std::vector<std::string>& found = work_->session->warnings();
    warnings_.insert(warnings_.end(), found.begin(), found.end());
}

PythonSession::~PythonSession() {
    retire(shop_, std::move(work_));
}

void PythonSession::on_device(const std::function<void()>& work) {
    try {
        work();
    } catch (const VulkanError& error) {
        if (error.result == VK_ERROR_DEVICE_LOST)
            forget_device_shop(*shop_);
        throw;
    }
}

void PythonSession::render(std::optional<std::uint32_t> samples) {
    const Turn turn(*shop_, work_->job.interrupted);
    on_device([&] { work_->session->render(samples.value_or(work_->scene.settings.spp)); });
    for (const Device* device : shop_->devices)
        if (const auto& objections = device->validation_messages(); !objections.empty())
            throw RenderError(fmt::format("the validation layer has {} objections, the first: {}", objections.size(),
                                          objections.front()));
}

PythonPicture PythonSession::picture() {
    const Turn turn(*shop_, work_->job.interrupted);
    const Scene& scene = work_->scene;
    const RenderResult* read = nullptr;
    on_device([&] { read = &work_->session->result(); });
    const RenderResult& result = *read;
    if (!work_->session->has_whole_film() && result.counts.abandoned == 0)
        throw RenderError("there is no picture: a batch failed, of which the film has some paths and not others");
    const Film& film = result.film;
    if (std::none_of(film.samples.begin(), film.samples.end(), [](std::uint32_t n) { return n > 0; }))
        throw RenderError("there is no picture: nothing was rendered yet");
    PythonPicture picture{film, make_metadata(request_, scene, shop_->device, result), {}, caps_text(result.counts)};
    Shown shown;
    shown.tone = choose_tone(request_.tone, film, picture.metadata);
    shown.explanation = foresee(scene);
    if (!shown.explanation)
        shown.explanation = explain(scene, result, shown.tone);
    picture.report = make_report(request_, scene, shop_->device, result, shown, 0.0);
    return picture;
}

} // namespace vkvol::python
