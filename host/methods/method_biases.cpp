#include "method_biases.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>
#include <string>
#include <vector>

#include "particle_scenes.h"
#include "scene_facts.h"
#include "shared/constants.h"
#include "shared/estimators.h"

namespace vkvol {

namespace {

bool is_smooth(const Surface& surface) {
    return surface.material.kind != MaterialKind::diffuse && surface.material.roughness == 0.0;
}

bool is_clear(const Surface& surface) {
    return surface.material.kind == MaterialKind::thin_dielectric ||
           (surface.material.kind == MaterialKind::dielectric && is_smooth(surface));
}

class BiasFinder {
public:
    BiasFinder(const Scene& scene, int field, Method& method) : scene_(scene), field_(field), method_(method) {}

    void find_biases();
    void find_chances();

private:
    template <class Is> bool any_surface(Is is) const {
        return std::any_of(scene_.surfaces.begin(), scene_.surfaces.end(), is);
    }
    bool has_thrown_light() const;
    bool shines_by_chance() const;
    bool glows_by_chance() const;
    bool is_thrown_from_afar() const;
    std::string who_finds_caustics() const;
    void warn(const std::string& message) { method_.warnings.push_back(method_.integrator + ": " + message); }

    const Scene& scene_;
    const int field_;
    Method& method_;
};

bool has_no_extent(const Light& light) {
    return !is_lamp(light) && !is_met_by_chance(light) && !is_met_on_the_way(light);
}

// Whether any surface shines that is no light.
bool BiasFinder::shines_by_chance() const {
    std::set<int> lights;
    for (const Light& light : scene_.lights)
        lights.insert(body_of(light));
    for (std::size_t i = 0; i < scene_.surfaces.size(); ++i)
        if (scene_.surfaces[i].emission != Rgb(0.0) && !lights.contains(static_cast<int>(i)))
            return true;
    return false;
}

// Whether a medium glows that no look goes to: all but even balls and boxes, and these too where there are no looks.
bool BiasFinder::glows_by_chance() const {
    std::set<int> looked_for;
    for (const Light& light : scene_.lights)
        if (const auto* glow = std::get_if<GlowLight>(&light))
            looked_for.insert(glow->medium);
    for (std::size_t i = 0; i < scene_.volumes.size(); ++i)
        if (glows(scene_.volumes[i]) && !looked_for.contains(static_cast<int>(i)))
            return true;
    return false;
}

// Whether there are caustics of lights that no path may meet.
bool BiasFinder::has_thrown_light() const {
    return method_.scattering == SCATTERING_MULTIPLE && method_.nee != NEE_NONE && any_surface(is_smooth) &&
           std::any_of(scene_.lights.begin(), scene_.lights.end(), has_no_extent);
}

// Whether some of them are of light that particles do not bring.
bool BiasFinder::is_thrown_from_afar() const {
    const auto is_directional = [](const Light& light) { return std::holds_alternative<DirectionalLight>(light); };
    return !particles_come_from_afar(scene_) && std::any_of(scene_.lights.begin(), scene_.lights.end(), is_directional);
}

// Where particles can, to the end of what is missing.
std::string BiasFinder::who_finds_caustics() const {
    if (why_no_particles(scene_, true, false))
        return reads_flux(scene_.camera) && !why_no_particles(scene_, false, emits(scene_))
                   ? "; integrator lightTracing does"
                   : "";
    return is_thrown_from_afar() ? "; of points and spots integrator bidirectional does"
                                 : "; integrator bidirectional does";
}

void BiasFinder::find_chances() {
    const bool has_extent = std::any_of(scene_.lights.begin(), scene_.lights.end(),
                                        [](const Light& light) { return is_lamp(light) || is_met_by_chance(light); });
    std::vector<const char*> found;
    const bool by_particles = method_.paths == PATHS_BOTH && particles_come_from_afar(scene_);
    const bool both_can = !why_no_particles(scene_, true, false);
    if (method_.paths == PATHS_BOTH && !by_particles && any_surface(is_smooth) &&
        std::any_of(scene_.lights.begin(), scene_.lights.end(), is_met_by_chance))
        found.push_back("what smooth mirrors, coats and glass throw of suns and skies, from which particles come only "
                        "where neither a plane nor a medium is without end");
    if (method_.paths == PATHS_CAMERA && any_surface(is_smooth) && has_extent)
        found.push_back(!both_can ? "what smooth mirrors, coats and glass throw of lights"
                        : particles_come_from_afar(scene_)
                            ? "what smooth mirrors, coats and glass throw of lights, which integrator bidirectional "
                              "looks for"
                            : "what smooth mirrors, coats and glass throw of lights, which integrator bidirectional "
                              "looks for if they have a place");
    if (method_.paths != PATHS_LIGHT && any_surface(is_smooth) &&
        std::any_of(scene_.lights.begin(), scene_.lights.end(), is_shining_surface))
        found.push_back("what smooth mirrors, coats and glass throw of meshes that shine");
    if (method_.paths != PATHS_LIGHT && method_.scattering != SCATTERING_SINGLE && shines_by_chance())
        found.push_back(scene_.periodic ? "light of surfaces, for which no shadow ray looks in domains that repeat"
                                        : "light of planes, or of any surface without shadow rays");
    if (method_.paths != PATHS_LIGHT && method_.scattering == SCATTERING_MULTIPLE && !scene_.surfaces.empty() &&
        glows_by_chance())
        found.push_back(why_no_particles(scene_, false, true)
                            ? "light of media that glow, for which no shadow ray looks, on surfaces"
                            : "light of media that glow, for which no shadow ray looks, on surfaces, which integrator "
                              "lightTracing brings");
    method_.by_chance = fmt::format("{}", fmt::join(found, "; "));
}

void BiasFinder::find_biases() {
    std::vector<std::string> reasons;
    const auto add = [&](Bias bias, const std::string& reason) {
        method_.biases |= bias;
        reasons.push_back(reason);
    };
    // At constant density a march knows its optical depths but for rounding (see check_step), though not the light
    // between its sample points.
    if (method_.flights_have(TRAIT_MARCH) && field_ != FIELD_CONSTANT)
        add(bias_flight_steps, "flights take the density of one point for that of a whole step");
    else if (method_.flights_have(TRAIT_MARCH) && is_through(method_) && method_.nee != NEE_NONE &&
             method_.scattering != SCATTERING_NONE)
        add(bias_flight_steps, "the march takes the light of one point for that of a whole step");
    if (method_.shadow_rays_have(TRAIT_INEXACT) && field_ != FIELD_CONSTANT)
        add(bias_shadow_steps, "shadow rays take the density of one point for that of a whole step");
    // The other null-collision estimators weight what exceeds the majorant.
    const bool needs_majorant = method_.flights_have(TRAIT_BOUND) || method_.shadow_rays_have(TRAIT_BOUND);
    if (needs_majorant && scene_.settings.majorant_scale < 1.0)
        add(bias_majorant, "the majorant is scaled below the density");
    if (method_.scattering == SCATTERING_SINGLE && (any_surface(is_smooth) || shines_by_chance()))
        add(bias_single_at_surfaces,
            "single scattering ends at the first surface: what mirrors, coats and glass show is "
            "missing, and so is what surfaces scatter of others that no shadow ray looks for");
    if (any_surface(is_smooth) && method_.paths == PATHS_LIGHT && !reads_flux(scene_.camera))
        add(bias_specular_view, "what smooth mirrors, coats and glass show is missing, which no particle finds");
    if (has_thrown_light() && method_.paths == PATHS_CAMERA) {
        if (any_surface(is_clear))
            warn("no path from the camera finds what directional lights, points and spots send through glass, which "
                 "casts their shadow" +
                 who_finds_caustics() + "; a sun, sphere, disk or rectangle shines through");
        add(bias_caustics, "what smooth mirrors, coats and glass throw of points, spots and directional lights is "
                           "missing, which no path from the camera finds" +
                               who_finds_caustics());
    } else if (has_thrown_light() && method_.paths == PATHS_BOTH) {
        if (is_thrown_from_afar())
            add(bias_caustics,
                "what smooth mirrors, coats and glass throw of directional lights is missing: from these "
                "particles come only where neither a plane nor a medium is without end");
        add(bias_caustics_in_mirrors,
            "what smooth mirrors, coats and glass throw of points, spots and directional lights and then "
            "show is missing, which neither particles nor paths from the camera find; lights with an "
            "extent have it");
    }
    method_.biased = fmt::format("{}", fmt::join(reasons, "; "));
}

} // namespace

void find_biases(const Scene& scene, int field, Method& method) {
    BiasFinder finder(scene, field, method);
    finder.find_biases();
    finder.find_chances();
}

} // namespace vkvol
