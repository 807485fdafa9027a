#include "obj_file.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <tiny_obj_loader.h>
#include <utility>

#include "error.h"
#include "number_text.h"
#include "one_line.h"
#include "polygon.h"

namespace vkvol {

namespace {

constexpr double largest_coordinate = largest_length;

// Three numbers, as many digits as a double holds. tinyobjloader reads floats, and takes what is no number for 0.
glm::dvec3 parse_vertex(std::string_view line, const std::filesystem::path& path, std::size_t number) {
    glm::dvec3 vertex;
    const char* at = line.data();
    const char* const end = line.data() + line.size();
    for (int axis = 0; axis < 3; ++axis) {
        while (at != end && (*at == ' ' || *at == '\t' || *at == '+'))
            ++at;
        const auto [next, error] = read_number_at(at, end, vertex[axis]);
        if (error != std::errc() || !(std::abs(vertex[axis]) <= largest_coordinate))
            throw InputError(fmt::format("{}:{}: a vertex needs three finite numbers of at most {:g}, but has \"{}\"; "
                                         "export the mesh again",
                                         path.string(), number, largest_coordinate,
                                         one_line(std::string(line.substr(0, 60)))));
        at = next;
    }
    return vertex;
}

// Behind the f. Whole numbers are read by atoi, which takes what it can of anything.
void check_face(std::string_view line, const std::filesystem::path& path, std::size_t number) {
    constexpr std::size_t most_digits = 9;
    std::size_t digits = 0;
    for (const char c : line) {
        const bool is_digit = c >= '0' && c <= '9';
        digits = is_digit ? digits + 1 : 0;
        if (digits > most_digits || !(is_digit || c == '-' || c == '+' || c == '/' || c == ' ' || c == '\t'))
            throw InputError(
                fmt::format("{}:{}: a face needs whole numbers of at most {} digits, but has \"{}\"; export "
                            "the mesh again",
                            path.string(), number, most_digits, one_line(std::string(line.substr(0, 60)))));
    }
}

// Whether what it says is numbers, behind which a # begins a comment. In names it is a letter.
bool has_numbers(std::string_view line) {
    const std::string_view word = line.substr(0, line.find_first_of(" \t"));
    return word == "v" || word == "vn" || word == "vt" || word == "f";
}

// In names of materials and of files. tinyobjloader ends names at blanks, from 2.0rc11 on, in one of the two places
// where it reads them.
constexpr char joint = '\x1f';

// A line may name several libraries, which are in `folder`, or one whose name has blanks.
void join_name(std::string& line, const std::filesystem::path& folder) {
    const std::string word = line.substr(0, line.find_first_of(" \t"));
    if (word != "newmtl" && word != "usemtl" && word != "mtllib")
        return;
    std::string name = line.substr(std::min(line.find_first_not_of(" \t", word.size()), line.size()));
    name.resize(name.find_last_not_of(" \t") + 1);
    std::error_code error;
    if (name.empty() || (word == "mtllib" && !std::filesystem::is_regular_file(folder / name, error)))
        return;
    std::replace(name.begin(), name.end(), '\t', joint);
    std::replace(name.begin(), name.end(), ' ', joint);
    line = word + ' ' + name;
}

std::string file_name(std::string joined) {
    std::replace(joined.begin(), joined.end(), joint, ' ');
    return joined;
}

// For parsers that know nothing of them: without a mark of UTF-8, without comments behind numbers, names in one piece,
// and, if `joins`, with lines that end in \ joined to the next; as many lines as before. What they name is in `folder`.
std::string plain_lines(std::string_view text, const std::filesystem::path& folder, bool joins = true) {
    constexpr std::string_view mark = "\xef\xbb\xbf", blanks = " \t";
    text.remove_prefix(text.substr(0, mark.size()) == mark ? mark.size() : 0);
    std::string plain, line; // `line`: as far as it has been joined
    plain.reserve(text.size());
    std::size_t joined = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        const std::size_t added = line.size(); // behind what needs no second look
        line += text.substr(0, end);
        text.remove_prefix(std::min(end + (text.substr(end, 2) == "\r\n" ? 2 : 1), text.size()));
        if (!line.empty() && blanks.find(line.front()) != std::string_view::npos)
            line.erase(0, line.find_first_not_of(blanks));
        if (has_numbers(line))
            line.resize(std::min(line.find('#', std::min(added, line.size())), line.size()));
        const std::size_t last = line.find_last_not_of(blanks);
        if (joins && last != std::string::npos && line[last] == '\\' && line[0] != '#' && !text.empty()) {
            line.resize(last);
            line += ' ';
            ++joined;
            continue;
        }
        join_name(line, folder);
        plain += line;
        plain.append(1 + joined, '\n');
        line.clear();
        joined = 0;
    }
    return plain;
}

std::vector<glm::dvec3> parse_vertices(std::string_view text, const std::filesystem::path& path) {
    std::vector<glm::dvec3> vertices;
    for (std::size_t begin = 0, number = 1; begin < text.size(); ++number) {
        const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
        std::string_view line = text.substr(begin, end - begin);
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        if (line.size() > 1 && line[0] == 'v' && (line[1] == ' ' || line[1] == '\t'))
            vertices.push_back(parse_vertex(line.substr(2), path, number));
        else if (line.size() > 1 && line[0] == 'f' && (line[1] == ' ' || line[1] == '\t'))
            check_face(line.substr(2), path, number);
        begin = end + (text.substr(end, 2) == "\r\n" ? 2 : 1);
    }
    return vertices;
}

// What the parser's callbacks know of the file so far.
struct Progress {
    Polygons* obj = nullptr;
    const std::filesystem::path* path = nullptr;
    std::int64_t vertices = 0; // seen, from which negative indices count back
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> places;                             // on a texture
    std::vector<glm::ivec3> of_triangles, places_of_triangles; // which of these their corners have, from 0; -1: none
    std::size_t faces = 0;
    bool has_odd_places = false;
    std::vector<std::optional<Rgb>> materials;
    std::optional<Rgb> diffuse; // of the faces that follow
};

std::uint32_t resolve(const Progress& progress, int index) {
    const std::int64_t resolved = index > 0 ? std::int64_t{index} - 1 : progress.vertices + index;
    const auto count = static_cast<std::int64_t>(progress.obj->vertices.size());
    if (index == 0 || resolved < 0 || resolved >= count)
        throw InputError(fmt::format("{}: face {} names vertex {}, but there are {} vertices; export the mesh again",
                                     progress.path->string(), progress.faces, index, count));
    return static_cast<std::uint32_t>(resolved);
}

void add_face(Progress& progress, const tinyobj::index_t* corners, int count) {
    ++progress.faces;
    if (count < 3)
        throw InputError(
            fmt::format("{}: face {} has fewer than three vertices; delete loose edges (in Blender: Mesh > "
                        "Clean Up > Delete Loose) and export the mesh again",
                        progress.path->string(), progress.faces));
    std::vector<std::uint32_t> vertices;
    std::vector<glm::dvec3> places_of_corners;
    for (int i = 0; i < count; ++i) {
        vertices.push_back(resolve(progress, corners[i].vertex_index));
        places_of_corners.push_back(progress.obj->vertices[vertices.back()]);
    }
    constexpr int beyond = std::numeric_limits<int>::max();
    const auto from_zero = [](int index, std::size_t count) { // -1: it has none
        const int counted_back = static_cast<int>(count) + index;
        return index >= 0 ? index - 1 : counted_back >= 0 ? counted_back : beyond;
    };
    const auto normal = [&](int i) { return from_zero(corners[i].normal_index, progress.normals.size()); };
    const auto place = [&](int i) { return from_zero(corners[i].texcoord_index, progress.places.size()); };
    for (const glm::ivec3 t : triangles_of_polygon(places_of_corners)) {
        progress.obj->triangles.emplace_back(vertices[t.x], vertices[t.y], vertices[t.z]);
        progress.of_triangles.emplace_back(normal(t.x), normal(t.y), normal(t.z));
        progress.places_of_triangles.emplace_back(place(t.x), place(t.y), place(t.z));
    }
    if (progress.faces == 1)
        progress.obj->diffuse = progress.diffuse;
    progress.obj->several_diffuse = progress.obj->several_diffuse || progress.diffuse != progress.obj->diffuse;
}

std::optional<Rgb> diffuse_of(const tinyobj::material_t& material, Progress& progress) {
    const Rgb color(material.diffuse[0], material.diffuse[1], material.diffuse[2]);
    if (glm::all(glm::greaterThanEqual(color, Rgb(0.0))) && glm::all(glm::lessThanEqual(color, Rgb(brightest_light))))
        return color;
    std::string name = material.name;
    std::replace(name.begin(), name.end(), joint, ' ');
    progress.obj->warnings.push_back(
        one_line(fmt::format("{}: the Kd of material \"{}\" is no colour, and is left out; numbers >= 0 are",
                             progress.path->string(), name)));
    return std::nullopt;
}

tinyobj::callback_t make_callbacks() {
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* user, tinyobj::real_t, tinyobj::real_t, tinyobj::real_t, tinyobj::real_t) {
        ++static_cast<Progress*>(user)->vertices;
    };
    callbacks.normal_cb = [](void* user, tinyobj::real_t x, tinyobj::real_t y, tinyobj::real_t z) {
        static_cast<Progress*>(user)->normals.emplace_back(x, y, z);
    };
    callbacks.texcoord_cb = [](void* user, tinyobj::real_t x, tinyobj::real_t y, tinyobj::real_t) {
        auto& progress = *static_cast<Progress*>(user);
        const bool is_usable = std::abs(x) <= 1e30f && std::abs(y) <= 1e30f; // neither NaN
        progress.places.emplace_back(is_usable ? glm::vec2(x, y) : glm::vec2(0.0f));
        if (!is_usable && !std::exchange(progress.has_odd_places, true))
            progress.obj->place_warnings.push_back(
                fmt::format("{}: vt {} {} counts as 0 0: its numbers are to be finite, and 1e30 at most",
                            progress.path->string(), x, y));
    };
    callbacks.index_cb = [](void* user, tinyobj::index_t* corners, int count) {
        add_face(*static_cast<Progress*>(user), corners, count);
    };
    callbacks.mtllib_cb = [](void* user, const tinyobj::material_t* materials, int count) {
        auto& progress = *static_cast<Progress*>(user);
        progress.materials.clear();
        for (int i = 0; i < count; ++i)
            progress.materials.push_back(diffuse_of(materials[i], progress));
    };
    callbacks.usemtl_cb = [](void* user, const char*, int material) {
        auto& progress = *static_cast<Progress*>(user);
        const bool known = material >= 0 && static_cast<std::size_t>(material) < progress.materials.size();
        progress.diffuse = known ? progress.materials[static_cast<std::size_t>(material)] : std::nullopt;
    };
    return callbacks;
}

// Material libraries, beside the .obj file. One that cannot be read is no error: the mesh has its shape without.
class MaterialReader : public tinyobj::MaterialReader {
public:
    MaterialReader(const std::filesystem::path& obj, std::vector<std::string>& warnings)
        : obj_(obj), warnings_(warnings) {}

    bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                    std::map<std::string, int>* indices, std::string*, std::string*) override {
        const std::filesystem::path file = obj_.parent_path() / file_name(name);
        try {
            // A path may end with one.
            std::istringstream stream(plain_lines(read_mesh_text(file), file.parent_path(), false));
            std::string warning, error;
            tinyobj::LoadMtl(indices, materials, &stream, &warning, &error);
            return true;
        } catch (const InputError&) {
            constexpr std::size_t most_warnings = 10;
            if (warnings_.size() < most_warnings)
                warnings_.push_back(
                    one_line(fmt::format("{}: its material library {} cannot be read, and its colours are "
                                         "left out; put it beside the mesh",
                                         obj_.string(), file.string())));
            return false;
        }
    }

private:
    const std::filesystem::path& obj_;
    std::vector<std::string>& warnings_;
};

// A normal or place that is not there is 0.
template <class Corners, class Value>
std::vector<Corners> of_corners(const std::vector<Value>& values, const std::vector<glm::ivec3>& of_triangles) {
    std::vector<Corners> found;
    for (const glm::ivec3& corners : of_triangles) {
        if (values.empty())
            break;
        found.emplace_back(0.0f);
        for (int i = 0; i < 3; ++i)
            if (corners[i] >= 0 && static_cast<std::size_t>(corners[i]) < values.size())
                found.back()[i] = values[static_cast<std::size_t>(corners[i])];
    }
    return found;
}

// How many triangles have a corner whose vn is beyond the list.
std::size_t without_their_normal(const Progress& progress) {
    const glm::ivec3 end(static_cast<int>(progress.normals.size()));
    const auto is_lost = [&](const glm::ivec3& corners) { return glm::any(glm::greaterThanEqual(corners, end)); };
    return std::size_t(std::count_if(progress.of_triangles.begin(), progress.of_triangles.end(), is_lost));
}

} // namespace

Polygons read_obj(const std::filesystem::path& path) {
    const std::string text = plain_lines(read_mesh_text(path), path.parent_path());
    Polygons obj;
    obj.vertices = parse_vertices(text, path);
    Progress progress;
    progress.obj = &obj;
    progress.path = &path;
    std::istringstream stream(text);
    MaterialReader materials(path, obj.warnings);
    std::string warnings, errors;
    if (!tinyobj::LoadObjWithCallback(stream, make_callbacks(), &progress, &materials, &warnings, &errors))
        throw InputError(fmt::format("{}: not readable as Wavefront .obj: {}; export the mesh again", path.string(),
                                     one_line(errors.substr(0, errors.find('\n')))));
    if (obj.triangles.empty())
        throw InputError(fmt::format("{}: has no faces; it must be a Wavefront .obj file that holds a closed surface",
                                     path.string()));
    obj.normals = of_corners<glm::mat3>(progress.normals, progress.of_triangles);
    obj.places = of_corners<glm::mat3x2>(progress.places, progress.places_of_triangles);
    if (const std::size_t lost = without_their_normal(progress))
        obj.normal_warnings.push_back(
            fmt::format("{}: {} of its {} triangles name a normal that is not among its {}, and have "
                        "their face's there; export the mesh again",
                        path.string(), lost, obj.triangles.size(), progress.normals.size()));
    const glm::ivec3 end(static_cast<int>(progress.places.size()));
    const auto bare = std::count_if(
        progress.places_of_triangles.begin(), progress.places_of_triangles.end(), [&](const glm::ivec3& corners) {
            return glm::any(glm::lessThan(corners, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(corners, end));
        });
    if (!obj.places.empty() && bare > 0)
        obj.place_warnings.push_back(
            fmt::format("{}: {} of its {} triangles do not say where on a texture their corners "
                        "are, which count as 0 0; unwrap these faces too",
                        path.string(), bare, obj.triangles.size()));
    return obj;
}

// As tinyobjloader reads it: names between spaces, but for one that has some.
std::vector<std::filesystem::path> material_libraries(const std::filesystem::path& path) {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        return files;
    std::string text;
    try {
        text = read_mesh_text(path);
    } catch (const InputError&) { // told by who reads the mesh
        return files;
    }
    std::istringstream stream(plain_lines(text, path.parent_path()));
    for (std::string line; std::getline(stream, line);) {
        std::istringstream words(line);
        std::string name;
        if (!(words >> name) || name != "mtllib")
            continue;
        while (words >> name)
            files.push_back(path.parent_path() / file_name(name));
    }
    return files;
}

} // namespace vkvol
