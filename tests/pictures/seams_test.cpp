// Surfaces in the seams of domains that repeat: met from either side, by whatever comes across.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

#include "seams.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"

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
    for (const std::string& wall : walls)
        for (const double toward_sun : {-1.0, 1.0})
            for (const char* integrator : {"ratioTracking", "lightTracing"}) {
                const Film film = render_here(street(wall + black, toward_sun, integrator), 1).film;
                CHECK_AGREEMENT(agree_with_means(film, {Rgb(expected)}, "seam"));
                CAPTURE(wall, toward_sun, integrator);
                CHECK(film.mean.front().x == Approx(expected).epsilon(0.1));
            }
}

// 4e-6 of what there is, and with all that they have in common with others.
TEST_CASE("what lies in a seam is moved off it, and nothing else", "[cpu][periodic]") {
    const Periodic periodic{{-1.0, 0.0, -1.0}, {1.0, 0.0, 1.0}};
    std::vector<Surface> surfaces(5);
    surfaces[0].shape = RectangleSurface{{1.0, 0.5, 0.0}, {0.0, 0.5, 0.0}, {0.0, 0.0, 1.0}};
    surfaces[1].shape = RectangleSurface{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}}; // a ground
    surfaces[2].shape = DiskSurface{{0.0, 0.0, -1.0}, {0.0, 0.0, 1.0}, 0.5};
    surfaces[3].shape = DiskSurface{{0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}, 0.5};
    TriangleSurface corner; // a face in the seam, and one from its edge into the domain
    corner.vertices = {{-1.0, 0.0, 0.0}, {-1.0, 1.0, 0.0}, {-1.0, 0.0, 0.5}, {0.0, 0.0, 0.0}};
    corner.triangles = {{0, 1, 2}, {0, 1, 3}};
    surfaces[4].shape = corner;
    const std::vector<Surface> before = surfaces;
    keep_off_seams(periodic, surfaces);
    const double moved = 1.0 - std::get<RectangleSurface>(surfaces[0].shape).center.x;
    CHECK(moved > 1e-6);
    CHECK(moved < 1e-4);
    CHECK(std::get<RectangleSurface>(surfaces[1].shape).center == glm::dvec3(0.0));
    CHECK(std::get<DiskSurface>(surfaces[2].shape).center.z == Approx(-1.0 + moved).epsilon(1e-9));
    CHECK(std::get<DiskSurface>(surfaces[3].shape).center.z == -1.0);
    const TriangleSurface& mesh = std::get<TriangleSurface>(surfaces[4].shape);
    for (int i = 0; i < 3; ++i)
        CHECK(mesh.vertices[i].x == Approx(-1.0 + moved).epsilon(1e-9));
    CHECK(mesh.vertices[3].x == 0.0);
}
