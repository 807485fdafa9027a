// Values on the command line that are more than a number or a name.
#pragma once

#include <fmt/format.h>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "nearest_name.h"
#include "options.h"

namespace vkvol {

// Throws InputError, "command line: " and the message.
[[noreturn]] void fail_command_line(const std::string& message);

// The value of that name.
template <typename T>
T choose(const char* option, const std::string& name, const std::vector<std::pair<std::string, T>>& choices) {
    std::vector<std::string> names;
    for (const auto& [known, value] : choices) {
        if (known == name)
            return value;
        names.push_back(known);
    }
    fail_command_line(fmt::format("{}: unknown value '{}'{}", option, name, name_hint(name, names)));
}

// Finite. `what`: for the message.
double parse_number(const std::string& text, const std::string& what);

std::vector<std::string> split(const std::string& text, char separator);

// "x0,x1,y0,y1": fractions if all are at most 1 and a dot is among them, else pixels.
CropRequest parse_crop(const std::string& text);

// "1%" or "0.01", in (0, 1).
double parse_noise(const std::string& text);

// "NAME[:slots=N][:steps=N]...".
Plan parse_schedule(const std::string& text);

// Adds "key=value".
void add_define(std::map<std::string, std::string>& defines, const std::string& text);

} // namespace vkvol
