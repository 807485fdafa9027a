#include "develop.h"

#include <fmt/format.h>

#include "error.h"
#include "file_uses.h"
#include "image_io.h"
#include "messages.h"
#include "render_summary.h"

namespace vkvol {

int run_develop(const DevelopOptions& options) {
    FileUses uses;
    uses.reads("the image", options.input);
    for (const std::filesystem::path& output : options.outputs) {
        if (!is_display_file(output))
            throw InputError(fmt::format("{}: develop writes what is to be looked at; expected .png", output.string()));
        check_writable(output);
        uses.writes("the picture", output, "-o");
    }
    uses.check();
    Metadata metadata;
    const Film film = read_exr(options.input, &metadata);
    if (film.has_other_primaries && !options.quiet)
        tell(stderr,
             "vkvol: warning: {}: its primaries are not those of Rec.709 (sRGB), but its numbers are taken as such\n",
             options.input.string());
    const Tone tone = choose_tone(options.tone, film, metadata);
    write_images(options.outputs, film, metadata, tone.mapping);
    if (options.quiet)
        return exit_done;
    std::string outputs;
    for (const std::filesystem::path& output : options.outputs)
        outputs += (outputs.empty() ? "" : ", ") + output.string();
    const std::string told = tone_text(tone);
    tell(stream_for_words(options.outputs, {}), "{}: {}x{} pixels{}\n", outputs, film.width(), film.height(),
         told.empty() ? "" : ", " + told);
    return exit_done;
}

} // namespace vkvol
