#include "scene_text.h"

#include <algorithm>

#include "error.h"

using namespace vkvol;

Scene parse(const std::string& body, const Defines& defines, const SceneOverrides& overrides) {
    return parse_scene("<options>" + body + "</options>", "s.xml", defines, overrides);
}

Scene parse_volumes(const std::string& text) {
    return parse("<volumes>" + text + "</volumes>");
}

std::string error_of(const std::string& body, const Defines& defines) {
    return error_of_text("<options>\n" + body + "\n</options>", defines);
}

std::string error_of_text(const std::string& xml, const Defines& defines) {
    try {
        parse_scene(xml, "s.xml", defines);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

bool warns(const Scene& scene, const std::string& words) {
    return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                       [&](const std::string& warning) { return warning.find(words) != std::string::npos; });
}
