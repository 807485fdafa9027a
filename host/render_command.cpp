#include "render_command.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <limits>

#include "error.h"
#include "image_io.h"
#include "interrupt.h"
#include "progress.h"
#include "renderer.h"
#include "report.h"
#include "scene_xml.h"

namespace vkvol {

namespace {

Scene load(const RenderOptions& options) {
    Scene scene = load_scene(options.scene, options.defines, {options.grid, options.integrator});
    if (options.spp)
        scene.settings.spp = *options.spp;
    else if (options.time_limit) // time alone decides
        scene.settings.spp = std::numeric_limits<std::int32_t>::max() - options.sample_offset;
    resize_picture(scene.picture, options.width, options.height);
    return scene;
}

// Before any work is done: a render that cannot be written is not worth its time.
void check_outputs(const RenderOptions& options) {
    for (const std::filesystem::path& output : options.outputs)
        check_writable(output);
    if (options.report)
        check_directory_writable(*options.report);
}

std::string samples_text(const Film& film) {
    const auto [least, most] = std::minmax_element(film.samples.begin(), film.samples.end());
    return *least == *most ? std::to_string(*most) : fmt::format("{} to {}", *least, *most);
}

void print_warnings(const RenderOptions& options, const std::vector<std::string>& warnings) {
    if (!options.quiet)
        for (const std::string& warning : warnings)
            fmt::print(stderr, "vkvol: warning: {}\n", warning);
}

// One line for each kind of thing that makes the picture less than it claims to be.
void print_caps(const RenderCounts& c, const RenderResult& result) {
    const auto line = [](std::uint64_t count, const char* what) {
        if (count > 0)
            fmt::print(stderr, "vkvol: note: {} {}\n", count, what);
    };
    line(c.cleaned_voxels, "voxels were NaN, infinite or negative and count as 0");
    line(c.depth_caps, "paths ended at maxDepth: the light of further scatterings is missing (raise or drop maxDepth)");
    line(c.step_caps, "segments were cut, by the step limit or by the driver: their light is missing");
    line(c.majorant_violations,
         "collisions met a density above its majorant: delta estimators lose light there, ratio and weighted ones "
         "stay unbiased with more noise");
    line(c.non_finite, "samples were not finite and were dropped");
    for (const NonFiniteSample& s : result.non_finite)
        fmt::print(stderr, "vkvol: note: not finite: pixel {},{} sample {}\n", s.x, s.y, s.sample);
}

double write_outputs(const RenderOptions& options, const Film& film, const Metadata& metadata) {
    const auto start = std::chrono::steady_clock::now();
    for (const std::filesystem::path& output : options.outputs)
        write_image(output, film, metadata, options.tone_mapping);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void print_summary(const RenderOptions& options, const Device& device, const RenderResult& result) {
    std::string outputs;
    for (const std::filesystem::path& output : options.outputs)
        outputs += (outputs.empty() ? "" : ", ") + output.string();
    fmt::print("{}: {} samples per pixel, {:.2f} s, noise {:.2g} %, on {}{}\n", outputs, samples_text(result.film),
               result.render_seconds, 100.0 * relative_noise(result.film), device.info().name,
               device.is_cpu() ? " (software)" : "");
}

RenderResult render_with_progress(const RenderOptions& options, const Scene& scene, const Device& device) {
    RenderJob job;
    job.crop = resolve_crop(options.crop, scene.picture);
    job.seed = options.seed;
    job.sample_offset = options.sample_offset;
    job.time_limit = options.time_limit;
    job.disk_cache = !options.no_cache;
    install_interrupt_handler();
    job.interrupted = interrupted;
    Progress progress(options.progress, options.quiet, scene.settings.spp, options.time_limit);
    job.progress = [&](double samples, std::optional<double> noise) {
        progress.update(static_cast<std::uint32_t>(samples), noise);
    };
    RenderResult result = render(device, scene, job);
    progress.finish();
    return result;
}

void check_result(const Device& device, const RenderResult& result) {
    for (const std::string& message : device.validation_messages())
        fmt::print(stderr, "vkvol: validation: {}\n", message);
    if (!device.validation_messages().empty())
        throw RenderError(fmt::format("the validation layer has {} objections", device.validation_messages().size()));
    if (result.counts.queue_overflows > 0)
        throw RenderError(fmt::format("{} queue items were dropped: this is a defect of vkvol; please report the scene",
                                      result.counts.queue_overflows));
}

} // namespace

int run_render(const RenderOptions& options) {
    const Scene scene = load(options);
    print_warnings(options, scene.warnings);
    check_outputs(options);
    const Device device({options.device, options.validate, options.robust});
    const RenderResult result = render_with_progress(options, scene, device);
    print_warnings(options, result.warnings);
    check_result(device, result);
    const double write_seconds = write_outputs(options, result.film, make_metadata(options, scene, device, result));
    if (options.report)
        write_text(*options.report, make_report(options, scene, device, result, write_seconds));
    if (!options.quiet) {
        print_caps(result.counts, result);
        print_summary(options, device, result);
    }
    if (result.interrupted)
        return exit_interrupted;
    return options.strict && result.counts.any_cap() ? exit_caps_hit : exit_done;
}

} // namespace vkvol
