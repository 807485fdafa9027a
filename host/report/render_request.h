// What is asked for: of which scene file, with what changed in it, and on which device. A picture and a bench share it,
// and what was asked for is part of what a report tells.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "device.h"
#include "file_scene.h"
#include "plan.h"
#include "tone_choice.h"

namespace vkvol {

// x0, x1, y0, y1: pixels of the picture, or fractions of it.
struct CropRequest {
    std::array<double, 4> window{};
    bool fractions = false;
    bool is_pixel = false; // as --pixel says
};

struct RenderRequest {
    std::filesystem::path scene; // or a .nvdb or .vdb file, for which one is made
    std::map<std::string, std::string> defines;
    std::optional<std::filesystem::path> grid;
    std::optional<std::string> integrator; // NAME:axis=choice...
    std::optional<int> width, height;
    std::string aov;      // names of layers, besides the scene's
    bool alpha = false;   // what is behind the media stays out of the picture, which has alpha
    bool frame = false;   // move the camera so that the medium fills the picture
    std::optional<Up> up; // of a grid file without a scene
    std::optional<CropRequest> crop;
    std::optional<std::uint32_t> spp;
    std::uint32_t seed = 0;
    std::uint32_t sample_offset = 0;  // the first sample's number: disjoint ranges of one seed can be merged
    std::optional<double> time_limit; // seconds
    std::optional<double> noise_goal; // relative standard error of the picture, in (0, 1)
    DeviceOptions device;
    Plan plan;             // what of it is chosen
    bool no_cache = false; // neither read nor write the pipeline cache
    ToneRequest tone;
};

} // namespace vkvol
