#include "requested_scene.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>

#include "aovs.h"
#include "error.h"
#include "framing.h"
#include "scene_xml.h"

namespace vkvol {

namespace {

// While it takes its picture: at other times its file would have it where it was authored. One of the scene's own,
// `authored`, moves on from where it is now.
void keep_camera(Scene& scene, const std::optional<Camera>& authored) {
    if (!scene.motion_blur)
        return;
    MotionBlur blur = *scene.motion_blur;
    blur.scene_at = [scene_at = blur.scene_at, camera = scene.camera, authored](double time) {
        Scene then = scene_at(time);
        if (!authored) {
            then.camera = camera;
            return then;
        }
        const glm::dvec3 moved = camera.position - authored->position;
        then.camera.position += moved;
        keep_focus(then.camera, moved);
        then.camera.view_height *= camera.view_height / authored->view_height;
        return then;
    };
    scene.motion_blur = std::make_shared<const MotionBlur>(std::move(blur));
}

} // namespace

std::string apply_request(const RenderRequest& request, bool has_view, Scene& scene, FieldCache& fields) {
    if (request.spp)
        scene.settings.spp = *request.spp;
    else if (request.time_limit || request.noise_goal) // these alone decide
        scene.settings.spp = std::numeric_limits<std::int32_t>::max() - request.sample_offset;
    resize_picture(scene, request.width, request.height);
    std::string wrong; // none: whoever made the request has looked
    scene.layers |= parse_layers(request.aov, wrong).value_or(0) | (request.alpha ? unsigned(layer_alpha) : 0u);
    scene.holds_out = scene.holds_out || request.alpha;
    if (const std::string trouble = trouble_with_layers(scene); !trouble.empty())
        throw InputError("--aov, --alpha: " + trouble);
    std::string given;
    try {
        if (!has_view)
            given = give_camera(scene, fields);
    } catch (const InputError&) { // of a file, say: whoever loads it says so, once no output can be in danger
    }
    const Camera authored = scene.camera;
    if (request.frame && !has_view)
        frame_medium(scene, fields);
    if (!given.empty())
        keep_camera(scene, std::nullopt);
    else if (request.frame && !has_view)
        keep_camera(scene, authored);
    return given;
}

std::string layers_text(const Scene& scene) {
    std::string text;
    if (scene.layers & layer_groups) {
        for (const Light& light : scene.lights)
            text += fmt::format("light of '{}'; ", group_of(light));
        text += fmt::format("background of '{}'; ", scene.background_group);
    }
    if (scene.layers & layer_media)
        for (std::size_t i = 0; i < scene.volumes.size(); ++i)
            text += fmt::format("medium '{}'; ", medium_name(scene, i));
    return text;
}

std::string asked_text(const RenderRequest& request, const Scene& scene, std::optional<std::uint32_t> samples) {
    const Crop crop = resolve_crop(request.crop, scene.picture);
    std::string text =
        fmt::format("{} samples from {} of seed {}, {} seconds, noise {}, window {},{},{},{}, layers {}{}",
                    samples.value_or(scene.settings.spp), request.sample_offset, request.seed,
                    request.time_limit.value_or(0.0), request.noise_goal.value_or(0.0), crop.x0, crop.x1, crop.y0,
                    crop.y1, scene.layers, scene.holds_out ? ", alpha" : "");
    if (const auto& exposure = scene.camera.exposure)
        text += fmt::format(", exposed {} s at f/{}, ISO {}, {} cd/m^2", exposure->shutter, exposure->f_number,
                            exposure->iso, exposure->luminance_unit);
    if (const std::string layers = layers_text(scene); !layers.empty())
        text += ", " + layers;
    return text;
}

Crop resolve_crop(const std::optional<CropRequest>& request, const Picture& picture) {
    if (!request)
        return {0, picture.width, 0, picture.height};
    std::array<double, 4> window = request->window;
    if (request->fractions) // rounded, so that neighbouring windows meet without gap or overlap
        window = {std::round(window[0] * picture.width), std::round(window[1] * picture.width),
                  std::round(window[2] * picture.height), std::round(window[3] * picture.height)};
    const bool inside = window[0] >= 0 && window[1] <= picture.width && window[2] >= 0 && window[3] <= picture.height;
    if (!inside && request->is_pixel)
        throw InputError(fmt::format("--pixel {},{}: the picture has {} x {} pixels, counted from 0", window[0],
                                     window[2], picture.width, picture.height));
    if (!inside || window[0] >= window[1] || window[2] >= window[3])
        throw InputError(fmt::format("--crop {}: expected 0 <= x0 < x1 <= {} and 0 <= y0 < y1 <= {}",
                                     fmt::join(window, ","), picture.width, picture.height));
    return {int(window[0]), int(window[1]), int(window[2]), int(window[3])};
}

} // namespace vkvol
