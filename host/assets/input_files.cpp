#include "input_files.h"

#include <fmt/format.h>

#include "error.h"
#include "obj_file.h"

namespace vkvol {

std::vector<InputFile> input_files(const Scene& scene, bool with_materials) {
    std::vector<InputFile> files;
    for (const std::filesystem::path& included : scene.included)
        files.push_back({"a file that the scene includes", included});
    if (!scene.camera.points_file.empty())
        files.push_back({"the scene's list of points", scene.camera.points_file});
    for (const Volume& volume : scene.volumes) {
        if (volume.phase == PhaseFunction::table)
            files.push_back({"the scene's phase function", volume.phase_details.file});
        if (const auto* grid = std::get_if<GridFile>(&volume.shape); grid && !grid->memory)
            files.push_back({"the scene's density field", grid->path});
        if (const auto* mesh = std::get_if<MeshFiles>(&volume.shape))
            for (const std::filesystem::path& model : mesh->paths) {
                files.push_back({"a model of the scene", model});
                if (!with_materials)
                    continue;
                for (const std::filesystem::path& library : material_libraries(model))
                    files.push_back({"the materials of a model", library});
            }
    }
    for (const Surface& surface : scene.surfaces) {
        if (const auto* mesh = std::get_if<MeshSurface>(&surface.shape))
            files.push_back({"a mesh of the scene", mesh->file});
        if (!surface.material.texture.empty())
            files.push_back({"a texture of the scene", surface.material.texture});
    }
    for (const Light& light : scene.lights)
        if (const auto* sky = std::get_if<SkyLight>(&light); sky && !sky->daylight)
            files.push_back({"the scene's map of the sky", sky->file});
    return files;
}

void SeenFiles::see(const InputFile& input) {
    std::error_code error; // what is not there is for whoever reads it to tell
    const Stamp stamp{std::filesystem::file_size(input.file, error),
                      std::filesystem::last_write_time(input.file, error)};
    const auto [seen, is_new] = stamps_.try_emplace(input.file, stamp);
    if (!is_new && seen->second != stamp && !error)
        throw InputError(fmt::format("{}: {} was changed while it was rendered, and what came before has it as it was; "
                                     "render anew",
                                     input.file.string(), input.what));
}

void SeenFiles::see(const Scene& scene) {
    for (const InputFile& input : input_files(scene, false))
        see(input);
}

} // namespace vkvol
