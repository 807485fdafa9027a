// What of a scene under <motionBlur> says how it is rendered, and where in its frame the picture is: it moves like all
// else.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

#include "error.h"
#include "motion_blur.h"
#include "requested_scene.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/statistics.h"
#include "support/test_device.h"

using namespace vkvol;

namespace {

Scene filmed(const std::string& body, double frame, const std::string& blur = R"(<motionBlur open="0" close="1"/>)") {
    return parse(blur + body, {{"F", fmt::format("{}", frame)}});
}

} // namespace

TEST_CASE("a picture may move in its frame while the shutter is open", "[cpu][motion][xml]") {
    Scene scene = filmed(R"(<width reference="800" startOffset="${= 40*F}">400</width>
        <height reference="${= 400 + 8*F}">400</height><sphere/>)",
                         1);
    CHECK(scene.picture.start_x == 40.0);
    CHECK(scene_of_time(scene, 0.0).picture.start_x == 40.0);
    CHECK(scene_of_time(scene, 0.5).picture.start_x == Approx(60.0));
    CHECK(scene_of_time(scene, 0.5).picture.reference_height == Approx(412.0));
    resize_picture(scene, 100, 200); // as by --width and --height
    const Picture later = scene_of_time(scene, 0.5).picture;
    CHECK((later.width == 100 && later.height == 200));
    CHECK(later.start_x == Approx(15.0));
    CHECK(later.reference_width == Approx(200.0));
    CHECK(later.reference_height == Approx(206.0));
}

TEST_CASE("how a picture is rendered may move, and what begins at 0 has no gap", "[cpu][motion][xml]") {
    const Scene scene =
        filmed(R"(<pixelFilter radius="${= .5+2*F}">tent</pixelFilter><maxDepth>${= round(3*F)}</maxDepth>
        <march step="${= .1+F}"/><rayPerPixelCount>${= round(7+F)}</rayPerPixelCount><sphere/>
        <surfaces><sphere x="3" material="conductor" roughness="${= .3*F}"/></surfaces>
        <camera z="5" focus="5" lensRadius="${= .5*F}"/>)",
               0);
    const auto is_pinhole = [](const std::string& warning) { return warning.find("pinhole") != warning.npos; };
    CHECK(std::none_of(scene.warnings.begin(), scene.warnings.end(), is_pinhole));
    const Scene later = scene_of_time(scene, 1.0);
    CHECK(later.settings.pixel_filter_radius == 2.5);
    CHECK(later.settings.max_depth == 3u);
    CHECK(later.settings.march.step == Approx(1.1));
    CHECK(later.settings.spp == 7);
    CHECK(scene_of_time(scene, 0.001).surfaces.front().material.roughness == 0.0);
    CHECK(scene_of_time(scene, 0.002).surfaces.front().material.roughness == least_roughness);
    CHECK(scene_of_time(scene, 0.5).surfaces.front().material.roughness == 0.15);
    CHECK_THROWS_AS(parse("<surfaces><sphere material='conductor' roughness='0.0005'/></surfaces>"), InputError);
}

// The same moments, as two frames have them.
TEST_CASE("a filter and a longest path move like all else", "[gpu][motion][long]") {
    const std::string rest = R"(<box width="2" height="2" depth="2"/><sigma_a>.1</sigma_a><sigma_s>1</sigma_s>
        <backgroundColor r=".2" g=".5" b=".1"/><light x="1" y="1" z="1" r="1" g="1" b="1"/><camera z="5" fov="40"/>
        <width>12</width><height>8</height><rayPerPixelCount>64</rayPerPixelCount>)";
    for (const char* moving :
         {R"(<pixelFilter radius="${= .5+2*F}">tent</pixelFilter>)", "<maxDepth>${= round(3*F)}</maxDepth>"}) {
        const Scene first = filmed(rest + moving, 0),
                    second = filmed(rest + moving, 1, R"(<motionBlur open="-1" close="0"/>)");
        CHECK(same_bits(render_here(first, 1).film, render_here(second, 1).film));
    }
}

// Orthographic, a pixel of the frame is a unit: what the picture moves the camera would.
TEST_CASE("a picture that moves in its frame is blurred as by its camera", "[gpu][motion]") {
    const auto film = [](const std::string& start, const std::string& x) {
        return render_here(
                   filmed("<width startOffset=\"" + start + "\" reference=\"16\">16</width><height>12</height>" +
                              "<camera projection=\"orthographic\" viewHeight=\"12\" z=\"50\" x=\"" + x +
                              "\"/><sphere radius=\"4\"/><sigma_a>1</sigma_a><sigma_s>0</sigma_s><medium r=\"1\" "
                              "g=\"1\" b=\"1\"/><rayPerPixelCount>64</rayPerPixelCount>",
                          0.0),
                   1)
            .film;
    };
    const Film window = film("${= 6*F}", "0"), camera = film("0", "${= 6*F}"), still = film("0", "${= 0*F}");
    double most = 0.0, moved = 0.0;
    for (std::size_t i = 0; i < window.pixel_count(); ++i) {
        worsen(most, double(std::abs(window.mean[i].x - camera.mean[i].x)));
        moved = std::max(moved, double(std::abs(window.mean[i].x - still.mean[i].x)));
    }
    CHECK(most < 1e-4); // places of 24 bits
    CHECK(moved > 0.3);
}
