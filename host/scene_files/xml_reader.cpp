#include "xml_reader.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <set>
#include <sstream>

#include "error.h"
#include "nearest_name.h"
#include "number_text.h"
#include "other_words.h"

namespace vkvol {

namespace {

const char* const spaces = " \t\r\n";

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(spaces);
    if (first == std::string::npos)
        return "";
    return text.substr(first, text.find_last_not_of(spaces) - first + 1);
}

// For messages.
std::string quoted(std::string text) {
    if (text.size() > 60)
        text = text.substr(0, 57) + "...";
    return fmt::format("'{}'", one_line(std::move(text)));
}

[[noreturn]] void fail_at(const std::string& place, const std::string& message) {
    throw InputError(place + ": " + one_line(message));
}

bool is_text(pugi::xml_node node) {
    return node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata;
}

bool inside(double value, const Limits& limits) {
    const bool above = limits.low_included ? value >= limits.low : value > limits.low;
    const bool below = limits.high_included ? value <= limits.high : value < limits.high;
    return above && below; // false for NaN
}

const char* comma_remedy(const std::string& text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos)
        return "";
    return comma + 1 < text.size() ? "; a decimal point is no comma, and between numbers stand spaces"
                                   : "; between numbers stand spaces, no commas";
}

// Empty when `text` is a number within the limits, else what is wrong with it.
std::string read_number(const std::string& text, const Limits& limits, double& value) {
    const NumberText read = read_number_text(text);
    value = read.value;
    if (text.empty())
        return fmt::format("is empty; expected {}", limits.expected);
    if (read.is_too_large)
        return fmt::format("{} is out of range; expected {}", quoted(text), limits.expected);
    if (!read.is_number || !std::isfinite(value))
        return fmt::format("{} is not a number; expected {}{}", quoted(text), limits.expected, comma_remedy(text));
    if (limits.device && std::abs(value) < smallest_number)
        value = 0.0;
    if (!inside(value, limits))
        return fmt::format("{} is out of range; expected {}{}", quoted(text), limits.expected,
                           std::abs(value) > no_limit ? fmt::format(", at most {:g}", no_limit) : "");
    return "";
}

std::string read_integer(const std::string& text, long long low, long long high, long long& value) {
    const std::string expected = fmt::format("expected a whole number from {} to {}", low, high);
    const char* first = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0);
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(first, last, value);
    if (text.empty())
        return "is empty; " + expected;
    if (error == std::errc::invalid_argument || end != last)
        return fmt::format("{} is not a whole number; {}", quoted(text), expected);
    if (error != std::errc() || value < low || value > high)
        return fmt::format("{} is out of range; {}", quoted(text), expected);
    return "";
}

std::string element_hint(const std::string& name, const std::string& parent, std::vector<std::string> known) {
    const bool holds_many_kinds =
        parent == "options" || parent == "volume" || parent == "lights" || parent == "surfaces";
    if (const std::string here = said_here(name); holds_many_kinds && !here.empty())
        return "; " + here;
    if (known.empty())
        return fmt::format("; <{}> has no elements inside", parent);
    for (std::string& candidate : known)
        candidate = "<" + candidate + ">";
    return name_hint("<" + name + ">", known);
}

// By the mark at the beginning, or by the zeros beside its letters; null: none that is not read.
const char* foreign_encoding(const std::string& text) {
    using namespace std::string_literals;
    for (const std::string& mark : {"\xff\xfe\0\0"s, "\0\0\xfe\xff"s, "<\0\0\0"s, "\0\0\0<"s})
        if (text.starts_with(mark))
            return "UTF-32";
    for (const std::string& mark : {"\xff\xfe"s, "\xfe\xff"s, "<\0"s, "\0<"s})
        if (text.starts_with(mark))
            return "UTF-16";
    return nullptr;
}

} // namespace

void XmlDocument::warn(const std::string& place, const std::string& message) {
    std::string warning = place + ": " + one_line(message);
    if (heard_.insert(warning).second) // an element may be read for several volumes
        warnings_.push_back(std::move(warning));
}

XmlDocument::XmlDocument(const std::string& text, std::filesystem::path file,
                         const std::map<std::string, std::string>& defines, const std::string& root,
                         ElementPlaces places, const std::set<std::string>& may_be_unused, double later)
    : places_(std::move(places)), text_(text), buffer_(text.begin(), text.end()), file_(std::move(file)),
      keys_(defines, may_be_unused, later) {
    for (std::size_t i = 0; i < text_.size(); ++i)
        if (text_[i] == '\n')
            line_starts_.push_back(std::ptrdiff_t(i + 1));
    parse();
    find_root(root);
    // Depth first without recursion, so that nesting is no danger. Positions come first: filling in moves strings.
    struct Visitor : pugi::xml_tree_walker {
        XmlDocument* self = nullptr;
        bool for_each(pugi::xml_node& node) override {
            if (node.type() == pugi::node_element)
                self->record_position(node);
            self->fill_in(node);
            return true;
        }
    } visitor;
    visitor.self = this;
    document_.traverse(visitor);
    try {
        keys_.check_all_used();
    } catch (const InputError& error) {
        fail_at(file_.string(), error.what());
    }
}

void XmlDocument::parse() {
    if (const char* encoding = foreign_encoding(text_))
        fail_at(file_.string(), fmt::format("is {}; save it as UTF-8", encoding));
    buffer_.push_back('\n'); // it would take the last letter for the text's end
    const pugi::xml_parse_result result =
        document_.load_buffer_inplace(buffer_.data(), buffer_.size(), pugi::parse_default | pugi::parse_fragment,
                                      pugi::encoding_utf8); // with what stands outside of the root
    if (!result) {
        std::string reason = result.description();
        reason[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(reason[0])));
        fail_at(place_of_offset(result.offset), "malformed XML: " + reason);
    }
}

void XmlDocument::find_root(const std::string& name) {
    for (const pugi::xml_node node : document_.children()) {
        if (is_text(node) && !trimmed(node.value()).empty())
            fail_at(place_of_offset(node.value() - buffer_.data() + std::ptrdiff_t(std::strspn(node.value(), spaces))),
                    fmt::format("stray text {} beside the root element", quoted(trimmed(node.value()))));
        if (node.type() != pugi::node_element)
            continue;
        record_position(node);
        if (root_)
            fail_at(place(node), fmt::format("a second root element <{}>; a scene has one <{}>", node.name(), name));
        root_ = node;
    }
    if (!root_)
        fail_at(place_of_offset(0), "malformed XML: no document element found");
    if (root_.name() != name)
        fail_at(place(root_), fmt::format("the root element is <{}>; a scene has <{}>", root_.name(), name));
}

void XmlDocument::record_position(pugi::xml_node node) {
    Position position;
    position.offset = std::max<std::ptrdiff_t>(0, node.name() - buffer_.data() - 1);
    position.text_offset = position.offset;
    for (const pugi::xml_node child : node.children()) {
        if (!is_text(child) || trimmed(child.value()).empty())
            continue;
        position.text_offset = child.value() - buffer_.data() + std::ptrdiff_t(std::strspn(child.value(), spaces));
        break;
    }
    positions_[node.internal_object()] = position;
}

void XmlDocument::fill_in(pugi::xml_node node) {
    if (is_text(node) && std::strchr(node.value(), '$'))
        node.set_value(substitute(node.value(), [&] { return text_place(node.parent()); }).c_str());
    std::set<std::string> seen;
    for (pugi::xml_attribute attribute : node.attributes()) {
        if (!seen.insert(attribute.name()).second)
            fail_at(place(attribute),
                    fmt::format("attribute {} given twice in <{}>; remove one", attribute.name(), node.name()));
        if (std::strchr(attribute.value(), '$'))
            attribute.set_value(substitute(attribute.value(), [&] { return place(attribute); }).c_str());
    }
}

// `place` is called for messages alone.
template <class Place> std::string XmlDocument::substitute(const std::string& raw, const Place& place) {
    try {
        return keys_.fill_in(raw);
    } catch (const InputError& error) {
        fail_at(place(), error.what());
    }
}

std::string XmlDocument::place_of_offset(std::ptrdiff_t offset) const {
    const auto after = std::upper_bound(places_.begin(), places_.end(), offset,
                                        [](std::ptrdiff_t at, const auto& place) { return at < place.first; });
    if (after != places_.begin())
        return std::prev(after)->second;
    const auto before = std::clamp<std::ptrdiff_t>(offset, 0, std::ptrdiff_t(text_.size()));
    const auto line = std::upper_bound(line_starts_.begin(), line_starts_.end(), before) - line_starts_.begin();
    const std::ptrdiff_t line_start = line_starts_[std::size_t(line - 1)];
    // From where it was counted to last, if that is in this line: a scene may be all in one.
    if (counted_to_ < line_start || counted_to_ > before) {
        counted_to_ = line_start;
        column_there_ = 1;
    }
    // UTF-8 continuation bytes belong to the character before them.
    column_there_ +=
        std::count_if(text_.begin() + counted_to_, text_.begin() + before, [](char c) { return (c & 0xC0) != 0x80; });
    counted_to_ = before;
    return fmt::format("{}:{}:{}", file_.string(), line, column_there_);
}

std::string XmlDocument::place(pugi::xml_node element) const {
    const auto position = positions_.find(element.internal_object());
    return place_of_offset(position == positions_.end() ? 0 : position->second.offset);
}

std::string XmlDocument::place(pugi::xml_attribute attribute) const {
    return place_of_offset(attribute.name() - buffer_.data());
}

std::string XmlDocument::text_place(pugi::xml_node element) const {
    const auto position = positions_.find(element.internal_object());
    return place_of_offset(position == positions_.end() ? 0 : position->second.text_offset);
}

void XmlElement::allow(const std::vector<std::string>& attributes, bool text,
                       const std::vector<std::string>& children) const {
    for (const pugi::xml_attribute attribute : node_.attributes()) {
        if (std::find(attributes.begin(), attributes.end(), attribute.name()) != attributes.end())
            continue;
        const std::string here = said_here(name(), attribute.name(), text);
        const std::string hint = !here.empty()        ? "; " + here
                                 : attributes.empty() ? "; it has none"
                                                      : name_hint(attribute.name(), attributes);
        fail_at(document_->place(attribute),
                fmt::format("unknown attribute {} of <{}>{}", quoted(attribute.name()), name(), hint));
    }
    for (const pugi::xml_node child : node_.children()) {
        if (child.type() == pugi::node_element &&
            std::find(children.begin(), children.end(), child.name()) == children.end())
            fail_at(document_->place(child),
                    fmt::format("unknown element <{}>{}", child.name(), element_hint(child.name(), name(), children)));
        if (!text && is_text(child) && !trimmed(child.value()).empty())
            fail_text(fmt::format("unexpected text {} in <{}>; its values are {}", quoted(trimmed(child.value())),
                                  name(), children.empty() ? "attributes" : "elements"));
    }
}

std::string XmlElement::text() const {
    std::string joined;
    for (const pugi::xml_node child : node_.children())
        if (is_text(child))
            joined += child.value();
    return trimmed(joined);
}

double XmlElement::number(double fallback, const Limits& limits) const {
    double value = fallback;
    if (exists())
        if (const std::string wrong = read_number(text(), limits, value); !wrong.empty())
            fail_text(fmt::format("<{}> {}", name(), wrong));
    return value;
}

long long XmlElement::integer(long long fallback, long long low, long long high) const {
    long long value = fallback;
    if (exists())
        if (const std::string wrong = read_integer(text(), low, high, value); !wrong.empty())
            fail_text(fmt::format("<{}> {}", name(), wrong));
    return value;
}

bool XmlElement::boolean(bool fallback) const {
    if (!exists())
        return fallback;
    const std::string value = text();
    if (!value.empty() && std::strchr("1tTyY", value[0]))
        return true;
    if (!value.empty() && std::strchr("0fFnN", value[0]))
        return false;
    fail_text(fmt::format("<{}> {} is neither true nor false", name(), value.empty() ? "(empty)" : quoted(value)));
}

std::string XmlElement::attribute(const char* attribute_name, const std::string& fallback) const {
    const pugi::xml_attribute found = node_.attribute(attribute_name);
    return found ? trimmed(found.value()) : fallback;
}

double XmlElement::attribute_number(const char* attribute_name, double fallback, const Limits& limits) const {
    double value = fallback;
    if (has(attribute_name))
        if (const std::string wrong = read_number(attribute(attribute_name), limits, value); !wrong.empty())
            fail_attribute(attribute_name, fmt::format("<{}> {}: {}", name(), attribute_name, wrong));
    return value;
}

namespace {

// Numbers between spaces. `fail`: with what is wrong.
template <class Fail> std::vector<double> numbers_of(const std::string& text, const Limits& limits, const Fail& fail) {
    std::vector<double> numbers;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        double value = 0.0;
        if (const std::string wrong = read_number(word, limits, value); !wrong.empty())
            fail(wrong);
        numbers.push_back(value);
    }
    return numbers;
}

} // namespace

std::vector<double> XmlElement::attribute_numbers(const char* attribute_name, const Limits& limits) const {
    return numbers_of(attribute(attribute_name), limits, [&](const std::string& wrong) {
        fail_attribute(attribute_name, fmt::format("<{}> {}: {}", name(), attribute_name, wrong));
    });
}

std::vector<double> XmlElement::text_numbers(const Limits& limits) const {
    return numbers_of(text(), limits,
                      [&](const std::string& wrong) { fail_text(fmt::format("<{}>: {}", name(), wrong)); });
}

bool XmlElement::attribute_boolean(const char* attribute_name, bool fallback) const {
    if (!has(attribute_name))
        return fallback;
    const std::string value = attribute(attribute_name);
    if (!value.empty() && std::strchr("1tTyY", value[0]))
        return true;
    if (!value.empty() && std::strchr("0fFnN", value[0]))
        return false;
    fail_attribute(attribute_name,
                   fmt::format("<{}> {}: {} is neither true nor false", name(), attribute_name, quoted(value)));
}

long long XmlElement::attribute_integer(const char* attribute_name, long long fallback, long long low,
                                        long long high) const {
    long long value = fallback;
    if (has(attribute_name))
        if (const std::string wrong = read_integer(attribute(attribute_name), low, high, value); !wrong.empty())
            fail_attribute(attribute_name, fmt::format("<{}> {}: {}", name(), attribute_name, wrong));
    return value;
}

void XmlElement::fail(const std::string& message) const {
    fail_at(place(), message);
}

void XmlElement::fail_text(const std::string& message) const {
    fail_at(document_->text_place(node_), message);
}

void XmlElement::fail_attribute(const char* attribute_name, const std::string& message) const {
    const pugi::xml_attribute found = node_.attribute(attribute_name);
    fail_at(found ? document_->place(found) : place(), message); // of one with its default, the element's
}

} // namespace vkvol
