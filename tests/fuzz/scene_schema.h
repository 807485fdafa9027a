// The grammar of scene files as their schema has it (scenes/vkvol.xsd): what is written at random follows what users
// are told.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

namespace vkvol::fuzz {

// What an attribute, or the text of an element, may be: one of some words, or numbers, or else any text.
struct ValueKind {
    std::vector<std::string> words;
    bool is_number = false, is_whole = false;
    double high = 1e30;              // of a number
    std::size_t least = 1, most = 1; // in a row
};

struct AttributeKind {
    std::string name;
    ValueKind value;
    bool is_required;
};

struct ElementKind;

struct ChildKind {
    std::string name;
    const ElementKind* kind;
    bool repeats;
};

struct ElementKind {
    std::optional<ValueKind> text;
    std::vector<AttributeKind> attributes;
    std::vector<ChildKind> children;
};

// Of XML Schema only what vkvol.xsd uses.
class SceneSchema {
public:
    // Throws std::runtime_error.
    explicit SceneSchema(const std::filesystem::path& file);
    const ChildKind& root() const { return root_; }
    // Of all elements, each once; they live as long as the schema.
    const std::vector<const char*>& names() const { return names_; }

private:
    pugi::xml_node named(const char* tag, const std::string& name) const;
    ValueKind value(const std::string& type) const;
    void restrict(pugi::xml_node simple, ValueKind& value) const;
    const ElementKind* kind(const std::string& type);
    void extend(pugi::xml_node complex, ElementKind& kind);

    pugi::xml_document document_;
    std::map<std::string, ElementKind> kinds_; // by the name of their type
    ChildKind root_;
    std::vector<const char*> names_;
};

} // namespace vkvol::fuzz
