#include "live_pictures.h"

#include <fmt/format.h>
#include <new>

#include "error.h"
#include "messages.h"
#include "report.h"
#include "tev_picture.h"

namespace vkvol {

LivePictures::LivePictures(const RenderOptions& options, const Scene& scene, bool tev_is_gone)
    : options_(options), scene_(scene) {
    if (options.dry_run || options.trace)
        return;
    if (!options.tev.empty() && !tev_is_gone) {
        const std::filesystem::path& file = options.outputs.empty() ? options.scene : options.outputs.front();
        try {
            pictures_.push_back(std::make_unique<TevPicture>(options.tev, file.filename().string()));
        } catch (const InputError& error) {
            if (!options.has_begun)
                throw;
            missing_ = fmt::format("{}; further frames are not shown", error.what());
        }
    }
    if (options.preview)
        pictures_.push_back(std::make_unique<TerminalPicture>(options.graphics));
}

void LivePictures::show(const Device& device, const RenderResult& result, Progress* progress) {
    if (pictures_.empty())
        return;
    try {
        show_all(device, result, progress);
    } catch (const std::bad_alloc&) { // no look is worth the picture
        pictures_.clear();
        tell(stderr, "vkvol: warning: there is not enough memory to show the picture meanwhile; the render goes on\n");
    }
}

void LivePictures::show_all(const Device& device, const RenderResult& result, Progress* progress) {
    const Tone tone = choose_tone(options_.tone, result.film, make_metadata(options_, scene_, device, result));
    if (progress)
        progress->finish();
    for (const std::unique_ptr<LivePicture>& picture : pictures_)
        picture->show(result.film, tone.mapping);
    std::erase_if(pictures_, [](const std::unique_ptr<LivePicture>& picture) {
        const bool failed = !picture->failure().empty();
        if (failed)
            tell(stderr, "vkvol: warning: {}; the render goes on\n", picture->failure());
        return failed;
    });
}

} // namespace vkvol
