// First flights that are split: what goes through and what collides both count. See shaders/estimators/split.glsl.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

#include "first_flights.h"
#include "loaded_medium.h"
#include "method.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/statistics.h"

using namespace vkvol;

namespace {

Scene with(Scene scene, int first_flight) {
    scene.settings.choices.first_flight = first_flight;
    return scene;
}

// Of all pixels of the picture together: the mean of a sample's variance.
double variance_of(const Film& film) {
    double sum = 0.0;
    for (const glm::vec3& variance : film.variance)
        sum += double(variance.x) + variance.y + variance.z;
    return sum / (3.0 * double(film.pixel_count())) * film.samples.front();
}

// What first collisions have, summed up over the picture, by renders with seeds of their own: unbiased, unlike a
// pixel's quotient, which has no collision at times.
struct FirstCollisions {
    RunningMean coverage, depth, position[3], albedo;

    FirstCollisions(Scene scene, int first_flight, std::uint32_t first_seed) {
        scene.settings.choices.first_flight = first_flight;
        scene.layers = layer_depth | layer_position | layer_albedo;
        for (std::uint32_t seed = first_seed; seed < first_seed + 8; ++seed) {
            const Film film = render_here(scene, seed).film;
            const auto &covered = layer_of(film, "coverage").mean, &far = layer_of(film, "depth").mean,
                       &where = layer_of(film, "position").mean;
            glm::dvec3 sum(0.0), at(0.0);
            for (std::size_t i = 0; i < film.pixel_count(); ++i) {
                sum += glm::dvec3(covered[i].x, covered[i].x * far[i].x, layer_of(film, "albedo").mean[i].x);
                at += glm::dvec3(covered[i].x * where[i]);
            }
            coverage.add(sum.x);
            depth.add(sum.y);
            albedo.add(sum.z);
            for (int axis = 0; axis < 3; ++axis)
                position[axis].add(at[axis]);
        }
    }
};

// Student's t of 14 degrees of freedom: 6.7 has a significance of 1e-5, for each of six comparisons of four scenes.
void check_same(const FirstCollisions& a, const FirstCollisions& b) {
    const auto check = [](const char* what, const RunningMean& x, const RunningMean& y) {
        CAPTURE(what, x.mean(), y.mean(), x.standard_error(), y.standard_error());
        CHECK(std::abs(x.mean() - y.mean()) < 6.7 * std::hypot(x.standard_error(), y.standard_error()));
        CHECK(std::hypot(x.standard_error(), y.standard_error()) > 0.0);
    };
    check("coverage", a.coverage, b.coverage);
    check("depth", a.depth, b.depth);
    check("albedo", a.albedo, b.albedo);
    for (int axis = 0; axis < 3; ++axis)
        check("position", a.position[axis], b.position[axis]);
}

Scene dark_wisp() {
    Scene scene = scene_of(medium(cloud_file(), 0.02, 0.9), 11.0, 24, 25.0);
    scene.lights = {sunlight({3.0, 2.5, 1.5})};
    scene.settings.spp = 128;
    return scene;
}

} // namespace

TEST_CASE("split first flights equal the reference's, that draws them", "[gpu][first_flight]") {
    for (const NamedScene& named : agreement_scenes()) {
        if (named.name.starts_with("homogeneous") || named.name.starts_with("sphere"))
            continue; // whose flights are closed forms
        Scene scene = with(named.scene, FIRST_FLIGHT_SPLIT);
        scene.settings.spp = 256;
        scene.settings.integrator = "ratioTracking";
        CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_reference(scene, 2), named.name));
    }
}

TEST_CASE("split first flights equal drawn ones", "[gpu][first_flight]") {
    const auto check = [](Scene scene, const char* integrator, const std::string& name) {
        scene.settings.spp = 256;
        scene.settings.integrator = integrator;
        CHECK_AGREEMENT(agree(render_here(with(scene, FIRST_FLIGHT_SPLIT), 1).film,
                              render_here(with(scene, FIRST_FLIGHT_DRAWN), 2).film, name));
    };
    const std::vector<NamedScene> scenes = agreement_scenes();
    Scene cloud = scenes[4].scene;
    check(cloud, "cachedRatioTracking", "cached");
    check(cloud, "deltaTrackingNEE", "delta shadow rays");
    cloud.background = Rgb(0.0);
    check(cloud, "cachedRatioTracking", "dark");
    cloud.settings.max_depth = 1;
    check(cloud, "ratioTracking", "to one depth");
    cloud.settings.max_depth.reset();
    cloud.volumes.front().Le = {0.5, 0.2, 0.1};
    check(cloud, "ratioTracking", "glowing");
    cloud.settings.choices.emission = EMISSION_AT_STEPS;
    check(cloud, "ratioTracking", "glowing, at steps");
    cloud.settings.choices.scattering = SCATTERING_NONE;
    check(cloud, "ratioTracking", "glowing, without scattering");
    cloud.settings.choices = {};
    cloud.lights = {PointLight{{1.0, 4.0, 0.5}, Rgb(60.0)}};
    check(cloud, "bidirectional", "bidirectional");
    cloud.settings.choices.distance = DISTANCE_MIXED;
    check(cloud, "ratioTracking", "looks from along flights");
}

TEST_CASE("split first flights beside surfaces, and under a sky", "[gpu][first_flight]") {
    const std::string cloud =
        "<noise/><sphere radius='2'/><sigma_a>0.1</sigma_a><sigma_s>0.6</sigma_s><width>16</width>"
        "<height>16</height><camera z='9' fov='32'/><rayPerPixelCount>512</rayPerPixelCount>";
    const std::string below = "<surfaces><plane y='-1.5' r='0.6' g='0.5' b='0.3'/></surfaces>";
    const std::string sky = "<backgroundColor r='0.2' g='0.3' b='0.6'/><lights><sun zenith='40' multiplier='2' "
                            "angle='3'/><sphere x='-1' y='3' radius='0.4' multiplier='6'/></lights>";
    for (const std::string& xml : {cloud + below + sky, cloud + sky}) {
        const Scene scene = parse(xml);
        CHECK_AGREEMENT(agree(render_here(with(scene, FIRST_FLIGHT_SPLIT), 1).film,
                              render_here(with(scene, FIRST_FLIGHT_DRAWN), 2).film, "surfaces and skies"));
    }
}

TEST_CASE("what goes through is alpha, and layers sum up to the picture", "[gpu][first_flight][aovs]") {
    Scene scene = with(dark_wisp(), FIRST_FLIGHT_SPLIT);
    scene.background = {0.3, 0.5, 0.9};
    scene.layers = layer_background | layer_emission | layer_direct | layer_indirect | layer_transmittance;
    const Film film = render_here(scene, 3).film; // by both schedules
    const Film drawn = render_here(with(scene, FIRST_FLIGHT_DRAWN), 4).film;
    for (const char* name : {"background", "direct", "indirect"})
        CHECK_AGREEMENT(agree(as_film(film, name), as_film(drawn, name), name));
    // Of the picture's mean: in some pixels none of the drawn flights collides.
    const Film through = as_film(film, "transmittance"), passed = as_film(drawn, "transmittance");
    const double samples = double(film.pixel_count()) * scene.settings.spp;
    CHECK(std::abs(mean_of(through) - mean_of(passed)) <
          4.0 * std::sqrt((variance_of(through) + variance_of(passed)) / samples));
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        glm::vec3 sum(0.0f);
        for (const char* name : {"background", "emission", "direct", "indirect"})
            sum += layer_of(film, name).mean[i];
        CHECK(glm::length(sum - film.mean[i]) < 1e-5f);
    }
    // Ratio tracking along the way leaves a hundredth of the variance of light that passes or does not.
    CHECK(variance_of(through) < 0.1 * variance_of(passed));
}

TEST_CASE("where and what first collisions of split flights are", "[gpu][first_flight][aovs][long]") {
    for (const char* name : {"thick cloud", "noise in a mesh"})
        for (const NamedScene& named : agreement_scenes()) {
            if (named.name != name)
                continue;
            INFO(name);
            Scene scene = named.scene;
            scene.settings.integrator = "ratioTracking";
            scene.settings.spp = 64;
            check_same(FirstCollisions(scene, FIRST_FLIGHT_SPLIT, 1), FirstCollisions(scene, FIRST_FLIGHT_DRAWN, 101));
        }
}

TEST_CASE("layers know what split flights meet where it neither glows nor scatters", "[gpu][first_flight][aovs]") {
    Scene scene = dark_wisp();
    scene.background = {0.3, 0.5, 0.9};
    scene.settings.integrator = "ratioTracking";
    scene.settings.spp = 64;
    Scene capped = scene;
    capped.settings.max_depth = 0;
    scene.settings.choices.scattering = SCATTERING_NONE;
    const FirstCollisions drawn(scene, FIRST_FLIGHT_DRAWN, 101);
    check_same(FirstCollisions(scene, FIRST_FLIGHT_SPLIT, 1), drawn);
    check_same(FirstCollisions(capped, FIRST_FLIGHT_SPLIT, 1), drawn);
}

TEST_CASE("split flights have two tentative collisions in a coarse cell, as in a fine one",
          "[gpu][first_flight][several]") {
    // A ball of smoke in a haze: about it cells are fine, and those of the haze are up to 32 times as wide.
    const Scene scene = parse(
        "<volumes><volume><box width='2000' height='2000' depth='2000'/><sigma_a>0</sigma_a><sigma_s>2e-4</sigma_s>"
        "</volume><volume><sphere radius='5'/><sigma_a>0</sigma_a><sigma_s>0.02</sigma_s></volume></volumes>"
        "<light y='1' r='3' g='2' b='1'/><camera z='3000' fov='20'/><width>16</width><height>16</height>"
        "<rayPerPixelCount>16</rayPerPixelCount><integrator>ratioTracking</integrator>");
    const auto counts = [&](int first) { return render_here(with(scene, first), 1).counts; };
    const RenderCounts split = counts(FIRST_FLIGHT_SPLIT), drawn = counts(FIRST_FLIGHT_DRAWN);
    CAPTURE(split.null_collisions, split.cells, drawn.null_collisions, drawn.cells);
    CHECK(split.null_collisions < 3.0 * split.cells);
}

TEST_CASE("first flights in media without end are drawn", "[cpu][first_flight]") {
    Scene scene = dark_wisp();
    scene.volumes.push_back(medium(Everywhere{}, 1e-7, 0.9));
    scene.settings.integrator = "ratioTracking";
    const Method method = choose_method(with(scene, FIRST_FLIGHT_SPLIT));
    CHECK(method.first_flight == FIRST_FLIGHT_DRAWN);
    CHECK(method.warnings.size() == 1);
}

TEST_CASE("beside surfaces those flights are split that go by", "[gpu][first_flight][surfaces]") {
    const std::string xml =
        "<noise/><sphere radius='2'/><sigma_a>0.001</sigma_a><sigma_s>0.01</sigma_s><width>16</width>"
        "<height>16</height><camera z='9' fov='24'/><rayPerPixelCount>64</rayPerPixelCount>"
        "<surfaces><sphere y='9'/></surfaces><light y='1' r='1' g='1' b='1'/>";
    const Scene scene = parse(xml);
    CHECK(variance_of(render_here(with(scene, FIRST_FLIGHT_SPLIT), 1).film) <
          0.3 * variance_of(render_here(with(scene, FIRST_FLIGHT_DRAWN), 1).film));
}

TEST_CASE("thin matter before nothing is seen by most samples", "[gpu][first_flight][variances]") {
    // One of 40 drawn flights collides. Most split ones do, and get a fortieth: of a variance that was 40 times the
    // mean's square that leaves what light differs by from place to place, and how much collides by chance.
    const Scene scene = dark_wisp();
    CHECK(variance_of(render_here(with(scene, FIRST_FLIGHT_SPLIT), 1).film) <
          0.2 * variance_of(render_here(with(scene, FIRST_FLIGHT_DRAWN), 1).film));
}

TEST_CASE("thin matter lit from aside is no noisier than thicker matter", "[gpu][first_flight][variances]") {
    // Lit by a spot on a wall, which one in some fifty scattered paths comes to. Before nothing split flights go on,
    // with throughputs of about 0.01 and 0.2: roulette, which asks what has lost nine tenths of what it began with, is
    // to ask neither. If it took 1 for the beginning it would end nine tenths of the former: ten times the variance.
    const auto spread = [](double sigma) {
        const Scene scene = parse(fmt::format(
            "<noise/><sphere/><sigma_a>0</sigma_a><sigma_s>{}</sigma_s><width>16</width><height>16</height>"
            "<camera z='9' fov='10'/><rayPerPixelCount>256</rayPerPixelCount><integrator "
            "firstFlight='split'>ratioTracking</integrator><surfaces><rectangle x='-4' lookAt='0 0 0' "
            "width='6' height='6'/></surfaces><lights><spot x='-3' z='5' lookAt='-4 0 0' angle='30'/></lights>",
            sigma));
        const Film film = render_here(scene, 1).film;
        const double mean = image_mean(film).value.x;
        return variance_of(film) / (mean * mean);
    };
    CHECK(spread(0.01) < 4.0 * spread(0.5));
}

TEST_CASE("an even glow leaves no noise, wherever flights are split", "[gpu][first_flight][furnace][long]") {
    Scene scene = dark_wisp();
    scene.lights.clear();
    scene.background = Rgb(1.0);
    scene.volumes.front().sigma_s += scene.volumes.front().sigma_a;
    scene.volumes.front().sigma_a = Rgb(0.0);
    scene.settings.integrator = "deltaTracking";
    for (const double scale : {1.0, 100.0}) {
        scene.volumes.front().density_scale = scale;
        const Film film = render_here(with(scene, FIRST_FLIGHT_SPLIT), 5).film;
        for (std::size_t i = 0; i < film.pixel_count(); ++i)
            CHECK(std::abs(film.mean[i].x - 1.0f) < 1e-5f);
        CHECK(variance_of(film) < 1e-10);
    }
}

TEST_CASE("first flights are split where media are thin and nothing bright is behind", "[cpu][first_flight]") {
    const auto splits = [](const Scene& scene) {
        return gains_by_split_flights(scene, load_assets(scene, choose_method(scene)).media);
    };
    Scene scene = dark_wisp();
    CHECK(splits(scene));
    scene.background = Rgb(0.5);
    CHECK(!splits(scene));
    scene.background = Rgb(0.0);
    scene.volumes.front().density_scale = 1000.0;
    CHECK(!splits(scene));
}

// Closed forms of depth: no tentative collisions, and no need of them.
TEST_CASE("flights through what is even, or fades, are split at once", "[gpu][first_flight]") {
    const std::string
        rest = "<width>16</width><height>16</height><rayPerPixelCount>512</rayPerPixelCount>"
               "<integrator>ratioTracking</integrator>",
        outside = "<camera x='1' y='1.5' z='5' lookAt='0 0 0' fov='30'/>",
        within = "<camera x='0.2' y='0.1' z='0.5' yaw='35' fov='80'/>",
        sun = "<light x='1' y='2' z='1' r='3' g='2' b='1'/>",
        lamps = "<lights><sun zenith='40' multiplier='2' angle='3'/><point x='0.3' y='4' multiplier='20'/></lights>";
    const std::string scenes[] = {
        "<sphere/><sigma_a>0.1</sigma_a><sigma_s>0.5</sigma_s>" + outside + sun,
        "<sphere/><sigma_a>0.1</sigma_a><sigma_s>1.5</sigma_s><backgroundColor r='0.1' g='0.2' b='0.4'/>" + within +
            sun,
        "<box width='1.5'/><sigma_a>0</sigma_a><sigma_s>0.2</sigma_s>" + outside + lamps,
        "<box/><layers scaleHeight='0.3'/><sigma_a>0.2</sigma_a><sigma_s>1</sigma_s>" + outside + lamps,
        "<box/><layers scaleHeight='0.4' up='x'/><sigma_a>0</sigma_a><sigma_s>0.3</sigma_s>" + within + sun};
    for (const std::string& xml : scenes) {
        CAPTURE(xml);
        const Scene scene = parse(xml + rest), split = with(scene, FIRST_FLIGHT_SPLIT);
        const RenderResult result = render_here(split, 1);
        CHECK(result.counts.null_collisions == 0);
        CHECK_AGREEMENT(agree(result.film, render_here(with(scene, FIRST_FLIGHT_DRAWN), 2).film, "drawn"));
        CHECK_AGREEMENT(agree(result.film, render_reference(split, 3), "the reference"));
        Scene few = scene;
        few.settings.spp = 64;
        check_same(FirstCollisions(few, FIRST_FLIGHT_SPLIT, 1), FirstCollisions(few, FIRST_FLIGHT_DRAWN, 101));
    }
}

TEST_CASE("an even glow leaves no noise where flights are split at once", "[gpu][first_flight][furnace]") {
    for (const char* xml : {"<sphere/>", "<box/><layers scaleHeight='0.3'/>"})
        for (const double sigma : {1e-6, 0.01, 2.0, 100.0}) {
            const Scene scene =
                parse(fmt::format("{}<sigma_a>0</sigma_a><sigma_s>{}</sigma_s><backgroundColor r='1' g='1' "
                                  "b='1'/><camera z='4' fov='40'/><width>16</width><height>16</height>"
                                  "<rayPerPixelCount>64</rayPerPixelCount><integrator "
                                  "firstFlight='split'>ratioTracking</integrator>",
                                  xml, sigma));
            const Film film = render_here(scene, 5).film;
            for (std::size_t i = 0; i < film.pixel_count(); ++i)
                CHECK(std::abs(film.mean[i].x - 1.0f) < 1e-5f);
        }
}

// One in 67 drawn flights collides.
TEST_CASE("even matter is seen by most samples, however thin", "[gpu][first_flight][variances]") {
    const Scene scene = parse("<sphere/><sigma_a>0</sigma_a><sigma_s>0.01</sigma_s><light y='1' r='3' g='3' b='3'/>"
                              "<camera z='4' fov='25'/><width>16</width><height>16</height>"
                              "<rayPerPixelCount>64</rayPerPixelCount><integrator>ratioTracking</integrator>");
    const Film film = render_here(scene, 1).film; // by itself
    CHECK(variance_of(film) < 0.1 * variance_of(render_here(with(scene, FIRST_FLIGHT_DRAWN), 1).film));
}

TEST_CASE("split flights in even media that glow, differ in colour or are models are drawn", "[cpu][first_flight]") {
    const auto first_flight_in = [](const std::string& medium) {
        const Scene scene = parse(medium + "<light y='1' r='1' g='1' b='1'/><integrator "
                                           "firstFlight='split'>ratioTracking</integrator>");
        return choose_method(scene).first_flight;
    };
    CHECK(first_flight_in("<sphere/><sigma_s>0.1</sigma_s>") == FIRST_FLIGHT_SPLIT);
    CHECK(first_flight_in("<sphere/><sigma_s>0.1</sigma_s><sigma_a>0.1</sigma_a><medium r='1' g='1' b='1'/>") ==
          FIRST_FLIGHT_DRAWN);
    CHECK(first_flight_in("<sphere/><sigma_s>0.1</sigma_s><sigma_a>0</sigma_a><periodic x='-2 2'/>") ==
          FIRST_FLIGHT_DRAWN);
    CHECK(first_flight_in("<sphere/><sigma_s r='0.1' g='0.2' b='0.3'/>") == FIRST_FLIGHT_DRAWN);
}
