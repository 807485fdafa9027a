#include "pbrt_colors.h"

#include <fmt/format.h>
#include <sstream>

#include "blackbody.h"
#include "error.h"
#include "input_file.h"

namespace vkvol {

namespace {

constexpr std::size_t longest_spectrum = 1 << 20; // bytes

[[noreturn]] void fail(const PbrtParameter& parameter, const std::string& expected) {
    fail_at(parameter.place, fmt::format("\"{} {}\": expected {}", parameter.type, parameter.name, expected));
}

bool has_values(const PbrtParameter& parameter, std::size_t count) {
    return parameter.numbers.size() == count && parameter.texts.empty();
}

const std::string& space_of(const PbrtThing& thing, const PbrtParameter& parameter) {
    return parameter.color_space.empty() ? thing.color_space : parameter.color_space;
}

glm::dvec3 to_scene(const PbrtThing& thing, const PbrtParameter& parameter, std::size_t at = 0) {
    const glm::dvec3 own(parameter.numbers[at], parameter.numbers[at + 1], parameter.numbers[at + 2]);
    const std::string& space = space_of(thing, parameter);
    if (space == "srgb")
        return own;
    return glm::max(*to_rec709(space) * own, glm::dvec3(0.0));
}

std::vector<double> numbers_in_file(const std::filesystem::path& file, const PbrtParameter& parameter) {
    std::string text;
    try {
        text = read_input_text(file, longest_spectrum, "or one of pbrt's own names");
    } catch (const InputError& error) {
        fail_at(parameter.place, error.what());
    }
    std::istringstream lines(text);
    std::vector<double> numbers;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line.substr(0, line.find('#')));
        for (std::string word; words >> word;) {
            const std::optional<double> number = pbrt_number(word);
            if (!number)
                fail_at(parameter.place,
                        fmt::format("{}: '{}' is no number; expected wavelengths and values", file.string(), word));
            numbers.push_back(*number);
        }
    }
    return numbers;
}

} // namespace

Spectrum PbrtColors::spectrum(const PbrtParameter& parameter) const {
    if (parameter.numbers.empty() && !files_.contains(parameter.texts.front()))
        files_[parameter.texts.front()] = numbers_in_file(folder_ / parameter.texts.front(), parameter);
    const std::vector<double>& numbers =
        parameter.numbers.empty() ? files_[parameter.texts.front()] : parameter.numbers;
    if (numbers.empty() || numbers.size() % 2 != 0)
        fail(parameter, "wavelengths in nm, each with its value");
    Spectrum spectrum;
    for (std::size_t i = 0; i < numbers.size(); i += 2) {
        if (!spectrum.empty() && numbers[i] <= spectrum.back().first)
            fail(parameter, "wavelengths that ascend");
        spectrum.emplace_back(numbers[i], numbers[i + 1]);
    }
    return spectrum;
}

// What does not depend on its use: "rgb", and "color" as older scenes have it.
std::optional<glm::dvec3> PbrtColors::color(const PbrtThing& thing, const PbrtParameter& parameter) const {
    if (parameter.type != "rgb" && parameter.type != "color")
        return std::nullopt;
    if (!has_values(parameter, 3))
        fail(parameter, "red, green and blue");
    return to_scene(thing, parameter);
}

// A "spectrum" of values, or by one of pbrt's names or a file's.
template <class Named, class Whole>
glm::dvec3 PbrtColors::of_spectrum(const PbrtParameter& parameter, const Named& named, const Whole& whole) const {
    if (parameter.type != "spectrum" || (parameter.numbers.empty() && parameter.texts.size() != 1))
        fail(parameter, "a colour or spectrum");
    if (parameter.numbers.empty())
        if (const std::optional<glm::dvec3> known = named(parameter.texts.front()))
            return *known;
    return whole(spectrum(parameter));
}

std::vector<glm::dvec3> PbrtColors::colors(const PbrtThing& thing, const std::string& name) const {
    const PbrtParameter* parameter = thing.parameters->find(name);
    if (!parameter)
        return {};
    if ((parameter->type != "rgb" && parameter->type != "color") || parameter->numbers.size() % 3 != 0)
        fail(*parameter, "red, green and blue of each voxel");
    std::vector<glm::dvec3> colors;
    for (std::size_t i = 0; i < parameter->numbers.size(); i += 3)
        colors.push_back(to_scene(thing, *parameter, i));
    return colors;
}

std::optional<glm::dvec3> PbrtColors::share(const PbrtThing& thing, const std::string& name) const {
    const PbrtParameter* parameter = thing.parameters->find(name);
    if (!parameter)
        return std::nullopt;
    if (const std::optional<glm::dvec3> rgb = color(thing, *parameter))
        return rgb;
    if (parameter->type == "float" && has_values(*parameter, 1))
        return glm::dvec3(parameter->numbers[0]);
    return of_spectrum(*parameter, named_share, color_of_share);
}

std::optional<glm::dvec3> PbrtColors::light(const PbrtThing& thing, const std::string& name) const {
    const PbrtParameter* parameter = thing.parameters->find(name);
    if (!parameter)
        return std::nullopt;
    if (const std::optional<glm::dvec3> rgb = color(thing, *parameter))
        return *rgb * white_of_space(space_of(thing, *parameter));
    if (parameter->type != "blackbody")
        return of_spectrum(*parameter, named_light, color_of_light);
    if (!has_values(*parameter, 1) || !(parameter->numbers[0] > 0.0))
        fail(*parameter, "one temperature in kelvin");
    return blackbody_rgb(parameter->numbers[0], parameter->numbers[0]);
}

} // namespace vkvol
