// Makes the elements of a scene file from a pbrt scene; pbrt_translation.h is its public face.
//
// pbrt's coordinates are left-handed: to its cameras x is right, y up and z ahead. A map of the world, `world_`, a
// rotation that mirrors where it has to, makes them right-handed, and turns what pbrt's map of the sky has for its
// zenith to the top, since maps stand upright here.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>

#include "pbrt_colors.h"
#include "pbrt_sides.h"
#include "pbrt_translation.h"
#include "pbrt_triangles.h"
#include "xml_text.h"

namespace vkvol {

// A medium whose densities stand in the scene, or are made up.
bool is_dense(const PbrtThing& medium);

constexpr double least_kelvin = 100.0; // of what glows

// Whether it turns, mirrors and has one scale, which is found.
bool turns_alone(const glm::dmat3& m, double& scale);

class PbrtTranslator {
public:
    PbrtTranslator(const PbrtScene& scene, PbrtTranslationOptions options);
    PbrtTranslation translate();

private:
    void choose_world();
    void write_camera();
    void add_projection(const PbrtThing& camera, double height, double scale, XmlAttributes& attributes);
    void write_film();
    void write_settings();
    void write_filter();

    void write_media();
    // What a homogeneous medium fills: an element of a scene file, or a model's file, and where it stands.
    struct Region {
        std::string element, model;
        glm::dmat4 transform{1.0};
    };
    void write_medium(const std::string& name, const PbrtThing& medium, const Region& region, const PbrtPlace& place);
    void write_grid_medium(const std::string& name, const PbrtThing& medium);
    std::string free_name(const std::string& medium) const;
    void write_dense_medium(const std::string& name, const PbrtThing& medium);
    void write_rgb_medium(const std::string& name, const PbrtThing& medium);
    MemoryGrids::Grid glow_of(const PbrtThing& medium, glm::ivec3 dims);
    std::vector<float> scales_of(const PbrtThing& medium, glm::ivec3 dims);
    void write_black_body(const std::string& grid, double glow, const PbrtThing& medium);
    static double glow_scale(const PbrtThing& medium);
    static glm::dvec2 kelvins(const PbrtThing& medium);
    void write_coefficients(const PbrtThing& medium);
    void write_coefficients(const glm::dvec3& sigma_a, const glm::dvec3& sigma_s, double g); // per length
    std::optional<Region> region_of(const PbrtShape& shape) const;
    std::optional<Region> region_within(const PbrtShape& shape, const std::string& medium);
    bool has_camera(const PbrtShape& shape, const Region& region) const;
    bool has_point(const PbrtShape& shape, const Region& region, const glm::dvec4& point) const;
    bool is_endless(const std::string& medium) const;
    void note_media_around(const PbrtShape& shape, const Region& region);
    struct Bounded { // a homogeneous medium in a ball or box
        const PbrtShape* shape;
        std::string medium;
        Region region;
    };
    std::vector<Bounded> bounded_;
    std::set<std::pair<std::string, std::string>> noted_around_; // once for two media
    bool ends_camera_medium();
    void write_camera_medium();
    void write_media_of(const PbrtShape& shape);
    bool write_grid_once(const std::string& name, const PbrtThing& medium);
    void note_beyond(const PbrtShape& shape, const std::string& medium);
    void note_what_is_not_cut(const PbrtShape& shape, const std::string& name, const PbrtThing& medium);
    bool lets_light_in(const PbrtShape& shape) const;
    void count_media();
    const PbrtThing* medium_of(const std::string& name, const PbrtPlace& place) const;

    void write_lights();
    void write_light(const PbrtThing& light);
    double own_illuminance(const PbrtThing& light) const;
    void write_sky(const PbrtThing& light);
    glm::dvec3 light_color(const PbrtThing& light, const char* name);

    void write_surfaces();
    void write_surface(const PbrtShape& shape);
    void write_ball(const PbrtShape& shape, const XmlAttributes& material);
    void write_disk(const PbrtShape& shape, const XmlAttributes& material);
    void write_file_mesh(const PbrtShape& shape, const XmlAttributes& material);
    void write_triangles(const PbrtShape& shape, const PbrtTriangles& own, const XmlAttributes& material);
    void write_emission(const PbrtShape& shape, std::optional<double> area);
    void write_matrix(const glm::dmat4& matrix);
    const PbrtThing& material_thing(const PbrtShape& shape) const;
    std::optional<XmlAttributes> material_of(const PbrtShape& shape); // nothing: it is not seen
    XmlAttributes material(const PbrtThing& thing);
    void add_conductor(XmlAttributes& attributes, const PbrtThing& thing);
    double index_of(const PbrtThing& thing, double least);
    void add_color(XmlAttributes& attributes, const PbrtThing& thing, const char* name, const glm::dvec3& fallback);
    void add_roughness(XmlAttributes& attributes, const PbrtThing& thing, const std::string& part = "");
    void add_texture(XmlAttributes& attributes, const PbrtThing& texture, const glm::dvec3& factor, int depth);
    void add_repeat(XmlAttributes& attributes, const PbrtThing& texture, double repeat);
    glm::dvec3 mean_of_image(const PbrtThing& thing);
    bool has_places(const PbrtThing& mesh);
    PbrtTriangles with_places_of_texture(const PbrtThing& shape, PbrtTriangles mesh, XmlAttributes& material) const;
    void note_places(XmlAttributes& material);
    void even_out(const PbrtShape& shape, XmlAttributes& material);
    bool is_unseen(const PbrtShape& shape);
    void note_odd_lists(const PbrtThing& mesh);
    void add_image(XmlAttributes& attributes, const PbrtThing& texture, const glm::dvec3& factor);
    void add_checkerboard(XmlAttributes& attributes, const PbrtThing& texture, const glm::dvec3& factor, int depth);
    const PbrtThing& texture_of(const PbrtThing& thing, const char* name) const;
    std::optional<glm::dvec3> even_color(const PbrtThing& texture, int depth);
    std::optional<glm::dvec3> even_part(const PbrtThing& thing, const char* name, double fallback, int depth);

    std::string file_name(const PbrtThing& thing, const char* parameter = "filename") const;
    // Of light that comes no more goes on, and no less than none: else says so.
    glm::dvec3 share_of_light(const PbrtThing& thing, const glm::dvec3& color);
    void note(const PbrtPlace& place, const std::string& message);
    void note_unused(const PbrtThing& thing, std::initializer_list<const char*> known = {});

    const PbrtScene& scene_;
    PbrtTranslationOptions options_;
    NamedGrids grids_;
    PbrtColors colors_;
    XmlText xml_;
    std::vector<std::string> notes_;
    std::set<std::string> heard_;
    std::set<std::string> written_grids_; // media
    std::set<std::string> media_within_;  // of shapes
    bool camera_medium_is_endless_ = false;
    int media_count_ = 0;            // of volumes, at most
    std::size_t triangle_count_ = 0; // that are written out
    glm::dmat4 world_{1.0};          // from pbrt's world to this renderer's
    bool sky_is_mirrored_ = false;
    // Of the material that was written last: its texture, and which part of pbrt's places it repeats in one.
    std::optional<PbrtThing> texture_;
    double texture_repeat_ = 1.0;
    std::map<std::string, glm::dvec3> means_; // of images, and which meshes in files have places: read once
    std::map<std::string, bool> have_places_;
    double exposure_ = 1.0; // by which pbrt's film multiplies radiance
};

} // namespace vkvol
