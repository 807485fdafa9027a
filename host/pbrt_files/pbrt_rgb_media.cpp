// The part of PbrtTranslator that writes media whose coefficients are a colour in each voxel. A medium here has one
// density for all channels; what a voxel absorbs and what it scatters, and of each red, green and blue, become media
// that fill the same space, which is exact since coefficients of media that overlap add up.
#include <algorithm>
#include <fmt/format.h>

#include "blackbody.h"
#include "pbrt_spectra.h"
#include "pbrt_translator.h"
#include "pbrt_voxels.h"

namespace vkvol {

namespace {

using Colors = std::vector<glm::dvec3>;

// A part of a medium that has one colour everywhere, or one channel.
struct Part {
    std::string name;
    glm::dvec3 color{0.0};
    std::vector<float> values;
    std::vector<float> glow; // Le of its largest channel; empty without
    glm::dvec3 glow_color{0.0};
};

Colors colors_of(const PbrtColors& colors, const PbrtThing& medium, const char* name, glm::ivec3 dims) {
    if (!medium.parameters->has(name))
        return Colors(voxel_count(dims), glm::dvec3(1.0)); // as pbrt has it
    Colors values = colors.colors(medium, name);
    if (values.size() != voxel_count(dims))
        fail_at(medium.parameters->find(name)->place,
                fmt::format("\"{}\" has {} colours; expected nx ny nz = {}", name, values.size(), voxel_count(dims)));
    for (const glm::dvec3& value : values)
        for (int c = 0; c < 3; ++c)
            if (!(value[c] >= 0.0 && value[c] <= 1e30))
                fail_at(medium.parameters->find(name)->place,
                        fmt::format("\"{}\" has {:g} among its values; expected 0 to 1e30", name, value[c]));
    return values;
}

double largest_of(const glm::dvec3& color) {
    return std::max({color.x, color.y, color.z});
}

// The colour, of largest channel 1, of which all are multiples; none: 0.
glm::dvec3 common_color(const Colors& colors) {
    const glm::dvec3 brightest = *std::max_element(
        colors.begin(), colors.end(), [](const auto& a, const auto& b) { return largest_of(a) < largest_of(b); });
    if (largest_of(brightest) == 0.0)
        return glm::dvec3(0.0);
    const glm::dvec3 color = brightest / largest_of(brightest);
    for (const glm::dvec3& each : colors) // single precision, in which grids are
        if (largest_of(glm::abs(each - largest_of(each) * color)) > 1e-6 * largest_of(each))
            return glm::dvec3(0.0);
    return color;
}

std::vector<float> channel_of(const Colors& colors, int channel) {
    std::vector<float> values;
    for (const glm::dvec3& color : colors)
        values.push_back(static_cast<float>(color[channel]));
    return values;
}

std::vector<float> largest_channels(const Colors& colors) {
    std::vector<float> values;
    for (const glm::dvec3& color : colors)
        values.push_back(static_cast<float>(largest_of(color)));
    return values;
}

// `glow`: empty without.
std::vector<Part> parts_of(const std::string& name, const Colors& colors, const Colors& glow) {
    const glm::dvec3 common = common_color(colors), common_glow = glow.empty() ? glm::dvec3(0.0) : common_color(glow);
    if (largest_of(common) > 0.0 && (glow.empty() || largest_of(common_glow) > 0.0))
        return {{name, common, largest_channels(colors), largest_channels(glow), common_glow}};
    const char* channels[] = {"red", "green", "blue"};
    std::vector<Part> parts;
    for (int c = 0; c < 3; ++c) {
        std::vector<float> values = channel_of(colors, c);
        if (*std::max_element(values.begin(), values.end()) == 0.0f)
            continue;
        glm::dvec3 color(0.0);
        color[c] = 1.0;
        parts.push_back({name + "_" + channels[c], color, std::move(values), channel_of(glow, c), color});
    }
    return parts;
}

} // namespace

void PbrtTranslator::write_rgb_medium(const std::string& name, const PbrtThing& medium) {
    const PbrtParameters& p = *medium.parameters;
    if (!p.has("sigma_a") && !p.has("sigma_s"))
        fail_at(medium.place, "medium \"rgbgrid\" lacks \"rgb sigma_a\" and \"rgb sigma_s\"; expected one of them");
    if (p.has("Le") && !p.has("sigma_a"))
        fail_at(p.find("Le")->place, "\"Le\" without \"sigma_a\", which says where it shines; expected both");
    const glm::ivec3 dims = dims_of(medium);
    const glm::dmat4 place = voxels_to_medium(bounds_of(medium), dims);
    const Colors glow = p.has("Le") ? colors_of(colors_, medium, "Le", dims) : Colors();
    // First what is given, which shows whether there are as many as the file says, and only then as many ones.
    const Colors given = colors_of(colors_, medium, p.has("sigma_s") ? "sigma_s" : "sigma_a", dims);
    const Colors other = colors_of(colors_, medium, p.has("sigma_s") ? "sigma_a" : "sigma_s", dims);
    std::vector<Part> parts = parts_of("sigma_a", p.has("sigma_s") ? other : given, glow);
    const std::vector<Part> scattering = parts_of("sigma_s", p.has("sigma_s") ? given : other, {});
    parts.insert(parts.end(), scattering.begin(), scattering.end());
    const std::string file = free_name(name);
    const auto grids = std::make_shared<MemoryGrids>();
    // pbrt divides the spectra of lights by what the observer makes of 1, but not those of these.
    const double scale = p.number("scale", 1.0), brightness = glow_scale(medium) * exposure_ * observer_integral;
    for (const Part& part : parts) {
        if (has_soft_edge(dims, part.values))
            note(medium.place, soft_edge_note);
        grids->grids.push_back({part.name, make_grid(part.name, dims, part.values)});
        const bool absorbs = part.name.starts_with("sigma_a");
        xml_.open("volume", {{"name", name + " " + part.name}}, medium.place.text());
        xml_.element("densityField", {{"grid", part.name}}, file);
        write_matrix(world_ * medium.transform * place);
        write_coefficients(absorbs ? scale * part.color : glm::dvec3(0.0),
                           absorbs ? glm::dvec3(0.0) : scale * part.color, p.number("g", 0.0));
        if (!part.glow.empty()) {
            const std::string glow_name = "Le" + part.name.substr(std::string("sigma_a").size());
            grids->grids.push_back({glow_name, make_grid(glow_name, dims, part.glow)});
            XmlAttributes attributes = {{"grid", glow_name}, {"model", "color"}};
            add_rgb(attributes, part.glow_color * brightness * white_of_space(medium.color_space));
            xml_.element("emission", attributes);
        }
        xml_.close();
    }
    note_unused(medium, {"type"});
    grids_.emplace(file, grids);
}

} // namespace vkvol
