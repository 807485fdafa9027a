#include "render_command.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <limits>
#include <unistd.h>

#include "error.h"
#include "image_io.h"
#include "interrupt.h"
#include "messages.h"
#include "progress.h"
#include "render_notes.h"
#include "renderer.h"
#include "report.h"
#include "scene_xml.h"
#include "trace.h"

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

std::filesystem::path checkpoint_file(const RenderOptions& options) {
    std::filesystem::path file = options.outputs.front();
    return file.replace_extension(".checkpoint");
}

// Where the picture can be kept when its own place takes no file: a render is not lost to a full disk.
std::string rescue(const Film& film, const Metadata& metadata) {
    std::error_code error;
    const std::filesystem::path directory = std::filesystem::temp_directory_path(error);
    if (error)
        return "";
    std::filesystem::path file = directory / fmt::format("vkvol-rescued-{}.exr", getpid());
    for (int i = 2; std::filesystem::exists(file, error); ++i) // numbers of processes come again
        file = directory / fmt::format("vkvol-rescued-{}-{}.exr", getpid(), i);
    try {
        write_exr(file, film, metadata);
    } catch (const RenderError&) {
        return "";
    }
    return fmt::format("; the picture is kept as {}", file.string());
}

// All outputs are tried before the first failure is reported.
double write_outputs(const RenderOptions& options, const Film& film, const Metadata& metadata) {
    const auto start = std::chrono::steady_clock::now();
    std::string failures;
    bool exr_written = false;
    for (const std::filesystem::path& output : options.outputs)
        try {
            write_image(output, film, metadata, options.tone_mapping);
            exr_written = exr_written || output.extension() == ".exr";
        } catch (const RenderError& error) {
            failures += (failures.empty() ? "" : "; ") + std::string(error.what());
        }
    if (!failures.empty())
        throw RenderError(failures + (exr_written ? "" : rescue(film, metadata)));
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// What a failure in the midst of a render leaves.
std::string resume_advice(const RenderOptions& options, std::uint32_t saved_samples) {
    return fmt::format("; {} holds {} samples per pixel: the same command with --resume goes on from there",
                       checkpoint_file(options).string(), saved_samples);
}

// Keeps checkpoints on disk. One that cannot be written is no reason to end the render.
class Keeper {
public:
    explicit Keeper(const RenderOptions& options) : options_(options) {}

    void keep(const Checkpoint& checkpoint) {
        try {
            save_checkpoint(checkpoint_file(options_), checkpoint);
            saved_ = checkpoint.done;
        } catch (const std::exception& error) {
            tell(stderr, "vkvol: warning: {}: the last checkpoint stays\n", error.what());
        }
    }
    std::optional<std::uint32_t> saved() const { return saved_; } // samples per pixel

private:
    const RenderOptions& options_;
    std::optional<std::uint32_t> saved_;
};

std::optional<Checkpoint> find_checkpoint(const RenderOptions& options) {
    std::error_code ignored;
    if (!options.resume)
        return std::nullopt;
    if (std::filesystem::exists(checkpoint_file(options), ignored))
        return load_checkpoint(checkpoint_file(options));
    if (!options.quiet)
        tell(stderr, "vkvol: note: there is no {}: the render begins anew\n", checkpoint_file(options).string());
    return std::nullopt;
}

RenderResult render_with_progress(const RenderOptions& options, const Scene& scene, const Device& device) {
    RenderJob job;
    const std::optional<Checkpoint> from = find_checkpoint(options);
    job.resume = from ? &*from : nullptr;
    Keeper keeper(options);
    if (options.checkpoint) {
        job.checkpoint_seconds = *options.checkpoint;
        job.checkpoint = [&](const Checkpoint& checkpoint) { keeper.keep(checkpoint); };
    }
    job.trace = options.trace;
    job.crop = resolve_crop(options.crop, scene.picture);
    job.seed = options.seed;
    job.sample_offset = options.sample_offset;
    job.time_limit = options.time_limit;
    job.disk_cache = !options.no_cache;
    job.interrupted = interrupted;
    Progress progress(options.progress, options.quiet || options.trace, scene.settings.spp, options.time_limit);
    job.progress = [&](double samples, std::optional<double> noise) {
        progress.update(static_cast<std::uint32_t>(samples), noise);
    };
    try {
        return render(device, scene, job);
    } catch (const RenderError& error) {
        if (!keeper.saved() && !from)
            throw;
        throw RenderError(error.what() + resume_advice(options, keeper.saved().value_or(from ? from->done : 0)));
    }
}

// The checkpoint of a render that is done is of no more use.
void remove_checkpoint(const RenderOptions& options, const Scene& scene, const RenderResult& result) {
    std::error_code ignored;
    if ((options.checkpoint || options.resume) && result.samples == scene.settings.spp)
        std::filesystem::remove(checkpoint_file(options), ignored);
}

bool has_samples(const Film& film) {
    return std::any_of(film.samples.begin(), film.samples.end(), [](std::uint32_t n) { return n > 0; });
}

void check_result(const Device& device, const RenderResult& result) {
    for (const std::string& message : device.validation_messages())
        tell(stderr, "vkvol: validation: {}\n", message);
    if (!device.validation_messages().empty())
        throw RenderError(fmt::format("the validation layer has {} objections", device.validation_messages().size()));
    if (result.counts.queue_overflows > 0)
        throw RenderError(fmt::format("{} queue items were dropped: this is a defect of vkvol; please report the scene",
                                      result.counts.queue_overflows));
}

} // namespace

int run_render(const RenderOptions& options) {
    install_interrupt_handler();
    const Scene scene = load(options);
    print_warnings(options, scene.warnings);
    check_outputs(options);
    const Device device({options.device, options.validate, options.robust});
    const RenderResult result = render_with_progress(options, scene, device);
    print_warnings(options, result.warnings);
    check_result(device, result);
    if (!options.trace && !has_samples(result.film)) {
        print_caps(options, result);
        print_no_samples(result); // and nothing is written, which might spoil a good picture
        return result.interrupted ? exit_interrupted : exit_render_failed;
    }
    const double write_seconds = write_outputs(options, result.film, make_metadata(options, scene, device, result));
    if (options.report)
        write_text(*options.report, make_report(options, scene, device, result, write_seconds));
    remove_checkpoint(options, scene, result);
    if (!options.quiet)
        print_caps(options, result);
    if (options.trace)
        fmt::print("{}", trace_table(result.trace, result.trace_origin, scene.background));
    else if (!options.quiet)
        print_summary(options, device, result);
    if (result.interrupted)
        return exit_interrupted;
    return options.strict && result.counts.any_cap() ? exit_caps_hit : exit_done;
}

} // namespace vkvol
