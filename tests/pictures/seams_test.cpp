// Surfaces in the seams of domains that repeat: met from either side, by whatever comes across.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

#include "seams.h"
#include "shared/constants.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/thorough.h"

using namespace vkvol;

namespace {

// A street of period 2, read on its ground, in the light of a sun at 30 degrees: of black walls, 1 high, in the seam.
Scene street(const std::string& walls, double toward_sun, const std::string& integrator) {
    return parse(fmt::format(R"(<periodic x="-1 1" z="-1 1"/><surfaces><plane/>{}</surfaces>
        <light x="{}" y=".5" r="1" g="1" b="1"/><irradiance lookAt="0 1 0" width="2" height="2"/>
        <width>1</width><height>1</height><rayPerPixelCount>16384</rayPerPixelCount>
        <integrator>{}</integrator>)",
                             walls, toward_sun * std::sqrt(0.75), integrator));
}

} // namespace

TEST_CASE("walls in a seam throw shadows to both sides", "[gpu][periodic]") {
    const std::string black = R"( r="0" g="0" b="0"/>)";
    const std::string walls[] = {R"(<rectangle x="1" y=".5" lookAt="0 .5 0" width="2" height="1")",
                                 R"(<rectangle x="-1" y=".5" lookAt="0 .5 0" width="2" height="1")",
                                 R"(<box x="1" y=".5" width="1e-4" depth="2")"};
    // Of the ground 2 less their shadow, sqrt(3), is lit.
    const double expected = 0.5 * (2.0 - std::sqrt(3.0)) / 2.0;
    std::size_t turn = 0;
    for (const std::string& wall : walls) {
        ++turn; // each way to render meets both sides
        for (const double toward_sun : {-1.0, 1.0})
            for (const char* integrator : in_turn(std::vector{"ratioTracking", "lightTracing"}, turn++, 2)) {
                const Film film = render_here(street(wall + black, toward_sun, integrator), 1).film;
                CHECK_AGREEMENT(agree_with_means(film, {Rgb(expected)}, "seam"));
                CAPTURE(wall, toward_sun, integrator);
                CHECK(film.mean.front().x == Approx(expected).epsilon(0.1));
            }
    }
}

TEST_CASE("a sensor on a wall in a seam is before it", "[gpu][periodic]") {
    const Scene scene = parse(R"(<periodic x="-1 1" z="-1 1"/><surfaces>
        <rectangle x="1" y=".5" lookAt="0 .5 0" width="2" height="1" r="0" g="0" b="0"/></surfaces>
        <light x="-1" y="1" r="1" g="1" b="1"/><irradiance x="1" y=".9" lookAt="0 .9 0" width="1" height=".1"/>
        <width>1</width><height>1</height><rayPerPixelCount>4</rayPerPixelCount>)");
    const Film film = render_here(by(scene, "ratioTracking"), 1).film; // at 45 degrees, over the next wall
    CHECK(film.mean.front().x == Approx(std::sqrt(0.5)).epsilon(1e-5));
}

// Half as much again as rays are kept off it, and with all that it has in common with others.
TEST_CASE("what lies in a seam is moved off it, and nothing else", "[cpu][periodic]") {
    const Periodic periodic{{-1.0, 0.0, -1.0}, {1.0, 0.0, 1.0}};
    std::vector<Surface> before(6);
    before[0].shape = RectangleSurface{{1.0, 0.5, 0.0}, {0.0, 0.5, 0.0}, {0.0, 0.0, 1.0}};
    before[1].shape = RectangleSurface{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}}; // a ground
    before[2].shape = DiskSurface{{0.0, 0.0, -1.0}, {0.0, 0.0, 1.0}, 0.5};
    before[3].shape = DiskSurface{{0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}, 0.5};
    TriangleSurface corner; // a face in the seam, and one from its edge into the domain
    corner.vertices = {{-1.0, 0.0, 0.0}, {-1.0, 1.0, 0.0}, {-1.0, 0.0, 0.5}, {0.0, 0.0, 0.0}};
    corner.triangles = {{0, 1, 2}, {0, 1, 3}};
    before[4].shape = corner;
    before[5].shape = RectangleSurface{{0.9999, 0.5, 0.0}, {0.0, 0.5, 0.0}, {0.0, 0.0, 1.0}};
    const auto rectangle = [](const Surface& surface) { return std::get<RectangleSurface>(surface.shape); };
    const auto disk = [](const Surface& surface) { return std::get<DiskSurface>(surface.shape).center; };
    const std::vector<Surface> after = kept_off_seams(periodic, {0.0, 0.0, 0.0}, before);
    const double moved = 1.5 * SURFACE_SPARE * std::sqrt(3.0); // to the wall's corners
    CHECK(glm::distance(rectangle(after[0]).center, {1.0 - moved, 0.5, 0.0}) < 1e-12);
    CHECK(rectangle(after[0]).edge_u == rectangle(before[0]).edge_u);
    CHECK(rectangle(after[1]).center == rectangle(before[1]).center);
    CHECK(disk(after[2]).z > -1.0);
    CHECK(disk(after[2]).x == 0.0);
    CHECK(disk(after[3]) == disk(before[3]));
    CHECK(rectangle(after[5]).center == rectangle(before[5]).center);
    const TriangleSurface& mesh = std::get<TriangleSurface>(after[4].shape);
    for (int i = 0; i < 3; ++i) {
        CHECK(mesh.vertices[i].x > -1.0);
        CHECK(mesh.vertices[i].x == mesh.vertices[0].x);
        CHECK(mesh.vertices[i].y == corner.vertices[i].y);
    }
    CHECK(mesh.vertices[3] == corner.vertices[3]);
    // Far from the origin they are known less well.
    const std::vector<Surface> far = kept_off_seams(periodic, {1000.0, 0.0, 0.0}, before);
    CHECK(1.0 - rectangle(far[0]).center.x > 100.0 * moved);
}
