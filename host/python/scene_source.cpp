#include "scene_source.h"

#include <fmt/format.h>

#include "error.h"
#include "file_ending.h"
#include "file_scene.h"
#include "requested_scene.h"

namespace vkvol::python {

namespace {

FileScene scene_for_grids(const SceneSource& source, const std::filesystem::path& beside,
                          const RenderRequest& request) {
    if (!source.defines.empty())
        throw InputError(
            fmt::format("{}: defines fill in the $keys of a scene, and a grid file has none", source.file.string()));
    if (request.grid)
        throw InputError(fmt::format("{}: grid replaces the density field of a scene, and is in place of one here; "
                                     "render {} without it",
                                     request.grid->string(), source.file.string()));
    FileSceneOptions options;
    options.picture = file_picture();
    resize_picture(options.picture, request.width, request.height);
    options.spp = request.spp;
    options.integrator = request.integrator.value_or("");
    options.up = source.up;
    return make_file_scene(source.file, beside, options);
}

} // namespace

ReadScene read_scene(const SceneSource& source, const RenderRequest& request, bool strict, FieldCache& fields) {
    const SceneOverrides overrides{request.grid, request.integrator, strict, source.grids};
    const bool is_made = !source.xml && is_grid_file(source.file);
    if (!is_made && source.up != Up::y)
        throw InputError("up: is for density files rendered without a scene; a scene's <camera> has lookAt and up");
    ReadScene read;
    if (is_made) {
        const std::filesystem::path folder = source.file.parent_path();
        const FileScene made = scene_for_grids(source, folder, request);
        read.scene = parse_scene(made.xml, folder / "scene.xml", {}, overrides);
        read.scene.warnings.insert(read.scene.warnings.begin(), made.warnings.begin(), made.warnings.end());
        read.assumed = made.assumed;
    } else if (source.xml) {
        read.scene = parse_scene(*source.xml, source.file, source.defines, overrides);
    } else {
        read.scene = load_scene(source.file, source.defines, overrides);
    }
    const std::string given = apply_request(request, is_made, read.scene, fields);
    if (!given.empty())
        read.assumed = given;
    return read;
}

} // namespace vkvol::python
