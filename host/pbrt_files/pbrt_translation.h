// A pbrt scene in the words of this renderer's own scene files.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "memory_grids.h"
#include "pbrt_scene.h"
#include "xml_text.h"

namespace vkvol {

// From a file's name in a pbrt scene to that in the translation.
using NameOfFile = std::function<std::string(const std::string&)>;

struct PbrtTranslation {
    std::string xml;
    ElementPlaces places;
    std::vector<std::string> notes; // "file:line:column: what cannot be rendered, and what is done instead"
    NamedGrids grids;               // density fields that the scene holds itself, by the names that they have in `xml`
};

struct PbrtTranslationOptions {
    NameOfFile name_of_file; // null: they stay as they are, relative to the pbrt scene's folder
    std::string grid_stem;   // with which the names of `grids` begin; odd characters of it do not matter
    double most_cloud_voxels = 256.0 * 256.0 * 256.0; // nor more of any other grid that is made up
};

// Throws InputError, "file:line:column: what is wrong; what would be right".
PbrtTranslation translate_pbrt(const PbrtScene& scene, const PbrtTranslationOptions& options = {});

} // namespace vkvol
