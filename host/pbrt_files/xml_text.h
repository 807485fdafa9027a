// Writes XML, and remembers where its elements come from.
#pragma once

#include <cstddef>
#include <fmt/format.h>
#include <glm/glm.hpp>
#include <string>
#include <utility>
#include <vector>

namespace vkvol {

// Where elements of a text come from: the offset of each one's <, ascending, and "file:line:column".
using ElementPlaces = std::vector<std::pair<std::ptrdiff_t, std::string>>;

// In an attribute or a text of a scene file, where $ begins a key.
std::string xml_escaped(const std::string& text);

using XmlAttributes = std::vector<std::pair<std::string, std::string>>;

inline std::string xml_number(double value) {
    return fmt::format("{:.12g}", value);
}
inline std::string xml_numbers(const glm::dvec3& v) {
    return fmt::format("{:.12g} {:.12g} {:.12g}", v.x, v.y, v.z);
}
double xml_value(const std::string& number); // of one that was written so
void add_xyz(XmlAttributes& attributes, const glm::dvec3& v);
void add_rgb(XmlAttributes& attributes, const glm::dvec3& color);

class XmlText {
public:
    // `place`: "file:line:column"; empty: that of the element it is in.
    void open(const std::string& name, const XmlAttributes& attributes = {}, const std::string& place = {});
    void close();
    void element(const std::string& name, const XmlAttributes& attributes = {}, const std::string& text = {},
                 const std::string& place = {});

    const std::string& text() const { return text_; }
    const ElementPlaces& places() const { return places_; }

private:
    void begin(const std::string& name, const XmlAttributes& attributes, const std::string& place);

    std::string text_;
    std::vector<std::string> open_;
    ElementPlaces places_;
};

} // namespace vkvol
