// Every integrator, flight and transmittance by both schedules, against the reference's own. The table of tools/results
// comes from here, by tools/validate.sh, on whatever driver it is told.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <iostream>
#include <set>

#include "error.h"
#include "integrators.h"
#include "method.h"
#include "preset.h"
#include "shared/constants.h"
#include "shared/estimators.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "support/surface_scenes.h"
#include "support/test_device.h"

using namespace vkvol;

namespace {

// All that renders this scene as it is asked to, by names: each integrator, and ratioTracking with each flight and each
// transmittance.
std::vector<std::pair<std::string, Scene>> ways_to_render(const Scene& scene) {
    std::vector<std::pair<std::string, Scene>> ways;
    const auto consider = [&](const std::string& text) {
        Scene trial = scene;
        const IntegratorRequest request = parse_integrator(text);
        trial.settings.integrator = request.name;
        trial.settings.choices = request.choices;
        const Integrator& row = *find_integrator(request.name);
        if (row.origin == Integrator::Origin::thesis_models && std::holds_alternative<GridFile>(scene.volumes[0].shape))
            return;
        if (row.nee == NEE_NONE) // which would miss their light, and say so
            trial.lights.clear();
        try {
            if (choose_method(with_preset(trial)).warnings.empty())
                ways.emplace_back(text, trial);
        } catch (const InputError&) { // not in this medium
        }
    };
    for (const Integrator& integrator : integrators())
        consider(integrator.name);
    for (const char* axis : {"flight", "transmittance"})
        for (const std::string& choice : find_axis(axis).names)
            consider(fmt::format("ratioTracking:{}={}", axis, choice));
    return ways;
}

// agreement_scenes() of which each has estimators that the others have not.
std::vector<NamedScene> scenes_of_all() {
    std::vector<NamedScene> scenes = agreement_scenes();
    std::erase_if(scenes, [](const NamedScene& named) {
        return named.name != "sphere, g 0.8" && named.name != "thick cloud" && named.name != "chromatic cloud" &&
               named.name != "fire";
    });
    for (NamedScene& named : scenes)
        named.scene.settings.spp = 500;
    // Which the original's integrators for models ask for.
    Scene mesh = scenes.front().scene;
    mesh.volumes = {medium(write_mesh(make_box({-0.8, -0.6, -0.7}, {0.7, 0.9, 0.6}, 1)), 2.0, 0.9, 0.3)};
    scenes.push_back({"mesh", mesh});
    // What these are for one directional light.
    const auto [point, spot, ball, disk, rectangle, sun, beam] = LightsAbout{};
    Scene lit = scenes.front().scene;
    lit.lights = {point, spot, ball, disk, rectangle, sun, beam, write_sky(sunset_map())};
    lit.settings.spp = 2000; // of 500 a pixel whose light is one lamp, seldom chosen, is far from a normal limit
    scenes.push_back({"all lights", lit});
    Scene surfaces = rough_still_life();
    surfaces.settings.spp = 1000;        // likewise
    surfaces.settings.march.step = 0.02; // the reference of surfaces does not march
    scenes.push_back({"surfaces", surfaces});
    return scenes;
}

Film by_schedule(const Scene& scene, Schedule schedule, std::uint32_t seed) {
    RenderJob job;
    job.plan.schedule = schedule;
    const RenderResult result = render_here(scene, seed, job);
    CHECK(result.plan.schedule == schedule);
    return result.film;
}

} // namespace

TEST_CASE("all integrators, flights and transmittances agree by both schedules", "[.schedules_table]") {
    std::vector<AgreementRow> rows;
    std::set<std::string> seen;
    std::uint32_t seed = 5000;
    for (const NamedScene& named : scenes_of_all()) {
        std::size_t same_bits_by_both = 0;
        PairwiseAgreement worst;
        const auto ways = ways_to_render(named.scene);
        const bool is_grid = std::holds_alternative<GridFile>(named.scene.volumes[0].shape);
        CHECK(ways.size() >= (is_grid ? 28u : named.scene.surfaces.empty() ? 37u : 5u));
        for (const auto& [name, scene] : ways) {
            seen.insert(name);
            // The reference has paths from the camera alone, and leaves to presets what media lack by them.
            const bool by_paths = find_integrator(scene.settings.integrator)->paths == PATHS_CAMERA;
            Scene known = with_preset(scene);
            if (!by_paths)
                known.settings.integrator = "ratioTracking";
            const Film expected = render_reference(known, ++seed);
            const Film fused = by_schedule(scene, Schedule::fused, ++seed);
            const Film staged = by_schedule(scene, Schedule::staged, seed);
            const bool same = same_bits(fused, staged);
            same_bits_by_both += same;
            CAPTURE(named.name, name);
            CHECK((same || !test_device().is_cpu()));
            std::vector<Estimate> estimates{{"reference, " + name, expected}, {"fused, " + name, fused}};
            if (!same)
                estimates.push_back({"staged, " + name, staged});
            const PairwiseAgreement found = compare_all(estimates);
            worst.pairs += found.pairs;
            worst.tests += by_paths ? found.tests : 3 * found.pairs;
            if (!std::isnan(worst.mean_z) && !(found.mean_z <= worst.mean_z)) {
                worst.mean_z = found.mean_z;
                worst.mean_pair = found.mean_pair;
            }
            // A particle's few pixels are far from a normal limit.
            if (by_paths && !std::isnan(worst.pixel_z) && !(found.pixel_z <= worst.pixel_z)) {
                worst.pixel_z = found.pixel_z;
                worst.pixel_pair = found.pixel_pair;
            }
        }
        rows.push_back({fmt::format("{:<16} {:>5} {:>5}", named.name, ways.size(), same_bits_by_both), worst, worst});
    }
    check_rows("Every integrator, and ratioTracking with every flight and every transmittance, fused and staged, each "
               "against the reference's own. same: by both schedules, bit for bit.",
               fmt::format("{:<16} {:>5} {:>5}", "scene", "ways", "same"), rows, 0.01);
    std::string missing;
    for (const Integrator& integrator : integrators())
        missing += seen.count(integrator.name) ? "" : std::string(" ") + integrator.name;
    for (const char* axis : {"flight", "transmittance"})
        for (const std::string& choice : find_axis(axis).names)
            missing += seen.count(fmt::format("ratioTracking:{}={}", axis, choice)) ? "" : " " + choice;
    std::cout << fmt::format("\n{} ways; missing:{}\n", seen.size(), missing.empty() ? " none" : missing) << std::flush;
    CHECK(missing.empty());
}
