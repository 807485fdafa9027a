// Surfaces against closed forms of optics: where light is refracted to, how much of a lamp comes to a floor.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"

using namespace vkvol;
using std::numbers::pi;

TEST_CASE("a pane of glass moves what is behind it by Snell's law", "[gpu][image][surfaces][long]") {
    // A pane of thickness t, turned by a, moves what is seen through it by t sin a (1 - cos a / sqrt(n^2 - sin^2 a)):
    // an edge of light, by 12 columns of a hundredth of a unit. What went to and fro within the pane is a three
    // hundredth.
    const double n = 1.5, t = 0.3, a = 50.0 * pi / 180.0;
    const double moved = t * std::sin(a) * (1.0 - std::cos(a) / std::sqrt(n * n - std::sin(a) * std::sin(a)));
    for (const int side : {-1, 1}) {
        const Film film =
            render_here(parse(fmt::format(
                            "<surfaces><box material='dielectric' ior='{}'><transform><scale x='8' y='8' z='{}'/>"
                            "<rotate y='1' angle='{}'/></transform></box><rectangle x='-3' z='-6' lookAt='-3 0 0' "
                            "width='6' height='6' r='0' g='0' b='0'><emission r='1' g='1' b='1'/></rectangle>"
                            "</surfaces><camera z='7' projection='orthographic' viewHeight='0.4'/><width>40</width>"
                            "<height>40</height><rayPerPixelCount>16</rayPerPixelCount>",
                            n, t, side * 50)),
                        1)
                .film;
        double lit = 0.0, brightest = 0.0; // columns; of one
        for (int x = 0; x < 40; ++x) {
            double column = 0.0;
            for (int y = 0; y < 40; ++y)
                column += film.mean[std::size_t(40 * y + x)].x / 40.0;
            brightest = std::max(brightest, column);
            lit += column > 0.45 ? 1.0 : 0.0;
        }
        CAPTURE(side, moved, lit, brightest);
        CHECK(std::abs(0.01 * lit - (0.2 + side * moved)) < 0.01);
    }
}

TEST_CASE("a square lamp above a floor has its form factor", "[gpu][image][surfaces][lights][long]") {
    // Of half its edge above a point, (4 / pi) (1 / sqrt 2) atan(1 / sqrt 2) = 0.5541 of the light that would come from
    // all above. From the floor's patch of a hundredth the mean is less by less than a ten thousandth.
    const double share = 4.0 / pi * std::atan(1.0 / std::sqrt(2.0)) / std::sqrt(2.0);
    const std::string floor = "<plane r='0.6' g='0.3' b='0.9'/>";
    const std::string view = "<camera y='0.5' x='0.001' lookAt='0 0 0' fov='1'/><width>4</width><height>4</height>"
                             "<rayPerPixelCount>1024</rayPerPixelCount><maxDepth>1</maxDepth>";
    for (const std::string& lamp :
         {"<lights><rectangle y='1' lookAt='0 0 0' width='2' height='2' r='1' g='1' b='1'/></lights><surfaces>" +
              floor + "</surfaces>",
          "<surfaces>" + floor +
              "<rectangle y='1' lookAt='0 0 0' width='2' height='2' r='0' g='0' b='0'><emission r='1' g='1' b='1'/>"
              "</rectangle></surfaces>"})
        for (const char* integrator : {"ratioTracking", "bidirectional"}) {
            const Film film = render_here(by(parse(lamp + view), integrator), 1).film;
            CHECK_AGREEMENT(
                agree_with_means(film, std::vector<Rgb>(film.mean.size(), share * Rgb(0.6, 0.3, 0.9)), lamp));
        }
}
