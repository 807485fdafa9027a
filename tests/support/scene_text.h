// Scenes written in a test's own lines.
#pragma once

#include <string>

#include "scene_xml.h"

// `body`: what stands between <options> and </options>.
vkvol::Scene parse(const std::string& body, const vkvol::Defines& defines = {},
                   const vkvol::SceneOverrides& overrides = {});
vkvol::Scene parse_volumes(const std::string& text); // between <volumes> and </volumes>

// What is wrong with it, or "no error". `body` starts at line 2, column 1.
std::string error_of(const std::string& body, const vkvol::Defines& defines = {});
// Likewise of a whole file.
std::string error_of_text(const std::string& xml, const vkvol::Defines& defines = {});

bool warns(const vkvol::Scene& scene, const std::string& words);
