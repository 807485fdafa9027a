#include "convert.h"

#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <map>

#include "atomic_file.h"
#include "error.h"
#include "file_ending.h"
#include "file_uses.h"
#include "image_io.h"
#include "messages.h"
#include "scene_beside.h"
#include "scene_xml.h"

namespace vkvol {

namespace {

constexpr const char* head = "<?xml version=\"1.0\"?>\n";

// Nobody has named these files: what is there, and is not what would be written, may be of use.
void check_unnamed(const std::filesystem::path& file, const std::string& bytes) {
    std::error_code error;
    if (!std::filesystem::exists(std::filesystem::symlink_status(file, error)))
        return;
    std::string old;
    if (std::filesystem::is_regular_file(file, error)) {
        std::ifstream there(file, std::ios::binary);
        old.assign(std::istreambuf_iterator<char>(there), std::istreambuf_iterator<char>());
    }
    if (old != bytes)
        throw InputError(
            fmt::format("{}: is there already, and densities of the new scene would be written over it; remove "
                        "it, or name another scene with -o",
                        file.string()));
}

} // namespace

int run_convert(const ConvertOptions& options) {
    if (!is_pbrt_file(options.scene))
        throw InputError(fmt::format("{}: convert reads scenes of pbrt-v4; expected .pbrt", options.scene.string()));
    if (file_ending(options.output) != ".xml" && !is_special(options.output))
        throw InputError(fmt::format("{}: convert writes a scene file; expected .xml", options.output.string()));
    const PbrtScene pbrt = read_pbrt(options.scene);
    const std::filesystem::path beside = options.output.parent_path();
    PbrtTranslationOptions choices;
    choices.name_of_file = [&](const std::string& name) { // a stream's text may come to be anywhere
        const std::filesystem::path file = pbrt.folder / name;
        return name_beside(is_special(options.output) ? std::filesystem::weakly_canonical(file) : file, beside);
    };
    choices.grid_stem = options.output.stem().string();
    const PbrtTranslation translation = translate_pbrt(pbrt, choices);
    if (is_special(options.output) && !translation.grids.empty())
        throw InputError(
            fmt::format("{}: has densities of its own, which become files beside the new scene; name a file "
                        "with -o",
                        options.scene.string()));
    if (const std::size_t size = std::strlen(head) + translation.xml.size(); size > largest_scene_file)
        throw InputError(
            fmt::format("{}: would come to {} MiB, and a scene file may have {}: put its meshes into files "
                        "(plymesh), or render it as it is",
                        options.output.string(), size >> 20, largest_scene_file >> 20));
    // Files are looked for where the new scene will be.
    const Scene scene = parse_scene(translation, options.output, {{}, {}, options.strict});
    FileUses uses;
    uses.reads("the scene", options.scene);
    uses.reads_files_of(scene);
    uses.writes("the new scene", options.output, "-o");
    for (const auto& [name, grids] : translation.grids)
        uses.writes("densities of the new scene", beside / name, "-o");
    uses.check();
    check_directory_writable(options.output);
    std::map<std::filesystem::path, std::string> densities;
    for (const auto& [name, grids] : translation.grids)
        check_unnamed(beside / name, densities[beside / name] = nvdb_file_of(*grids));
    for (const auto& [file, bytes] : densities)
        write_text(file, bytes);
    write_text(options.output, head + translation.xml);
    if (options.quiet)
        return exit_done;
    for (const std::string& warning : scene.warnings)
        tell(stderr, "vkvol: warning: {}\n", warning);
    tell(is_special(options.output) ? stderr : stdout, "{}: {} media, {} lights, {} surfaces\n",
         options.output.string(), scene.volumes.size(), scene.lights.size(), scene.surfaces.size());
    return exit_done;
}

} // namespace vkvol
