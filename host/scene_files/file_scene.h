// A scene for a grid file that has none: `vkvol cloud.nvdb`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "camera_view.h"
#include "suitable_medium.h"

namespace vkvol {

enum class Up { y, z };

// Picture of such a scene, unless another size is asked for.
Picture file_picture();

// What is chosen for a file; all of it follows from the file, the picture's shape and what is up.
struct FileView {
    std::string grid, temperature; // names of grids; temperature: empty without one
    Orbit orbit;
    double fov = 0.0; // degrees
    SuitableMedium medium;
    glm::dvec3 sun{0.0};               // direction towards it
    std::vector<std::string> warnings; // what of the file is left out, and why
};

// The grid "density" or, without one, the first that can be one. Throws InputError if there is none, with what is wrong
// with each.
FileView view_file(const std::filesystem::path& file, const Picture& picture, Up up);

// Elements of a scene file, each on a line of its own; all in the units of the world.
std::string camera_element(const FileView& view);
std::string medium_elements(const FileView& view);

struct FileSceneOptions {
    Picture picture;
    std::optional<std::uint32_t> spp; // none: some tens, for a picture in some tens of seconds on two cores
    std::string integrator;           // NAME:axis=choice..., or empty
    Up up = Up::y;
};

struct FileScene {
    std::string xml;
    std::string assumed; // in one line, for the user
    std::vector<std::string> warnings;
};

// A scene that renders `file`, to stand in the folder `beside`.
FileScene make_file_scene(const std::filesystem::path& file, const std::filesystem::path& beside,
                          const FileSceneOptions& options);

} // namespace vkvol
