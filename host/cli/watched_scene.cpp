#include "watched_scene.h"

#include <system_error>

#include "error.h"
#include "file_ending.h"
#include "file_scene.h"
#include "input_file.h"
#include "requested_scene.h"
#include "scene_beside.h"
#include "scene_xml.h"

namespace vkvol {

namespace {

// When it was written, and its size: a clock's ticks are long, and what is written in two goes may be read between
// them.
std::pair<std::filesystem::file_time_type, std::uintmax_t> state_of(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::file_time_type time = std::filesystem::last_write_time(file, error);
    return {time, std::filesystem::file_size(file, error)};
}

} // namespace

WatchedScene::WatchedScene(const ViewOptions& options)
    : options_(options), name_(options.request.scene.filename().string()), file_(options.request.scene) {
    check_read_again(file_, "view reads the scene whenever something of it changes");
    load();
}

void WatchedScene::load() {
    const std::filesystem::path& file = options_.request.scene;
    state_ = state_of(file);
    if (is_grid_file(file)) {
        FileSceneOptions made;
        made.picture = file_picture();
        resize_picture(made.picture, options_.request.width, options_.request.height);
        made.up = options_.request.up.value_or(Up::y);
        file_ = file.parent_path() / (file.stem().string() + ".xml");
        name_ = file_.filename().string();
        xml_ = make_file_scene(file, file.parent_path(), made).xml;
        has_view_ = true;
    } else if (is_pbrt_file(file)) {
        const PbrtTranslation translation = translate_pbrt(read_pbrt(file));
        parse_scene(translation, file, {{}, {}, options_.strict}); // whose errors have places in the file
        xml_ = translation.xml;
        grids_ = translation.grids;
        notes_ = translation.notes;
    } else {
        const RenderRequest& request = options_.request;
        load_scene(file, request.defines, {request.grid, request.integrator, options_.strict}); // likewise
        xml_ = read_input_text(file, largest_scene_file, "name a scene file (.xml)");
    }
}

bool WatchedScene::refresh() {
    const auto now = state_of(options_.request.scene);
    if (now == state_ ||
        now.first == std::filesystem::file_time_type::min()) // one that is replaced is away for a moment
        return false;
    load();
    return true;
}

WatchedScene::Read WatchedScene::read(const SceneEdits& edits, const std::string& layers, FieldCache& fields) const {
    RenderRequest request = options_.request;
    if (!edits.integrator.empty())
        request.integrator.reset(); // the viewer's choice comes last
    if (!layers.empty())
        request.aov += (request.aov.empty() ? "" : ",") + layers;
    Read result;
    result.xml = edited(xml_, edits);
    SceneOverrides overrides{request.grid, request.integrator, options_.strict, grids_};
    if (edits.camera || !edits.integrator.empty()) // which may have stood where a $key was
        for (const auto& [key, value] : request.defines)
            overrides.may_be_unused.insert(key);
    result.scene = parse_scene(result.xml, file_, request.defines, overrides);
    result.scene.warnings.insert(result.scene.warnings.begin(), notes_.begin(), notes_.end());
    apply_request(request, has_view_ || edits.camera.has_value(), result.scene, fields);
    return result;
}

} // namespace vkvol
