#include "scene_keys.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>

#include "error.h"
#include "expression.h"
#include "nearest_name.h"
#include "number_text.h"

namespace vkvol {

namespace {

constexpr std::size_t longest = 16 << 20; // of all values filled in, like the file itself
constexpr int deepest = 16;               // defaults and expressions within each other
const char* const frame_key = "F";        // number of the frame, see -f

bool in_key(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

// None if it is no number.
std::optional<double> as_number(const std::string& text) {
    const NumberText read = read_number_text(text);
    const bool good = read.is_number && !read.is_too_large && std::isfinite(read.value);
    return good ? std::optional(read.value) : std::nullopt;
}

// Of words that are no numbers, as files' names are, none is of a time.
bool are_numbers(const std::string& text) {
    constexpr const char* between = " \t\r\n,";
    for (std::size_t begin = text.find_first_not_of(between); begin != std::string::npos;
         begin = text.find_first_not_of(between, begin)) {
        const std::size_t end = std::min(text.find_first_of(between, begin), text.size());
        if (!as_number(text.substr(begin, end - begin)))
            return false;
        begin = end;
    }
    return true;
}

// The shortest that reads back as the same number; whole ones as such, so that they do where those are asked for.
std::string written(double value) {
    if (value == std::floor(value) && std::abs(value) < 1e15)
        return fmt::format("{}", static_cast<std::int64_t>(value));
    return fmt::format("{}", value);
}

// F4 is F with four digits, for the names of files: 0007.
int digits_of_frame(const std::string& key) {
    return key.size() == 2 && key[0] == frame_key[0] && key[1] >= '1' && key[1] <= '9' ? key[1] - '0' : 0;
}

} // namespace

std::string SceneKeys::fill_in(const std::string& raw) {
    const bool moved_before = moves_;
    std::string text = fill_in_at(0.0, raw);
    if (!are_numbers(text))
        moves_ = moved_before;
    else if (later_ != 0.0)
        text = fill_in_at(later_, raw);
    return text;
}

std::string SceneKeys::fill_in_at(double later, const std::string& raw) {
    time_ = later;
    raw_ = raw;
    at_ = 0;
    depth_ = 0;
    return text_up_to('\0', true);
}

std::string SceneKeys::text_up_to(char end, bool live) {
    std::string result;
    while (at_ < raw_.size() && (end == '\0' || raw_[at_] != end)) {
        if (raw_[at_] != '$') {
            result += raw_[at_++];
        } else if (raw_.compare(at_, 2, "$$") == 0) { // $$ is a dollar sign
            result += '$';
            at_ += 2;
        } else {
            result += reference(live);
        }
    }
    return result;
}

// What begins with the $ at hand.
std::string SceneKeys::reference(bool live) {
    ++at_;
    if (at_ < raw_.size() && raw_[at_] == '{') {
        ++at_;
        if (++depth_ > deepest)
            throw InputError(fmt::format("${{...}} more than {} deep in each other; write it flatter", deepest));
        std::string value = braced(live);
        --depth_;
        return value;
    }
    return value_of(key_here(), live);
}

// Behind ${, up to and with the }.
std::string SceneKeys::braced(bool live) {
    if (at_ < raw_.size() && raw_[at_] == '=') {
        ++at_;
        const double value = Expression(raw_, at_, live, [&] { return key_number(live); }).evaluate();
        ++at_;
        return written(value);
    }
    const std::string key = key_here();
    if (raw_.compare(at_, 2, ":-") == 0) {
        at_ += 2;
        named_.insert(key);
        const std::optional<std::string> value = find(key);
        const bool has_value = value && !value->empty();
        const std::string fallback = text_up_to('}', live && !has_value);
        if (at_ == raw_.size())
            throw InputError(fmt::format("${{{}:-{}: the closing }} is missing", key, fallback));
        ++at_;
        if (has_value && live)
            count(key, value->size());
        return has_value ? *value : fallback;
    }
    if (at_ == raw_.size() || raw_[at_] != '}')
        throw InputError(
            fmt::format("${{{}: expected }} or a default, ${{{}:-VALUE}}; arithmetic begins with ${{=", key, key));
    ++at_;
    return value_of(key, live);
}

std::string SceneKeys::key_here() {
    const std::size_t first = at_;
    while (at_ < raw_.size() && in_key(raw_[at_]))
        ++at_;
    if (at_ == first)
        throw InputError("a $ that names no key; write $key, ${key}, ${key:-default}, ${= arithmetic}, or $$ for a "
                         "dollar sign");
    return raw_.substr(first, at_ - first);
}

// `live` false: of a default that is not used, where nothing needs a value.
std::string SceneKeys::value_of(const std::string& key, bool live) {
    named_.insert(key);
    if (!live)
        return "";
    const std::optional<std::string> value = find(key);
    if (const auto frame = values_.find(frame_key); !value && digits_of_frame(key) > 0 && frame != values_.end())
        throw InputError(
            fmt::format("${} has no value: F is {}, no whole number from 0 on; give one with -f 1..8 or -D F=1, or "
                        "take ${{{}}}, which is F as it is",
                        key, frame->second.empty() ? "empty" : frame->second, frame_key));
    if (!value && (key == frame_key || digits_of_frame(key) > 0))
        throw InputError(
            fmt::format("${} has no value: it is the number of a frame; give it with -f 1..8 or -D F=1, or "
                        "here with a default: ${{{}:-1}}",
                        key, key));
    if (!value)
        throw InputError(fmt::format(
            "${} has no value; give it with -D {}=VALUE, or here with a default: ${{{}:-VALUE}}", key, key, key));
    count(key, value->size());
    return *value;
}

std::optional<std::string> SceneKeys::find(const std::string& key) {
    if (const auto value = values_.find(key); value != values_.end())
        return value->second;
    const auto frame = values_.find(frame_key);
    const int digits = digits_of_frame(key);
    if (digits == 0 || frame == values_.end() || frame->second.empty() ||
        frame->second.find_first_not_of("0123456789") != std::string::npos)
        return std::nullopt;
    named_.insert(frame_key);
    return fmt::format("{:0>{}}", frame->second, digits);
}

// F, $F, ${F} or ${F:-1}, within an expression, or the default of a key without a value: ${t:-$F}.
bool SceneKeys::is_time_here() {
    for (std::size_t at = at_;;) {
        bool is_braced = false;
        for (const char c : {'$', '{'})
            if (at < raw_.size() && raw_[at] == c) {
                is_braced = c == '{';
                ++at;
            }
        std::size_t end = at;
        while (end < raw_.size() && in_key(raw_[end]))
            ++end;
        const std::string key = raw_.substr(at, end - at);
        if (key == frame_key)
            return true;
        const std::optional<std::string> value = find(key);
        if (!is_braced || raw_.compare(end, 3, ":-$") != 0 || (value && !value->empty()))
            return false;
        at = end + 2;
    }
}

// A key within an expression, with or without $.
double SceneKeys::key_number(bool live) {
    const std::size_t first = at_;
    const bool is_time = live && is_time_here();
    const std::string value = raw_[at_] == '$' ? reference(live) : value_of(key_here(), live);
    if (!live)
        return 1.0;
    moves_ = moves_ || is_time;
    if (const std::optional<double> number = as_number(value))
        return *number + (is_time ? time_ : 0.0);
    throw InputError(fmt::format("{} is '{}', no number; give one to compute with it", raw_.substr(first, at_ - first),
                                 value.substr(0, 60)));
}

void SceneKeys::count(const std::string& key, std::size_t bytes) {
    filled_in_ += bytes;
    if (filled_in_ > longest)
        throw InputError(fmt::format("the values of $keys amount to more than 16 MiB by ${}; give shorter ones", key));
}

void SceneKeys::check_all_used() const {
    for (const auto& [key, value] : values_) {
        if (named_.count(key) || may_be_unused_.count(key))
            continue;
        if (key == frame_key)
            throw InputError(fmt::format(
                "$F, the number {} of the frame, is used nowhere in the scene: all frames would "
                "be the same; write $F where they differ, e.g. yaw=\"${{= 360*F/8}}\", or let --grid have it: "
                "smoke.####.vdb",
                value));
        const std::vector<std::string> known(named_.begin(), named_.end());
        const std::string hint = known.empty() ? "; the scene has no $keys" : name_hint(key, known);
        throw InputError(fmt::format("-D {}={} is used nowhere in the scene{}", key, value, hint));
    }
}

} // namespace vkvol
