#include "option_values.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

#include "error.h"
#include "one_line.h"

namespace vkvol {

namespace {

std::uint32_t parse_plan_number(const std::string& text, const char* key, std::uint32_t least, std::uint32_t most) {
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || number < least || number > most)
        fail_command_line(
            fmt::format("--schedule: {}={}: expected a whole number from {} to {}", key, text, least, most));
    return number;
}

} // namespace

void fail_command_line(const std::string& message) {
    throw InputError("command line: " + one_line(message));
}

double parse_number(const std::string& text, const std::string& what) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        fail_command_line(fmt::format("{}: '{}' is not a number", what, text));
    return value;
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::size_t start = 0;
    for (std::size_t end; (end = text.find(separator, start)) != std::string::npos; start = end + 1)
        parts.push_back(text.substr(start, end - start));
    parts.push_back(text.substr(start));
    return parts;
}

CropRequest parse_crop(const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    if (parts.size() != 4)
        fail_command_line(fmt::format("--crop: '{}' has {} numbers; expected x0,x1,y0,y1", text, parts.size()));
    CropRequest request;
    bool all_below_one = true;
    for (std::size_t i = 0; i < 4; ++i) {
        request.window[i] = parse_number(parts[i], "--crop");
        all_below_one = all_below_one && request.window[i] <= 1.0;
    }
    request.fractions = all_below_one && text.find('.') != std::string::npos;
    for (const double value : request.window)
        if (!request.fractions && value != std::floor(value))
            fail_command_line(
                fmt::format("--crop: '{}': pixels are whole numbers, and fractions are all at most 1", text));
    return request;
}

double parse_noise(const std::string& text) {
    const bool percent = !text.empty() && text.back() == '%';
    const double noise =
        parse_number(percent ? text.substr(0, text.size() - 1) : text, "--noise") * (percent ? 0.01 : 1.0);
    if (!(noise > 0.0 && noise < 1.0))
        fail_command_line(fmt::format("--noise: '{}' is not between 0 and 100 %; expected e.g. 1% or 0.01", text));
    return noise;
}

Plan parse_schedule(const std::string& text) {
    const std::vector<std::string> parts = split(text, ':');
    const std::map<std::string, Schedule> names = {
        {"auto", Schedule::automatic}, {"fused", Schedule::fused}, {"staged", Schedule::staged}};
    const auto name = names.find(parts.front());
    if (name == names.end())
        fail_command_line(fmt::format("--schedule: '{}' is none of auto, fused, staged", parts.front()));
    Plan plan;
    plan.schedule = name->second;
    for (std::size_t i = 1; i < parts.size(); ++i) {
        const std::size_t equals = parts[i].find('=');
        const std::string key = parts[i].substr(0, equals);
        const std::string value = equals == std::string::npos ? "" : parts[i].substr(equals + 1);
        if (key == "slots")
            plan.slots = parse_plan_number(value, "slots", 64, most_slots);
        else if (key == "steps")
            plan.steps = parse_plan_number(value, "steps", 1, 8);
        else if (key == "lanes")
            plan.lanes = parse_plan_number(value, "lanes", 64, most_slots);
        else if (key == "budget")
            plan.budget = parse_plan_number(value, "budget", 1, 65535);
        else if (key == "hits")
            plan.hits = choose<Hits>("--schedule: hits", value, {{"tree", Hits::tree}, {"query", Hits::query}});
        else
            fail_command_line(fmt::format(
                "--schedule: '{}' is none of slots=N, lanes=N, budget=N, steps=N, hits=tree|query", parts[i]));
    }
    return plan;
}

void add_define(std::map<std::string, std::string>& defines, const std::string& text) {
    const std::size_t equals = text.find('=');
    const std::string key = text.substr(0, equals);
    const bool is_name = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    });
    if (equals == std::string::npos || !is_name)
        fail_command_line(fmt::format("-D: '{}' is not of the form key=value, key of letters, digits and _", text));
    if (!defines.emplace(key, text.substr(equals + 1)).second)
        fail_command_line(fmt::format("-D: {} given twice", key));
}

double parse_duration(const std::string& text, const char* option) {
    double unit = 1.0;
    std::string number = text;
    if (!text.empty() && std::isalpha(static_cast<unsigned char>(text.back()))) {
        const char suffix = text.back();
        if (suffix != 's' && suffix != 'm' && suffix != 'h')
            fail_command_line(fmt::format("{}: '{}' has an unknown unit; expected e.g. 30s, 5m or 2h", option, text));
        unit = suffix == 'h' ? 3600.0 : suffix == 'm' ? 60.0 : 1.0;
        number.pop_back();
    }
    const double seconds = parse_number(number, option) * unit;
    constexpr double longest = 1e9; // thirty years
    if (!(seconds > 0.0 && seconds <= longest))
        fail_command_line(fmt::format("{}: '{}' is not a duration; expected e.g. 30s, 5m or 2h", option, text));
    return seconds;
}

} // namespace vkvol
