// What a request changes of a scene that has been read.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "field_cache.h"
#include "render_request.h"
#include "scene.h"

namespace vkvol {

// Its samples, size, layers and view; `fields` as in framing.h. Where the scene has no camera it gets one: in one line,
// which. `has_view`: the view was chosen with the scene, and stays. Throws InputError.
std::string apply_request(const RenderRequest& request, bool has_view, Scene& scene, FieldCache& fields);

// Which light is in which layer, where layers are told apart by groups or media, in one line; else empty.
std::string layers_text(const Scene& scene);

// All that decides which samples a picture of the scene holds, which layers, and how it is shown, in one line.
// `samples`: per pixel; without, as many as the scene says.
std::string asked_text(const RenderRequest& request, const Scene& scene, std::optional<std::uint32_t> samples = {});

// The window in pixels; the whole picture without a request. Throws InputError if it is empty or leaves the picture.
Crop resolve_crop(const std::optional<CropRequest>& request, const Picture& picture);

} // namespace vkvol
