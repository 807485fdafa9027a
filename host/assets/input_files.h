// The files that a scene names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scene.h"

namespace vkvol {

struct InputFile {
    std::string what; // "the scene's density field"
    std::filesystem::path file;
};

// Density fields, models, meshes, textures, maps, tables and lists of points; `with_materials`, for which models have
// to be read, also those that these name.
std::vector<InputFile> input_files(const Scene& scene, bool with_materials);

// Files as they were when they were first seen, for what reads them again and again.
class SeenFiles {
public:
    // Throw InputError if it has changed since; of a scene, any of its files but for materials of models.
    void see(const InputFile& input);
    void see(const Scene& scene);

private:
    struct Stamp {
        std::uintmax_t bytes = 0;
        std::filesystem::file_time_type written;
        bool operator==(const Stamp&) const = default;
    };
    std::map<std::filesystem::path, Stamp> stamps_;
};

} // namespace vkvol
