// The part of PbrtTranslator that writes textures, and where on them shapes are.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <sstream>

#include "error.h"
#include "pbrt_translator.h"
#include "ply_file.h"
#include "radiance_map.h"

namespace vkvol {

namespace {

constexpr int most_nested = 16; // textures of textures

// What pbrt makes of a place on it: s * place + d.
glm::dvec2 scale_of(const PbrtThing& texture) {
    return {texture.parameters->number("uscale", 1.0), texture.parameters->number("vscale", 1.0)};
}
glm::dvec2 shift_of(const PbrtThing& texture) {
    return {texture.parameters->number("udelta", 0.0), texture.parameters->number("vdelta", 0.0)};
}
bool is_plain(const PbrtThing& texture) {
    const glm::dvec2 scale = scale_of(texture);
    return scale.x >= 0.0 && scale.y >= 0.0 && shift_of(texture) == glm::dvec2(0.0);
}

void set(XmlAttributes& attributes, const std::string& name, const std::string& value) {
    for (auto& [each, old] : attributes)
        if (each == name)
            old = value;
}

} // namespace

const PbrtThing& PbrtTranslator::texture_of(const PbrtThing& thing, const char* name) const {
    const std::string texture = thing.parameters->texture(name);
    const auto found = scene_.textures.find(texture);
    if (found == scene_.textures.end())
        fail_at(thing.parameters->find(name)->place, fmt::format("no texture \"{}\"; Texture makes one", texture));
    return found->second;
}

// Colour of a texture that has the same one everywhere; else none.
std::optional<glm::dvec3> PbrtTranslator::even_color(const PbrtThing& texture, int depth) {
    if (texture.type != "imagemap")
        texture.parameters->find("invert"); // of Attribute, say: nothing to these
    if (texture.type == "constant")
        return colors_.share(texture, "value").value_or(glm::dvec3(1.0));
    if (texture.type != "scale" || !texture.parameters->texture("scale").empty() || depth >= most_nested)
        return std::nullopt;
    std::optional<glm::dvec3> color = even_part(texture, "tex", 1.0, depth);
    if (color)
        *color *= texture.parameters->number("scale", 1.0);
    return color;
}

std::optional<glm::dvec3> PbrtTranslator::even_part(const PbrtThing& thing, const char* name, double fallback,
                                                    int depth) {
    if (thing.parameters->texture(name).empty())
        return colors_.share(thing, name).value_or(glm::dvec3(fallback));
    return even_color(texture_of(thing, name), depth + 1);
}

void PbrtTranslator::add_texture(XmlAttributes& attributes, const PbrtThing& texture, const glm::dvec3& factor,
                                 int depth) {
    const PbrtParameters& p = *texture.parameters;
    if (const std::optional<glm::dvec3> color = even_color(texture, depth)) {
        add_rgb(attributes, share_of_light(texture, factor * *color));
    } else if (texture.type == "imagemap" && p.has("filename")) {
        add_image(attributes, texture, factor);
    } else if (texture.type == "checkerboard" && p.number("dimension", 2.0) == 2.0 &&
               (!p.has("mapping") || p.text("mapping") == "uv")) {
        add_checkerboard(attributes, texture, factor, depth);
    } else if (texture.type == "scale" && depth < most_nested && p.texture("scale").empty()) {
        add_texture(attributes, texture_of(texture, "tex"), factor * p.number("scale", 1.0), depth + 1);
    } else {
        note(texture.place, fmt::format("Texture \"{}\" is left out; what has it is grey", texture.type));
        add_rgb(attributes, glm::dvec3(0.5));
    }
}

void PbrtTranslator::add_image(XmlAttributes& attributes, const PbrtThing& texture, const glm::dvec3& factor) {
    const PbrtParameters& p = *texture.parameters;
    const glm::dvec3 share = factor * p.number("scale", 1.0);
    if (const double most = std::max({share.x, share.y, share.z}); most > 1.0)
        note(texture.place,
             fmt::format("its image is taken {:g} times, and once here; brighter ones have to be in the file", most));
    if (const std::string wrap = p.text("wrap", "repeat"); wrap != "repeat")
        note(texture.place, fmt::format("\"{}\" at its edges is left out; the image is repeated", wrap));
    if (const std::string encoding = p.text("encoding", "sRGB"); encoding != "sRGB")
        note(texture.place,
             fmt::format("encoding \"{}\" is left out; what is in the file is known by its format, of 8 bits as sRGB",
                         encoding));
    add_rgb(attributes, glm::clamp(share, 0.0, 1.0));
    attributes.emplace_back("texture", file_name(texture));
    if (const std::string mapping = p.text("mapping", "uv"); mapping != "uv")
        note(texture.place, fmt::format("mapping \"{}\" is left out; its places are the shape's", mapping));
    add_repeat(attributes, texture, 1.0);
    if (const std::string filter = p.text("filter", "bilinear"); filter == "point")
        note(texture.place, "filter \"point\" is left out; between the middles of texels images are linear here");
    note_unused(texture, {"filter", "maxanisotropy"});
}

// Where signs and shifts matter, meshes that stand in the scene have them in their places: with_places_of_texture().
void PbrtTranslator::add_repeat(XmlAttributes& attributes, const PbrtThing& texture, double repeat) {
    const PbrtParameters& p = *texture.parameters;
    texture_ = texture;
    texture_repeat_ = repeat;
    constexpr double least = 1e-9; // for 0, which pbrt takes for one place all along
    const auto repeats = [&](const char* name) { return std::max(std::abs(p.number(name, 1.0)) * repeat, least); };
    attributes.emplace_back("repeat", fmt::format("{} {}", repeats("uscale"), repeats("vscale")));
    p.find("udelta");
    p.find("vdelta");
}

// A square of it is 1 / uscale wide, and the one on the lower left "tex1".
void PbrtTranslator::add_checkerboard(XmlAttributes& attributes, const PbrtThing& texture, const glm::dvec3& factor,
                                      int depth) {
    const std::optional<glm::dvec3> first = even_part(texture, "tex1", 1.0, depth),
                                    second = even_part(texture, "tex2", 0.0, depth);
    if (!first || !second)
        note(texture.place, "images in a Texture \"checkerboard\" are left out; its squares are light and dark grey");
    glm::dvec3 own(0.6), other(0.4);
    if (first && second)
        own = *first, other = *second;
    add_rgb(attributes, share_of_light(texture, factor * own));
    attributes.emplace_back("checker", xml_numbers(share_of_light(texture, factor * other)));
    add_repeat(attributes, texture, 0.5);
    note_unused(texture);
}

PbrtTriangles PbrtTranslator::with_places_of_texture(const PbrtThing& shape, PbrtTriangles mesh,
                                                     XmlAttributes& material) const {
    if (!texture_)
        return mesh;
    if (mesh.places.empty())
        mesh = with_usual_places(mesh, shape.type == "bilinearmesh");
    if (is_plain(*texture_))
        return mesh;
    for (glm::dvec2& place : mesh.places)
        place = scale_of(*texture_) * place + shift_of(*texture_);
    set(material, "repeat", fmt::format("{0} {0}", texture_repeat_));
    return mesh;
}

// Of what has its places by its shape, or in a file.
void PbrtTranslator::note_places(XmlAttributes& material) {
    if (!texture_ || is_plain(*texture_))
        return;
    const glm::dvec2 scale = scale_of(*texture_);
    const bool is_image = texture_->type == "imagemap";
    if (is_image && (scale.x < 0.0 || scale.y < 0.0))
        note(texture_->place, "a negative \"uscale\" or \"vscale\" mirrors no image of such a shape here");
    if (shift_of(*texture_) != glm::dvec2(0.0))
        note(texture_->place, "\"udelta\" and \"vdelta\" are left out of such a shape");
    if (is_image || scale.x * scale.y >= 0.0)
        return;
    std::string own[3], other; // squares of a board whose sides go on behind 0 the other way
    for (const auto& [name, value] : material)
        for (int c = 0; c < 3; ++c)
            if (name == std::string(1, "rgb"[c]))
                own[c] = value;
            else if (name == "checker")
                other = value;
    std::istringstream others(other);
    for (int c = 0; c < 3; ++c) {
        std::string value;
        others >> value;
        set(material, std::string(1, "rgb"[c]), value);
    }
    set(material, "checker", fmt::format("{} {} {}", own[0], own[1], own[2]));
}

// Throws InputError, without a place, if it cannot be read.
glm::dvec3 PbrtTranslator::mean_of_image(const PbrtThing& thing) {
    const std::string name = thing.parameters->text("filename");
    if (const auto known = means_.find(name); known != means_.end())
        return known->second;
    const RadianceMap map = read_radiance_map(scene_.folder / name);
    for (const std::string& warning : map.warnings)
        note(thing.place, warning);
    glm::dvec3 mean(0.0);
    for (const glm::vec3& texel : map.texels)
        mean += glm::dvec3(texel) / double(map.texels.size());
    return means_[name] = mean;
}

// True as well where that cannot be told: whoever loads it says why.
bool PbrtTranslator::has_places(const PbrtThing& mesh) {
    const std::string name = mesh.parameters->text("filename");
    const auto [has, is_new] = have_places_.try_emplace(name, true);
    try {
        if (is_new)
            has->second = has_ply_places(scene_.folder / name);
    } catch (const InputError&) {
    }
    return has->second;
}

// A mesh in a file that has no places is of its texture's mean colour.
void PbrtTranslator::even_out(const PbrtShape& shape, XmlAttributes& material) {
    if (!texture_ || has_places(shape.thing))
        return;
    note(shape.thing.place, "has no places on its texture (u and v), and is of that one's mean colour");
    glm::dvec3 color(0.0), other(0.0);
    for (const auto& [name, value] : material) {
        for (int c = 0; c < 3; ++c)
            if (name == std::string(1, "rgb"[c]))
                color[c] = xml_value(value);
        if (std::istringstream rest(name == "checker" ? value : ""); name == "checker")
            rest >> other.x >> other.y >> other.z;
    }
    try {
        color = texture_->type == "imagemap" ? color * glm::min(mean_of_image(*texture_), 1.0) : 0.5 * (color + other);
    } catch (const InputError& error) { // which names the file
        fail_at(texture_->place, error.what());
    }
    std::erase_if(material, [](const auto& each) {
        return each.first == "texture" || each.first == "checker" || each.first == "repeat";
    });
    for (int c = 0; c < 3; ++c)
        set(material, std::string(1, "rgb"[c]), xml_number(color[c]));
}

} // namespace vkvol
