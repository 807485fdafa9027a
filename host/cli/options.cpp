#include "options.h"

#include <charconv>
#include <fmt/format.h>

#include "bench_options.h"
#include "demo_scene.h"
#include "error.h"
#include "frames.h"
#include "init_options.h"
#include "measure_options.h"
#include "nearest_name.h"
#include "one_line.h"
#include "option_groups.h"
#include "option_values.h"
#include "options_help.h"
#include "tev_picture.h"
#include "tone_options.h"
#include "version.h"
#include "view_options.h"

namespace vkvol {

namespace {

constexpr std::uint32_t max_samples = 2147483647;

// The options of `render` that need a second look after CLI11 has read them.
struct RenderTexts {
    std::string time, noise, crop, checkpoint, pixel, up, schedule, tev, preview, progress = "auto";
    std::vector<std::string> defines;
    std::vector<std::string> outputs;
    ToneTexts tone;
    std::optional<std::uint32_t> sample;
    std::optional<std::string> frames;
    bool version = false;
};

void add_picture_options(CLI::App& app, RenderOptions& render, RenderTexts& texts) {
    const char* group = "Picture";
    add_list(
        app, "-o,--output", texts.outputs,
        "Where to write, .exr, .png or .csv, what <absorption> reads also .nvdb or .vdb; may be given several times")
        ->option_text("FILE [SCENE.exr and SCENE.png here]")
        ->group(group);
    add_size_options(app, render);
    app.add_option("--crop", texts.crop,
                   "Render only this window of the picture: pixels, x1 and y1 excluded; or fractions if written with "
                   "a dot and all at most 1")
        ->option_text("X0,X1,Y0,Y1")
        ->group(group);
    app.add_flag("--frame", render.frame, "Move the camera, without turning it, so that the medium fills the picture")
        ->group(group);
    app.add_option("--aov", render.aov,
                   "Layers of the EXR besides radiance: background, emission, direct, indirect, groups, media, depth, "
                   "position, albedo, transmittance, alpha, normal")
        ->option_text("NAME,NAME...")
        ->group(group);
    app.add_flag(
           "--alpha", render.alpha,
           "Leave out what is behind the media, for compositing: with alpha in EXR, premultiplied, and PNG, not so")
        ->group(group);
    app.add_option("--up", texts.up, "Of a grid file without a scene: y, or z as Blender has it")
        ->option_text("AXIS [y]")
        ->group(group);
    texts.tone.add(app, "agx if it glows, else srgb", "0");
}

void add_sampling_options(CLI::App& app, RenderOptions& render, RenderTexts& texts) {
    const char* group = "Sampling";
    app.add_option("--spp", render.spp, "Samples per pixel, in place of rayPerPixelCount")
        ->transform(whole_number(1, max_samples))
        ->option_text("N [scene]")
        ->group(group);
    app.add_option("--time", texts.time,
                   "Render for this long: 30s, 5m, 2h, or seconds; with --spp, whichever is reached first")
        ->option_text("T")
        ->group(group);
    app.add_option(
           "--noise", texts.noise,
           "Render until the picture's noise, as the summary has it, is no more than this: 1%, or 0.01; looked at "
           "when samples are a power of two. With --spp or --time, whichever is reached first")
        ->option_text("P%")
        ->group(group);
    app.add_option("--seed", render.seed, "Another seed gives another, independent noise pattern")
        ->transform(whole_number(0, max_seed))
        ->option_text("S [0]")
        ->group(group);
    app.add_option("--sample-offset", render.sample_offset,
                   "Number of the first sample; runs with the same seed and disjoint ranges can be merged")
        ->transform(whole_number(0, max_samples))
        ->option_text("K [0]")
        ->group(group);
    app.add_option(
           "--integrator", render.integrator,
           "In place of the scene's, e.g. ratioTracking or ratioTracking:flight=weighted; see vkvol integrators")
        ->option_text("NAME[:AXIS=CHOICE...] [scene]")
        ->group(group);
    add_scene_options(app, render, texts.defines, group);
    app.add_option("-f,--frames", texts.frames,
                   "Render these frames, each with its number as $F in the scene: 1..8, 1..48x4 (every fourth) or "
                   "1,5,9. Names of "
                   "outputs and of --grid may hold it as ####, %04d or $F4; else it comes before the outputs' "
                   "extension. files: "
                   "all for which there is a --grid")
        ->option_text("FRAMES|files")
        ->group(group);
}

void add_run_options(CLI::App& app, RenderOptions& render, RenderTexts& texts) {
    add_device_options(app, render, true);
    app.add_flag("--no-cache", render.no_cache, "Neither read nor write compiled kernels in the user's cache")
        ->group("Device");
    app.add_option(
           "--schedule", texts.schedule,
           "fused: one pass takes pixels through all stages; staged: passes of their own over queues of paths; "
           "auto: what is faster on the device. slots: pixels, or paths, in work; lanes: that work on them; "
           "steps: tracking steps in a turn; budget: turns before a lane lays its path aside; hits: surfaces are "
           "found by a tree of the program's own (tree), or by the device's units for ray tracing (query)")
        ->option_text("NAME[:slots=N][:lanes=N][:steps=N][:budget=N][:hits=WAY] [auto]")
        ->group("Device");

    app.add_option("--report", render.report, "Write what was done and how long it took, as JSON")
        ->option_text("FILE.json")
        ->group("Output");
    app.add_option("--progress", texts.progress,
                   "On standard error: auto (a bar on a terminal), json (a line each), none")
        ->option_text("STYLE [auto]")
        ->group("Output");
    app.add_flag("--tev", texts.tev,
                 fmt::format("Show the picture while it is rendered, with all layers, in the viewer tev; it listens at "
                             "{}, or --tev=HOST:PORT",
                             tev_address))
        ->group("Output");
    app.add_flag("--preview", texts.preview,
                 "Show it on the terminal: --preview=blocks, sixel or kitty, else as the terminal says")
        ->group("Output");
    app.add_option("--checkpoint", texts.checkpoint,
                   "Keep the state of the render this often, beside the first output as NAME.checkpoint")
        ->option_text("T")
        ->group("Output");
    app.add_flag("--resume", render.resume,
                 "Go on from the checkpoint, to the same bits; without one, begin. Frames of -f whose .exr is there, "
                 "whole and "
                 "of the same request, are passed over")
        ->group("Output");
    app.add_flag("--dry-run", render.dry_run,
                 "Check scene, files, device and outputs, say what would be rendered, and render nothing")
        ->group("Output");
    app.add_flag("-q,--quiet", render.quiet, "Print errors only")->group("Output");
    app.add_flag("--strict", render.strict,
                 "End with code 5 if anything was cut short, dropped or cleaned; refuse a pbrt scene of which "
                 "something cannot be rendered")
        ->group("Output");
    app.add_flag("--version", texts.version, "Print the version")->group("Output");
}

void add_trace_options(CLI::App& app, RenderOptions& render, RenderTexts& texts) {
    const char* group = "One path";
    app.add_option("--pixel", texts.pixel, "This pixel of the picture alone")->option_text("X,Y")->group(group);
    app.add_option("--sample", texts.sample, "This sample of it alone")
        ->transform(whole_number(0, max_samples))
        ->option_text("K")
        ->group(group);
    app.add_flag("--trace", render.trace, "Print that path's vertices; pictures only where -o says so")->group(group);
}

std::array<int, 2> parse_pixel(const std::string& text) {
    std::array<int, 2> pixel{};
    const char* end = text.data() + text.size();
    const auto [comma, error] = std::from_chars(text.data(), end, pixel[0]);
    if (error != std::errc() || comma == end || *comma != ',')
        fail_command_line(fmt::format("--pixel: '{}' is not X,Y; e.g. --pixel 12,34", text));
    const auto [last, error2] = std::from_chars(comma + 1, end, pixel[1]);
    if (error2 != std::errc() || last != end || pixel[0] < 0 || pixel[1] < 0)
        fail_command_line(fmt::format("--pixel: '{}' is not X,Y; e.g. --pixel 12,34", text));
    return pixel;
}

void check_trace_complete(const RenderOptions& render, const RenderTexts& texts) {
    std::vector<std::string> missing;
    if (texts.pixel.empty())
        missing.push_back("--pixel X,Y");
    if (!texts.sample)
        missing.push_back("--sample K");
    if (!render.trace)
        missing.push_back("--trace");
    if (missing.empty())
        return;
    std::string instead;
    if (missing.size() == 2 && !texts.pixel.empty()) {
        const auto [x, y] = parse_pixel(texts.pixel);
        instead = fmt::format("; for a picture of that pixel alone, give --crop {},{},{},{}", x, x + 1LL, y, y + 1LL);
    }
    fail_command_line(fmt::format("--pixel X,Y, --sample K and --trace follow one path together: add {}{}",
                                  fmt::join(missing, " and "), instead));
}

// One pixel is a crop, and one sample a range of one.
void finish_trace(RenderOptions& render, const RenderTexts& texts) {
    if (!render.trace && texts.pixel.empty() && !texts.sample)
        return;
    check_trace_complete(render, texts);
    if (render.crop || render.spp || render.time_limit || render.noise_goal || render.sample_offset != 0 ||
        render.checkpoint || render.resume)
        fail_command_line(
            "--trace follows one path; --crop, --spp, --time, --noise, --sample-offset, --checkpoint and --resume "
            "are of no use with it");
    const auto [x, y] = parse_pixel(texts.pixel);
    render.crop = CropRequest{{double(x), x + 1.0, double(y), y + 1.0}, false, true};
    render.sample_offset = *texts.sample;
    render.spp = 1;
}

void finish_render(RenderOptions& render, const RenderTexts& texts) {
    if (render.scene.empty())
        fail_command_line("no scene given; e.g. vkvol scenes/cumulus.xml, or see vkvol --help");
    render.outputs.assign(texts.outputs.begin(), texts.outputs.end());
    if (render.outputs.empty() && !render.trace)
        render.outputs = {render.scene.stem().string() + ".exr", render.scene.stem().string() + ".png"};
    if (!texts.time.empty())
        render.time_limit = parse_duration(texts.time);
    if (!texts.noise.empty())
        render.noise_goal = parse_noise(texts.noise);
    if ((render.time_limit || render.noise_goal) && !render.spp && render.sample_offset >= max_samples)
        fail_command_line(fmt::format("--sample-offset: {} leaves no samples to take; expected less than {}",
                                      render.sample_offset, max_samples));
    if (!texts.checkpoint.empty())
        render.checkpoint = parse_duration(texts.checkpoint, "--checkpoint");
    if (!texts.crop.empty())
        render.crop = parse_crop(texts.crop);
    finish_trace(render, texts);
    for (const std::string& define : texts.defines)
        add_define(render.defines, define);
    if (texts.frames)
        set_frames(render, *texts.frames);
    render.progress = choose<ProgressStyle>(
        "--progress", texts.progress,
        {{"auto", ProgressStyle::automatic}, {"json", ProgressStyle::json}, {"none", ProgressStyle::none}});
    const std::string given = "true"; // CLI11's word for a flag without a value
    render.tev = texts.tev == given ? tev_address : texts.tev;
    render.preview = !texts.preview.empty();
    if (render.preview)
        render.graphics =
            choose<std::optional<TerminalGraphics>>("--preview", texts.preview == given ? "auto" : texts.preview,
                                                    {{"auto", std::nullopt},
                                                     {"blocks", TerminalGraphics::blocks},
                                                     {"sixel", TerminalGraphics::sixel},
                                                     {"kitty", TerminalGraphics::kitty}});
    if (!texts.up.empty())
        render.up = choose<Up>("--up", texts.up, {{"y", Up::y}, {"z", Up::z}});
    if (!texts.schedule.empty())
        set_schedule(texts.schedule, render);
    render.tone = texts.tone.request();
    if (std::string wrong; !parse_layers(render.aov, wrong))
        fail_command_line(fmt::format("--aov: unknown layer '{}'{}", one_line(wrong), name_hint(wrong, layer_names())));
    check_integrator_option(render);
}

void parse_render(CLI::App& app, const std::vector<std::string>& arguments, Options& options) {
    RenderTexts texts;
    add_picture_options(app, options.render, texts);
    add_sampling_options(app, options.render, texts);
    add_run_options(app, options.render, texts);
    add_trace_options(app, options.render, texts);
    if (!run_parser(app, arguments, options))
        return;
    if (texts.version) {
        options.command = Command::print;
        options.text = fmt::format("vkvol {}\n", version);
        return;
    }
    finish_render(options.render, texts);
}

void add_scene(CLI::App& app, RenderOptions& render) {
    app.add_option(
           "scene", render.scene,
           "Scene file, see scenes/README.md, or a scene of pbrt-v4; or a density file, for which a scene is made")
        ->option_text("SCENE.xml|SCENE.pbrt|FILE.nvdb|FILE.vdb");
}

void parse_scene_render(const std::vector<std::string>& arguments, Options& options) {
    CLI::App app(render_description, "vkvol");
    add_scene(app, options.render);
    app.footer(render_footer);
    parse_render(app, arguments, options);
}

// A render of the scene that comes with the program.
void parse_demo(const std::vector<std::string>& arguments, Options& options) {
    CLI::App app(demo_description, "vkvol demo");
    app.footer(demo_footer);
    std::vector<std::string> with_scene = arguments;
    const bool asks = std::any_of(arguments.begin(), arguments.end(),
                                  [](const std::string& word) { return word == "--help" || word == "-h"; });
    if (!asks) {
        add_scene(app, options.render);
        with_scene.insert(with_scene.begin(), demo_scene().string());
    }
    const bool has_curve = std::any_of(arguments.begin(), arguments.end(),
                                       [](const std::string& word) { return word.starts_with("--tonemap"); });
    if (!asks && !has_curve)
        with_scene.push_back("--tonemap=aces");
    parse_render(app, with_scene, options);
}

void parse_devices(const std::vector<std::string>& arguments, Options& options) {
    CLI::App app("Lists the Vulkan devices, and why those that cannot be used cannot.", "vkvol devices");
    app.add_flag("--json", options.devices_json, "For machines");
    run_parser(app, arguments, options);
}

void parse_integrators(const std::vector<std::string>& arguments, Options& options) {
    CLI::App app(integrators_description, "vkvol integrators");
    app.add_flag("--json", options.integrators_json, "For machines");
    run_parser(app, arguments, options);
}

void parse_info(const std::vector<std::string>& arguments, Options& options) {
    CLI::App app("Says what is in a density file: grids, types, bounds, value range; and a view and "
                 "coefficients that "
                 "suit it.",
                 "vkvol info");
    app.add_option("file", options.info_file, "The file")->option_text("FILE.nvdb|.vdb");
    app.add_flag("--json", options.info_json, "For machines");
    if (run_parser(app, arguments, options) && options.info_file.empty())
        fail_command_line("info: no file given; e.g. vkvol info cloud.nvdb");
}

void parse_compare(const std::vector<std::string>& arguments, Options& options) {
    CompareOptions& compare = options.compare;
    CLI::App app(compare_description, "vkvol compare");
    app.add_option("a", compare.a, "The image under test")->option_text("A.exr");
    app.add_option("b", compare.b, "The reference")->option_text("B.exr");
    app.add_option("--significance", compare.significance,
                   "Chance that two renders of the same picture are called different")
        ->check(in_range(1e-12, 0.5))
        ->option_text("P [0.01]");
    app.add_option("--max-relmse", compare.max_relmse, "Judge by relMSE <= X alone, without statistics")
        ->check(in_range(0.0, 1e300))
        ->option_text("X");
    app.add_flag("--json", compare.json, "For machines");
    app.footer(compare_footer);
    if (run_parser(app, arguments, options) && compare.b.empty())
        fail_command_line("compare: two images are needed; e.g. vkvol compare new.exr reference.exr");
}

void parse_merge(const std::vector<std::string>& arguments, Options& options) {
    MergeOptions& merge = options.merge;
    CLI::App app(merge_description, "vkvol merge");
    std::vector<std::string> inputs, outputs;
    ToneTexts tone;
    app.add_option("images", inputs, "Renders of one picture")->option_text("A.exr B.exr ...");
    add_list(app, "-o,--output", outputs, "Where to write, .exr, .png or .csv; may be given several times")
        ->option_text("FILE")
        ->group("Picture");
    tone.add(app, "as rendered", "as rendered");
    app.add_flag("-q,--quiet", merge.quiet, "Print errors only");
    app.footer(merge_footer);
    if (!run_parser(app, arguments, options))
        return;
    if (inputs.empty() || outputs.empty())
        fail_command_line("merge: images and an output are needed; e.g. vkvol merge a.exr b.exr -o all.exr");
    merge.inputs.assign(inputs.begin(), inputs.end());
    merge.outputs.assign(outputs.begin(), outputs.end());
    merge.tone = tone.request();
}

void parse_develop(const std::vector<std::string>& arguments, Options& options) {
    DevelopOptions& develop = options.develop;
    CLI::App app(develop_description, "vkvol develop");
    std::vector<std::string> outputs;
    ToneTexts tone;
    app.add_option("image", develop.input, "A render, or any image with channels R, G and B")->option_text("A.exr");
    add_list(app, "-o,--output", outputs, "Where to write, .png; may be given several times")
        ->option_text("FILE")
        ->group("Picture");
    tone.add(app, "as rendered", "as rendered");
    app.add_flag("-q,--quiet", develop.quiet, "Print errors only");
    app.footer(develop_footer);
    if (!run_parser(app, arguments, options))
        return;
    if (develop.input.empty() || outputs.empty())
        fail_command_line("develop: an image and an output are needed; e.g. vkvol develop a.exr -o b.png --exposure 1");
    develop.outputs.assign(outputs.begin(), outputs.end());
    develop.tone = tone.request();
}

void parse_convert(const std::vector<std::string>& arguments, Options& options) {
    ConvertOptions& convert = options.convert;
    CLI::App app(convert_description, "vkvol convert");
    app.add_option("scene", convert.scene, "A scene of pbrt-v4")->option_text("SCENE.pbrt");
    app.add_option("-o,--output", convert.output, "Where to write, .xml")->option_text("FILE");
    app.add_flag("--strict", convert.strict, "Write nothing if something of the scene cannot be rendered");
    app.add_flag("-q,--quiet", convert.quiet, "Print errors only");
    app.footer(convert_footer);
    if (!run_parser(app, arguments, options))
        return;
    if (convert.scene.empty() || convert.output.empty())
        fail_command_line("convert: a scene and an output are needed; e.g. vkvol convert cloud.pbrt -o cloud.xml");
}

// A misspelt command would be taken for a scene.
void check_command_spelling(const std::string& word, const std::vector<std::string>& commands) {
    std::error_code ignored;
    const std::filesystem::path path(word);
    if (word.empty() || word[0] == '-' || path.has_extension() || std::filesystem::exists(path, ignored))
        return;
    if (const std::string nearest = nearest_name(word, commands); !nearest.empty())
        fail_command_line(fmt::format("unknown command '{}'; did you mean {}?", word, nearest));
}

} // namespace

Options parse_options(int argc, const char* const* argv) {
    std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
    using Parser = void (*)(const std::vector<std::string>&, Options&);
    const std::vector<std::pair<std::string, std::pair<Command, Parser>>> commands = {
        {"render", {Command::render, parse_scene_render}},
        {"devices", {Command::devices, parse_devices}},
        {"info", {Command::info, parse_info}},
        {"integrators", {Command::integrators, parse_integrators}},
        {"compare", {Command::compare, parse_compare}},
        {"merge", {Command::merge, parse_merge}},
        {"develop", {Command::develop, parse_develop}},
        {"convert", {Command::convert, parse_convert}},
        {"bench", {Command::bench, parse_bench}},
        {"demo", {Command::render, parse_demo}},
        {"measure", {Command::measure, parse_measure}},
        {"view", {Command::view, parse_view}},
        {"init", {Command::init, parse_init}}};
    Options options;
    Parser parse = parse_scene_render;
    if (!arguments.empty()) {
        std::vector<std::string> names;
        bool found = false;
        for (const auto& [name, command] : commands) {
            names.push_back(name);
            if (name != arguments.front())
                continue;
            found = true;
            options.command = command.first;
            parse = command.second;
        }
        if (found)
            arguments.erase(arguments.begin());
        else
            check_command_spelling(arguments.front(), names);
    }
    parse(arguments, options);
    return options;
}

} // namespace vkvol
