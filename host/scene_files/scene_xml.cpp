#include "scene_xml.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "error.h"
#include "file_ending.h"
#include "gzip.h"
#include "input_file.h"
#include "scene_reader.h"

namespace vkvol {

namespace {

std::string read_file(const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::is_directory(file, error))
        throw InputError(fmt::format("{}: is a directory; expected a scene file (.xml)", file.string()));
    std::string text = read_input_text(file, largest_scene_file, "name a scene file (.xml)");
    for (const char* picture : {"\x76\x2f\x31\x01", "\x89PNG"})
        if (text.starts_with(picture))
            throw InputError(
                fmt::format("{}: is a picture (vkvol develop, compare and merge read .exr files); expected a scene "
                            "file (.xml)",
                            file.string()));
    if (text.size() > largest_scene_file)
        throw InputError(
            fmt::format("{}: larger than 256 MiB; expected a scene file (.xml), with its meshes in files of their own",
                        file.string()));
    return text;
}

struct SceneText {
    std::string xml;
    std::filesystem::path file;
    Defines defines;
    SceneOverrides overrides;
};

Scene read(const SceneText& text, double later) {
    XmlDocument document(text.xml, text.file, text.defines, "options", {}, text.overrides.may_be_unused, later);
    return SceneReader(document, text.overrides).read();
}

} // namespace

Scene parse_scene(const std::string& xml, const std::filesystem::path& file, const Defines& defines,
                  const SceneOverrides& overrides) {
    const auto text = std::make_shared<const SceneText>(SceneText{xml, file, defines, overrides});
    Scene scene = read(*text, 0.0);
    if (!scene.motion_blur)
        return scene;
    MotionBlur blur = *scene.motion_blur;
    blur.scene_at = [text](double later) { return read(*text, later); };
    scene.motion_blur = std::make_shared<const MotionBlur>(std::move(blur));
    for (const double time : telling_times(*scene.motion_blur))
        scene_of_time(scene, time);
    return scene;
}

Scene parse_scene(const PbrtTranslation& translation, const std::filesystem::path& file,
                  const SceneOverrides& overrides) {
    SceneOverrides with_grids = overrides;
    with_grids.grids.insert(translation.grids.begin(), translation.grids.end());
    XmlDocument document(translation.xml, file, {}, "options", translation.places);
    Scene scene = SceneReader(document, with_grids).read();
    scene.warnings.insert(scene.warnings.begin(), translation.notes.begin(), translation.notes.end());
    if (overrides.strict && !scene.warnings.empty())
        throw InputError(scene.warnings.front() + " (under --strict)");
    return scene;
}

bool is_pbrt_file(const std::filesystem::path& file) {
    return file_ending(file) == ".pbrt" || is_packed(file, ".pbrt");
}

Scene load_scene(const std::filesystem::path& file, const Defines& defines, const SceneOverrides& overrides) {
    if (is_pbrt_file(file) && !defines.empty())
        throw InputError(
            fmt::format("{}: -D and -f fill in the $keys of a scene, and pbrt's have none; `vkvol convert` "
                        "makes a scene of it that can have some",
                        file.string()));
    if (is_pbrt_file(file)) {
        const PbrtScene pbrt = read_pbrt(file);
        Scene scene = parse_scene(translate_pbrt(pbrt), file, overrides);
        scene.included.assign(pbrt.included.begin(), pbrt.included.end());
        return scene;
    }
    if (is_grid_file(file))
        throw InputError(fmt::format("{}: is a density file; expected a scene file (.xml), like that which `vkvol {}` "
                                     "writes beside its picture",
                                     file.string(), file.string()));
    return parse_scene(read_file(file), file, defines, overrides);
}

void resize_picture(Picture& picture, std::optional<int> width, std::optional<int> height) {
    if (!width && !height)
        return;
    const auto scaled = [](int edge, int to, int from) { return std::max(1.0, std::round(double(edge) * to / from)); };
    const double new_width = width ? *width : scaled(picture.width, *height, picture.height);
    const double new_height = height ? *height : scaled(picture.height, *width, picture.width);
    if (!(new_width >= 1 && new_width <= max_edge && new_height >= 1 && new_height <= max_edge))
        throw InputError(fmt::format("a picture of {}x{} pixels is out of range; each edge is 1 to {}", new_width,
                                     new_height, max_edge));
    const double scale_x = new_width / picture.width;
    const double scale_y = new_height / picture.height;
    picture.width = static_cast<int>(new_width);
    picture.height = static_cast<int>(new_height);
    picture.start_x *= scale_x;
    picture.start_y *= scale_y;
    picture.reference_width *= scale_x;
    picture.reference_height *= scale_y;
}

void resize_picture(Scene& scene, std::optional<int> width, std::optional<int> height) {
    if ((width || height) && scene.camera.projection == Projection::fluence)
        throw InputError(
            "--width and --height make another picture of the same view, and <fluence> has a pixel for each "
            "of its points; leave them out");
    if ((width || height) && scene.camera.projection == Projection::absorption)
        throw InputError("--width and --height make another picture of the same view, and <absorption> has a pixel for "
                         "each of its cells; leave them out");
    resize_picture(scene.picture, width, height);
}

} // namespace vkvol
