#include "even_sky.h"

#include "alias_table.h"
#include "phase_params.h"
#include "scene_facts.h"
#include "shared/constants.h"

namespace vkvol {

namespace {

// Whether all that scatters does so ahead for the most part, whatever peak a small share has. Then looks are mostly
// where little is scattered to.
bool scatters_ahead(const Scene& scene, Media media, double least) {
    bool any = false;
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        if (can_scatter(scene.volumes[i])) {
            any = true;
            if (mean_cosine(scene.volumes[i], media[i].phase_nodes) < least)
                return false;
        }
    return any;
}

} // namespace

bool is_left_to_flights(const Scene& scene, Media media, const Method& method, const SkyMap* sky) {
    // Where light is scattered once no flight goes on to meet it; and particles come from all of it.
    if (!sky || method.mis || scene.settings.choices.nee || method.nee == NEE_NONE ||
        method.scattering != SCATTERING_MULTIPLE || method.paths != PATHS_CAMERA)
        return false;
    // Measured: tools/results/README.md. Where no other light asks for looks, none costs anything.
    if (!scene.surfaces.empty() || reads_flux(scene.camera)) // which have no narrow view
        return sky->unevenness < 1.6;
    if (scene.lights.size() == 1)
        return sky->unevenness < (scatters_ahead(scene, media, 0.75) ? 6.0 : 2.1);
    return sky->unevenness < (scatters_ahead(scene, media, 0.83) ? 4.0 : 1.6);
}

Method without_idle_looks(const Scene& scene, Media media, const Method& method, const SkyMap* sky) {
    Method without = method;
    if (scene.lights.size() == 1 && is_left_to_flights(scene, media, method, sky))
        without.nee = NEE_NONE;
    return without;
}

void leave_sky_to_flights(LightTable& table) {
    std::vector<double> chances;
    for (std::uint32_t i = 0; i < table.choices; ++i)
        chances.push_back(table.rows[i].kind == LIGHT_MAP ? 0.0 : table.rows[i].chance);
    double sum = 0.0;
    for (const double chance : chances)
        sum += chance;
    const std::vector<shared::AliasEntry> alias = make_alias_table(chances);
    for (std::uint32_t i = 0; i < table.choices; ++i) {
        table.rows[i].chance = static_cast<float>(chances[i] / sum);
        table.rows[i].alias = alias[i];
    }
    for (shared::LightRow& row : table.rows) // of those that flights meet as well
        row.look_density = static_cast<float>(row.look_density / sum);
}

} // namespace vkvol
