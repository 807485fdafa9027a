#include "python_session.h"

#include <algorithm>
#include <fmt/format.h>

#include "error.h"
#include "explain.h"
#include "report.h"
#include "requested_scene.h"

namespace vkvol::python {

PythonSession::PythonSession(const SceneSource& source, const RenderRequest& request, bool strict, Callbacks callbacks)
    : request_(request), shop_(device_shop(request.device)) {
    request_.scene = source.file;
    const std::lock_guard lock(shop_->mutex);
    ReadScene read = read_scene(source, request_, strict, shop_->workshop.fields());
    scene_ = std::move(read.scene);
    assumed_ = std::move(read.assumed);
    job_.workshop = &shop_->workshop;
    job_.crop = resolve_crop(request_.crop, scene_.picture);
    job_.seed = request_.seed;
    job_.sample_offset = request_.sample_offset;
    job_.time_limit = request_.time_limit;
    job_.noise_goal = request_.noise_goal;
    job_.disk_cache = !request_.no_cache;
    job_.plan = request_.plan;
    job_.progress = std::move(callbacks.progress);
    job_.interrupted = std::move(callbacks.interrupted);
    session_ = std::make_unique<Session>(shop_->device, scene_, job_);
}

PythonSession::~PythonSession() {
    const std::lock_guard lock(shop_->mutex);
    session_.reset();
}

void PythonSession::render(std::optional<std::uint32_t> samples) {
    const std::lock_guard lock(shop_->mutex);
    session_->render(samples.value_or(scene_.settings.spp));
    if (const auto& objections = shop_->device.validation_messages(); !objections.empty())
        throw RenderError(fmt::format("the validation layer has {} objections, the first: {}", objections.size(),
                                      objections.front()));
}

PythonPicture PythonSession::picture() {
    const std::lock_guard lock(shop_->mutex);
    const RenderResult& result = session_->result();
    const Film& film = result.film;
    if (std::none_of(film.samples.begin(), film.samples.end(), [](std::uint32_t n) { return n > 0; }))
        throw RenderError("there is no picture: nothing was rendered yet");
    PythonPicture picture{film, make_metadata(request_, scene_, shop_->device, result), {}};
    Shown shown;
    shown.tone = choose_tone(request_.tone, film, picture.metadata);
    shown.explanation = explain(scene_, result, shown.tone);
    picture.report = make_report(request_, scene_, shop_->device, result, shown, 0.0);
    return picture;
}

} // namespace vkvol::python
