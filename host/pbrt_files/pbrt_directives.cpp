#include "pbrt_directives.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>
#include <map>
#include <utility>

#include "error.h"
#include "nearest_name.h"
#include "pbrt_spectra.h"

namespace vkvol {

namespace {

constexpr std::size_t most_shapes = 5'000'000, most_triangles = 20'000'000;
constexpr std::size_t deepest_state = 10'000;
const std::set<std::string> of_the_world = {
    "AreaLightSource", "AttributeBegin", "AttributeEnd",   "Import",      "LightSource",    "MakeNamedMaterial",
    "Material",        "NamedMaterial",  "ObjectBegin",    "ObjectEnd",   "ObjectInstance", "ReverseOrientation",
    "Shape",           "Texture",        "TransformBegin", "TransformEnd"};
const std::set<std::string> of_the_options = {"Accelerator", "Camera",  "Film",          "Integrator",
                                              "PixelFilter", "Sampler", "TransformTimes"};

using Kind = PbrtToken::Kind;

} // namespace

PbrtDirectives::PbrtDirectives(PbrtTokens tokens, PbrtScene& scene) : tokens_(std::move(tokens)), scene_(scene) {
    state_.material.thing.type = "diffuse";
    add_transforms();
    add_coordinate_systems();
    add_settings();
    add_world();
    add_things();
}

void PbrtDirectives::note(const PbrtPlace& place, const std::string& message) {
    scene_.notes.push_back(place.text() + ": " + message);
}

void PbrtDirectives::read() {
    PbrtToken token = tokens_.next();
    for (; !token.is(Kind::end); token = tokens_.next()) {
        end_imports();
        if (!in_world_ && token.is(Kind::word) && of_the_world.count(token.value) > 0)
            fail_at(token.place, fmt::format("{} belongs behind WorldBegin", token.value));
        if (in_world_ && token.is(Kind::word) && of_the_options.count(token.value) > 0)
            fail_at(token.place, fmt::format("{} belongs before WorldBegin", token.value));
        const auto handler = token.is(Kind::word) ? handlers_.find(token.value) : handlers_.end();
        if (handler == handlers_.end()) {
            std::vector<std::string> known;
            for (const auto& [name, unused] : handlers_)
                known.push_back(name);
            fail_at(token.place,
                    token.value == "WorldEnd"
                        ? "WorldEnd is of older versions of pbrt; pbrt --upgrade makes a scene of version 4"
                        : fmt::format("'{}' is no directive{}", token.value, name_hint(token.value, known)));
        }
        handler->second(token);
    }
    end_imports();
    check_ended(0);
    if (!in_world_)
        fail_at(token.place, "the scene lacks its WorldBegin, behind which it is; is the file whole?");
    place_objects();
    place_early_media();
}

// What pbrt makes before it knows the camera stands in the space that it renders in, whose origin the camera's eye will
// be, and whose axes too if that is the camera's own.
void PbrtDirectives::place_early_media() {
    if (!scene_.camera || scene_.rendered_in == "world")
        return;
    const glm::dmat4 to_world = glm::inverse(scene_.camera->transform);
    const glm::dmat4 shift = scene_.rendered_in == "camera"
                                 ? to_world
                                 : glm::translate(glm::dmat4(1.0), glm::dvec3(to_world[3]) / to_world[3].w);
    for (auto& [name, medium] : scene_.media)
        if (medium.is_before_camera && medium.type != "homogeneous")
            medium.transform = shift * medium.transform;
}

// Whether all that was begun after so many states were kept has its end.
void PbrtDirectives::check_ended(std::size_t states) const {
    if (states_.size() > states && state_.is_object)
        fail_at(state_.begun, fmt::format("ObjectBegin \"{}\" lacks its ObjectEnd; is the file whole?", *object_));
    if (states_.size() > states)
        fail_at(state_.begun, "an AttributeBegin lacks its AttributeEnd; is the file whole?");
}

std::string PbrtDirectives::name(const char* expected) {
    return tokens_.next(Kind::quoted, expected).value;
}

// TYPE and parameters; `target`: whose defaults of Attribute count.
PbrtThing PbrtDirectives::thing(const PbrtToken& directive, const char* target) {
    PbrtThing result;
    result.place = directive.place;
    result.type = name(fmt::format("a type in quotes after {}", directive.value).c_str());
    auto parameters = std::make_shared<PbrtParameters>(tokens_);
    if (const auto defaults = state_.defaults.find(target); defaults != state_.defaults.end())
        parameters->add_defaults(defaults->second);
    result.parameters = std::move(parameters);
    result.transform = state_.transform;
    result.is_before_camera = !scene_.camera && !in_world_;
    result.color_space = state_.color_space;
    return result;
}

void PbrtDirectives::add_settings() {
    const auto keeps = [this](std::optional<PbrtThing>& where) {
        return [this, &where](const PbrtToken& directive) { where = thing(directive); };
    };
    handlers_["Film"] = keeps(scene_.film);
    handlers_["PixelFilter"] = keeps(scene_.filter);
    handlers_["Sampler"] = keeps(scene_.sampler);
    handlers_["Integrator"] = keeps(scene_.integrator);
    handlers_["Camera"] = [this, keep = keeps(scene_.camera)](const PbrtToken& directive) {
        keep(directive);
        scene_.camera_medium = state_.outside;
        coordinate_systems_["camera"] = glm::inverse(state_.transform);
    };
    handlers_["Accelerator"] = [this](const PbrtToken& directive) { thing(directive); };
    handlers_["Option"] = [this](const PbrtToken&) { read_option(); };
    handlers_["ColorSpace"] = [this](const PbrtToken&) { read_color_space(); };
}

void PbrtDirectives::read_option() {
    const PbrtToken option = tokens_.next(Kind::quoted, "an option in quotes");
    const PbrtToken value = tokens_.next();
    std::string called; // as pbrt reads it: render-coord-sys is RenderCoordSys
    for (const char c : option.value)
        if (c != '-' && c != '_')
            called += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (called.ends_with("rendercoordsys"))
        scene_.rendered_in = value.value;
    const std::vector<std::string> without_effect = {"seed", "rendercoordsys", "wavefront", "pixelstats",
                                                     "recordpixelstatistics"};
    if (std::none_of(without_effect.begin(), without_effect.end(),
                     [&](const std::string& name) { return called.ends_with(name); }))
        note(option.place, fmt::format("Option \"{}\" is left out", option.value));
}

void PbrtDirectives::read_color_space() {
    PbrtToken space = tokens_.next(Kind::quoted, "a colour space in quotes");
    std::transform(space.value.begin(), space.value.end(), space.value.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (!to_rec709(space.value))
        fail_at(space.place, fmt::format("ColorSpace \"{}\" is unknown{}", space.value,
                                         name_hint(space.value, {"srgb", "dci-p3", "rec2020", "aces2065-1"})));
    if (space.value != "srgb")
        note(space.place, fmt::format("colours of \"{}\" become Rec.709's, of which the picture is", space.value));
    state_.color_space = space.value;
}

void PbrtDirectives::add_world() {
    handlers_["WorldBegin"] = [this](const PbrtToken& token) {
        if (in_world_)
            fail_at(token.place, "a second WorldBegin; remove one");
        in_world_ = true;
        state_.transform = glm::dmat4(1.0);
        state_.is_moving = false;
        coordinate_systems_["world"] = state_.transform;
    };
    for (const char* begin : {"AttributeBegin", "TransformBegin"})
        handlers_[begin] = [this](const PbrtToken& token) {
            if (states_.size() >= deepest_state)
                fail_at(token.place,
                        fmt::format("{} within {} others, more than are read", token.value, deepest_state));
            push(token.place);
        };
    for (const char* end : {"AttributeEnd", "TransformEnd"}) // which are the same in version 4
        handlers_[end] = [this](const PbrtToken& token) { pop(token, false); };
    handlers_["Attribute"] = [this](const PbrtToken& token) { read_attribute(token); };
    handlers_["ReverseOrientation"] = [this](const PbrtToken&) { state_.is_reversed = !state_.is_reversed; };
    handlers_["Include"] = [this](const PbrtToken& token) {
        const std::string file = name("a file in quotes");
        include(scene_.folder / file, token.place);
    };
    handlers_["Import"] = [this](const PbrtToken& token) { import(token); };
}

void PbrtDirectives::add_things() {
    handlers_["MediumInterface"] = [this](const PbrtToken&) { read_medium_interface(); };
    handlers_["Material"] = [this](const PbrtToken& token) { state_.material = {thing(token, "material"), false}; };
    handlers_["NamedMaterial"] = [this](const PbrtToken& token) {
        state_.material = {};
        state_.material.thing.type = name("a name in quotes");
        state_.material.thing.place = token.place;
        state_.material.is_named = true;
    };
    handlers_["MakeNamedMaterial"] = [this](const PbrtToken& token) {
        PbrtThing made = thing(token, "material");
        const std::string called = made.type;
        made.type = made.parameters->text("type");
        if (!made.parameters->has("type"))
            fail_at(token.place, fmt::format("MakeNamedMaterial \"{}\" lacks its \"string type\"", called));
        if (!scene_.materials.try_emplace(called, std::move(made)).second)
            fail_at(token.place, fmt::format("a second material \"{}\"; give it another name", called));
    };
    handlers_["MakeNamedMedium"] = [this](const PbrtToken& token) {
        PbrtThing made = thing(token, "medium");
        const std::string called = made.type;
        made.type = made.parameters->text("type");
        if (!scene_.media.try_emplace(called, std::move(made)).second)
            fail_at(token.place, fmt::format("a second medium \"{}\"; give it another name", called));
    };
    handlers_["Texture"] = [this](const PbrtToken& token) { read_texture(token); };
    handlers_["LightSource"] = [this](const PbrtToken& token) { scene_.lights.push_back(thing(token, "light")); };
    handlers_["AreaLightSource"] = [this](const PbrtToken& token) {
        state_.light = thing(token, "light");
        if (!state_.light->type.empty() && state_.light->type != "diffuse")
            fail_at(token.place,
                    fmt::format("AreaLightSource \"{}\"; \"diffuse\" is the only one", state_.light->type));
        if (state_.light->type.empty()) // what follows does not shine
            state_.light.reset();
    };
    handlers_["Shape"] = [this](const PbrtToken& token) { read_shape(token); };
    handlers_["ObjectBegin"] = [this](const PbrtToken& token) { begin_object(token); };
    handlers_["ObjectEnd"] = [this](const PbrtToken& token) { end_object(token); };
    handlers_["ObjectInstance"] = [this](const PbrtToken&) { read_instance(); };
}

void PbrtDirectives::include(const std::filesystem::path& file, const PbrtPlace& place) {
    tokens_.include(file, place);
    scene_.included.insert(file);
}

void PbrtDirectives::import(const PbrtToken& directive) {
    const std::string file = name("a file in quotes");
    push(directive.place);
    imports_.push_back({states_.size(), tokens_.depth(), std::exchange(coordinate_systems_, {})});
    include(scene_.folder / file, directive.place);
}

// Where a directive begins, those whose file has ended before it.
void PbrtDirectives::end_imports() {
    for (; !imports_.empty() && tokens_.depth() <= imports_.back().files; imports_.pop_back()) {
        check_ended(imports_.back().states);
        state_ = std::move(states_.back());
        states_.pop_back();
        coordinate_systems_ = std::move(imports_.back().coordinate_systems);
    }
}

void PbrtDirectives::pop(const PbrtToken& directive, bool ends_object) {
    if (states_.size() == (imports_.empty() ? 0 : imports_.back().states))
        fail_at(directive.place, fmt::format("{} without what it ends", directive.value));
    if (state_.is_object != ends_object)
        fail_at(directive.place,
                fmt::format("{}, but what {} begins is to be ended before", directive.value, state_.begun.text()));
    state_ = std::move(states_.back());
    states_.pop_back();
}

void PbrtDirectives::read_attribute(const PbrtToken& directive) {
    const std::string target = name("what it is for in quotes");
    const std::vector<std::string> known = {"shape", "light", "material", "medium", "texture"};
    if (std::find(known.begin(), known.end(), target) == known.end())
        fail_at(directive.place, fmt::format("Attribute \"{}\" is unknown{}", target, name_hint(target, known)));
    const PbrtParameters parameters(tokens_, state_.color_space); // the last first
    std::vector<SharedParameter>& defaults = state_.defaults[target];
    defaults.insert(defaults.begin(), parameters.all().begin(), parameters.all().end()); // the last one counts
}

void PbrtDirectives::read_medium_interface() {
    state_.inside = name("the name of a medium in quotes");
    PbrtToken second = tokens_.next();
    if (second.is(Kind::quoted)) {
        state_.outside = second.value;
        return;
    }
    state_.outside = state_.inside;
    tokens_.put_back(std::move(second));
}

void PbrtDirectives::read_texture(const PbrtToken& directive) {
    const std::string called = name("a name in quotes");
    const PbrtToken kind = tokens_.next(Kind::quoted, "\"spectrum\" or \"float\"");
    if (kind.value != "spectrum" && kind.value != "float")
        fail_at(kind.place, fmt::format("Texture of \"{}\"; expected \"spectrum\" or \"float\"", kind.value));
    PbrtThing made = thing(directive, "texture");
    // Those of numbers have names of their own, and nothing here has them.
    const bool is_new = kind.value == "float" ? numbers_.insert(called).second
                                              : scene_.textures.try_emplace(called, std::move(made)).second;
    if (!is_new)
        fail_at(directive.place, fmt::format("a second texture \"{}\"; give it another name", called));
}

void PbrtDirectives::read_shape(const PbrtToken& directive) {
    PbrtShape shape;
    shape.thing = thing(directive, "shape");
    shape.is_reversed = state_.is_reversed;
    shape.is_mirrored = glm::determinant(glm::dmat3(state_.transform)) < 0.0;
    shape.material = state_.material;
    shape.light = state_.light;
    shape.inside = state_.inside;
    shape.outside = state_.outside;
    if (object_ && shape.light) {
        note(directive.place, "shines, but in an object: pbrt leaves that light out, and so does this");
        shape.light.reset();
    }
    (object_ ? objects_[*object_] : scene_.shapes).push_back(std::move(shape));
}

void PbrtDirectives::begin_object(const PbrtToken& directive) {
    if (object_)
        fail_at(directive.place, "ObjectBegin within another one; end that first");
    push(directive.place);
    state_.is_object = true;
    object_ = name("a name in quotes");
    if (!objects_.try_emplace(*object_).second)
        fail_at(directive.place, fmt::format("a second object \"{}\"; give it another name", *object_));
}

void PbrtDirectives::end_object(const PbrtToken& directive) {
    if (!object_)
        fail_at(directive.place, "ObjectEnd without ObjectBegin");
    pop(directive, true);
    object_.reset();
}

void PbrtDirectives::read_instance() {
    const PbrtToken which = tokens_.next(Kind::quoted, "a name in quotes");
    if (object_)
        fail_at(which.place, "an ObjectInstance within an object; put it after ObjectEnd");
    instances_.push_back({which.value, state_.transform, which.place, scene_.shapes.size()});
}

// Once all are known: an instance may come before its object. Shapes stay in the order of the file.
void PbrtDirectives::place_objects() {
    std::vector<PbrtShape> all;
    std::size_t taken = 0;
    const auto take = [&](std::size_t end) {
        std::move(scene_.shapes.begin() + std::ptrdiff_t(taken), scene_.shapes.begin() + std::ptrdiff_t(end),
                  std::back_inserter(all));
        taken = end;
    };
    std::map<std::string, std::size_t> triangles_of; // of an object, but for files
    for (const auto& [name, shapes] : objects_)
        for (const PbrtShape& shape : shapes)
            if (const PbrtParameter* indices = shape.thing.parameters->find("indices"))
                triangles_of[name] += indices->numbers.size() / 3;
    std::size_t triangles = 0;
    for (const Instance& instance : instances_) {
        take(instance.before);
        const auto object = objects_.find(instance.object);
        if (object == objects_.end())
            fail_at(instance.place, fmt::format("no object \"{}\"; ObjectBegin defines one", instance.object));
        if (all.size() + object->second.size() > most_shapes)
            fail_at(instance.place, fmt::format("comes to more than {} shapes, the most that are read", most_shapes));
        triangles += triangles_of[instance.object];
        if (triangles > most_triangles)
            fail_at(instance.place,
                    fmt::format("instances come to more than {} triangles, the most that are read: each "
                                "has its own here; put such meshes into files (plymesh)",
                                most_triangles));
        for (PbrtShape shape : object->second) {
            shape.thing.transform = instance.transform * shape.thing.transform;
            all.push_back(std::move(shape));
        }
    }
    take(scene_.shapes.size());
    scene_.shapes = std::move(all);
}

namespace {

PbrtScene read(PbrtTokens tokens, const std::filesystem::path& file) {
    PbrtScene scene;
    scene.folder = file.parent_path();
    PbrtDirectives(std::move(tokens), scene).read();
    return scene;
}

} // namespace

PbrtScene read_pbrt(const std::filesystem::path& file) {
    return read(PbrtTokens(file), file);
}

PbrtScene read_pbrt(const std::string& text, const std::filesystem::path& file) {
    return read(PbrtTokens(text, file.string()), file);
}

} // namespace vkvol
