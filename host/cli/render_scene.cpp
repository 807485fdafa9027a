#include "render_scene.h"

#include <fmt/format.h>

#include "error.h"
#include "file_ending.h"
#include "file_scene.h"
#include "image_io.h"
#include "messages.h"
#include "render_summary.h"
#include "requested_scene.h"
#include "scene_beside.h"
#include "scene_xml.h"

namespace vkvol {

namespace {

void check_file_options(const RenderOptions& options) {
    const auto refuse = [&](const char* option, const char* reason) {
        throw InputError(fmt::format("{}: {}; render {} without it, or change the scene that is then written beside "
                                     "the picture",
                                     option, reason, options.scene.string()));
    };
    if (!options.defines.empty())
        refuse("-D and -f", "fill in the $keys of a scene, and a grid file has none");
    if (options.grid)
        refuse("--grid", "replaces the density field of a scene, and there is a grid file in place of the scene");
}

RenderScene make_scene(const RenderOptions& options) {
    check_file_options(options);
    FileSceneOptions file;
    file.picture = file_picture();
    resize_picture(file.picture, options.width, options.height);
    file.spp = options.spp;
    file.integrator = options.integrator.value_or("");
    file.up = options.up.value_or(Up::y);
    RenderScene made;
    made.xml_file = scene_beside(options.outputs.empty() ? options.scene.filename() : options.outputs.front());
    const FileScene scene = make_file_scene(options.scene, made.xml_file.parent_path(), file);
    made.xml = marked(scene.xml);
    made.assumed = scene.assumed;
    made.scene = parse_scene(made.xml, made.xml_file);
    made.scene.warnings.insert(made.scene.warnings.begin(), scene.warnings.begin(), scene.warnings.end());
    return made;
}

} // namespace

RenderScene load_render_scene(const RenderOptions& options, FieldCache& fields, bool frames) {
    RenderScene result;
    if (is_grid_file(options.scene))
        result = make_scene(options);
    else if (options.up)
        throw InputError("--up: is for grid files rendered without a scene; a scene's <camera> has lookAt and up");
    else
        result.scene =
            load_scene(options.scene, options.defines,
                       {options.grid,
                        options.integrator,
                        options.strict,
                        {},
                        options.grid_has_frame || (options.trace && options.grid) ? std::set<std::string>{"F"}
                                                                                  : std::set<std::string>{}});
    const std::string given = apply_request(options, !result.xml.empty() || !frames, result.scene, fields);
    if (!given.empty())
        result.assumed = given;
    return result;
}

bool is_kept(const RenderOptions& options, const RenderScene& scene) {
    return !scene.xml.empty() && !options.outputs.empty();
}

void keep_made_scene(const RenderOptions& options, const RenderScene& made) {
    if (!is_kept(options, made))
        return;
    if (!options.dry_run)
        write_text(made.xml_file, made.xml);
    if (!options.quiet)
        tell(stream_for_words(options.outputs, options.report), "{}; scene{}: {}\n", made.assumed,
             options.dry_run ? " that would be written" : "", made.xml_file.string());
}

} // namespace vkvol
