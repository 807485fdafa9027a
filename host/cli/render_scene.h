// The scene that a command line asks for: from a scene file, or made for a grid file.
#pragma once

#include "field_cache.h"
#include "options.h"

namespace vkvol {

struct RenderScene {
    Scene scene;
    std::string xml;                // made for a grid file; empty: the scene has a file of its own
    std::filesystem::path xml_file; // where it is kept, beside the first picture
    std::string assumed;            // in it, in one line; of a scene without a camera, which it has got
};

// With the samples, size and view of the command line; `fields` as in framing.h. Throws InputError.
// `frames`: whether a camera may be given or moved, for which grids are read.
RenderScene load_render_scene(const RenderOptions& options, FieldCache& fields, bool frames = true);

// Was it made, and are pictures to be written that it can lie beside?
bool is_kept(const RenderOptions& options, const RenderScene& scene);

// Keeps it then, and says so.
void keep_made_scene(const RenderOptions& options, const RenderScene& made);

} // namespace vkvol
