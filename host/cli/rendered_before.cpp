#include "rendered_before.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "checkpoint_file.h"
#include "error.h"
#include "file_ending.h"
#include "file_uses.h"
#include "image_io.h"
#include "metadata.h"
#include "method.h"
#include "preset.h"
#include "render_outputs.h"
#include "requested_scene.h"
#include "scene_hash.h"

namespace vkvol {

namespace {

// Exit code of the render that made this picture; none if the picture is another one, or was interrupted.
std::optional<int> code_of(const std::filesystem::path& exr, const RenderOptions& options, const Scene& scene) {
    Metadata metadata;
    try {
        read_exr(exr, &metadata);
    } catch (const InputError&) { // whatever it is, it is no such picture
        return std::nullopt;
    }
    const bool is_this =
        text_of(metadata, "vkvol/sceneHash") == scene_hash(scene) &&
        text_of(metadata, "vkvol/integrator") == choose_method(with_preset(with_steady_integrator(scene))).integrator &&
        text_of(metadata, "vkvol/asked") == asked_text(options, scene) && text_of(metadata, "vkvol/interrupted") == "0";
    if (!is_this || (shows(options) && !has_recorded(options.tone, metadata)))
        return std::nullopt;
    return options.strict && text_of(metadata, "vkvol/capsHit") != "0" ? exit_caps_hit : exit_done;
}

bool tells_of_success(const std::filesystem::path& report) {
    std::ifstream file(report);
    const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
    return json.is_object() && json.contains("error") && json["error"].is_null();
}

} // namespace

std::optional<int> rendered_before(const RenderOptions& options, const Scene& scene) {
    std::error_code error;
    if (std::filesystem::exists(CheckpointFile(options).path(), error))
        return std::nullopt;
    std::vector<std::filesystem::path> outputs = options.outputs;
    if (options.report)
        outputs.push_back(*options.report);
    FileUses uses;
    uses.reads_files_of(scene);
    std::optional<int> code;
    auto first = std::filesystem::file_time_type::min(); // of what is made of an EXR
    for (const std::filesystem::path& output : outputs)
        if (file_ending(output) == ".exr")
            first = std::max(first, std::filesystem::last_write_time(output, error));
    for (const std::filesystem::path& output : outputs) {
        if (!std::filesystem::is_regular_file(output, error) || !uses.is_newer_than_inputs(output))
            return std::nullopt;
        if (options.report && output == *options.report && !tells_of_success(output))
            return std::nullopt;
        if (file_ending(output) != ".exr") {
            if (std::filesystem::last_write_time(output, error) < first)
                return std::nullopt;
            continue;
        }
        code = code_of(output, options, scene);
        if (!code)
            return std::nullopt;
    }
    return code;
}

} // namespace vkvol
