// make_field: density fields from formulas, as NanoVDB or OpenVDB files.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <optional>

#include "error.h"
#include "field_file.h"
#include "recipes.h"

using namespace vkvol;

namespace {

struct Options {
    std::string name, output, all;
    bool list = false, if_missing = false;
    int size = 0;
    std::uint32_t seed = 1;
    Codec codec = Codec::blosc;
    std::optional<SampleType> type; // else the recipe's
};

std::string describe(const GridSummary& grid) {
    if (grid.active == 0)
        return fmt::format("{}: no active voxel", grid.name);
    const auto [min, max] = grid.box;
    return fmt::format("{}: index box [{}..{}] x [{}..{}] x [{}..{}], {} active voxels of {:.4g}..{:.4g}", grid.name,
                       min.x, max.x, min.y, max.y, min.z, max.z, grid.active, grid.lowest, grid.highest);
}

void make(const Recipe& recipe, const std::filesystem::path& path, const Options& options) {
    if (options.size != 0 && recipe.default_size == 0)
        throw InputError(fmt::format("field '{}' has one size only: leave --size out", recipe.name));
    const auto start = std::chrono::steady_clock::now();
    const Field field = recipe.make(options.size ? options.size : recipe.default_size, options.seed);
    const FileSummary summary = write_field(field, path, options.codec, options.type.value_or(recipe.type));
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    fmt::print("{}: {:.2f} MB in {:.1f} s, voxel size {:.4g}, index 0 at ({:g}, {:g}, {:g})\n", path.string(),
               double(summary.bytes) * 1e-6, elapsed.count(), field.voxel_size, field.origin.x, field.origin.y,
               field.origin.z);
    for (const GridSummary& grid : summary.grids)
        fmt::print("  {}\n", describe(grid));
    std::fflush(stdout);
}

void make_if_missing(const Recipe& recipe, const std::filesystem::path& path, const Options& options) {
    if (std::filesystem::exists(path))
        fmt::print("{}: there already, kept\n", path.string());
    else
        make(recipe, path, options);
}

void make_all(const Options& options) {
    std::filesystem::create_directories(options.all);
    for (const Recipe& recipe : recipes())
        make_if_missing(recipe, std::filesystem::path(options.all) / (std::string(recipe.name) + ".nvdb"), options);
}

void list() {
    for (const Recipe& recipe : recipes())
        fmt::print("{:<11} {}{}\n", recipe.name, recipe.what,
                   recipe.default_size ? fmt::format(" (default {})", recipe.default_size) : "");
}

void add_options(CLI::App& app, Options& options) {
    const std::map<std::string, Codec> codecs{{"none", Codec::none}, {"zip", Codec::zip}, {"blosc", Codec::blosc}};
    const std::map<std::string, SampleType> types{{"float", SampleType::float32}, {"half", SampleType::half},
                                                  {"fp4", SampleType::fp4},       {"fp8", SampleType::fp8},
                                                  {"fp16", SampleType::fp16},     {"fpn", SampleType::fpn}};
    app.add_option("NAME", options.name, "the field, one of --list");
    app.add_option("-o,--output", options.output, ".nvdb or .vdb file (default: NAME.nvdb)");
    app.add_option("--size", options.size, "samples along an edge")->check(CLI::Range(12, 1024));
    app.add_option("--seed", options.seed, "another cloud of the same kind (default 1)");
    app.add_option("--codec", options.codec, "none, zip or blosc (default)")->transform(CLI::Transformer(codecs));
    app.add_option_function<SampleType>(
           "--type", [&](const SampleType& type) { options.type = type; },
           "float, fp4, fp8, fp16, fpn; half for .vdb only (default: the field's own, float for most)")
        ->transform(CLI::Transformer(types));
    app.add_flag("--list", options.list, "list the fields");
    app.add_flag("--if-missing", options.if_missing, "keep the output if it is there already");
    app.add_option("--all", options.all, "make each field that this folder lacks");
}

void run(const Options& options) {
    if (options.list)
        list();
    else if (!options.all.empty() && options.size == 0 && options.output.empty() && options.name.empty())
        make_all(options);
    else if (options.all.empty() && !options.name.empty())
        (options.if_missing ? make_if_missing : make)(
            find_recipe(options.name), options.output.empty() ? options.name + ".nvdb" : options.output, options);
    else
        throw InputError("give the NAME of a field, --all DIR alone, or --list");
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Makes density fields from formulas."};
    Options options;
    add_options(app, options);
    try {
        app.parse(argc, argv);
        run(options);
    } catch (const CLI::CallForHelp& help) {
        return app.exit(help);
    } catch (const std::exception& error) {
        fmt::print(stderr, "make_field: {}\n", error.what());
        return exit_bad_input;
    }
    return exit_done;
}
