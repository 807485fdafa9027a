#include "other_words.h"

#include <map>

namespace vkvol {

namespace {

const char* const extinction =
    "extinction is sigma_a + sigma_s: of an albedo w, sigma_s is w sigma_t and sigma_a is (1 - w) sigma_t";
const char* const samples = "samples per pixel are <rayPerPixelCount>, or --spp";
const char* const sky = "a map of the sky is <lights><sky>FILE</sky></lights>";
const char* const lights = "lights stand in <lights>: directional, sun, sky, daylight, point, spot, sphere, disk, "
                           "rectangle";
const char* const mean_cosine = "the mean cosine is <heyneygreenstein_g>";
const char* const surfaces = "surfaces stand in <surfaces>: sphere, disk, rectangle, box, plane, mesh";
const char* const color = "colours are r=\"...\" g=\"...\" b=\"...\" multiplier=\"...\"";

const char* const radiance =
    "colours are r=\"...\" g=\"...\" b=\"...\" multiplier=\"...\"; what a surface shines with is the "
    "<emission r=\"...\" g=\"...\" b=\"...\"/> in it";
const char* const places =
    "places are attributes of a shape; a <volume> of <volumes>, and what is in <surfaces>, may have "
    "a <transform>";

using Words = std::map<std::string, const char*>;

// Words of Mitsuba, pbrt and Cycles, as elements.
const Words elements{{"sigma_t", extinction},
                     {"sigmaT", extinction},
                     {"spp", samples},
                     {"sampleCount", samples},
                     {"sample_count", samples},
                     {"samples", samples},
                     {"sampler", samples},
                     {"envmap", sky},
                     {"environment", sky},
                     {"infinite", sky},
                     {"emitter", lights},
                     {"point", lights},
                     {"spot", lights},
                     {"sun", lights},
                     {"sky", lights},
                     {"daylight", lights},
                     {"directional", lights},
                     {"g", mean_cosine},
                     {"anisotropy", mean_cosine},
                     {"shape", surfaces},
                     {"mesh", surfaces},
                     {"plane", surfaces},
                     {"rectangle", surfaces},
                     {"disk", surfaces},
                     {"fov", "the vertical angle of view is an attribute: <camera fov=\"40\"/>"},
                     {"sensor", "the sensor is <camera>, or <irradiance>, <fluence>, <absorption>"},
                     {"toWorld", places},
                     {"to_world", places},
                     {"max_depth", "the number of vertices is bounded by <maxDepth>"},
                     {"density", "a medium has the density of its <densityField> or shape, times sigma_a and sigma_s"}};

const Words attributes{
    {"radiance", radiance}, {"intensity", color},        {"irradiance", color},
    {"color", color},       {"colour", color},           {"rgb", color},
    {"g", mean_cosine},     {"anisotropy", mean_cosine}, {"value", "the value stands between the tags"}};

std::string known_as(const Words& words, const std::string& word) {
    const auto found = words.find(word);
    return found == words.end() ? "" : found->second;
}

} // namespace

std::string said_here(const std::string& element) {
    return known_as(elements, element);
}

std::string said_here(const std::string& element, const std::string& attribute, bool has_text) {
    // g is green of many things, and value stands between the tags of what has something there.
    const bool is_other = (attribute == "g" && element != "phase") || (attribute == "value" && !has_text);
    return is_other ? "" : known_as(attributes, attribute);
}

} // namespace vkvol
