// How much samples differ, where a poor choice would let a few carry the light: means would be right, and take for
// ever.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"

using namespace vkvol;

namespace {

// Variance of a sample over the square of the pixel's mean: of all pixels that show anything, the value that `part` of
// them are below. A pixel of one sample that found light, of n, has n.
double spread(const std::string& xml, double part) {
    Scene scene = parse(xml + "<width>24</width><height>24</height>");
    scene.settings.spp = 512;
    const Film film = render_here(scene, 3).film;
    std::vector<double> values;
    for (std::size_t i = 0; i < film.pixel_count(); ++i)
        if (film.mean[i].x > 0.0f)
            values.push_back(double(film.variance[i].x) * scene.settings.spp /
                             (double(film.mean[i].x) * film.mean[i].x));
    REQUIRE(values.size() > 50);
    std::sort(values.begin(), values.end());
    return values[std::size_t(part * double(values.size() - 1))];
}

} // namespace

TEST_CASE("lamps along a ray are chosen by what it gathers of each", "[gpu][variances][lights]") {
    std::string lamps;
    for (int i = 0; i < 60; ++i)
        lamps += fmt::format("<point x='1' z='{}'/>", 100.0 / 60.0 * (i + 0.5));
    // Along their row, each at its height of the ray: 0.58; chosen for where rays begin: 1.6.
    CHECK(spread(fmt::format("<box z='50' width='6' height='6' depth='100'/><sigma_a>0</sigma_a>"
                             "<sigma_s>0.005</sigma_s><maxDepth>1</maxDepth><lights>{}</lights>"
                             "<camera z='0' yaw='180' fov='40'/>",
                             lamps),
                 0.5) < 1.0);
}

TEST_CASE("a lamp beside a searchlight that passes by is found", "[gpu][variances][lights]") {
    // Each of two is looked at by a hundredth of the looks or more. By intensity alone it is one of 160,000.
    CHECK(spread("<box width='10' height='10' "
                 "depth='10'/><sigma_a>0.01</sigma_a><sigma_s>0.1</sigma_s><maxDepth>1</maxDepth>"
                 "<lights><spot y='4' lookAt='0 5 0' angle='2' power='100'/><point y='-2' power='10'/></lights>"
                 "<camera z='25' fov='20'/>",
                 0.5) < 150.0);
}

TEST_CASE("lamps that a surface or a sensor has behind it take no looks from those before it",
          "[gpu][variances][lights]") {
    std::string lamps = "<lights><point y='3'/>";
    for (int i = 0; i < 100; ++i)
        lamps += fmt::format("<point x='{}' y='-0.5' z='{}'/>", i % 10 - 4.5, i / 10 - 4.5);
    lamps += "</lights><sphere radius='0.1' y='20'/><maxDepth>1</maxDepth>";
    // A fiftieth of the looks go down, evenly. By powers and distances those below take 99 of 100: 500 and more.
    CHECK(spread(lamps + "<surfaces><box y='-0.1' width='10' height='0.2' depth='10'/></surfaces>"
                         "<camera y='4' z='9' lookAt='0 0 0' fov='30'/>",
                 0.5) < 0.1);
    CHECK(spread(lamps + "<irradiance lookAt='0 1 0' width='4' height='4'/>", 0.5) < 0.1);
}

TEST_CASE("distances are drawn about a lamp however long free paths are", "[gpu][variances][lights]") {
    // With distances drawn evenly within a thousandth of a free path from it: 1 to 30, the nearer the more.
    CHECK(spread("<everywhere/><sigma_a>1e-4</sigma_a><sigma_s>9e-4</sigma_s><maxDepth>1</maxDepth><lights><point "
                 "z='-10'/></lights>"
                 "<camera fov='20'/>",
                 0.97) < 0.3);
}

TEST_CASE("a peak of the phase function is not looked along for a lamp that lies elsewhere",
          "[gpu][variances][lights]") {
    // By the peak's height alone four of five looks go there: 4.
    CHECK(
        spread(
            "<box width='12' height='12' depth='12'/><sigma_a>0</sigma_a><sigma_s>0.1</sigma_s><phase>droplets</phase>"
            "<maxDepth>1</maxDepth><lights><sphere y='4' radius='0.5' multiplier='20'/></lights><camera z='25' "
            "fov='20'/>",
            0.5) < 2.0);
}

TEST_CASE("the cache of light knows the colours that several media take away", "[gpu][variances][several]") {
    // A thirtieth of red is taken away of what is of blue. Held to be as dark as blue, most of its light is left to the
    // twentieth of the collisions that look whatever the cache says: 15 there, where flights alone make 3.
    const std::string half =
        "<volume><sphere radius='2'/><noise/><sigma_a>0</sigma_a><sigma_s r='0.1' g='1' b='3'/></volume>";
    CHECK(spread("<volumes>" + half + half +
                     "</volumes><light x='1' y='1' z='0.3' r='1' g='1' b='1' multiplier='3'/>"
                     "<maxDepth>1</maxDepth><camera z='9' fov='20'/><integrator>cachedRatioTracking</integrator>",
                 0.97) < 6.0);
}

TEST_CASE("a thin even glow is seen by every sample", "[gpu][variances][emission][long]") {
    // One of 50 flights collides there: 50. What is left is what chords and second collisions differ by.
    CHECK(spread("<sphere/><sigma_a>0.01</sigma_a><sigma_s>0.01</sigma_s><medium r='1' g='1' b='1'/><camera z='4' "
                 "fov='10'/>",
                 0.97) < 0.5);
}

TEST_CASE("each of several media glows wherever any is met", "[gpu][variances][several][long]") {
    // A hundredth of what paths meet glows. Left to which one they meet: 100. All of it is met, and brings its part.
    const auto media = [](const char* thick) {
        return fmt::format("<volumes><volume><box width='4' height='4' depth='4'/><sigma_a {}/><sigma_s>0</sigma_s>"
                           "</volume><volume><box width='4' height='4' depth='4'/><sigma_a>0.03</sigma_a><sigma_s>0"
                           "</sigma_s><medium r='1' g='1' b='1'/></volume></volumes><camera z='9' fov='10'/>",
                           thick);
    };
    CHECK(spread(media("r='3' g='3' b='3'"), 1.0) < 0.01);
    // Collisions of a channel that differ from those of the others in how often they happen have weights, of their own.
    CHECK(spread(media("r='3' g='2' b='4'"), 1.0) < 1.0);
}

TEST_CASE("lamps behind frosted glass are looked for by how far it scatters", "[gpu][variances][surfaces]") {
    // It scatters 22 times less far than metal of this roughness: 7.
    CHECK(spread("<surfaces><rectangle lookAt='0 0 1' width='4' height='4' material='dielectric' ior='1.1' "
                 "roughness='0.02'/></surfaces>"
                 "<lights><sphere z='-3' radius='0.042' multiplier='100'/></lights><camera z='3' fov='0.4'/>",
                 0.5) < 1.0);
}

TEST_CASE("of a coat that path is taken which has light left", "[gpu][variances][surfaces]") {
    const std::string scene =
        "<surfaces><sphere material='coated' {}/></surfaces><backgroundColor {}/><camera z='4' fov='5'/>";
    // All paths are mirrored, F = 0.04 of each, of which roulette keeps 0.4 and makes them 0.1: 1.5. By F alone it is
    // (1 - F) / F, 24.
    CHECK(spread(fmt::format(fmt::runtime(scene), "r='0' g='0' b='0'", "r='1' g='1' b='1'"), 0.5) < 1.6);
    // And half of them below a white one: each has its share of all that is left.
    CHECK(spread(fmt::format(fmt::runtime(scene), "r='1' g='1' b='1'", "r='1' g='1' b='1'"), 1.0) < 0.1);
}

TEST_CASE("light that glass holds for long has a bounded variance", "[gpu][variances][surfaces]") {
    // Of diffuse light within, 0.04 leaves each time. After 32 vertices a sample's weight grows no faster than by the
    // square of their number: the mean of its square is the sum of 0.04 0.96^k (1 + k / 32)^2 over k or less, 3.65. By
    // a fixed chance of 0.9 it is that of 0.04 (0.96 / 0.9)^k, which has no bound.
    CHECK(spread("<surfaces><sphere material='dielectric' "
                 "ior='4'/></surfaces><sphere/><sigma_s>20</sigma_s><sigma_a>0</sigma_a>"
                 "<backgroundColor r='1' g='1' b='1'/><camera z='6' fov='5'/>",
                 0.9) < 2.65);
}

TEST_CASE("particles of a narrow spot have the weight of the light that it sends that way",
          "[gpu][variances][particles]") {
    // Paths find what a spot of 5 degrees lights one time in a thousand. If it counts as a point, whose particles go
    // anywhere, they keep two thirds of the light: a spread of 2000, of which one of 512 samples shows 500.
    CHECK(spread("<surfaces><rectangle lookAt='0 1 0' width='6' height='6'/><rectangle y='2' lookAt='0 0 0' width='6' "
                 "height='6'/></surfaces>"
                 "<lights><spot y='1' lookAt='0 2 0' angle='5' blend='0'/></lights><camera y='1' z='2' lookAt='0 0 1' "
                 "fov='40'/>"
                 "<integrator>bidirectional</integrator>",
                 0.9) < 100.0);
}

TEST_CASE("films in several buffers have as many particles for each row", "[gpu][variances][particles]") {
    // Each buffer has as many particles as pixels, from all of the light: one of a single row, beside one of eight,
    // would have an eighth as many, and eight times the variance.
    Scene scene = parse("<periodic x='-4 4' z='-4 4'/><box y='0.5' width='8' height='1' "
                        "depth='8'/><sigma_s>0</sigma_s><sigma_a>0.5</sigma_a>"
                        "<light zenith='0' r='1' g='1' b='1'/><irradiance y='0' lookAt='0 1 0' width='8' height='8'/>"
                        "<width>64</width><height>9</height><integrator>lightTracing</integrator>");
    scene.settings.spp = 64;
    RenderJob job;
    job.plan.band_rows = 8;
    const Film film = render_here(scene, 4, job).film;
    const auto variance_of = [&](int row) {
        double sum = 0.0;
        for (int x = 0; x < 64; ++x)
            sum += film.variance[std::size_t(row) * 64 + std::size_t(x)].x;
        return sum;
    };
    CHECK(variance_of(8) < 2.0 * variance_of(0));
    CHECK(variance_of(0) < 2.0 * variance_of(8));
}

TEST_CASE("a control density above rough noise does not make weights that grow with the way",
          "[gpu][variances][noise]") {
    // Of 10 to 80 mean free paths with densities far below half of their bound: 50 times the variance of ratio
    // tracking.
    const auto by = [](const char* integrator) {
        return spread(
            fmt::format("<box width='4' height='4' depth='4'/><noise frequency='.25' octaves='8' gain='1'/>"
                        "<sigma_a>0</sigma_a><sigma_s>20</sigma_s><maxDepth>1</maxDepth>"
                        "<light y='1' z='0.2' r='1' g='1' b='1'/><camera y='6' z='7' lookAt='0 0 0' fov='20'/>"
                        "<integrator>{}</integrator>",
                        integrator),
            0.9);
    };
    CHECK(by("residualRatioTracking") < 1.1 * by("ratioTracking"));
}
