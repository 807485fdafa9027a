#include "missing_field.h"

#include <algorithm>
#include <fmt/format.h>
#include <sstream>

namespace vkvol {

namespace {

using std::filesystem::path;

// Beside this program, as the build leaves it, or as it is installed.
std::string make_field_command() {
    std::error_code error;
    const path folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
    if (!error && std::filesystem::exists(folder / "vkvol-make-field", error))
        return folder == "/usr/bin" ? "vkvol-make-field" : (folder / "vkvol-make-field").string();
    const path beside = folder / "make_field";
    if (error || !std::filesystem::exists(beside, error))
        return "build/make_field";
    const path relative = std::filesystem::proximate(beside, error);
    return error || relative.string().size() > beside.string().size() ? beside.string() : relative.string();
}

// Name and options of make_field for names such as ramp, ramp-fp8 and ramp-440-fp8; empty: it has no such field.
std::string make_field_arguments(const std::string& stem) {
    constexpr std::array<std::string_view, 5> types = {"half", "fp4", "fp8", "fp16", "fpn"};
    std::istringstream words(stem);
    std::string word, arguments;
    while (std::getline(words, word, '-'))
        if (arguments.empty() && std::find(recipe_names.begin(), recipe_names.end(), word) != recipe_names.end())
            arguments = word;
        else if (!arguments.empty() && word.find_first_not_of("0123456789") == std::string::npos)
            arguments += " --size " + word;
        else if (!arguments.empty() && std::find(types.begin(), types.end(), word) != types.end())
            arguments += " --type " + word;
        else
            return "";
    return arguments;
}

} // namespace

std::string missing_field_hint(const path& file) {
    if (file.filename().string().find("##") != std::string::npos)
        return "#### is the number of a frame: say which, -f files or -f 1..48; in a scene file it is $F4, e.g. "
               "smoke.$F4.vdb";
    if (const std::string arguments = make_field_arguments(file.stem().string()); !arguments.empty())
        return fmt::format("make it with `{} {} -o {}`", make_field_command(), arguments, file.string());
    return "check the path, which starts from the scene file's directory in a scene, and from the current one after "
           "--grid";
}

} // namespace vkvol
