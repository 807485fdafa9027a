#include "render_notes.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

#include "messages.h"

namespace vkvol {

namespace {

std::string samples_text(const Film& film) {
    const auto [least, most] = std::minmax_element(film.samples.begin(), film.samples.end());
    if (*least != *most)
        return fmt::format("{} to {} samples", *least, *most);
    return *most == 1 ? "1 sample" : fmt::format("{} samples", *most);
}

// Nothing of single samples, and of a black picture that it has none to speak of.
std::string noise_text(const Film& film) {
    if (const std::optional<double> noise = relative_noise(film))
        return fmt::format(", noise {:.2g} %", 100.0 * *noise);
    return *std::max_element(film.samples.begin(), film.samples.end()) > 1 ? ", noise -" : "";
}

// As a shell reads it, also where printable() had to write a control character otherwise.
std::string quoted(const std::string& text) {
    if (const std::string shown = printable(text); shown != text && text.find_first_of("'\\") == std::string::npos)
        return "$'" + shown + "'";
    std::string result = "'";
    for (const char c : text)
        result += c == '\'' ? "'\\''" : std::string(1, c);
    return result + "'";
}

// The command that follows just this path.
std::string replay_command(const RenderOptions& options, const NonFiniteSample& s) {
    std::string command = "vkvol " + quoted(options.scene.string());
    for (const auto& [key, value] : options.defines)
        command += " -D " + quoted(key + "=" + value);
    if (options.integrator)
        command += " --integrator " + quoted(*options.integrator);
    if (options.grid)
        command += " --grid " + quoted(options.grid->string());
    if (options.width)
        command += fmt::format(" --width {}", *options.width);
    if (options.height)
        command += fmt::format(" --height {}", *options.height);
    if (options.frame)
        command += " --frame";
    if (options.up)
        command += *options.up == Up::z ? " --up z" : " --up y";
    if (options.device != "auto")
        command += " --device " + quoted(options.device);
    return command + fmt::format(" --seed {} --pixel {},{} --sample {} --trace", options.seed, s.x, s.y, s.sample);
}

} // namespace

void print_warnings(const RenderOptions& options, const std::vector<std::string>& warnings) {
    if (!options.quiet)
        for (const std::string& warning : warnings)
            tell(stderr, "vkvol: warning: {}\n", warning);
}

void print_reading(const RenderOptions& options) {
    const std::array<double, 4> corner = {0.0, 1.0, 0.0, 1.0};
    if (!options.quiet && !options.trace && options.crop && !options.crop->fractions && options.crop->window == corner)
        tell(stderr, "vkvol: note: --crop 0,1,0,1 is the first pixel alone: without a dot, these are pixels; the whole "
                     "picture is 0.0,1.0,0.0,1.0\n");
}

void print_explanation(const RenderOptions& options, const Explanation& explanation) {
    if (!options.quiet)
        tell(stderr, "vkvol: note: {}\n", explanation.text);
}

void print_caps(const RenderOptions& options, const RenderResult& result) {
    const RenderCounts& c = result.counts;
    const auto line = [](std::uint64_t count, const char* what) {
        if (count > 0)
            tell(stderr, "vkvol: note: {} {}\n", count, what);
    };
    line(c.cleaned_voxels, "voxels were NaN, infinite or negative and count as 0");
    line(c.depth_caps, "paths ended at maxDepth: the light of further scatterings is missing (raise maxDepth; without "
                       "one it is a million)");
    line(c.step_caps, "segments were cut by the step limit: their light is missing");
    line(c.abandoned, "paths would not end when the render was to, and are missing: they are the long ones");
    line(c.majorant_violations,
         "collisions met a density above its majorant: delta estimators lose light there, ratio and weighted ones "
         "stay unbiased with more noise");
    line(c.non_finite, "samples were not finite, or beyond 2.8e14, and were dropped");
    for (const NonFiniteSample& s : result.non_finite)
        tell(stderr, "vkvol: note: not finite: pixel {},{} sample {} seed {}; its path: {}\n", s.x, s.y, s.sample,
             options.seed, replay_command(options, s));
}

void print_summary(const RenderOptions& options, const Device& device, const RenderResult& result, const Tone& tone) {
    std::string outputs;
    for (const std::filesystem::path& output : options.outputs)
        outputs += (outputs.empty() ? "" : ", ") + output.string();
    const std::string told = tone_text(tone);
    tell(stdout, "{}: {} per pixel, {:.2f} s{}{}, on {}{}\n", outputs, samples_text(result.film), result.render_seconds,
         noise_text(result.film), told.empty() ? "" : ", " + told, device.info().name,
         device.is_cpu() ? " (software)" : "");
}

std::string no_samples_text(const RenderResult& result) {
    return result.interrupted             ? "interrupted before the first sample"
           : result.counts.non_finite > 0 ? "no sample was finite"
                                          : "out of time before the first sample";
}

} // namespace vkvol
