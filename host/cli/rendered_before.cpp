#include "rendered_before.h"

#include <algorithm>
#include <string>

#include "checkpoint_file.h"
#include "error.h"
#include "file_ending.h"
#include "image_io.h"
#include "metadata.h"
#include "method.h"
#include "requested_scene.h"
#include "scene_hash.h"

namespace vkvol {

namespace {

bool is_this_render(const std::filesystem::path& exr, const RenderOptions& options, const Scene& scene) {
    Metadata metadata;
    Film film;
    try {
        film = read_exr(exr, &metadata);
    } catch (const InputError&) { // whatever it is, it is no such picture
        return false;
    }
    const bool counts_samples = options.spp || !(options.time_limit || options.noise_goal);
    return text_of(metadata, "vkvol/sceneHash") == scene_hash(scene) &&
           text_of(metadata, "vkvol/integrator") == choose_method(with_preset(scene)).integrator &&
           text_of(metadata, "vkvol/seed") == std::to_string(options.seed) &&
           text_of(metadata, "vkvol/sampleOffset") == std::to_string(options.sample_offset) &&
           text_of(metadata, "vkvol/interrupted") == "0" && film.crop == resolve_crop(options.crop, scene.picture) &&
           (!counts_samples || text_of(metadata, "samplesPerPixel") == std::to_string(scene.settings.spp));
}

// The hash knows grids by their names and sizes.
bool has_newer_grid(const std::filesystem::path& picture, const Scene& scene) {
    std::error_code error;
    const auto made = std::filesystem::last_write_time(picture, error);
    return std::any_of(scene.volumes.begin(), scene.volumes.end(), [&](const Volume& volume) {
        const auto* grid = std::get_if<GridFile>(&volume.shape);
        return grid && !grid->memory && std::filesystem::last_write_time(grid->path, error) > made;
    });
}

} // namespace

bool rendered_before(const RenderOptions& options, const Scene& scene) {
    std::error_code error;
    if (std::filesystem::exists(CheckpointFile(options).path(), error))
        return false;
    return std::all_of(options.outputs.begin(), options.outputs.end(), [&](const std::filesystem::path& output) {
        return std::filesystem::is_regular_file(output, error) && !has_newer_grid(output, scene) &&
               (file_ending(output) != ".exr" || is_this_render(output, options, scene));
    });
}

} // namespace vkvol
