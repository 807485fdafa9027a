#include "option_groups.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>

#include "error.h"
#include "integrators.h"
#include "nearest_name.h"
#include "option_values.h"

namespace vkvol {

namespace {

std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames())
            names.push_back("--" + name);
        for (const std::string& name : option->get_snames())
            names.push_back("-" + name);
    }
    return names;
}

// What is empty came from a variable that was not set; CLI11 would take the next word for the value of `--name=`.
void check_no_empty_word(const CLI::App& app, const std::vector<std::string>& arguments) {
    const auto fail_empty = [&app](const std::string& name) {
        const CLI::Option* option = app.get_option_no_throw(name);
        std::string expected = option ? option->get_option_text() : "";
        expected = expected.substr(0, expected.find(" ["));
        fail_command_line(fmt::format("{}: is empty{}; see {} --help", name,
                                      expected.empty() ? "" : "; expected " + expected, app.get_name()));
    };
    for (std::size_t i = 0; i < arguments.size() && arguments[i] != "--"; ++i) {
        const std::string& word = arguments[i];
        if (word.size() > 3 && word.starts_with("--") && word.find('=') == word.size() - 1)
            fail_empty(word.substr(0, word.size() - 1));
        const CLI::Option* before = i > 0 ? app.get_option_no_throw(arguments[i - 1]) : nullptr;
        if (word.empty() && before && before->get_items_expected_min() > 0)
            fail_empty(arguments[i - 1]);
        if (word.empty())
            fail_command_line(fmt::format("word {} is empty; see {} --help", i + 1, app.get_name()));
    }
}

} // namespace

bool run_parser(CLI::App& app, const std::vector<std::string>& arguments, Options& options) {
    app.allow_extras(); // so that the hint can be ours
    app.get_formatter()->column_width(34);
    check_no_empty_word(app, arguments);
    try {
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::CallForHelp&) {
        options.command = Command::print;
        options.text = app.help();
        return false;
    } catch (const CLI::ParseError& error) {
        std::string message = error.what();
        std::replace(message.begin(), message.end(), '\n', ' ');
        fail_command_line(fmt::format("{}; see {} --help", message, app.get_name()));
    }
    std::vector<std::string> rest = app.remaining();
    std::erase(rest, "--"); // it has done its work
    for (const std::string& argument : rest)
        if (argument.size() > 1 && argument[0] == '-') {
            const std::string name = argument.substr(0, argument.find('='));
            const std::string nearest = nearest_name(name, option_names(app));
            fail_command_line(fmt::format("unknown option {}{}; see {} --help", name,
                                          nearest.empty() ? "" : "; did you mean " + nearest + "?", app.get_name()));
        }
    if (!rest.empty())
        fail_command_line(fmt::format("unexpected argument '{}'; see {} --help", rest.front(), app.get_name()));
    return true;
}

CLI::Validator in_range(double low, double high) {
    return CLI::Validator(
        [low, high](std::string& text) {
            double value = 0.0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
            const bool good = error == std::errc() && end == text.data() + text.size() && value >= low && value <= high;
            return good ? "" : fmt::format("'{}' is not a number from {:g} to {:g}", text, low, high);
        },
        "");
}

CLI::Validator whole_number(long long low, long long high) {
    return CLI::Validator(
        [low, high](std::string& text) -> std::string {
            long long value = 0;
            const char* const begin = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0);
            const char* const end = text.data() + text.size();
            const auto [last, error] = std::from_chars(begin, end, value);
            if (error != std::errc() || last != end || value < low || value > high)
                return fmt::format("'{}' is not a whole number from {} to {}", text, low, high);
            text = std::to_string(value); // CLI11 takes a leading 0 for a sign of octal numbers
            return "";
        },
        "");
}

void add_size_options(CLI::App& app, RenderRequest& render) {
    app.add_option("--width", render.width, "Pixels across; the view stays, and the shape too if given alone")
        ->transform(whole_number(1, 65536))
        ->option_text("W [scene]")
        ->group("Picture");
    app.add_option("--height", render.height, "Pixels down; likewise")
        ->transform(whole_number(1, 65536))
        ->option_text("H [scene]")
        ->group("Picture");
}

void add_scene_options(CLI::App& app, RenderRequest& render, std::vector<std::string>& defines, const char* group) {
    app.add_option("--grid", render.grid, "A .nvdb or .vdb file in place of the scene's density field")
        ->option_text("FILE [scene]")
        ->group(group);
    add_list(app, "-D,--define", defines, "Fills $KEY in the scene; may be given several times")
        ->option_text("KEY=VALUE")
        ->group(group);
}

void add_sampling_options(CLI::App& app, RenderRequest& render, SamplingTexts& texts, const char* usual_noise) {
    const char* group = "Sampling";
    app.add_option("--spp", render.spp, "Samples per pixel, in place of rayPerPixelCount")
        ->transform(whole_number(1, 2147483647))
        ->option_text("N [scene]")
        ->group(group);
    app.add_option("--noise", texts.noise, "Until each picture's noise is no more than this: 1%, or 0.01")
        ->option_text(fmt::format("P%{}", usual_noise))
        ->group(group);
    app.add_option("--seed", render.seed, "Another one gives another, independent noise pattern")
        ->transform(whole_number(0, max_seed))
        ->option_text("S [0]")
        ->group(group);
    app.add_option("--integrator", render.integrator, "In place of the scene's; see vkvol integrators")
        ->option_text("NAME[:AXIS=CHOICE...] [scene]")
        ->group(group);
    app.add_flag("--no-cache", render.no_cache, "Neither read nor write the pipeline cache")->group("Device");
    app.add_option("--schedule", texts.schedule, "As of a render")->option_text("NAME [auto]")->group("Device");
}

void finish_sampling(RenderRequest& render, const SamplingTexts& texts) {
    if (!texts.noise.empty())
        render.noise_goal = parse_noise(texts.noise);
    if (!texts.schedule.empty())
        set_schedule(texts.schedule, render);
    check_integrator_option(render);
}

void set_schedule(const std::string& text, RenderRequest& render) {
    render.plan = parse_schedule(text);
    render.device.ray_queries = render.plan.hits == Hits::query;
}

void check_integrator_option(const RenderRequest& render) {
    if (render.integrator)
        try {
            parse_integrator(*render.integrator);
        } catch (const InputError& error) {
            fail_command_line(fmt::format("--integrator: {}", error.what()));
        }
}

void add_device_options(CLI::App& app, RenderRequest& render, bool several) {
    app.add_option("--device", render.device.choice,
                   std::string("auto, a number from vkvol devices, part of a name, a UUID, or cpu") +
                       (several ? "; or several numbers, as 0,1, which share the picture's rows by their speed" : ""))
        ->option_text("DEVICE [auto]")
        ->group("Device");
    app.add_flag("--robust", render.device.robust, "Robust buffer access: out-of-range reads give zero")
        ->group("Device");
    app.add_flag("--validate", render.device.validate, "Switch the Vulkan validation layer on")->group("Device");
}

} // namespace vkvol
