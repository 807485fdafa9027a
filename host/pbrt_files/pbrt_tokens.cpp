#include "pbrt_tokens.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

#include "error.h"
#include "gzip.h"
#include "input_file.h"
#include "number_text.h"
#include "one_line.h"

namespace vkvol {

namespace {

constexpr int most_includes = 10000;
constexpr std::size_t deepest_include = 64;
constexpr std::size_t longest_file = std::size_t(1) << 30; // bytes

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

bool ends_word(char c) {
    return is_space(c) || c == '"' || c == '[' || c == ']';
}

std::string text_of(const std::filesystem::path& file) {
    std::string text = unpacked(read_input_text(file, longest_file, "name a pbrt scene"), file, longest_file);
    if (text.size() > longest_file)
        throw InputError(one_line(file.string() + ": is larger than 1 GiB; put its meshes into .ply files"));
    return text;
}

} // namespace

std::string PbrtPlace::text() const {
    return fmt::format("{}:{}:{}", *file, line, column);
}

void fail_at(const PbrtPlace& place, const std::string& message) {
    throw InputError(one_line(place.text() + ": " + message));
}

PbrtTokens::PbrtTokens(const std::filesystem::path& file) {
    open(text_of(file), file.string(), file);
}

PbrtTokens::PbrtTokens(std::string text, std::string name) {
    open(std::move(text), name, {});
}

void PbrtTokens::open(std::string text, const std::string& name, const std::filesystem::path& file) {
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
        throw InputError(one_line(name + ": is UTF-16; save it as UTF-8"));
    Source source;
    source.text = std::move(text);
    source.place.file = std::make_shared<const std::string>(name);
    source.file = file;
    sources_.push_back(std::move(source));
}

void PbrtTokens::include(const std::filesystem::path& file, const PbrtPlace& by) {
    const auto is_open = [&](const Source& source) { return source.file == file; };
    if (std::any_of(sources_.begin(), sources_.end(), is_open))
        fail_at(by, fmt::format("\"{}\" includes itself; remove one of the Includes", file.string()));
    if (sources_.size() >= deepest_include || ++includes_ > most_includes)
        fail_at(by, fmt::format("is the {}, more than are read; put them into fewer files",
                                sources_.size() >= deepest_include ? "64th Include within one another"
                                                                   : "10001st Include"));
    std::string text;
    try {
        text = text_of(file);
    } catch (const InputError& error) {
        fail_at(by, error.what());
    }
    open(std::move(text), file.string(), file);
}

char PbrtTokens::take() {
    Source& source = sources_.back();
    const char c = source.text[source.at++];
    if (c == '\n') {
        ++source.place.line;
        source.place.column = 1;
    } else if ((c & 0xC0) != 0x80) { // not the continuation of a character
        ++source.place.column;
    }
    return c;
}

// And comments.
void PbrtTokens::skip_space() {
    bool comment = false;
    while (!sources_.empty()) {
        Source& source = sources_.back();
        if (source.at == source.text.size()) {
            end_ = source.place;
            sources_.pop_back();
            comment = false;
            continue;
        }
        const char c = source.text[source.at];
        if (c == '#')
            comment = true;
        else if (c == '\n' || c == '\r')
            comment = false;
        else if (!comment && !is_space(c))
            return;
        take();
    }
}

PbrtToken PbrtTokens::quoted() {
    Source& source = sources_.back();
    PbrtToken token{PbrtToken::Kind::quoted, "", source.place};
    take();
    while (source.at < source.text.size()) {
        char c = take();
        if (c == '"')
            return token;
        if (c == '\n')
            break;
        if (c == '\\' && source.at < source.text.size()) {
            constexpr char written[] = "bfnrt\\'\"", meant[] = "\b\f\n\r\t\\'\"";
            const char* which = std::strchr(written, c = take());
            if (c == '\0' || !which)
                fail_at(token.place, "a text with an unknown escape; \\\\ stands for a backslash");
            c = meant[which - written];
        }
        token.value += c;
    }
    fail_at(token.place, "a text without its closing quote, which belongs on the same line");
}

PbrtToken PbrtTokens::next() {
    if (back_) {
        PbrtToken token = std::move(*back_);
        back_.reset();
        return token;
    }
    skip_space();
    if (sources_.empty())
        return {PbrtToken::Kind::end, "", end_};
    Source& source = sources_.back();
    const char c = source.text[source.at];
    if (c == '"')
        return quoted();
    PbrtToken token{PbrtToken::Kind::word, "", source.place};
    if (c == '[' || c == ']') {
        token.kind = c == '[' ? PbrtToken::Kind::open : PbrtToken::Kind::close;
        token.value = take();
        return token;
    }
    while (source.at < source.text.size() && !ends_word(source.text[source.at]))
        token.value += take();
    return token;
}

PbrtToken PbrtTokens::next(PbrtToken::Kind kind, const char* expected) {
    PbrtToken token = next();
    if (token.is(PbrtToken::Kind::end))
        fail_at(token.place, fmt::format("the scene ends where {} is expected; is its file whole?", expected));
    if (!token.is(kind))
        fail_at(token.place, fmt::format("'{}': expected {}", token.value, expected));
    return token;
}

std::optional<double> pbrt_number(const std::string& text) {
    const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const char* end = text.data() + text.size();
    double value = 0.0;
    const auto [stop, error] = read_number_at(begin, end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value))
        return std::nullopt;
    return value;
}

double PbrtTokens::number() {
    const PbrtToken token = next(PbrtToken::Kind::word, "a number");
    const std::optional<double> value = pbrt_number(token.value);
    if (!value)
        fail_at(token.place, fmt::format("'{}': expected a number", token.value));
    return *value;
}

} // namespace vkvol
