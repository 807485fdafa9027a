// Reads one scene document, element by element; scene_xml is its public face.
#pragma once

#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "method.h"
#include "scene.h"
#include "scene_xml.h"
#include "xml_reader.h"

namespace vkvol {

inline const std::vector<std::string> color_attributes = {"r", "g", "b", "multiplier"};
using Shape = decltype(Volume::shape);
using NamedVolumes = std::map<std::string, std::vector<pugi::xml_node>>;

inline constexpr long long max_edge = 65536; // pixels
inline constexpr long long max_integer = 2147483647;

// Null if there is none in `scope`. Throws InputError if there are two.
pugi::xml_node find_one(XmlDocument& document, pugi::xml_node scope, std::initializer_list<const char*> names);

// Elements whose colour is black unless it is given, and that say something else of it.
void warn_of_forgotten_color(const XmlElement& element);

class SceneReader {
public:
    SceneReader(XmlDocument& document, const SceneOverrides& overrides)
        : document_(document), overrides_(overrides), scopes_{document.root()} {}

    Scene read();

private:
    pugi::xml_node find(std::initializer_list<const char*> names) const;
    XmlElement one(std::initializer_list<const char*> names) const { return {document_, find(names)}; }
    XmlElement one(const char* name) const { return one({name}); }

    RenderSettings settings() const;
    void read_pixel_filter(RenderSettings& settings) const;
    void read_integrator(RenderSettings& settings) const;
    March march() const;
    void check_method(const Scene& scene) const;
    void warn_about_light(const Scene& scene, const Method& method) const;
    void warn_about_steps(const Scene& scene, const Method& method) const;
    std::optional<Periodic> periodic() const;
    std::shared_ptr<const MotionBlur> motion_blur() const;
    void check_motion(Scene& scene) const;
    void read_units(Scene& scene) const;
    Camera sensor() const;
    Camera camera() const;
    Camera irradiance(const XmlElement& element) const;
    Camera absorption(const XmlElement& element) const;
    Picture picture_of_cells(const Camera& camera) const;
    Camera fluence(const XmlElement& element) const;
    Picture picture(const Camera& camera) const;
    Picture picture_of_points(const Camera& camera) const;
    void read_edge(const char* name, int& size, double& start, double& reference) const;
    Rgb color(const XmlElement& element) const;
    void read_film(Scene& scene) const;
    std::string group_name(const XmlElement& element) const;
    void read_light(Scene& scene) const;
    void read_lights(Scene& scene) const;
    void read_daylight(const XmlElement& element, Scene& scene) const;
    Light light(const XmlElement& element) const;
    Rgb light_color(const XmlElement& element) const;
    template <class Kind> Light of_power(const XmlElement& element, Kind light, Rgb Kind::*shine) const;
    std::optional<Volume> volume(const std::string& integrator) const;
    void read_volumes(Scene& scene);
    NamedVolumes named_volumes(pugi::xml_node list) const;
    pugi::xml_node volume_it_is_like(const XmlElement& volume, const NamedVolumes& named) const;
    std::vector<pugi::xml_node> with_those_it_is_like(pugi::xml_node volume, const NamedVolumes& named) const;
    void read_surfaces(Scene& scene);
    Surface surface(const XmlElement& element) const;
    TriangleSurface triangles() const;
    Material material(const XmlElement& element) const;
    void read_texture(const XmlElement& element, Material& material) const;
    glm::dmat4 transform() const;
    std::optional<Shape> shape(const std::string& integrator, std::string& place) const;
    XmlElement shape_element(const std::string& integrator) const;
    XmlElement shape_element(pugi::xml_node scope, const std::string& integrator) const;
    // Of those in force, by the volume itself, what it is like, and so on, the first that has it; or their number.
    std::size_t scope_of(const char* name) const;
    // Of a volume with a shape of its own, whether this is of what it is like, whose density may have been another
    // kind.
    bool is_behind_shape(const char* name) const;
    Sphere sphere(const XmlElement& element) const;
    Box box(const XmlElement& element) const;
    Everywhere everywhere(const XmlElement& element) const;
    std::filesystem::path file_path(const XmlElement& element, const char* example) const;
    std::filesystem::path file_path(const XmlElement& element, const std::string& name) const;
    GridFile grid_file(const XmlElement& element) const;
    Drift drift(const std::string& integrator) const;
    MeshFiles mesh_files() const;
    std::optional<Noise> noise(const Volume& volume) const;
    void read_layers(Volume& volume) const;
    Layers exponential_layers(const XmlElement& element, const Volume& volume) const;
    Layers layer_table(const XmlElement& element, Volume& volume) const;
    Rgb coefficient(const char* name, const Rgb& fallback) const;
    void read_coefficients(Volume& volume) const;
    void read_phase(Volume& volume) const;
    void check_extinction(const Volume& volume) const;
    TemperatureEmission temperature_emission(bool is_grid) const;
    std::string albedo_grid(bool is_grid) const;
    void read_map(Volume& volume) const;
    ValueMap density_map(const XmlElement& element) const;
    ValueMap transfer_function(const XmlElement& element) const;
    ValueMap ramp(const XmlElement& element) const;
    std::vector<MapPoint> map_points(const char* name, bool is_transfer) const;
    MapPoint map_point(const XmlElement& element, const char* value, const Limits& limits, bool is_transfer) const;
    void take_transfer(Volume& volume, ValueMap map) const;
    void check_points(const std::vector<MapPoint>& points, const char* value, const XmlElement& last) const;
    CoefficientUnit unit(const XmlElement& sigma_a, const XmlElement& sigma_s, bool is_grid) const;
    std::optional<Expected> expected() const;
    Rgb channels(const XmlElement& element, const char* attribute, const Limits& limits, const Rgb& fallback) const;
    void warn_without_volume() const;
    void warn_of_glow_without_absorption(const Volume& volume) const;
    void warn_of_what_is_in_no_volume() const;
    void read_without_effect() const;
    void read_bookkeeping() const;

    XmlDocument& document_;
    const SceneOverrides& overrides_;
    // Whose elements are read: the scene's, or those of a <volume>, and, where it lacks some, of that which it is like.
    std::vector<pugi::xml_node> scopes_;
};

} // namespace vkvol
