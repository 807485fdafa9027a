#include "render_summary.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "atomic_file.h"
#include "messages.h"
#include "render_notes.h"

namespace vkvol {

namespace {

std::string samples_text(const Film& film) {
    const auto [least, most] = std::minmax_element(film.samples.begin(), film.samples.end());
    if (*least != *most)
        return fmt::format("{} to {} samples", *least, *most);
    return *most == 1 ? "1 sample" : fmt::format("{} samples", *most);
}

// Scenes that name no number of samples have one.
const char* more_samples(const RenderOptions& options, const Film& film) {
    const bool has_one = *std::max_element(film.samples.begin(), film.samples.end()) == 1;
    return has_one && !options.spp && !options.time_limit ? " (more by --spp)" : "";
}

// Nothing of single samples, and of a black picture that it has none to speak of.
std::string noise_text(const Film& film) {
    if (const std::optional<double> noise = relative_noise(film))
        return fmt::format(", noise {:.2g} %", 100.0 * *noise);
    return *std::max_element(film.samples.begin(), film.samples.end()) > 1 ? ", noise -" : "";
}

} // namespace

std::FILE* stream_for_words(const std::vector<std::filesystem::path>& outputs,
                            const std::optional<std::filesystem::path>& report) {
    const bool is_taken = std::any_of(outputs.begin(), outputs.end(), is_standard_output);
    return is_taken || (report && is_standard_output(*report)) ? stderr : stdout;
}

void print_reading(const RenderOptions& options) {
    const std::array<double, 4> corner = {0.0, 1.0, 0.0, 1.0};
    if (!options.quiet && !options.trace && options.crop && !options.crop->fractions && options.crop->window == corner)
        tell(stderr, "vkvol: note: --crop 0,1,0,1 is the first pixel alone: without a dot, these are pixels; the whole "
                     "picture is 0.0,1.0,0.0,1.0\n");
}

void print_summary(const RenderOptions& options, const Device& device, const RenderResult& result, const Tone& tone) {
    std::string outputs;
    for (const std::filesystem::path& output : options.outputs)
        outputs += (outputs.empty() ? "" : ", ") + output.string();
    const std::string told = tone_text(tone);
    tell(stream_for_words(options.outputs, options.report), "{}: {} per pixel{}, {:.2f} s{}{}, on {}{}\n", outputs,
         samples_text(result.film), more_samples(options, result.film), result.render_seconds, noise_text(result.film),
         told.empty() ? "" : ", " + told, of_all_devices(device, result, &DeviceInfo::name),
         device.is_cpu() ? " (software)" : "");
}

} // namespace vkvol
