#include "render_command.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <new>

#include "checkpoint_file.h"
#include "dry_run.h"
#include "error.h"
#include "explain.h"
#include "file_ending.h"
#include "image_io.h"
#include "interrupt.h"
#include "live_pictures.h"
#include "loaded_medium.h"
#include "messages.h"
#include "picture_codec.h"
#include "progress.h"
#include "reading_grid.h"
#include "render_notes.h"
#include "render_outputs.h"
#include "render_scene.h"
#include "render_summary.h"
#include "requested_scene.h"
#include "sequence.h"
#include "session.h"
#include "trace.h"
#include "workshop.h"

namespace vkvol {

namespace {

// Before any work is done: a render that cannot be written, or would be written over its own files, is not worth its
// time.
FileUses check_files(const RenderOptions& options, const RenderScene& loaded, const CheckpointFile& checkpoint) {
    FileUses uses;
    uses.reads("the scene", options.scene);
    uses.reads_files_of(loaded.scene);
    for (const std::filesystem::path& output : options.outputs)
        uses.writes("a picture", output, "-o");
    if (is_kept(options, loaded))
        uses.writes("the scene that is made", loaded.xml_file, "-o");
    if (!checkpoint.path().empty())
        uses.writes("the checkpoint", checkpoint.path(), "-o");
    if (options.report)
        uses.writes("the report", *options.report, "--report");
    uses.check();
    for (const std::filesystem::path& output : options.outputs)
        if (is_grid_file(output))
            check_grid_file(output, loaded.scene.camera, options.crop.has_value());
        else
            check_writable(output);
    if (options.report)
        check_directory_writable(*options.report, "--report");
    checkpoint.check();
    return uses;
}

// None: all layers that are asked for are kept, or shown.
std::string lost_layers(const RenderOptions& options, const Scene& scene) {
    const auto writes = [&](const char* ending) {
        return std::any_of(options.outputs.begin(), options.outputs.end(),
                           [&](const std::filesystem::path& output) { return file_ending(output) == ending; });
    };
    if (writes(".exr") || !options.tev.empty() || options.trace)
        return "";
    const bool has_alpha = scene.holds_out && writes(".png");
    std::string names;
    for (std::size_t i = 0; i < layer_names().size(); ++i)
        if (const unsigned layer = 1u << i; (scene.layers & layer) && !(layer == layer_alpha && has_alpha))
            names += (names.empty() ? "" : ", ") + layer_names()[i];
    return names.empty() ? "" : fmt::format("layers are kept in .exr alone, and are lost: {}; add -o FILE.exr", names);
}

// Samples that are done are not lost to those that cannot be. While it makes ready, the session may have begun to load
// `codec`, without which none could be kept.
RenderResult render_what_can_be(const Device& device, const Scene& scene, const RenderJob& job,
                                std::future<void>& codec) {
    Session session(device, scene, job);
    if (codec.valid())
        codec.get();
    session.check_resume(scene.settings.spp);
    std::exception_ptr failure;
    try {
        if (!job.dry_run)
            session.render(scene.settings.spp);
    } catch (const std::exception&) {
        if (session.samples() == 0 || !session.has_whole_film())
            throw;
        failure = std::current_exception();
    }
    RenderResult result = std::move(session.result());
    result.failure = failure;
    return result;
}

RenderResult render_with_progress(const RenderOptions& options, const Scene& scene, Workshop& workshop,
                                  CheckpointFile& file, LivePictures& live) {
    RenderJob job;
    job.workshop = &workshop;
    job.dry_run = options.dry_run;
    const std::optional<Checkpoint>& from = file.find();
    job.resume = from ? &*from : nullptr;
    if (options.checkpoint) {
        job.checkpoint_seconds = *options.checkpoint;
        job.checkpoint = [&](const Checkpoint& checkpoint) { file.keep(checkpoint); };
    }
    job.trace = options.trace;
    job.crop = resolve_crop(options.crop, scene.picture);
    job.seed = options.seed;
    job.plan = options.plan;
    job.sample_offset = options.sample_offset;
    job.time_limit = options.time_limit;
    job.noise_goal = options.noise_goal;
    job.disk_cache = !options.no_cache && !options.dry_run;
    job.interrupted = interrupted;
    Progress progress(options.progress, options.quiet || options.trace || options.dry_run, scene.settings.spp,
                      options.time_limit, options.noise_goal);
    std::future<void> codec;
    if (!options.outputs.empty() && !options.dry_run)
        job.compiling = [&codec] { codec = picture_codec_ahead(); };
    job.progress = [&](double samples, std::optional<double> noise) { progress.update(samples, noise); };
    const std::vector<const Device*> devices = workshop.devices(options.device);
    const Device& device = *devices.front();
    job.others.assign(devices.begin() + 1, devices.end());
    if (!live.empty())
        job.preview = [&](const RenderResult& result) { live.show(device, result, &progress); };
    try {
        return render_what_can_be(device, scene, job, codec);
    } catch (const RenderError& error) {
        throw RenderError(error.what() + file.advice());
    }
}

bool has_samples(const Film& film) {
    return std::any_of(film.samples.begin(), film.samples.end(), [](std::uint32_t n) { return n > 0; });
}

// Once, also where all frames of a sequence have the same.
void tell_why(const RenderOptions& options, Workshop& workshop, const std::optional<Explanation>& explanation) {
    if (explanation && !workshop.new_warnings({explanation->text}).empty() && !options.quiet)
        print_explanation(*explanation);
}

// What the validation layer objects to, once it has been told; a picture is written all the same.
std::string objection_of(const std::vector<const Device*>& devices) {
    try {
        for (const Device* device : devices)
            check_validation(*device);
    } catch (const RenderError& error) {
        return error.what();
    }
    return "";
}

int render_scene(const RenderOptions& options, const Scene& scene, Workshop& workshop, CheckpointFile& checkpoint,
                 RenderOutputs& outputs, LivePictures& live) {
    const std::optional<Explanation> foreseen = options.trace ? std::nullopt : foresee(scene);
    tell_why(options, workshop, foreseen);
    const std::vector<const Device*> devices = workshop.devices(options.device);
    const Device& device = *devices.front();
    outputs.set_device(device.info());
    const RenderResult result = render_with_progress(options, scene, workshop, checkpoint, live);
    live.show(device, result, nullptr);
    if (!options.quiet)
        print_warnings(workshop.new_warnings(result.warnings));
    const std::string objection = objection_of(devices);
    if (options.dry_run) {
        if (!objection.empty())
            throw RenderError(objection);
        if (!options.quiet)
            print_dry_run(options, scene, device, result);
        return exit_done;
    }
    if (!options.trace && !has_samples(result.film)) {
        print_caps(options, result);
        const std::string why = no_samples_text(result) + (objection.empty() ? "" : "; " + objection);
        outputs.write_report(device, result, why);
        tell(stderr, "vkvol: {}: no picture is written\n", why); // which might spoil a good one
        return result.interrupted ? exit_interrupted : exit_render_failed;
    }
    Shown shown;
    if (shows(options))
        shown.tone = choose_tone(options.tone, result.film, make_metadata(options, scene, device, result));
    shown.explanation = foreseen || options.trace ? foreseen : explain(scene, result, shown.tone);
    outputs.write(device, result, shown, objection);
    if (!objection.empty())
        throw RenderError(objection);
    // A picture's time may be given once more, and it goes on; a frame is done with it.
    const bool is_done = result.samples == scene.settings.spp || result.reached_goal;
    if (is_done || (options.is_frame && !result.interrupted && !result.failure))
        checkpoint.remove();
    if (!foreseen)
        tell_why(options, workshop, shown.explanation);
    if (!options.quiet)
        print_caps(options, result);
    if (options.trace)
        put(stdout, trace_table(result.trace, result.trace_origin, result.film.mean.front()));
    else if (!options.quiet)
        print_summary(options, device, result, shown.tone);
    if (result.failure) {
        tell(stderr, "vkvol: note: {} samples per pixel were done, and are written{}\n", result.samples,
             checkpoint.advice());
        std::rethrow_exception(result.failure);
    }
    if (result.interrupted)
        return exit_interrupted;
    return options.strict && result.counts.any_cap() ? exit_caps_hit : exit_done;
}

} // namespace

CheckedPicture check_picture(const RenderOptions& options, Workshop& workshop) {
    const RenderScene loaded = load_render_scene(options, workshop.fields(), false);
    resolve_crop(options.crop, loaded.scene.picture);
    CheckedPicture checked{grid_files(loaded.scene), check_files(options, loaded, CheckpointFile(options))};
    checked.uses.check_inputs();
    return checked;
}

int render_picture(const RenderOptions& options, Workshop& workshop) {
    const RenderScene loaded = load_render_scene(options, workshop.fields());
    const Scene& scene = loaded.scene;
    print_reading(options);
    if (!options.quiet)
        print_warnings(workshop.new_warnings(scene.warnings));
    const bool gave_camera = loaded.xml.empty() && !loaded.assumed.empty();
    if (!options.quiet && gave_camera && !workshop.new_warnings({loaded.assumed}).empty()) // once in a sequence
        tell(stderr, "vkvol: note: {}\n", loaded.assumed);
    if (const std::string lost = lost_layers(options, scene); !lost.empty() && !options.quiet)
        print_warnings(workshop.new_warnings({lost}));
    CheckpointFile checkpoint(options);
    check_files(options, loaded, checkpoint);
    LivePictures live(options, scene, workshop.viewer_is_gone);
    if (!live.missing().empty()) {
        workshop.viewer_is_gone = true;
        print_warnings({live.missing()});
    }
    keep_made_scene(options, loaded);
    RenderOutputs outputs(options, scene);
    try {
        return render_scene(options, scene, workshop, checkpoint, outputs, live);
    } catch (const std::bad_alloc&) {
        outputs.fail("out of memory");
        throw;
    } catch (const std::exception& error) {
        outputs.fail(error.what());
        throw;
    }
}

int run_render(const RenderOptions& options) {
    install_interrupt_handler();
    if (!options.frames.empty())
        return run_sequence(options);
    Workshop workshop(false);
    const int code = render_picture(options, workshop);
    if (options.dry_run && !options.quiet)
        tell(stdout, "all is well: nothing is rendered, nothing written\n");
    return code;
}

} // namespace vkvol
