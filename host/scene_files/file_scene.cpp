#include "file_scene.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

#include "camera_view.h"
#include "decimals.h"
#include "error.h"
#include "framing.h"
#include "integrators.h"
#include "one_line.h"
#include "scene_beside.h"
#include "xml_text.h"

namespace vkvol {

namespace {

// In the usual view: the sun high on the left, so that one sees lit and shaded sides.
constexpr double sun_azimuth = -75.0, sun_elevation = 42.0; // degrees

std::string lower(std::string text) {
    for (char& c : text)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

bool is_temperature(const std::string& name) {
    const std::string plain = lower(name);
    return plain == "temperature" || plain == "temp" || plain == "heat";
}

// Names in the order in which they are taken for a density.
std::vector<std::string> candidates(const std::vector<std::string>& names) {
    const auto rank = [](const std::string& name) {
        return name == "density" ? 0 : lower(name) == "density" ? 1 : is_temperature(name) ? 3 : 2;
    };
    std::vector<std::string> sorted = names;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
    return sorted;
}

// What stands before a message of a file that is named already.
std::string without(const std::string& message, const std::filesystem::path& file) {
    const std::string prefix = file.string() + ": ";
    return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
}

// A grid with something in it, or why it is none.
std::optional<DensityField> load(const GridFile& file, std::string& reason) {
    try {
        DensityField field = load_density_field(file);
        if (field.active_voxels > 0 && field.max_value() > 0.0f)
            return field;
        reason = field.active_voxels > 0 ? fmt::format("\"{}\" is 0 everywhere", file.grid)
                                         : fmt::format("\"{}\" is empty", file.grid);
    } catch (const InputError& error) {
        const std::string message = without(error.what(), file.path);
        reason = message.substr(0, message.find(';')); // the remedy would be for whoever wants that very grid
    }
    return std::nullopt;
}

DensityField load_density(const std::filesystem::path& file, const std::vector<std::string>& names, FileView& view) {
    std::string reasons;
    for (const std::string& name : candidates(names)) {
        std::string reason;
        if (std::optional<DensityField> field = load({file, name}, reason)) {
            if (!reasons.empty())
                view.warnings.push_back(
                    one_line(fmt::format("{}: \"{}\" is taken for the density: {}", file.string(), name, reasons)));
            view.grid = name;
            return std::move(*field);
        }
        reasons += (reasons.empty() ? "" : "; ") + reason;
    }
    throw InputError(one_line(fmt::format("{}: holds no density to render: {}", file.string(),
                                          reasons.empty() ? "it has no grid" : reasons)));
}

std::optional<DensityField> load_temperature(const std::filesystem::path& file, const std::vector<std::string>& names,
                                             FileView& view) {
    for (const std::string& name : names) {
        if (!is_temperature(name) || name == view.grid)
            continue;
        std::string reason;
        if (std::optional<DensityField> field = load({file, name}, reason)) {
            view.temperature = name;
            return field;
        }
        view.warnings.push_back(fmt::format("{}: nothing glows: {}", file.string(), one_line(reason)));
    }
    return std::nullopt;
}

glm::dvec3 on_orbit(double turn, double lift, glm::dvec3 up) {
    Camera camera;
    place_on_orbit(camera, {glm::dvec3(0.0), 1.0, turn, lift, up});
    return camera.position;
}

double rounded(double value, int decimals) {
    const std::string text = fmt::format("{:.{}f}", value, decimals);
    std::from_chars(text.data(), text.data() + text.size(), value); // whatever a locale takes for a decimal point
    return value;
}

std::string integrator_element(const std::string& request) {
    if (request.empty())
        return "";
    std::string attributes, rest = request;
    const std::string name = rest.substr(0, rest.find(':'));
    rest = rest.size() > name.size() ? rest.substr(name.size() + 1) : "";
    while (!rest.empty()) {
        const std::string choice = rest.substr(0, rest.find(':'));
        rest = rest.size() > choice.size() ? rest.substr(choice.size() + 1) : "";
        const std::size_t equals = choice.find('=');
        attributes += fmt::format(" {}=\"{}\"", choice.substr(0, equals), choice.substr(equals + 1));
    }
    return fmt::format("  <integrator{}>{}</integrator>\n", attributes, name);
}

std::string light_elements(const FileView& view) {
    const bool glows = view.medium.kelvin.has_value();
    return fmt::format("  <light x=\"{}\" y=\"{}\" z=\"{}\" r=\"1\" g=\"0.93\" b=\"0.82\" multiplier=\"{}\"/>\n"
                       "  <backgroundColor r=\"{}\" g=\"{}\" b=\"{}\"/>\n",
                       short_text(view.sun.x, 3), short_text(view.sun.y, 3), short_text(view.sun.z, 3),
                       glows ? 4.0 : 5.5, glows ? 0.02 : 0.06, glows ? 0.03 : 0.12, glows ? 0.055 : 0.25);
}

std::string assumed_line(const std::filesystem::path& file, const FileView& view, Up up, bool is_only) {
    const SuitableMedium& m = view.medium;
    std::string text =
        fmt::format("{}: \"{}\"{}, optical depth {:g} (sigma_t {:.3g} per world unit)", file.string(), view.grid,
                    view.grid == "density" || is_only ? "" : " taken for the density", m.depth, m.sigma_t);
    if (m.kelvin)
        text += m.kelvin->offset > 0.0
                    ? fmt::format(", \"{}\" glows up to {:g} K ({:.4g} per unit + {:g})", view.temperature,
                                  m.kelvin->hottest, m.kelvin->scale, m.kelvin->offset)
                    : fmt::format(", \"{}\" glows as kelvin", view.temperature);
    else if (!view.temperature.empty())
        text += fmt::format(", \"{}\" is too cool to glow", view.temperature);
    return one_line(text + (up == Up::z ? ", sun and sky, z up" : ", sun and sky, y up (else --up z)"));
}

} // namespace

Picture file_picture() {
    return {640, 480, 0.0, 0.0, 640.0, 480.0};
}

FileView view_file(const std::filesystem::path& file, const Picture& picture, Up up) {
    const std::vector<std::string> names = grid_names(file);
    FileView view;
    const DensityField density = load_density(file, names, view);
    const std::optional<DensityField> temperature = load_temperature(file, names, view);

    view.fov = usual_fov;
    view.orbit.up = up == Up::y ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    view.orbit.azimuth = usual_azimuth;
    view.orbit.elevation = usual_elevation;
    view.sun = on_orbit(sun_azimuth, sun_elevation, view.orbit.up);
    const Corners corners = corners_of(density);
    Camera camera;
    camera.fov = usual_fov;
    place_on_orbit(camera, view.orbit);
    frame(camera, picture, corners);
    const glm::dvec3 forward = -camera_rotation(camera)[2];
    const double distance = glm::dot(middle_of(corners) - camera.position, forward);
    const int decimals = decimals_for(diagonal_of(corners));
    view.orbit.distance = rounded(distance, decimals);
    for (int axis = 0; axis < 3; ++axis)
        view.orbit.target[axis] = rounded(camera.position[axis] + distance * forward[axis], decimals);
    view.medium = suit_medium(density, temperature ? &*temperature : nullptr, camera, picture);
    return view;
}

std::string camera_element(const FileView& view) {
    const Orbit& orbit = view.orbit;
    return fmt::format("<camera lookAt=\"{} {} {}\" distance=\"{}\" azimuth=\"{}\" elevation=\"{}\"{} fov=\"{}\"/>",
                       orbit.target.x, orbit.target.y, orbit.target.z, orbit.distance, orbit.azimuth, orbit.elevation,
                       orbit.up.z != 0.0 ? " up=\"0 0 1\"" : "", view.fov);
}

std::string medium_elements(const FileView& view) {
    const SuitableMedium& m = view.medium;
    std::string text = fmt::format("  <sigma_a unit=\"world\">{:.4g}</sigma_a>\n"
                                   "  <sigma_s unit=\"world\">{:.4g}</sigma_s>\n"
                                   "  <heyneygreenstein_g>{:g}</heyneygreenstein_g>\n",
                                   (1.0 - m.albedo) * m.sigma_t, m.albedo * m.sigma_t, m.g);
    if (m.kelvin)
        text +=
            fmt::format("  <emission grid=\"{}\" model=\"blackbody\" temperatureScale=\"{:.6g}\" "
                        "temperatureOffset=\"{:g}\" referenceTemperature=\"{:.6g}\" r=\"1\" g=\"1\" b=\"1\" "
                        "multiplier=\"{:.4g}\"/>\n",
                        xml_escaped(view.temperature), m.kelvin->scale, m.kelvin->offset, m.kelvin->hottest, m.glow);
    return text;
}

FileScene make_file_scene(const std::filesystem::path& file, const std::filesystem::path& beside,
                          const FileSceneOptions& options) {
    const FileView view = view_file(file, options.picture, options.up);
    FileScene scene;
    scene.warnings = view.warnings;
    scene.assumed = assumed_line(file, view, options.up, grid_names(file).size() == 1);
    scene.xml = fmt::format("  <densityField grid=\"{}\">{}</densityField>\n", xml_escaped(view.grid),
                            xml_escaped(name_beside(file, beside)));
    scene.xml += medium_elements(view);
    scene.xml += light_elements(view);
    scene.xml += fmt::format("  {}\n", camera_element(view));
    scene.xml +=
        fmt::format("  <width>{}</width>\n  <height>{}</height>\n", options.picture.width, options.picture.height);
    scene.xml += integrator_element(options.integrator);
    // Glowing smoke is quick, and noisy where it is thin and hot.
    const std::uint32_t spp = options.spp.value_or(view.medium.kelvin ? 64 : 32);
    scene.xml += fmt::format("  <rayPerPixelCount>{}</rayPerPixelCount>\n", spp);
    scene.xml = "<options>\n" + scene.xml + "</options>\n";
    return scene;
}

} // namespace vkvol
