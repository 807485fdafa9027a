// A pbrt scene as its directives say it, before anything is made of it.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pbrt_parameters.h"

namespace vkvol {

// What a directive with a type and parameters makes: LightSource "point" "rgb I" [ 1 1 1 ].
struct PbrtThing {
    std::string type;
    std::shared_ptr<const PbrtParameters> parameters =
        std::make_shared<PbrtParameters>(); // instances have them in common
    PbrtPlace place;
    glm::dmat4 transform{1.0};        // from its own space to the world
    bool is_before_camera = false;    // made before there was one
    std::string color_space = "srgb"; // of its colours
};

struct PbrtMaterial {
    PbrtThing thing;
    bool is_named = false; // then thing.type is its name
};

struct PbrtShape {
    PbrtThing thing;
    bool is_reversed = false;
    bool is_mirrored = false; // by its own transform, without an instance's
    PbrtMaterial material;
    std::optional<PbrtThing> light; // what its surface sends out
    std::string inside, outside;    // names of media; empty: vacuum
};

struct PbrtScene {
    std::filesystem::path folder;                                       // from which file names are
    std::optional<PbrtThing> camera, film, filter, sampler, integrator; // of the camera, `transform` is from the world
    std::string camera_medium;
    std::string rendered_in = "cameraworld"; // of Option "rendercoordsys"
    std::map<std::string, PbrtThing> media, materials, textures;
    std::vector<PbrtThing> lights;
    std::vector<PbrtShape> shapes;            // those of instances included
    std::set<std::filesystem::path> included; // files that it is read from beside its own
    std::vector<std::string> notes;           // "file:line:column: ..." for what was understood but is not honoured
};

// Throws InputError, "file:line:column: what is wrong; what would be right".
PbrtScene read_pbrt(const std::filesystem::path& file);
PbrtScene read_pbrt(const std::string& text, const std::filesystem::path& file);

} // namespace vkvol
