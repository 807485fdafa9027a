// Reads one scene document, element by element; scene_xml is its public face.
#pragma once

#include <initializer_list>
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

inline constexpr long long max_edge = 65536; // pixels
inline constexpr long long max_integer = 2147483647;

class SceneReader {
public:
    SceneReader(XmlDocument& document, const SceneOverrides& overrides)
        : document_(document), overrides_(overrides), scope_(document.root()) {}

    Scene read();

private:
    XmlElement one(std::initializer_list<const char*> names) const;
    XmlElement one(const char* name) const { return one({name}); }

    RenderSettings settings() const;
    void read_pixel_filter(RenderSettings& settings) const;
    void read_integrator(RenderSettings& settings) const;
    March march() const;
    void check_method(const Scene& scene) const;
    void warn_about_light(const Scene& scene, const Method& method) const;
    void warn_about_steps(const Scene& scene, const Method& method) const;
    Camera camera() const;
    Picture picture() const;
    void read_edge(const char* name, int& size, double& start, double& reference) const;
    Rgb color(const XmlElement& element) const;
    void read_light(Scene& scene) const;
    void read_lights(Scene& scene) const;
    void read_daylight(const XmlElement& element, Scene& scene) const;
    Light light(const XmlElement& element) const;
    Rgb light_color(const XmlElement& element) const;
    template <class Kind> Light of_power(const XmlElement& element, Kind light, Rgb Kind::*shine) const;
    std::optional<Volume> volume(const std::string& integrator) const;
    void read_volumes(Scene& scene);
    glm::dmat4 transform() const;
    std::optional<Shape> shape(const std::string& integrator, std::string& place) const;
    XmlElement shape_element(const std::string& integrator) const;
    Sphere sphere(const XmlElement& element) const;
    Box box(const XmlElement& element) const;
    std::filesystem::path file_path(const XmlElement& element, const char* example) const;
    std::filesystem::path file_path(const XmlElement& element, const std::string& name) const;
    GridFile grid_file(const XmlElement& element) const;
    MeshFiles mesh_files() const;
    std::optional<Noise> noise(bool is_grid) const;
    Rgb coefficient(const char* name, const Rgb& fallback) const;
    void read_coefficients(Volume& volume) const;
    void read_phase(Volume& volume) const;
    void check_extinction(const Volume& volume) const;
    TemperatureEmission temperature_emission(bool is_grid) const;
    std::string albedo_grid(bool is_grid) const;
    CoefficientUnit unit(const XmlElement& sigma_a, const XmlElement& sigma_s, bool is_grid) const;
    std::optional<Expected> expected() const;
    Rgb channels(const XmlElement& element, const char* attribute, const Rgb& fallback) const;
    void warn_without_volume() const;
    void read_without_effect() const;
    void read_bookkeeping() const;

    XmlDocument& document_;
    const SceneOverrides& overrides_;
    pugi::xml_node scope_; // whose elements are read: the scene's, or those of a <volume>
};

} // namespace vkvol
