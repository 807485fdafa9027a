// A pbrt scene in the words of this renderer's own scene files.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "pbrt_scene.h"

namespace vkvol {

// Where elements of a text come from: the offset of each one's <, ascending, and "file:line:column".
using ElementPlaces = std::vector<std::pair<std::ptrdiff_t, std::string>>;

// From a file's name in a pbrt scene to that in the translation.
using NameOfFile = std::function<std::string(const std::string&)>;

struct PbrtTranslation {
    std::string xml;
    ElementPlaces places;
    std::vector<std::string> notes; // "file:line:column: what cannot be rendered, and what is done instead"
};

// Throws InputError, "file:line:column: what is wrong; what would be right".
// Names of files stay as they are, relative to the pbrt scene's folder, unless `name_of_file` is there.
PbrtTranslation translate_pbrt(const PbrtScene& scene, const NameOfFile& name_of_file = {});

} // namespace vkvol
