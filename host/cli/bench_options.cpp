#include "bench_options.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

#include "error.h"
#include "integrators.h"
#include "option_groups.h"
#include "option_values.h"
#include "options_help.h"

namespace vkvol {

namespace {

struct BenchTexts {
    std::string integrators, time;
    std::vector<std::string> defines;
};

// The list in its parts; each must be an integrator, and none may come twice, since results go by name.
std::vector<std::string> parse_list(const std::string& text) {
    std::vector<std::string> list;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string name = text.substr(begin, end - begin);
        if (name.empty())
            fail_command_line(fmt::format("--integrators: '{}' has an empty name in it; expected e.g. "
                                          "ratioTracking,regularTracking",
                                          text));
        try {
            parse_integrator(name);
        } catch (const InputError& error) {
            fail_command_line(fmt::format("--integrators: {}", error.what()));
        }
        if (std::find(list.begin(), list.end(), name) != list.end())
            fail_command_line(fmt::format("--integrators: {} given twice; once is enough", name));
        list.push_back(name);
        begin = end + 1;
    }
    return list;
}

// As a shell would read it.
std::string command_text(const std::vector<std::string>& arguments) {
    std::string text = "vkvol bench";
    for (const std::string& argument : arguments) {
        const bool plain = !argument.empty() && std::all_of(argument.begin(), argument.end(), [](char c) {
            return std::isalnum(static_cast<unsigned char>(c)) ||
                   std::string("-_=./:,+@%").find(c) != std::string::npos;
        });
        std::string quoted;
        for (const char c : argument)
            quoted += c == '\'' ? "'\\''" : std::string(1, c);
        text += " " + (plain ? argument : "'" + quoted + "'");
    }
    return text;
}

void add_options(CLI::App& app, BenchRequest& bench, BenchTexts& texts) {
    app.add_option("scene", bench.render.scene, "Scene file; see scenes/README.md")
        ->option_text("SCENE.xml|SCENE.pbrt");
    app.add_option("-o,--output", bench.name, "What the results' names begin with")
        ->option_text("NAME [the scene's, here]")
        ->group("Picture");
    add_size_options(app, bench.render);
    const char* group = "Measuring";
    app.add_option("--integrators", texts.integrators, "What to measure; see vkvol integrators")
        ->option_text("A,B,... [the unbiased ones that suit the scene]")
        ->group(group);
    app.add_option("--time", texts.time, "Rendering that is measured: 30s, 5m, 2h, or seconds")
        ->option_text("T [60s]")
        ->group(group);
    app.add_option("--reference", bench.reference, "An image to measure against, rather than one rendered for it")
        ->option_text("FILE.exr")
        ->group(group);
    app.add_option("--seed", bench.render.seed, "Every render has a seed of its own, made from this one")
        ->transform(whole_number(0, max_seed))
        ->option_text("S [0]")
        ->group(group);
    add_scene_options(app, bench.render, texts.defines, group);
    add_device_options(app, bench.render);
    app.add_flag("--no-cache", bench.render.no_cache, "Neither read nor write cached pipelines and references")
        ->group("Device");
    app.add_flag("-q,--quiet", bench.quiet, "Print errors and the table only")->group("Output");
    app.footer(bench_footer);
}

} // namespace

void parse_bench(const std::vector<std::string>& arguments, Options& options) {
    BenchRequest& bench = options.bench;
    CLI::App app(bench_description, "vkvol bench");
    BenchTexts texts;
    add_options(app, bench, texts);
    if (!run_parser(app, arguments, options))
        return;
    if (bench.render.scene.empty())
        fail_command_line("bench: no scene given; e.g. vkvol bench scenes/cumulus.xml --width 120");
    if (!texts.integrators.empty())
        bench.integrators = parse_list(texts.integrators);
    if (!texts.time.empty())
        bench.seconds = parse_duration(texts.time);
    if (bench.name.empty())
        bench.name = bench.render.scene.stem();
    for (const std::string& define : texts.defines)
        add_define(bench.render.defines, define);
    bench.command = command_text(arguments);
}

} // namespace vkvol
