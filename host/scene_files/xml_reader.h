// Elements with their place, strict values and no unread parts: the generic layer under scene_xml.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "one_line.h"
#include "scene.h"
#include "scene_keys.h"
#include "xml_text.h"

namespace vkvol {

// A document in memory, with its $keys filled in and with what is needed to say where in it something is.
class XmlDocument {
public:
    // Throws InputError for malformed XML, a root element other than `root`, an attribute given twice, a $key
    // without a value, and a define that no $key uses; see scene_keys.h. `places`: of elements, where the text was made
    // of something else. `may_be_unused`: defines. `later`: frames after F.
    XmlDocument(const std::string& text, std::filesystem::path file, const std::map<std::string, std::string>& defines,
                const std::string& root, ElementPlaces places = {}, const std::set<std::string>& may_be_unused = {},
                double later = 0.0);

    pugi::xml_node root() const { return root_; }
    bool moves() const { return keys_.moves(); } // with F
    double later() const { return keys_.later(); }
    const std::filesystem::path& file() const { return file_; }

    // "file:line:column", both counted from 1, columns in characters.
    std::string place(pugi::xml_node element) const;
    std::string place(pugi::xml_attribute attribute) const;
    std::string text_place(pugi::xml_node element) const; // of its first text; of the element if it has none

    void warn(const std::string& place, const std::string& message);
    const std::vector<std::string>& warnings() const { return warnings_; }

private:
    struct Position {
        std::ptrdiff_t offset = 0;      // of the element's <
        std::ptrdiff_t text_offset = 0; // of the first character of its text that is not a space
    };

    void parse();
    void find_root(const std::string& name);
    void record_position(pugi::xml_node node);
    void fill_in(pugi::xml_node node);
    template <class Place> std::string substitute(const std::string& raw, const Place& place);
    std::string place_of_offset(std::ptrdiff_t offset) const;

    ElementPlaces places_;
    std::string text_; // as read, for places
    std::vector<std::ptrdiff_t> line_starts_{0};
    mutable std::ptrdiff_t counted_to_ = 0, column_there_ = 1; // of the place that was last asked for
    std::vector<char> buffer_; // what pugixml parsed in place: names still point into it
    std::filesystem::path file_;
    SceneKeys keys_;
    std::unordered_map<pugi::xml_node_struct*, Position> positions_;
    pugi::xml_document document_;
    pugi::xml_node root_;
    std::vector<std::string> warnings_;
    std::set<std::string> heard_; // the same
};

struct Limits {
    double low;
    double high;
    bool low_included;
    bool high_included;
    const char* expected; // completes "expected ..."
    bool device = true;   // the device has to take it: what is too small counts as 0
};

// Single precision on the device ends at 3e38 and 1e-38; the margin is for what is multiplied or divided there. What is
// nearer to 0 than `smallest_number` counts as 0.
inline constexpr double no_limit = 1e30;
inline constexpr double smallest_number = 1e-30;
inline constexpr Limits any_number{-no_limit, no_limit, true, true, "a number"};
inline constexpr Limits not_negative{0.0, no_limit, true, true, "a number >= 0"};
inline constexpr Limits positive{0.0, no_limit, false, true, "a number > 0"};
inline constexpr Limits coordinate{-largest_length, largest_length, true, true, "a number from -1e11 to 1e11"};
inline constexpr Limits length{1.0 / largest_length, largest_length, true, true, "a number > 0, from 1e-11 to 1e11"};

// One element, or a missing one: then every getter gives its fallback.
class XmlElement {
public:
    XmlElement(XmlDocument& document, pugi::xml_node node) : document_(&document), node_(node) {}

    bool exists() const { return bool(node_); }
    std::string name() const { return node_.name(); }
    std::string place() const { return document_->place(node_); }

    // Throws InputError for an attribute, a child element or a text that has no business here.
    void allow(const std::vector<std::string>& attributes, bool text = false,
               const std::vector<std::string>& children = {}) const;

    bool has(const char* attribute) const { return bool(node_.attribute(attribute)); }

    // The element's text, trimmed; empty if there is none.
    std::string text() const;
    double number(double fallback, const Limits& limits) const;
    long long integer(long long fallback, long long low, long long high) const;
    std::vector<double> text_numbers(const Limits& limits) const; // between spaces
    // As the original renderer read them: true starts with one of 1 t T y Y, false with one of 0 f F n N.
    bool boolean(bool fallback) const;

    std::string attribute(const char* name, const std::string& fallback = "") const;
    double attribute_number(const char* name, double fallback, const Limits& limits) const;
    // Numbers between spaces; none if there is no such attribute.
    std::vector<double> attribute_numbers(const char* name, const Limits& limits) const;
    bool attribute_boolean(const char* name, bool fallback) const;
    long long attribute_integer(const char* name, long long fallback, long long low, long long high) const;

    [[noreturn]] void fail(const std::string& message) const;
    [[noreturn]] void fail_text(const std::string& message) const;
    [[noreturn]] void fail_attribute(const char* attribute, const std::string& message) const;
    void warn(const std::string& message) const { document_->warn(place(), message); }

private:
    XmlDocument* document_;
    pugi::xml_node node_;
};

} // namespace vkvol
