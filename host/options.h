// The command line as plain data.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene.h"
#include "tone_choice.h"

namespace vkvol {

enum class Command { render, devices, info, integrators, compare, merge, develop, bench, print };
enum class Up { y, z };
enum class ProgressStyle { automatic, json, none };

// x0, x1, y0, y1: pixels of the picture, or fractions of it.
struct CropRequest {
    std::array<double, 4> window{};
    bool fractions = false;
};

struct RenderOptions {
    std::filesystem::path scene;                // or a .nvdb or .vdb file, for which one is made
    std::vector<std::filesystem::path> outputs; // the scene's stem with .exr and .png if none was asked for
    std::optional<std::uint32_t> spp;
    std::uint32_t seed = 0;
    std::uint32_t sample_offset = 0;       // the first sample's number: disjoint ranges of one seed can be merged
    std::optional<std::string> integrator; // NAME:axis=choice...
    std::optional<double> time_limit;      // seconds
    std::optional<int> width, height;
    bool frame = false;   // move the camera so that the medium fills the picture
    std::optional<Up> up; // of a grid file without a scene
    std::optional<CropRequest> crop;
    std::optional<std::filesystem::path> grid;
    std::map<std::string, std::string> defines;
    std::string device = "auto";
    std::optional<std::filesystem::path> report;
    std::optional<double> checkpoint; // seconds between two
    bool resume = false;              // from the checkpoint, if there is one
    std::vector<int> frames;          // of a sequence, by -f; empty: one picture
    bool dry_run = false;             // check everything, render and write nothing
    bool trace = false;               // print the path's vertices; crop and sample range hold just one
    ProgressStyle progress = ProgressStyle::automatic;
    ToneRequest tone;
    bool quiet = false;    // errors only
    bool strict = false;   // caps hit or non-finite samples: exit code 5
    bool robust = false;   // robust buffer access
    bool validate = false; // validation layer
    bool no_cache = false; // neither read nor write the pipeline cache
};

struct CompareOptions {
    std::filesystem::path a, b; // b is the reference
    std::optional<double> max_relmse;
    double significance = 0.01; // chance that two equal renders are called different
    bool json = false;
};

struct MergeOptions {
    std::vector<std::filesystem::path> inputs;
    std::vector<std::filesystem::path> outputs;
    ToneRequest tone;
    bool quiet = false;
};

struct DevelopOptions {
    std::filesystem::path input;
    std::vector<std::filesystem::path> outputs; // 8 bit
    ToneRequest tone;
    bool quiet = false;
};

struct BenchOptions {
    RenderOptions render;                 // scene, defines, grid, size, seed, device: as for a render
    std::vector<std::string> integrators; // NAME:axis=choice...; empty: the unbiased ones that suit the scene
    double seconds = 60.0;                // of measured rendering, shared by all
    std::optional<std::filesystem::path> reference;
    std::filesystem::path name; // NAME.bench.json, NAME.bench.csv and NAME.bench/INTEGRATOR.exr
    std::string command;        // as it was typed, for the record
};

struct Options {
    Command command = Command::render;
    RenderOptions render;
    CompareOptions compare;
    MergeOptions merge;
    DevelopOptions develop;
    BenchOptions bench;
    std::filesystem::path info_file;
    bool info_json = false;
    bool devices_json = false;
    bool integrators_json = false;
    std::string text; // Command::print: help or version, for standard output
};

// Throws InputError: one line with a hint.
Options parse_options(int argc, const char* const* argv);

// The window in pixels; the whole picture without a request. Throws InputError if it is empty or leaves the picture.
Crop resolve_crop(const std::optional<CropRequest>& request, const Picture& picture);

// "30s", "5m", "2h" or plain seconds. Throws InputError.
double parse_duration(const std::string& text, const char* option = "--time");

} // namespace vkvol
