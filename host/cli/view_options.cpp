#include "view_options.h"

#include "option_groups.h"
#include "option_values.h"
#include "options_help.h"

namespace vkvol {

namespace {

constexpr double usual_noise = 0.005; // beyond which nobody sees a picture become better

struct ViewTexts {
    std::vector<std::string> defines;
    SamplingTexts sampling;
};

void add_options(CLI::App& app, ViewOptions& view, ViewTexts& texts) {
    RenderRequest& request = view.request;
    app.add_option("scene", request.scene, "Scene file, scene of pbrt-v4, or density file, as of a render")
        ->option_text("SCENE.xml|SCENE.pbrt|FILE.nvdb|FILE.vdb");
    app.add_option("--port", view.port, "Where the page is, on this machine alone")
        ->transform(whole_number(0, 65535))
        ->option_text("N [any that is free]");
    add_size_options(app, request);
    add_sampling_options(app, request, texts.sampling, " [0.5%]");
    add_scene_options(app, request, texts.defines, "Sampling");
    add_device_options(app, request);
    app.add_flag("--strict", view.strict, "Refuse a pbrt scene of which something cannot be rendered")->group("Output");
    app.add_flag("-q,--quiet", view.quiet, "Print errors and the page's address only")->group("Output");
    app.footer(view_footer);
}

} // namespace

void parse_view(const std::vector<std::string>& arguments, Options& options) {
    ViewOptions& view = options.view;
    CLI::App app(view_description, "vkvol view");
    ViewTexts texts;
    add_options(app, view, texts);
    if (!run_parser(app, arguments, options))
        return;
    if (view.request.scene.empty())
        fail_command_line("view: no scene given; e.g. vkvol view scenes/cumulus.xml");
    for (const std::string& define : texts.defines)
        add_define(view.request.defines, define);
    view.request.noise_goal = usual_noise;
    finish_sampling(view.request, texts.sampling);
}

} // namespace vkvol
