#include "even_sky.h"

#include "alias_table.h"
#include "shared/constants.h"

namespace vkvol {

bool is_left_to_flights(const Scene& scene, const Method& method, const SkyMap* sky) {
    constexpr double most = 1.6; // measured: tools/results/README.md
    // Where light is scattered once no flight goes on to meet it; and particles come from all of it.
    return sky && sky->unevenness < most && !scene.settings.choices.mis && method.nee != NEE_NONE &&
           method.scattering == SCATTERING_MULTIPLE && method.paths == PATHS_CAMERA;
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
}

} // namespace vkvol
