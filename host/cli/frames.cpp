#include "frames.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <fmt/format.h>
#include <set>

#include "atomic_file.h"
#include "option_values.h"

namespace vkvol {

namespace {

constexpr std::size_t most_frames = 100000;
constexpr int last_frame = 9999999;

[[noreturn]] void fail_frames(const std::string& text, const std::string& why) {
    fail_command_line(
        fmt::format("-f: '{}' {}; expected frames such as 3, 1..8, 1..48x4 or 1,5,9, or files", text, why));
}

// A whole number at the beginning of `rest`, which is taken off; -1: there is none.
int take_number(std::string& rest) {
    int value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error != std::errc() || value < 0 || value > last_frame)
        return -1;
    rest.erase(0, static_cast<std::size_t>(end - rest.data()));
    return value;
}

bool take(std::string& rest, const std::string& word) {
    if (rest.compare(0, word.size(), word) != 0)
        return false;
    rest.erase(0, word.size());
    return true;
}

// Length of the field for a frame's number at the beginning of `text`, and its digits; 0: there is none.
struct Field {
    std::size_t length = 0;
    int digits = 1;
};

Field field_at(const std::string& text) {
    if (text[0] == '#') {
        const std::size_t length = std::min(text.find_first_not_of('#'), text.size());
        return {length, static_cast<int>(length)};
    }
    const auto digit = [&](std::size_t i) { return i < text.size() && text[i] >= '1' && text[i] <= '9'; };
    const auto is = [&](std::size_t i, char c) { return i < text.size() && text[i] == c; };
    if (text[0] == '%') { // %d, %04d
        if (is(1, 'd'))
            return {2, 1};
        if (is(1, '0') && digit(2) && is(3, 'd'))
            return {4, text[2] - '0'};
    }
    if (text[0] == '$') { // $F, $F4, ${F}, ${F4}
        const std::size_t brace = is(1, '{') ? 1 : 0;
        if (!is(1 + brace, 'F'))
            return {};
        const std::size_t padded = digit(2 + brace) ? 1 : 0;
        if (brace && !is(3 + padded, '}'))
            return {};
        return {2 + padded + 2 * brace, padded ? text[2 + brace] - '0' : 1};
    }
    return {};
}

// None if the name has no place for it.
std::optional<std::string> with_number(const std::string& pattern, int frame) {
    std::string numbered;
    bool found = false;
    for (std::size_t i = 0; i < pattern.size();) {
        const Field field = field_at(pattern.substr(i));
        found = found || field.length > 0;
        if (field.length > 0)
            numbered += fmt::format("{:0{}}", frame, field.digits);
        else
            numbered += pattern[i];
        i += std::max<std::size_t>(field.length, 1);
    }
    return found ? std::optional(numbered) : std::nullopt;
}

} // namespace

std::vector<int> parse_frames(const std::string& text) {
    std::vector<int> frames;
    std::set<int> seen;
    std::string rest = text;
    do {
        const int first = take_number(rest);
        int last = first, step = 1;
        if (first >= 0 && take(rest, ".."))
            last = take_number(rest);
        if (last != first && take(rest, "x"))
            step = take_number(rest);
        if (first < 0 || last < 0)
            fail_frames(text, fmt::format("is not a range of whole numbers from 0 to {}", last_frame));
        if (step < 1)
            fail_frames(text, "has a step that is no whole number >= 1");
        if (static_cast<std::size_t>(std::abs(last - first) / step) + frames.size() >= most_frames)
            fail_frames(text, fmt::format("has more than {} frames", most_frames));
        for (int i = 0; i <= std::abs(last - first) / step; ++i) {
            frames.push_back(first + (last < first ? -1 : 1) * i * step);
            if (!seen.insert(frames.back()).second)
                fail_frames(text, fmt::format("has frame {} twice", frames.back()));
        }
    } while (take(rest, ","));
    if (!rest.empty())
        fail_frames(text, fmt::format("ends in '{}'", rest));
    return frames;
}

std::string frames_text(const std::vector<int>& frames) {
    std::string text;
    for (std::size_t i = 0; i < frames.size();) {
        std::size_t last = i + 1;
        const int step = last < frames.size() ? frames[last] - frames[i] : 1;
        while (last + 1 < frames.size() && frames[last + 1] - frames[last] == step)
            ++last;
        text += fmt::format("{}{}", i == 0 ? "" : ",", frames[i]);
        if (last >= i + 2) { // three at least
            text += fmt::format("..{}", frames[last]);
            if (std::abs(step) != 1)
                text += fmt::format("x{}", std::abs(step));
            i = last;
        }
        ++i;
    }
    return text;
}

std::filesystem::path frame_file(const std::filesystem::path& name, int frame) {
    if (is_special(name))
        return name;
    const std::optional<std::string> numbered = with_number(name.filename().string(), frame);
    return name.parent_path() /
           numbered.value_or(fmt::format("{}.{:04}{}", name.stem().string(), frame, name.extension().string()));
}

std::vector<int> frames_with_file(const std::filesystem::path& name) {
    const std::string pattern = name.filename().string();
    if (!with_number(pattern, 0))
        fail_command_line(fmt::format("-f files: {} has no place for the number of a frame; write it as ####: "
                                      "--grid smoke.####.vdb",
                                      name.string()));
    std::set<int> frames;
    std::error_code error;
    const std::filesystem::path folder = name.has_parent_path() ? name.parent_path() : std::filesystem::path(".");
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const std::string file = entry.path().filename().string();
        // Any number in its name may be the frame's; that it is, its name tells.
        for (std::size_t i = 0; i < file.size(); ++i) {
            std::string rest = file.substr(i);
            const int frame = take_number(rest);
            if (frame >= 0 && with_number(pattern, frame) == file)
                frames.insert(frame);
        }
    }
    if (frames.empty())
        fail_command_line(fmt::format("-f files: there is no file {}", name.string()));
    return {frames.begin(), frames.end()};
}

RenderOptions frame_options(const RenderOptions& options, int frame) {
    RenderOptions one = options;
    one.frames.clear();
    one.is_frame = true;
    one.defines["F"] = std::to_string(frame);
    for (std::filesystem::path& output : one.outputs)
        output = frame_file(output, frame);
    if (one.report)
        one.report = frame_file(*one.report, frame);
    if (one.grid)
        if (const std::optional<std::string> numbered = with_number(one.grid->filename().string(), frame)) {
            one.grid = one.grid->parent_path() / *numbered;
            one.grid_has_frame = true;
        }
    return one;
}

void set_frames(RenderOptions& options, const std::string& text) {
    if (text == "files" && !options.grid)
        fail_command_line("-f files: are those of --grid; add e.g. --grid smoke.####.vdb");
    options.frames = text == "files" ? frames_with_file(*options.grid) : parse_frames(text);
    if (options.trace)
        fail_command_line("-f: --trace follows a path of one picture; choose the frame with -D F=3");
    for (const auto& [key, value] : options.defines)
        if (key == "F" || (key.size() == 2 && key[0] == 'F' && std::isdigit(static_cast<unsigned char>(key[1]))))
            fail_command_line(
                fmt::format("-D {}={}: with -f, F is the number of the frame; leave out one of them", key, value));
}

} // namespace vkvol
