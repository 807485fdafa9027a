// What a bench is asked to measure.
#pragma once

#include <vector>

#include "render_request.h"

namespace vkvol {

struct BenchRequest {
    RenderRequest render;                 // scene, defines, grid, size, seed, device: as for a render
    std::vector<std::string> integrators; // NAME:axis=choice...; empty: the unbiased ones that suit the scene
    double seconds = 60.0;                // of measured rendering, shared by all
    std::optional<std::filesystem::path> reference;
    std::filesystem::path name; // NAME.bench.json, NAME.bench.csv and NAME.bench/INTEGRATOR.exr
    std::string command;        // as it was typed, for the record
    bool quiet = false;         // errors only
};

} // namespace vkvol
