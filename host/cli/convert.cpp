#include "convert.h"

#include <fmt/format.h>
#include <system_error>

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

} // namespace

int run_convert(const ConvertOptions& options) {
    if (!is_pbrt_file(options.scene))
        throw InputError(fmt::format("{}: convert reads scenes of pbrt-v4; expected .pbrt", options.scene.string()));
    if (file_ending(options.output) != ".xml" && !is_special(options.output))
        throw InputError(fmt::format("{}: convert writes a scene file; expected .xml", options.output.string()));
    const PbrtScene pbrt = read_pbrt(options.scene);
    const std::filesystem::path beside = options.output.parent_path();
    const PbrtTranslation translation =
        translate_pbrt(pbrt, [&](const std::string& name) { return name_beside(pbrt.folder / name, beside); });
    PbrtTranslation as_read = translation; // where the new file will be, of places in the old one
    as_read.notes.clear();
    const Scene scene = parse_scene(as_read, options.output);
    FileUses uses;
    uses.reads("the scene", options.scene);
    uses.reads_files_of(scene);
    uses.writes("the new scene", options.output, "-o");
    uses.check();
    if (options.strict && !translation.notes.empty())
        throw InputError(translation.notes.front() + " (under --strict)");
    write_text(options.output, head + translation.xml);
    if (options.quiet)
        return exit_done;
    for (const std::vector<std::string>& lines : {translation.notes, scene.warnings})
        for (const std::string& line : lines)
            tell(stderr, "vkvol: warning: {}\n", line);
    tell(stdout, "{}: {} media, {} lights, {} surfaces\n", options.output.string(), scene.volumes.size(),
         scene.lights.size(), scene.surfaces.size());
    return exit_done;
}

} // namespace vkvol
