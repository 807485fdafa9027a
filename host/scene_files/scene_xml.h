// Scene files: XML with root <options>, the vocabulary of scenes/README.md.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "pbrt_translation.h"
#include "scene.h"

namespace vkvol {

inline constexpr std::size_t largest_scene_file = 256u << 20u; // bytes

// Values for `$key` in attribute values and text.
using Defines = std::map<std::string, std::string>;

// What whoever asks for a scene puts in the place of its own; known while loading so that checks and warnings fit.
struct SceneOverrides {
    std::optional<std::filesystem::path> grid; // instead of the scene's shape, with the coefficients of its medium
    std::optional<std::string> integrator;     // NAME:axis=choice..., instead of the scene's and of its choices
    bool strict = false;                       // of a scene that is translated nothing may be left out
    NamedGrids grids = {};                     // instead of density fields of these names
    std::set<std::string> may_be_unused = {};  // of the defines: another one is an error where no $key asks for it
};

// Throws InputError, "file:line:column: what is wrong; what would be right". What the scene asks for and this
// renderer does not do ends up in Scene::warnings. Grid files are named here, not opened. A file that ends in .pbrt is
// translated first.
Scene load_scene(const std::filesystem::path& file, const Defines& defines = {}, const SceneOverrides& overrides = {});

// The same from text already in memory; `file` names it in messages, and relative paths start from its directory.
Scene parse_scene(const std::string& xml, const std::filesystem::path& file, const Defines& defines = {},
                  const SceneOverrides& overrides = {});

// The same of a scene that was translated: `file` is what it was before.
Scene parse_scene(const PbrtTranslation& translation, const std::filesystem::path& file,
                  const SceneOverrides& overrides = {});

bool is_pbrt_file(const std::filesystem::path& file);

// The same view in `width` x `height` pixels; with only one given the aspect is kept. Start and reference scale along.
void resize_picture(Picture& picture, std::optional<int> width, std::optional<int> height);

// As the command line asks for it: InputError where pixels are not for a view.
void resize_picture(Scene& scene, std::optional<int> width, std::optional<int> height);

} // namespace vkvol
