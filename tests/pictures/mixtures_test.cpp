// Media of which one is several: their phase functions mix by what each scatters, and boundaries between them are
// nothing.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/thorough.h"

using namespace vkvol;

TEST_CASE("media of two phase functions on top of each other are one of their mixture",
          "[gpu][image][several][phase][long]") {
    const LightsAbout lights;
    Volume whole = medium(Sphere{{0.2, -0.1, 0.0}, 1.4}, 1.6, 0.9, 0.8);
    whole.phase = PhaseFunction::double_henyey_greenstein;
    whole.phase_details.g2 = -0.4;
    whole.phase_details.share = 0.3;
    Scene mixed = scene_of(whole, 5.0, 16, 12.0);
    mixed.lights = {lights.point, lights.ball, lights.rectangle, lights.beam};
    mixed.background = {0.1, 0.2, 0.4};
    mixed.settings.spp = 256;
    Scene apart = mixed;
    for (const auto& [g, share] : {std::pair(0.8, 0.7), std::pair(-0.4, 0.3)}) {
        Volume part = whole;
        part.phase = PhaseFunction::henyey_greenstein;
        part.g = g;
        part.density_scale = share;
        apart.volumes.push_back(part);
    }
    apart.volumes.erase(apart.volumes.begin());
    const Film expected = render_here(mixed, 1).film;
    for (const char* integrator : {"ratioTracking", "weightedTracking", "unbiasedRayMarching", "deltaTracking"})
        CHECK_AGREEMENT(
            agree(render_here(by(apart, integrator), 2).film,
                  std::string(integrator) == "deltaTracking" ? render_here(by(mixed, integrator), 3).film : expected,
                  integrator));
}

TEST_CASE("halves of a medium on top of each other are the whole, under every light",
          "[gpu][image][several][lights][long]") {
    const LightsAbout lights;
    const std::vector<std::pair<std::string, Light>> all = {
        {"point", lights.point}, {"spot", lights.spot},           {"ball", lights.ball},
        {"disk", lights.disk},   {"rectangle", lights.rectangle}, {"sun", lights.sun},
        {"beam", lights.beam},   {"map", write_sky(sunset_map())}};
    for (const auto& [name, light] : in_turn(all, 0)) {
        Scene whole = scene_of(smoke(), 5.0, 16, 12.0);
        whole.lights = {light};
        whole.background = {0.1, 0.2, 0.4};
        whole.settings.spp = 256;
        Scene halves = whole;
        halves.volumes.push_back(halves.volumes.front());
        for (Volume& half : halves.volumes)
            half.density_scale *= 0.5;
        CHECK_AGREEMENT(agree(render_here(whole, 1).film, render_here(halves, 2).film, "halves, " + name));
    }
}

TEST_CASE("boundaries between media are nothing that a path meets", "[gpu][image][several][long]") {
    // Twenty boxes in one another, then as many side by side, of one medium alone.
    const std::string view =
        "<camera z='9' projection='orthographic' viewHeight='1'/><width>4</width><height>4</height>";
    std::string nested, stacked;
    for (int i = 1; i <= 20; ++i) {
        nested += fmt::format(
            "<volume><box width='{0}' height='{0}' depth='{1}'/><sigma_a>{2}</sigma_a><sigma_s>0</sigma_s></volume>",
            2 + i, 0.1 * i, 0.05 / (0.1 * i));
        stacked += fmt::format("<volume><box width='4' height='4' depth='0.1' z='{}'/><sigma_a>0.1</sigma_a>"
                               "<sigma_s>0.9</sigma_s></volume>",
                               -0.95 + 0.1 * (i - 1));
    }
    // What the eye sees through them is exp(-1) of what is behind, whatever the limit of depth.
    const Film through =
        render_here(parse("<volumes>" + nested +
                          "</volumes><maxDepth>0</maxDepth>"
                          "<backgroundColor r='2' g='3' b='4'/><rayPerPixelCount>4096</rayPerPixelCount>" +
                          view),
                    1)
            .film;
    CHECK_AGREEMENT(
        agree_with_means(through, std::vector<Rgb>(through.mean.size(), std::exp(-1.0) * Rgb(2, 3, 4)), "nested"));
    const std::string lit = "<maxDepth>1</maxDepth><light x='1' y='1' z='1' r='1' g='2' b='3'/><backgroundColor r='.2' "
                            "g='.2' b='.2'/><rayPerPixelCount>2048</rayPerPixelCount>" +
                            view;
    const Film alone =
        render_here(parse("<box width='4' height='4' depth='2'/><sigma_a>0.1</sigma_a><sigma_s>0.9</sigma_s>" + lit), 2)
            .film;
    CHECK_AGREEMENT(agree(render_here(parse("<volumes>" + stacked + "</volumes>" + lit), 3).film, alone, "stacked"));
}
