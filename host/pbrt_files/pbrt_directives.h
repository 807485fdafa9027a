// Reads the directives of a pbrt scene, one after another; pbrt_scene.h is its public face.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "pbrt_scene.h"

namespace vkvol {

// What a directive finds, and AttributeEnd brings back.
struct PbrtState {
    glm::dmat4 transform{1.0};
    bool is_reversed = false;
    PbrtMaterial material;
    std::optional<PbrtThing> light;
    std::string inside, outside;
    std::string color_space = "srgb";
    std::map<std::string, std::vector<SharedParameter>> defaults; // by what they are for
    bool is_moving = false;                                       // transforms count at the shutter's end alone
    PbrtPlace begun;                                              // the AttributeBegin or the like that it is within,
    bool is_object = false;                                       // which is an ObjectBegin
};

class PbrtDirectives {
public:
    PbrtDirectives(PbrtTokens tokens, PbrtScene& scene);
    void read();

private:
    using Handler = std::function<void(const PbrtToken&)>;

    void add_transforms();
    void add_coordinate_systems();
    void add_settings();
    void add_world();
    void add_things();
    void concatenate(const glm::dmat4& transform);
    glm::dmat4 matrix();
    glm::dmat4 look_at();
    std::string name(const char* expected);
    PbrtThing thing(const PbrtToken& directive, const char* target = "");
    void read_option();
    void read_medium_interface();
    void read_active_transform(const PbrtToken& directive);
    void read_attribute(const PbrtToken& directive);
    void read_color_space();
    void read_shape(const PbrtToken& directive);
    void read_texture(const PbrtToken& directive);
    void begin_object(const PbrtToken& directive);
    void end_object(const PbrtToken& directive);
    void read_instance();
    void place_objects();
    void place_early_media();
    void push(const PbrtPlace& place) {
        states_.push_back(state_);
        state_.begun = place;
        state_.is_object = false;
    }
    void pop(const PbrtToken& directive, bool ends_object);
    void check_ended(std::size_t states) const;
    void include(const std::filesystem::path& file, const PbrtPlace& place);
    void import(const PbrtToken& directive);
    void end_imports();
    void note(const PbrtPlace& place, const std::string& message);

    PbrtTokens tokens_;
    PbrtScene& scene_;
    PbrtState state_;
    std::vector<PbrtState> states_;
    // The files being imported, which leave the state as they find it: how many states were kept, and how many files
    // open; coordinate systems, of which they know their own alone.
    struct Importing {
        std::size_t states, files;
        std::map<std::string, glm::dmat4> coordinate_systems;
    };
    std::vector<Importing> imports_;
    std::map<std::string, glm::dmat4> coordinate_systems_;
    std::map<std::string, std::vector<PbrtShape>> objects_;
    std::optional<std::string> object_; // that is being defined
    struct Instance {
        std::string object;
        glm::dmat4 transform;
        PbrtPlace place;
        std::size_t before; // shapes that are no instances'
    };
    std::vector<Instance> instances_;
    std::map<std::string, Handler> handlers_;
    bool in_world_ = false;
    std::set<std::string> numbers_; // textures of "float"
};

} // namespace vkvol
