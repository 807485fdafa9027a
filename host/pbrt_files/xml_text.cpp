#include "xml_text.h"

#include <charconv>

namespace vkvol {

std::string xml_escaped(const std::string& text) {
    std::string result;
    for (const char c : text)
        result += c == '&'   ? "&amp;"
                  : c == '<' ? "&lt;"
                  : c == '>' ? "&gt;"
                  : c == '"' ? "&quot;"
                  : c == '$' ? "$$"
                             : std::string(1, c);
    return result;
}

double xml_value(const std::string& number) { // whatever a locale takes for a decimal point
    double value = 0.0;
    std::from_chars(number.data(), number.data() + number.size(), value);
    return value;
}

void add_xyz(XmlAttributes& attributes, const glm::dvec3& v) {
    const char* names[] = {"x", "y", "z"};
    for (int axis = 0; axis < 3; ++axis)
        attributes.emplace_back(names[axis], xml_number(v[axis]));
}

void add_rgb(XmlAttributes& attributes, const glm::dvec3& color) {
    const char* names[] = {"r", "g", "b"};
    for (int channel = 0; channel < 3; ++channel)
        attributes.emplace_back(names[channel], xml_number(color[channel]));
}

void XmlText::begin(const std::string& name, const XmlAttributes& attributes, const std::string& place) {
    text_.append(2 * open_.size(), ' ');
    if (!place.empty())
        places_.emplace_back(std::ptrdiff_t(text_.size()), place);
    text_ += '<' + name;
    for (const auto& [key, value] : attributes)
        text_ += fmt::format(" {}=\"{}\"", key, xml_escaped(value));
}

void XmlText::open(const std::string& name, const XmlAttributes& attributes, const std::string& place) {
    begin(name, attributes, place);
    text_ += ">\n";
    open_.push_back(name);
}

void XmlText::close() {
    const std::string name = open_.back();
    open_.pop_back();
    text_.append(2 * open_.size(), ' ');
    text_ += fmt::format("</{}>\n", name);
}

void XmlText::element(const std::string& name, const XmlAttributes& attributes, const std::string& text,
                      const std::string& place) {
    begin(name, attributes, place);
    text_ += text.empty() ? "/>\n" : fmt::format(">{}</{}>\n", xml_escaped(text), name);
}

} // namespace vkvol
