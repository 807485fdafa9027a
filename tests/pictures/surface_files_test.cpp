// Surfaces as scene files have them: read, refused, warned of, and in the hash.
#include <algorithm>
#include <catch2/catch.hpp>

#include "method.h"
#include "preset.h"
#include "scene_hash.h"
#include "shared/constants.h"
#include "support/scene_text.h"
#include "support/surface_scenes.h"

using namespace vkvol;
using Catch::Contains;

TEST_CASE("single scattering says what it misses at surfaces", "[cpu][surfaces]") {
    Scene scene = still_life();
    scene.settings.integrator = "ratioTracking";
    scene.settings.choices.scattering = SCATTERING_SINGLE;
    CHECK_THAT(choose_method(with_preset(scene)).biased, Contains("ends at the first surface"));
    std::erase_if(scene.surfaces,
                  [](const Surface& surface) { return surface.material.kind != MaterialKind::diffuse; });
    REQUIRE_FALSE(scene.surfaces.empty());
    CHECK(choose_method(with_preset(scene)).biased.empty());
}

TEST_CASE("surfaces are read, moved and refused by name", "[xml][surfaces]") {
    const Scene scene = parse(R"(<surfaces>
  <sphere x="1" radius="2" material="dielectric" ior="1.33"/>
  <plane y="-1" r="0.1" g="0.2" b="0.3"/>
  <rectangle lookAt="0 1 0" width="2" height="4"><emission r="1" g="1" b="1" multiplier="3" sides="2"/></rectangle>
  <box width="2"><transform><scale value="2"/><translate y="5"/></transform></box>
  <disk lookAt="0 0 1" material="conductor" metal="gold"/>
  <sphere material="coated" r=".1" g=".2" b="1"/>
  <sphere material="conductor" roughness=".3"/>
  <plane material="thinDielectric" ior="1.4"/>
</surfaces>)");
    REQUIRE(scene.surfaces.size() == 8);
    CHECK(scene.surfaces[0].material.ior == 1.33);
    CHECK(scene.surfaces[1].material.color == Rgb(0.1, 0.2, 0.3));
    CHECK(scene.surfaces[2].emission == Rgb(3.0));
    CHECK(scene.surfaces[2].shines_both_ways);
    const auto& box = std::get<TriangleSurface>(scene.surfaces[3].shape);
    CHECK(box.vertices.front() == glm::dvec3(-2.0, 4.0, -1.0));
    CHECK(box.vertices.back() == glm::dvec3(2.0, 6.0, 1.0));
    CHECK(scene.surfaces[4].material.k.x == 3.983);
    CHECK(scene.surfaces[5].material.kind == MaterialKind::coated);
    CHECK(scene.surfaces[6].material.roughness == 0.3);
    CHECK(scene.surfaces[7].material.kind == MaterialKind::thin_dielectric);
    CHECK(scene.surfaces[7].material.ior == 1.4);

    const std::string glass = "<surfaces><box material=\"dielectric\"/></surfaces>";
    const auto shadowed = [](const std::string& text, const char* integrator) {
        Scene scene = parse(text);
        scene.settings.integrator = integrator;
        const std::vector<std::string> warnings = choose_method(with_preset(scene)).warnings;
        return std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
            return warning.find("no path from") != std::string::npos;
        });
    };
    CHECK(shadowed(glass + "<lights><point/><sphere/></lights>", "ratioTracking"));
    CHECK_FALSE(shadowed(glass + "<lights><point/><sphere/></lights>", "bidirectional"));
    CHECK_FALSE(shadowed(glass + "<lights><sun y=\"1\"/><sphere/></lights>", "ratioTracking"));
    const std::string frosted_glass = "<surfaces><box material=\"dielectric\" roughness=\".1\"/></surfaces>";
    CHECK_FALSE(shadowed(frosted_glass + "<lights><point/></lights>", "ratioTracking"));

    const auto refused = [](const std::string& surface) { return error_of("<surfaces>" + surface + "</surfaces>"); };
    CHECK_THAT(refused("<sphere material=\"gold\"/>"), Contains("2:19") && Contains("'gold' is unknown"));
    CHECK_THAT(refused("<sphere ior=\"2\"/>"),
               Contains("has a meaning with material=\"dielectric\", \"coated\" or \"thinDielectric\" only"));
    CHECK_THAT(refused("<sphere roughness=\".2\"/>"), Contains("\"conductor\" or \"dielectric\" only"));
    CHECK_THAT(refused("<sphere material=\"conductor\" roughness=\"1e-4\"/>"), Contains("0.001 at least"));
    CHECK_THAT(refused("<sphere material=\"dielectric\" ior=\"1\" roughness=\".1\"/>"), Contains("shows nothing"));
    CHECK_THAT(refused("<sphere material=\"coated\" ior=\".9\"/>"), Contains("denser than what is around"));
    CHECK_THAT(refused("<sphere r=\"2\"/>"), Contains("more than it gets"));
    CHECK_THAT(refused("<sphere><transform><scale x=\"2\"/></transform></sphere>"), Contains("use a mesh"));
    CHECK_THAT(refused("<mesh/>"), Contains("names no file"));
    CHECK_THAT(refused("<disk material=\"conductor\" metal=\"tin\"/>"), Contains("lookAt"));
    CHECK_THAT(refused("<plane material=\"conductor\" metal=\"tin\"/>"), Contains("'tin' is unknown"));
    CHECK_THAT(refused("<cone/>"), Contains("cone"));
}

TEST_CASE("what a surface is and is made of is in the scene hash", "[method][surfaces]") {
    const Scene scene = still_life();
    const std::string hash = scene_hash(scene);
    const auto differs = [&](const auto& change) {
        Scene other = scene;
        change(other.surfaces);
        return scene_hash(other) != hash;
    };
    CHECK(scene_hash(still_life()) == hash);
    CHECK(differs([](auto& s) { std::get<PlaneSurface>(s[0].shape).point.y = -1.0; }));
    CHECK(differs([](auto& s) { std::get<BallSurface>(s[1].shape).radius = 0.61; }));
    CHECK(differs([](auto& s) { s[1].material.ior = 1.4; }));
    CHECK(differs([](auto& s) { s[2].material.k.x = 4.0; }));
    CHECK(differs([](auto& s) { s[2].material.roughness = 0.1; }));
    CHECK(differs([](auto& s) { std::get<TriangleSurface>(s[3].shape).vertices[0].x += 0.1; }));
    CHECK(differs([](auto& s) { s[4].emission.x = 1.6; }));
    CHECK(differs([](auto& s) { s[4].shines_both_ways = true; }));
    CHECK(differs([](auto& s) { s[0].material.kind = MaterialKind::mirror; }));
    CHECK(differs([](auto& s) { s.pop_back(); }));
}
