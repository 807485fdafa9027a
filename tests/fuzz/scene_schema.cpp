#include "scene_schema.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace vkvol::fuzz {

namespace {

const ElementKind* const none = nullptr;

std::string_view tag(pugi::xml_node node) {
    return node.name();
}

std::string attribute(pugi::xml_node node, const char* name) {
    return node.attribute(name).as_string();
}

} // namespace

SceneSchema::SceneSchema(const std::filesystem::path& file) : root_{"options", none, false} {
    if (const pugi::xml_parse_result read = document_.load_file(file.c_str()); !read)
        throw std::runtime_error(file.string() + ": " + read.description());
    ElementKind& options = kinds_["options"];
    extend(named("xs:element", "options").child("xs:complexType"), options);
    root_.kind = &options;
    for (const auto& found : document_.select_nodes("//xs:element"))
        names_.push_back(found.node().attribute("name").value());
    std::sort(names_.begin(), names_.end(), [](const char* a, const char* b) { return std::string_view(a) < b; });
    names_.erase(std::unique(names_.begin(), names_.end(),
                             [](const char* a, const char* b) { return std::string_view(a) == b; }),
                 names_.end());
}

pugi::xml_node SceneSchema::named(const char* tag, const std::string& name) const {
    return document_.child("xs:schema").find_child_by_attribute(tag, "name", name.c_str());
}

ValueKind SceneSchema::value(const std::string& type) const {
    ValueKind value;
    value.is_whole = type == "xs:integer";
    value.is_number = value.is_whole || type == "xs:double";
    if (const pugi::xml_node simple = named("xs:simpleType", type))
        restrict(simple, value);
    return value;
}

// By all that a simple type says.
void SceneSchema::restrict(pugi::xml_node simple, ValueKind& value) const {
    const auto take = [&](const ValueKind& other) {
        value.words.insert(value.words.end(), other.words.begin(), other.words.end());
        value.is_number |= other.is_number;
        value.is_whole |= other.is_whole;
        value.high = std::min(value.high, other.high);
        value.least = other.least;
        value.most = other.most;
    };
    for (const pugi::xml_node part : simple.children()) {
        const std::string_view name = tag(part);
        if (name == "xs:enumeration")
            value.words.push_back(attribute(part, "value"));
        else if (name == "xs:maxInclusive" || name == "xs:maxExclusive")
            value.high = part.attribute("value").as_double();
        else if (name == "xs:length" && value.is_number)
            value.least = value.most = part.attribute("value").as_uint();
        else if (name == "xs:minLength" && value.is_number)
            value.least = part.attribute("value").as_uint();
        else if (name == "xs:maxLength" && value.is_number)
            value.most = part.attribute("value").as_uint();
        if (name == "xs:restriction" && part.attribute("base"))
            take(this->value(attribute(part, "base")));
        if (name == "xs:list") {
            take(this->value(attribute(part, "itemType")));
            value.most = 12;
        }
        if (name == "xs:union") {
            std::istringstream members(attribute(part, "memberTypes"));
            for (std::string member; members >> member;)
                if (member != "key")
                    take(this->value(member));
        }
        if (name == "xs:simpleType" || name == "xs:restriction" || name == "xs:union")
            restrict(part, value);
    }
}

const ElementKind* SceneSchema::kind(const std::string& type) {
    const auto [found, is_new] = kinds_.try_emplace(type);
    if (!is_new)
        return &found->second;
    if (const pugi::xml_node complex = named("xs:complexType", type))
        extend(complex, found->second);
    else
        found->second.text = value(type);
    return &found->second;
}

// By all that a complex type, or what it is made of, says.
void SceneSchema::extend(pugi::xml_node complex, ElementKind& kind) {
    for (const pugi::xml_node part : complex.children()) {
        const std::string_view name = tag(part);
        if (name == "xs:attribute") {
            kind.attributes.push_back(
                {attribute(part, "name"), value(attribute(part, "type")), attribute(part, "use") == "required"});
        } else if (name == "xs:attributeGroup") {
            extend(named("xs:attributeGroup", attribute(part, "ref")), kind);
        } else if (name == "xs:element") {
            const auto is_many = [](pugi::xml_node node) {
                return node.attribute("maxOccurs") && attribute(node, "maxOccurs") != "1";
            };
            kind.children.push_back(
                {attribute(part, "name"), this->kind(attribute(part, "type")), is_many(part) || is_many(complex)});
        } else if (name == "xs:extension") {
            const std::string base = attribute(part, "base");
            if (const pugi::xml_node extended = named("xs:complexType", base))
                extend(extended, kind);
            else
                kind.text = value(base);
            extend(part, kind);
        } else {
            extend(part, kind);
        }
    }
}

} // namespace vkvol::fuzz
