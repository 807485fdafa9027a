// Looks alone, flights alone, and both by their weights find the same light: of wide lights of all kinds that flights
// meet, by every phase function; ratio, delta, residual and telescoping shadow rays. tools/validate.sh prints the
// table.
#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "method.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/surface_scenes.h"

using namespace vkvol;

namespace {

struct NamedShine {
    std::string name;
    std::vector<Light> lights;
    std::vector<Surface> surfaces = {};
};

// About a ball of radius 1, and so wide that flights alone meet them.
std::vector<NamedShine> wide_lights() {
    const glm::dvec3 above = glm::normalize(glm::dvec3(0.3, 1.0, 0.5));
    const RectangleSurface pane{{0.0, 2.0, 0.0}, {1.5, 0.0, 0.0}, {0.0, 0.0, 1.5}}; // its front is below
    TriangleSurface round = round_mesh(8, 0.8);
    for (glm::dvec3& vertex : round.vertices)
        vertex += 2.2 * above;
    const auto shining = [](SurfaceShape shape, const Rgb& emission) {
        Surface surface;
        surface.shape = std::move(shape);
        surface.material = matte(0.0);
        surface.emission = emission;
        return surface;
    };
    const auto gradient = [](int, int row) { return Rgb(2.0, 1.5, 1.0) * (8.0 - row) / 4.0; };
    return {{"sun of 60 degrees", {SunLight{above, {3.0, 2.5, 2.0}, 60.0}}},
            {"sun of a dark limb", {SunLight{above, {3.0, 2.5, 2.0}, 90.0, 1.0}}},
            {"map, a gradient", {write_sky(make_map(16, 8, gradient))}},
            {"map, a sunset", {write_sky(sunset_map())}},
            {"map of equal areas", {write_sky(square_map(), SkyMapping::equal_area)}},
            {"ball", {SphereLight{2.2 * above, 0.8, {6.0, 4.0, 3.0}}}},
            {"disk", {DiskLight{1.8 * above, -above, 1.0, {6.0, 5.0, 4.0}}}},
            {"rectangle", {RectangleLight{{0.0, -1.6, 0.2}, {0.0, 0.0, 1.2}, {1.2, 0.0, 0.0}, {4.0, 3.0, 5.0}}}},
            {"pane that shines", {}, {shining(pane, {3.0, 4.0, 5.0})}},
            {"mesh that shines", {}, {shining(std::move(round), {5.0, 4.0, 3.0})}},
            {"several",
             {SunLight{above, Rgb(1.0), 60.0}, SphereLight{-2.2 * above, 0.9, Rgb(2.0)}, write_sky(sunset_map())}}};
}

Scene smoke_under(const NamedShine& shine, const NamedPhase& phase) {
    Volume volume = medium(Sphere{{0.0, 0.0, 0.0}, 1.0}, 4.0, 0.9);
    volume.noise = Noise{1.3, 2, 0.5, 2.0};
    Scene scene = scene_of(phase.of(volume), 2.2, 7, 12.0, glm::dvec3(0.0), {10.0, 25.0, -5.0});
    scene.lights = shine.lights;
    scene.surfaces = shine.surfaces;
    scene.settings.integrator = "ratioTracking";
    scene.settings.spp = 1024;
    return scene;
}

constexpr std::pair<const char*, int> ways[] = {
    {"balance", MIS_BALANCE}, {"power", MIS_POWER}, {"light", MIS_LIGHT}, {"phase", MIS_PHASE}};
constexpr std::pair<const char*, int> shadows[] = {{"ratio", TRANSMITTANCE_RATIO},
                                                   {"delta", TRANSMITTANCE_DELTA},
                                                   {"residual", TRANSMITTANCE_RESIDUAL},
                                                   {"telescoping", TRANSMITTANCE_TELESCOPING}};

// Means of pictures by all four ways, pixels by those that are weighted: a pixel's samples are too few for a normal
// limit where one technique has to find what it rarely draws.
AgreementRow row_of(const std::string& what, const Scene& scene, std::uint32_t seed, std::size_t some_shadows) {
    const Film expected = render_reference(scene, seed);
    std::vector<Estimate> all{{"reference", expected}}, weighted = all;
    for (std::size_t shadow = 0; shadow < some_shadows; ++shadow)
        for (const auto& [way, mis] : ways) {
            Scene chosen = scene;
            chosen.settings.choices.mis = mis;
            chosen.settings.choices.transmittance = shadows[shadow].second;
            CHECK(choose_method(chosen).warnings.empty()); // nothing gave way
            all.push_back({fmt::format("{}, {}", way, shadows[shadow].first), render_here(chosen, ++seed).film});
            if (mis == MIS_BALANCE || mis == MIS_POWER)
                weighted.push_back(all.back());
        }
    return {what, compare_all(all), compare_all(weighted)};
}

} // namespace

TEST_CASE("looks, flights and their mixtures agree under every light", "[.lights_table]") {
    const std::vector<NamedPhase> phases = all_phases();
    std::vector<AgreementRow> rows;
    std::uint32_t seed = 1000;
    for (const NamedShine& shine : wide_lights())
        for (const NamedPhase& phase : phases) {
            const bool first = phase.name == phases.front().name; // in whose light all transmittances are compared
            rows.push_back(row_of(fmt::format("{:<20} {:<24}", shine.name, phase.name), smoke_under(shine, phase),
                                  seed += 100, first ? std::size(shadows) : 1));
        }
    check_rows(
        "mis = balance, power, light and phase, and the reference, which asks all lights and weights nothing: every "
        "pair; pixels of those that are weighted. For the\nfirst phase function with ratio, delta, residual and "
        "telescoping shadow rays.",
        fmt::format("{:<20} {:<24}", "light", "phase function"), rows, 0.01);
}
