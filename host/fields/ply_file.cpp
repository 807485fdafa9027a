#include "ply_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <sstream>

#include "error.h"
#include "number_text.h"
#include "one_line.h"
#include "polygon.h"

namespace vkvol {

namespace {

struct Type {
    const char* name;
    const char* other_name;
    std::size_t bytes;
    bool is_real, has_sign;
};
constexpr Type types[] = {{"char", "int8", 1, false, true},    {"uchar", "uint8", 1, false, false},
                          {"short", "int16", 2, false, true},  {"ushort", "uint16", 2, false, false},
                          {"int", "int32", 4, false, true},    {"uint", "uint32", 4, false, false},
                          {"float", "float32", 4, true, true}, {"double", "float64", 8, true, true}};

struct Property {
    std::string name;
    const Type* type = nullptr;
    const Type* count = nullptr; // of a list, the type of its length
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

// Names of places on a texture, across and upwards: programs differ.
const std::vector<std::string> names_of_places[] = {{"u", "s", "texture_u", "texture_s"},
                                                    {"v", "t", "texture_v", "texture_t"}};

std::optional<int> axis_of_place(const std::string& property) {
    for (int axis = 0; axis < 2; ++axis)
        for (const std::string& name : names_of_places[axis])
            if (property == name)
                return axis;
    return std::nullopt;
}

enum class Format { ascii, little_endian, big_endian };

class PlyReader {
public:
    explicit PlyReader(const std::filesystem::path& path) : path_(path), text_(read_mesh_text(path)) {}

    Polygons read() {
        read_header();
        for (const Element& element : elements_) {
            now_ = &element;
            for (index_ = 0; index_ < element.count; ++index_)
                read_one(element);
        }
        // Faces may come before vertices.
        for (const glm::uvec3& triangle : mesh_.triangles)
            for (int corner = 0; corner < 3; ++corner)
                if (triangle[corner] >= mesh_.vertices.size())
                    throw InputError(
                        fmt::format("{}: a face names vertex {}, but there are {}, from 0; export the mesh again",
                                    path_.string(), triangle[corner], mesh_.vertices.size()));
        for (const auto& [first, count] : polygons_)
            cut(first, count);
        for (const glm::uvec3& t : mesh_.triangles)
            if (!normals_.empty())
                mesh_.normals.emplace_back(normals_[t.x], normals_[t.y], normals_[t.z]);
        for (const glm::uvec3& t : mesh_.triangles)
            if (!places_.empty())
                mesh_.places.emplace_back(places_[t.x], places_[t.y], places_[t.z]);
        if (mesh_.triangles.empty())
            throw InputError(fmt::format("{}: has no faces; export the mesh with them", path_.string()));
        return std::move(mesh_);
    }

    bool has_places() {
        read_header();
        const auto is_place = [](const Property& property) { return !property.count && axis_of_place(property.name); };
        return std::any_of(elements_.begin(), elements_.end(), [&](const Element& element) {
            return element.name == "vertex" &&
                   std::any_of(element.properties.begin(), element.properties.end(), is_place);
        });
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        const std::string place = now_ ? fmt::format("{} {}, counted from 0: ", now_->name, index_) : "";
        throw InputError(fmt::format("{}: {}{}; export the mesh again", path_.string(), place, what));
    }

    std::string_view line() {
        const std::size_t end = text_.find('\n', at_);
        if (end == std::string::npos)
            fail("not a .ply file: its header has no end");
        std::string_view found = std::string_view(text_).substr(at_, end - at_);
        at_ = end + 1;
        if (!found.empty() && found.back() == '\r')
            found.remove_suffix(1);
        return found;
    }

    const Type& type(const std::string& name) const {
        for (const Type& each : types)
            if (name == each.name || name == each.other_name)
                return each;
        fail(fmt::format("its header has a property of unknown type \"{}\"", one_line(name.substr(0, 40))));
    }

    void read_header() {
        if (line() != "ply")
            fail("not a .ply file, which begins with the line \"ply\"");
        bool has_format = false;
        while (true) {
            std::istringstream words{std::string(line())};
            std::string word, name;
            words >> word;
            if (word == "end_header")
                break;
            if (word == "format") {
                words >> name;
                if (name != "ascii" && name != "binary_little_endian" && name != "binary_big_endian")
                    fail(fmt::format("its format \"{}\" is unknown", one_line(name.substr(0, 40))));
                has_format = true;
                format_ = name == "ascii"               ? Format::ascii
                          : name == "binary_big_endian" ? Format::big_endian
                                                        : Format::little_endian;
            } else if (word == "element") {
                Element& element = elements_.emplace_back();
                if (elements_.size() > 1000)
                    fail("its header has more than 1000 elements");
                if (!(words >> element.name >> element.count))
                    fail("its header has an element without a name and a count");
                element.name = one_line(element.name.substr(0, 40));
                const auto has_its_name = [&](const Element& other) { return other.name == element.name; };
                if (std::count_if(elements_.begin(), elements_.end(), has_its_name) > 1)
                    fail(fmt::format("its header has two elements \"{}\"", element.name));
            } else if (word == "property") {
                read_property(words);
            }
        }
        if (!has_format)
            fail("its header says no format");
    }

    void read_property(std::istringstream& words) {
        if (elements_.empty())
            fail("its header has a property before any element");
        Property property;
        std::string word, count;
        words >> word;
        if (word == "list" && words >> count >> word) {
            property.count = &type(count);
            if (property.count->is_real)
                fail("its header has a list whose length is no whole number");
        }
        property.type = &type(word);
        words >> property.name;
        elements_.back().properties.push_back(property);
    }

    // One number, whatever its type.
    double number(const Type& type) {
        if (format_ == Format::ascii) {
            at_ = std::min(text_.find_first_not_of(" \t\r\n+", at_), text_.size());
            double value = 0.0;
            const auto [next, error] = read_number_at(text_.data() + at_, text_.data() + text_.size(), value);
            if (at_ == text_.size())
                fail("the file ends before it");
            if (error != std::errc())
                fail(fmt::format("\"{}\" is no number", one_line(text_.substr(at_, 20))));
            at_ = static_cast<std::size_t>(next - text_.data());
            return value;
        }
        if (text_.size() - at_ < type.bytes)
            fail("the file ends before it");
        unsigned char bytes[8] = {};
        std::memcpy(bytes, text_.data() + at_, type.bytes);
        at_ += type.bytes;
        if (format_ == Format::big_endian)
            std::reverse(bytes, bytes + type.bytes);
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < type.bytes; ++i)
            bits |= std::uint64_t{bytes[i]} << (8 * i);
        if (type.is_real)
            return type.bytes == 4 ? std::bit_cast<float>(static_cast<std::uint32_t>(bits))
                                   : std::bit_cast<double>(bits);
        const int unused = static_cast<int>(64 - 8 * type.bytes);
        return type.has_sign ? static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused)
                             : static_cast<double>(bits);
    }

    void read_one(const Element& element) {
        if (element.properties.empty())
            fail("its element has no properties");
        glm::dvec3 vertex(0.0);
        glm::vec3 normal(0.0f);
        glm::vec2 place(0.0f);
        bool has_normal = false, has_place = false;
        for (const Property& property : element.properties) {
            if (property.count) {
                const double length = number(*property.count);
                const bool is_face =
                    element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
                read_list(property, length, is_face);
                continue;
            }
            const double value = number(*property.type);
            if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
                vertex[property.name[0] - 'x'] = value;
            if (property.name == "nx" || property.name == "ny" || property.name == "nz") {
                normal[property.name[1] - 'x'] = static_cast<float>(value);
                has_normal = true;
            }
            if (const std::optional<int> axis = axis_of_place(property.name)) {
                place[*axis] = static_cast<float>(value);
                has_place = true;
            }
        }
        if (element.name != "vertex")
            return;
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(vertex[axis]) <= largest_length))
                fail(fmt::format("its coordinates are to be finite, and {:g} at most", largest_length));
        if (!(std::abs(place.x) <= 1e30f && std::abs(place.y) <= 1e30f))
            fail("its place on a texture is to be finite, and 1e30 at most");
        mesh_.vertices.push_back(vertex);
        if (has_normal) // as all others
            normals_.push_back(normal);
        if (has_place)
            places_.push_back(place);
    }

    // The fan that a polygon became, whose corners are known now, becomes what it should be.
    void cut(std::size_t first, std::size_t count) {
        const auto fan = std::span(mesh_.triangles).subspan(first, count);
        std::vector<std::uint32_t> numbers = {fan[0].x, fan[0].y};
        for (const glm::uvec3& triangle : fan)
            numbers.push_back(triangle.z);
        std::vector<glm::dvec3> corners;
        for (const std::uint32_t number : numbers)
            corners.push_back(mesh_.vertices[number]);
        const std::vector<glm::uvec3> triangles = triangles_of_polygon(corners);
        for (std::size_t i = 0; i < count; ++i)
            fan[i] = {numbers[triangles[i].x], numbers[triangles[i].y], numbers[triangles[i].z]};
    }

    void read_list(const Property& property, double length, bool is_face) {
        if (!(length >= (is_face ? 3 : 0)) || length != std::floor(length))
            fail(is_face ? "has fewer than three vertices" : "has a list of no length");
        if (is_face && length > 3)
            polygons_.emplace_back(mesh_.triangles.size(), static_cast<std::size_t>(length) - 2);
        std::uint32_t first = 0, before = 0;
        for (double i = 0; i < length; ++i) {
            const double value = number(*property.type);
            if (!is_face)
                continue;
            if (!(value >= 0.0 && value < 4294967295.0) || value != std::floor(value))
                fail(fmt::format("names vertex {}, which is none", value));
            const auto index = static_cast<std::uint32_t>(value);
            if (i >= 2)
                mesh_.triangles.emplace_back(first, before, index);
            first = i == 0 ? index : first;
            before = index;
        }
    }

    const std::filesystem::path& path_;
    const std::string text_;
    std::size_t at_ = 0;
    const Element* now_ = nullptr; // being read, and how many of them have been
    std::uint64_t index_ = 0;
    Format format_ = Format::ascii;
    std::vector<Element> elements_;
    Polygons mesh_;
    std::vector<glm::vec3> normals_; // of vertices, or none
    std::vector<glm::vec2> places_;  // likewise, on a texture
    // Fans of more than one triangle: the first of each, and how many.
    std::vector<std::pair<std::size_t, std::size_t>> polygons_;
};

} // namespace

Polygons read_ply(const std::filesystem::path& path) {
    return PlyReader(path).read();
}

bool has_ply_places(const std::filesystem::path& path) {
    return PlyReader(path).has_places();
}

} // namespace vkvol
