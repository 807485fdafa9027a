// The command line as plain data.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench_request.h"
#include "film.h"
#include "render_request.h"
#include "scene.h"
#include "terminal_picture.h"

namespace vkvol {

enum class Command {
    render,
    devices,
    info,
    integrators,
    compare,
    merge,
    develop,
    convert,
    init,
    measure,
    view,
    bench,
    print
};
enum class ProgressStyle { automatic, json, none };

struct RenderOptions : RenderRequest {
    std::vector<std::filesystem::path> outputs; // the scene's stem with .exr and .png if none was asked for
    std::optional<std::filesystem::path> report;
    std::optional<double> checkpoint; // seconds between two
    bool resume = false;              // from the checkpoint, if there is one
    std::vector<int> frames;          // of a sequence, by -f; empty: one picture
    bool is_frame = false;            // one of a sequence
    bool has_begun = false;           // which has rendered others before: viewers that were there may be gone
    bool grid_has_frame = false;      // the grid's name goes by the frame
    bool dry_run = false;             // check everything, render and write nothing
    bool trace = false;               // print the path's vertices; crop and sample range hold just one
    ProgressStyle progress = ProgressStyle::automatic;
    std::string tev;                          // HOST:PORT of a viewer that shows the picture meanwhile; or empty
    bool preview = false;                     // on the terminal
    std::optional<TerminalGraphics> graphics; // of it; else as the terminal says
    bool quiet = false;                       // errors only
    bool strict = false; // caps hit or non-finite samples: exit code 5; of a pbrt scene all of it has to be rendered
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

struct ConvertOptions {
    std::filesystem::path scene;  // .pbrt
    std::filesystem::path output; // .xml
    bool strict = false;          // what cannot be rendered is an error
    bool quiet = false;
};

struct InitOptions {
    std::filesystem::path grid;   // .nvdb or .vdb to begin with; or empty
    std::filesystem::path output; // .xml; empty: of a name that suits
    std::optional<Up> up;         // of the grid; y
    bool quiet = false;
};

// Values that a $key of the scene has one after the other.
struct Sweep {
    std::string key;
    std::vector<std::string> values;
};

struct MeasureOptions {
    RenderRequest request; // whose defines are among the sweeps
    std::vector<Sweep> sweeps;
    std::optional<std::filesystem::path> bands;  // a table of them, whose weighted sum is each reading
    std::optional<std::filesystem::path> output; // .csv or .json; else the table is printed
    bool means = false;                          // of pictures, in place of all pixels
    bool quiet = false;
};

struct ViewOptions {
    RenderRequest request;
    int port = 0;        // 0: any that is free
    bool strict = false; // as of a render
    bool quiet = false;
};

struct Options {
    Command command = Command::render;
    RenderOptions render;
    CompareOptions compare;
    MergeOptions merge;
    DevelopOptions develop;
    ConvertOptions convert;
    InitOptions init;
    MeasureOptions measure;
    ViewOptions view;
    BenchRequest bench;
    std::filesystem::path info_file;
    bool info_json = false;
    bool devices_json = false;
    bool integrators_json = false;
    std::string text; // Command::print: help or version, for standard output
};

// Throws InputError: one line with a hint.
Options parse_options(int argc, const char* const* argv);

// "30s", "5m", "2h" or plain seconds. Throws InputError.
double parse_duration(const std::string& text, const char* option = "--time");

} // namespace vkvol
