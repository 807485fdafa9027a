#include "render_notes.h"

#include <fmt/format.h>

#include "error.h"
#include "messages.h"

namespace vkvol {

namespace {

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
std::string replay_command(const RenderRequest& request, const NonFiniteSample& s) {
    std::string command = "vkvol " + quoted(request.scene.string());
    for (const auto& [key, value] : request.defines)
        command += " -D " + quoted(key + "=" + value);
    if (request.integrator)
        command += " --integrator " + quoted(*request.integrator);
    if (request.grid)
        command += " --grid " + quoted(request.grid->string());
    if (request.width)
        command += fmt::format(" --width {}", *request.width);
    if (request.height)
        command += fmt::format(" --height {}", *request.height);
    if (request.frame)
        command += " --frame";
    if (request.up)
        command += *request.up == Up::z ? " --up z" : " --up y";
    if (request.device.choice != "auto")
        command += " --device " + quoted(request.device.choice);
    return command + fmt::format(" --seed {} --pixel {},{} --sample {} --trace", request.seed, s.x, s.y, s.sample);
}

} // namespace

void print_warnings(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings)
        tell(stderr, "vkvol: warning: {}\n", warning);
}

void print_explanation(const Explanation& explanation) {
    tell(stderr, "vkvol: note: {}\n", explanation.text);
}

void check_validation(const Device& device) {
    const std::vector<std::string>& messages = device.validation_messages();
    for (const std::string& message : messages)
        tell(stderr, "vkvol: validation: {}", message + "\n"); // of several lines
    if (!messages.empty())
        throw RenderError(fmt::format("the validation layer has {} objections", messages.size()));
}

std::vector<std::string> caps_text(const RenderCounts& c) {
    std::vector<std::string> lines;
    const auto line = [&](std::uint64_t count, const char* what) {
        if (count > 0)
            lines.push_back(fmt::format("{} {}", count, what));
    };
    line(c.cleaned_voxels, "voxels were NaN, infinite or negative and count as 0");
    line(c.depth_caps, "paths ended at maxDepth: the light of further scatterings is missing (raise maxDepth; without "
                       "one it is a million)");
    line(c.step_caps, "segments were cut by the step limit: their light is missing");
    line(c.abandoned, "paths had not ended when the render did, and are missing; long paths are the ones lost");
    line(c.majorant_violations,
         "collisions met a density above its majorant: delta estimators lose light there, ratio and weighted ones "
         "stay unbiased with more noise");
    line(c.non_finite, "samples were not finite, or brighter than the film has room for, and were dropped");
    return lines;
}

void print_caps(const RenderRequest& request, const RenderResult& result) {
    for (const std::string& line : caps_text(result.counts))
        tell(stderr, "vkvol: note: {}\n", line);
    for (const NonFiniteSample& s : result.non_finite)
        tell(stderr, "vkvol: note: not finite: pixel {},{} sample {} seed {}; its path: {}\n", s.x, s.y, s.sample,
             request.seed, replay_command(request, s));
}

std::string of_all_devices(const Device& first, const RenderResult& result, std::string DeviceInfo::*text) {
    std::string all = first.info().*text;
    for (const OtherDevice& other : result.others)
        all += " + " + other.info.*text;
    return all;
}

std::string no_samples_text(const RenderResult& result) {
    return result.interrupted             ? "interrupted before the first sample"
           : result.counts.non_finite > 0 ? "no sample was finite"
                                          : "out of time before the first sample";
}

} // namespace vkvol
