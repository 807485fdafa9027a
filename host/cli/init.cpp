#include "init.h"

#include <fmt/format.h>

#include "atomic_file.h"
#include "error.h"
#include "file_ending.h"
#include "first_scene.h"
#include "image_io.h"
#include "messages.h"
#include "scene_xml.h"

namespace vkvol {

namespace {

constexpr const char* head = "<?xml version=\"1.0\"?>\n<!-- A scene to start from, with a view, light and coefficients "
                             "that suit the file. All elements: scenes/README.md. -->\n";

std::filesystem::path output_of(const InitOptions& options) {
    if (!options.output.empty())
        return options.output;
    return options.grid.empty() ? "scene.xml" : options.grid.stem().string() + ".xml";
}

} // namespace

int run_init(const InitOptions& options) {
    const std::filesystem::path output = output_of(options);
    if (!options.grid.empty() && !is_grid_file(options.grid))
        throw InputError(fmt::format("{}: init begins a scene with a density file; expected .nvdb or .vdb (a scene of "
                                     "pbrt-v4 is written anew by vkvol convert)",
                                     options.grid.string()));
    if (file_ending(output) != ".xml" && !is_special(output))
        throw InputError(fmt::format("{}: init writes a scene file; expected .xml", output.string()));
    std::error_code ignored;
    if (!is_special(output) && std::filesystem::exists(std::filesystem::symlink_status(output, ignored)))
        throw InputError(fmt::format("{}: is there already, and would be lost; remove it, or name another with -o",
                                     output.string()));
    if (options.up && options.grid.empty())
        throw InputError("--up: is for density files; name one");
    check_directory_writable(output);
    std::string xml = first_scene, assumed;
    if (!options.grid.empty()) {
        FileSceneOptions file;
        file.picture = file_picture();
        file.up = options.up.value_or(Up::y);
        // A stream's text may come to be anywhere.
        const std::filesystem::path grid =
            is_special(output) ? std::filesystem::weakly_canonical(options.grid) : options.grid;
        FileScene scene = make_file_scene(grid, output.parent_path(), file);
        for (const std::string& warning : scene.warnings)
            if (!options.quiet)
                tell(stderr, "vkvol: warning: {}\n", warning);
        xml = head + scene.xml;
        assumed = "; " + scene.assumed;
    }
    write_text(output, xml);
    if (!options.quiet)
        tell(is_special(output) ? stderr : stdout, "{}{}: vkvol {} renders it\n", output.string(), assumed,
             output.string());
    return exit_done;
}

} // namespace vkvol
