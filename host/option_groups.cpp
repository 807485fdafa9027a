#include "option_groups.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>

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

} // namespace

bool run_parser(CLI::App& app, const std::vector<std::string>& arguments, Options& options) {
    app.allow_extras(); // so that the hint can be ours
    app.get_formatter()->column_width(34);
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
    const std::vector<std::string> rest = app.remaining();
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

void add_size_options(CLI::App& app, RenderOptions& render) {
    app.add_option("--width", render.width, "Pixels across; the view stays, and the shape too if given alone")
        ->check(CLI::Range(1, 65536))
        ->option_text("W [scene]")
        ->group("Picture");
    app.add_option("--height", render.height, "Pixels down; likewise")
        ->check(CLI::Range(1, 65536))
        ->option_text("H [scene]")
        ->group("Picture");
}

void add_scene_options(CLI::App& app, RenderOptions& render, std::vector<std::string>& defines, const char* group) {
    app.add_option("--grid", render.grid, "A .nvdb or .vdb file in place of the scene's density field")
        ->option_text("FILE [scene]")
        ->group(group);
    add_list(app, "-D,--define", defines, "Fills $KEY in the scene; may be given several times")
        ->option_text("KEY=VALUE")
        ->group(group);
}

void add_device_options(CLI::App& app, RenderOptions& render) {
    app.add_option("--device", render.device, "auto, a number from vkvol devices, part of a name, a UUID, or cpu")
        ->option_text("DEVICE [auto]")
        ->group("Device");
    app.add_flag("--robust", render.robust, "Robust buffer access: out-of-range reads give zero")->group("Device");
    app.add_flag("--validate", render.validate, "Switch the Vulkan validation layer on")->group("Device");
}

} // namespace vkvol
