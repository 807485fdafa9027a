// Reads one scene document, element by element; scene_xml is its public face.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "scene.h"
#include "scene_xml.h"
#include "xml_reader.h"

namespace vkvol {

inline const std::vector<std::string> color_attributes = {"r", "g", "b", "multiplier"};
inline constexpr long long max_edge = 65536; // pixels
inline constexpr long long max_integer = 2147483647;

class SceneReader {
public:
    SceneReader(XmlDocument& document, const SceneOverrides& overrides) : document_(document), overrides_(overrides) {}

    Scene read();

private:
    XmlElement one(std::initializer_list<const char*> names) const;
    XmlElement one(const char* name) const { return one({name}); }

    std::string integrator() const;
    RenderSettings settings() const;
    Camera camera() const;
    Picture picture() const;
    void read_edge(const char* name, int& size, double& start, double& reference) const;
    Rgb color(const XmlElement& element) const;
    void read_light(Scene& scene) const;
    std::optional<Volume> volume() const;
    XmlElement shape_element() const;
    Sphere sphere(const XmlElement& element) const;
    Box box(const XmlElement& element) const;
    GridFile grid_file(const XmlElement& element) const;
    void read_coefficients(Volume& volume) const;
    TemperatureEmission temperature_emission(bool is_grid) const;
    CoefficientUnit unit(const XmlElement& sigma_a, const XmlElement& sigma_s, bool is_grid) const;
    void warn_without_volume() const;
    void read_without_effect() const;
    void read_bookkeeping() const;

    XmlDocument& document_;
    const SceneOverrides& overrides_;
};

} // namespace vkvol
