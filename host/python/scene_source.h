// Where a scene comes from, as Python has it: a file, or a text with grids in memory. It is read anew for each render,
// since an integrator or a grid that is asked for decides what in it is right.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "field_cache.h"
#include "memory_grids.h"
#include "render_request.h"
#include "scene_xml.h"

namespace vkvol::python {

struct SceneSource {
    std::filesystem::path file;     // .xml, .pbrt, .nvdb or .vdb; of a text what it is called, and where names start
    std::optional<std::string> xml; // instead of a file
    Defines defines;
    NamedGrids grids;
    Up up = Up::y; // of a grid file without a scene
};

struct ReadScene {
    Scene scene;
    std::string assumed; // of a grid file, or a scene without a camera; in one line, or empty
};

// As the request wants it. Throws InputError.
ReadScene read_scene(const SceneSource& source, const RenderRequest& request, bool strict, FieldCache& fields);

} // namespace vkvol::python
