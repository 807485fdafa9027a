// Several media that are even balls and boxes, or everywhere: what shadow rays through them find is a closed form.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <functional>

#include "method.h"
#include "preset.h"
#include "scene_facts.h"
#include "session.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/surface_scenes.h"

using namespace vkvol;

namespace {

std::string volume(const std::string& shape, double sigma_a, double sigma_s, const std::string& more = "") {
    return fmt::format("<volume>{}<sigma_a>{}</sigma_a><sigma_s>{}</sigma_s>{}</volume>", shape, sigma_a, sigma_s,
                       more);
}

// A picture of 6 x 6 pixels, `width` across, along z from z = 9, of media before a panel of radiance 1 in the plane z =
// -5.
Scene before_a_panel(const std::string& volumes, double width = 1.0) {
    Scene scene = parse("<volumes>" + volumes +
                        "</volumes><lights><rectangle z='-5' lookAt='0 0 9' width='20' height='20' r='1' g='1' b='1'/>"
                        "</lights><camera z='9' projection='orthographic'/><rayPerPixelCount>4</rayPerPixelCount>"
                        "<width>6</width><height>6</height>");
    scene.camera.view_height = width;
    return scene;
}

// Of these no two samples differ: lamps are seen by shadow rays, and nothing scatters.
void check_panel(const Scene& scene, double depth) {
    const Film film = render_here(scene, 1).film;
    CAPTURE(depth);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        CHECK(film.mean[i].y == Approx(std::exp(-depth)).epsilon(2e-6));
        CHECK(film.variance[i].y < 1e-13);
    }
}

// Balls and boxes, moved, sheared by scaling what was turned, and mirrored, in and beside one another, that scatter.
const std::string jumble = volume("<sphere radius='1.2'/>", 0.1, 0.7, "<heyneygreenstein_g>0.4</heyneygreenstein_g>") +
                           volume("<box width='2' height='1' depth='1.5'/>", 0.2, 0.5,
                                  "<transform><rotate x='1' y='2' z='-1' angle='35'/><scale x='1.3' y='-0.7' "
                                  "z='1'/><translate x='0.4' y='0.3'/></transform>") +
                           volume("<sphere radius='0.8'/>", 0.0, 1.1,
                                  "<transform><scale x='0.5' y='1.5' z='1'/><rotate z='1' angle='50'/><translate "
                                  "x='-0.9' y='-0.5' z='0.4'/></transform>") +
                           volume("<box width='0.4' height='3' depth='0.4'/>", 0.6, 0.3,
                                  "<transform><translate x='1.1' z='-0.5'/></transform>");

// What stands beside the volumes; `spp` samples of 12 x 12 pixels.
Scene jumble_with(const std::string& more, int spp = 512) {
    return parse(fmt::format("<volumes>{}</volumes>{}<camera x='1' y='1.5' z='6' lookAt='0 0 0' fov='35'/>"
                             "<rayPerPixelCount>{}</rayPerPixelCount><width>12</width><height>12</height>"
                             "<integrator>ratioTracking</integrator>",
                             jumble, more, spp));
}

} // namespace

TEST_CASE("lamps are seen through several even media without noise", "[gpu][several][transmittance]") {
    const std::string first = volume("<box width='8' height='8' depth='2'/>", 0.5, 0.0),
                      second = volume("<box z='0.5' width='8' height='8' depth='3'/>", 0.3, 0.0),
                      fog = volume("<everywhere/>", 0.1, 0.0);
    check_panel(before_a_panel(first + second), 0.5 * 2.0 + 0.3 * 3.0);
    check_panel(before_a_panel(first + second + fog), 0.5 * 2.0 + 0.3 * 3.0 + 0.1 * 14.0);
    // The camera, and the panel, within: of the third box what is between them counts.
    const std::string about = volume("<box width='40' height='40' depth='40'/>", 0.02, 0.0);
    check_panel(before_a_panel(first + second + about), 0.5 * 2.0 + 0.3 * 3.0 + 0.02 * 14.0);
    // A ball's middle, and one mirrored, of half that width along z.
    const std::string ball = volume("<sphere radius='1.5'/>", 0.4, 0.0),
                      flat = volume("<sphere radius='1'/>", 0.7, 0.0,
                                    "<transform><scale x='2' y='2' z='-0.5'/></transform>");
    check_panel(before_a_panel(ball + flat, 1e-4), 0.4 * 3.0 + 0.7 * 1.0);
    // Nothing is not everything.
    check_panel(before_a_panel(first + volume("<sphere x='30' radius='1'/>", 5.0, 0.0)), 0.5 * 2.0);
}

TEST_CASE("as many even media as shadow rays ask one by one are closed forms, and more are walked through",
          "[gpu][several][transmittance]") {
    std::string slabs;
    double depth = 0.0;
    for (int i = 0; i < MOST_EVEN_MEDIA; ++i) {
        slabs +=
            volume(fmt::format("<box z='{}' width='8' height='8' depth='0.2'/>", 4.0 - 0.25 * i), 0.01 * (i + 1), 0.0);
        depth += 0.2 * 0.01 * (i + 1);
    }
    check_panel(before_a_panel(slabs), depth);
    Scene scene = before_a_panel(slabs + volume("<sphere x='3' radius='0.1'/>", 1.0, 0.0));
    CHECK(!are_even_together(scene));
    scene.settings.spp = 2000;
    const Film film = render_here(scene, 1).film;
    CHECK_AGREEMENT(agree_with_means(film, std::vector<Rgb>(film.pixel_count(), Rgb(std::exp(-depth))), "33 media"));
}

TEST_CASE("light through several even media equals the reference's", "[gpu][image][several][transmittance]") {
    const std::pair<const char*, const char*> lights[] = {
        {"a sun", "<lights><sun zenith='40' azimuth='30' angle='3'/></lights>"},
        {"a beam and a sky",
         "<light x='1' y='2' z='0.5' r='1' g='1' b='1'/><backgroundColor r='0.2' g='0.3' b='0.5'/>"},
        {"points and a ball",
         "<lights><point y='2.5'/><point x='-2' z='1'/><sphere x='2' y='1' radius='0.5'/></lights>"},
        {"what glows", "<backgroundColor r='0.1' g='0.1' b='0.1'/><light y='1' r='0.2' g='0.2' b='0.2'/>"}};
    for (const auto& [name, xml] : lights)
        check_by_both_schedules(jumble_with(xml), name);
}

TEST_CASE("light through several even media to surfaces and sensors equals the reference's",
          "[gpu][image][several][surfaces][transmittance]") {
    check_by_both_schedules(
        jumble_with(
            "<surfaces><rectangle y='-1.5' lookAt='0 0 0' width='8' height='8' r='0.6' g='0.6' b='0.6'/>"
            "<sphere x='0.3' radius='0.3' r='0.8' g='0.5' b='0.2'/></surfaces><light x='1' y='2' r='1' g='1' b='1'/>"),
        "beside surfaces");
}

TEST_CASE("shadow rays through several even media mean what walks do, of less noise",
          "[gpu][several][transmittance][variances]") {
    const Scene scene = jumble_with("<light x='1' y='2' z='0.5' r='1' g='1' b='1'/>");
    Scene walks = scene;
    walks.settings.choices.transmittance = TRANSMITTANCE_RATIO;
    const RenderResult known = render_here(scene, 3), walked = render_here(walks, 4);
    CHECK_AGREEMENT(agree(known.film, walked.film, "closed form and ratio tracking"));
    const auto noise = [](const Film& film) {
        double sum = 0.0;
        for (const glm::vec3& variance : film.variance)
            sum += variance.x;
        return sum;
    };
    CHECK(noise(known.film) < 0.8 * noise(walked.film));
}

TEST_CASE("light through several even media that repeat", "[gpu][several][periodic][transmittance]") {
    const std::string media =
        volume("<box width='1' height='1' depth='1'/>", 0.1, 0.9) + volume("<sphere x='0.5' radius='0.6'/>", 0.0, 0.8);
    const auto film = [&](const char* transmittance, std::uint32_t seed) {
        return render_here(
                   parse(fmt::format(
                       "<volumes>{}</volumes><periodic x='-1 1' z='-1 1'/><light x='1' y='1' z='0.3' r='1' g='1' "
                       "b='1'/>"
                       "<camera y='4' lookAt='0 0 0' up='0 0 1' fov='30'/><rayPerPixelCount>512</rayPerPixelCount>"
                       "<width>8</width><height>8</height><integrator transmittance='{}'>ratioTracking</integrator>",
                       media, transmittance)),
                   seed)
            .film;
    };
    CHECK_AGREEMENT(agree(film("analytic", 1), film("ratio", 2), "repeated"));
}

TEST_CASE("particles through several even media are seen by closed forms", "[gpu][several][particles][transmittance]") {
    Scene scene = jumble_with("<lights><point y='2.5'/></lights>");
    const Film paths = render_here(scene, 1).film;
    scene.settings.integrator = "bidirectional";
    check_same_mean(render_here(scene, 2).film, paths, "bidirectional");
    scene.settings.integrator = "lightTracing";
    check_same_mean(render_here(scene, 3).film, paths, "lightTracing");
}

TEST_CASE("media that no shadow ray asks take no turns away", "[gpu][several][transmittance]") {
    std::string balls;
    for (int i = 0; i < 300; ++i)
        balls += volume(fmt::format("<sphere x='{}' y='{}' radius='0.4'/>", i % 20 - 10, i / 20 - 7), 0.1, 0.5);
    const Scene scene = parse("<volumes>" + balls +
                              "</volumes><backgroundColor r='1' g='1' b='1'/><camera z='40' fov='30'/><width>8</width>"
                              "<height>8</height><rayPerPixelCount>4</rayPerPixelCount>");
    CHECK(render_here(scene, 1).plan.budget > 100); // of one medium or two at a place
}

TEST_CASE("where shadow rays through several media are closed forms", "[cpu][several][transmittance]") {
    const auto transmittance = [](const Scene& scene) { return choose_method(with_preset(scene)).transmittance; };
    const auto with = [](const std::function<void(Scene&)>& change) {
        Scene scene = jumble_with("<light y='1' r='1' g='1' b='1'/>");
        change(scene);
        return scene;
    };
    CHECK(transmittance(with([](Scene&) {})) == TRANSMITTANCE_ANALYTIC);
    CHECK(transmittance(with([](Scene& s) { s.settings.integrator.clear(); })) == TRANSMITTANCE_ANALYTIC);
    CHECK(transmittance(with([](Scene& s) { s.settings.choices.transmittance = TRANSMITTANCE_DELTA; })) ==
          TRANSMITTANCE_DELTA);
    CHECK(transmittance(with([](Scene& s) {
              s.settings.choices.nee = NEE_CACHED; // where nothing can be cached
              s.volumes.push_back(medium(Everywhere{}, 0.1, 0.5));
          })) == TRANSMITTANCE_ANALYTIC);
    // What glows is looked for whether that is named or not.
    const auto looks_for_glow = [](std::optional<int> chosen) {
        Scene scene = jumble_with("");
        scene.volumes[0].Le = Rgb(1.0);
        scene.settings.choices.transmittance = chosen;
        return with_preset(scene).lights.size();
    };
    CHECK(looks_for_glow(std::nullopt) == 1);
    CHECK(looks_for_glow(TRANSMITTANCE_ANALYTIC) == 1);
    CHECK(transmittance(with([](Scene& s) { s.volumes[1].noise = Noise{}; })) == TRANSMITTANCE_RATIO);
    CHECK(transmittance(with([](Scene& s) { s.volumes[1].sigma_a = {0.2, 0.3, 0.4}; })) == TRANSMITTANCE_RATIO);
    CHECK(transmittance(with([](Scene& s) { s.volumes[2].shape = cloud_file(); })) == TRANSMITTANCE_RATIO);
}

TEST_CASE("lamps among several even media are looked at from along flights", "[gpu][several][variances]") {
    Scene scene =
        jumble_with("<lights><spot x='-1' y='1.2' lookAt='0.6 -0.5 0' angle='40' multiplier='5'/></lights>", 256);
    const auto spread = [&](std::optional<int> distance) {
        scene.settings.choices.distance = distance;
        const Film film = render_here(scene, 1).film;
        double sum = 0.0;
        for (std::size_t i = 0; i < film.pixel_count(); ++i)
            sum += film.variance[i].y;
        return sum;
    };
    CHECK(spread(std::nullopt) < 0.4 * spread(DISTANCE_FLIGHTS));
    scene.settings.choices.distance.reset();
    CHECK_AGREEMENT(agree(render_here(scene, 2).film, render_reference(scene, 3), "a lamp among several even media"));
}

TEST_CASE("lights from afar that a medium without end shuts out are told", "[cpu][several]") {
    const auto warnings_of = [](const std::string& xml) {
        const Scene scene = parse(xml);
        return load_assets(scene, choose_method(scene)).warnings;
    };
    const std::string fog = "<everywhere/><sigma_a>0.01</sigma_a><sigma_s>0.05</sigma_s>";
    const std::vector<std::string> told = warnings_of(fog + "<light y='1' r='1' g='1' b='1'/>");
    REQUIRE(told.size() == 1);
    CHECK_THAT(told.front(), Catch::Contains("has no end, and so lets no light through from <light>, <sun> or <sky>"));
    CHECK(warnings_of(fog + "<lights><sun zenith='30'/><point/></lights>").size() == 1);
    CHECK(warnings_of(fog + "<lights><point/></lights>").empty());
    CHECK(warnings_of(fog + "<layers scaleHeight='100'/><light y='1' r='1' g='1' b='1'/>").empty());
    CHECK(warnings_of("<everywhere/><sigma_a>0</sigma_a><sigma_s r='0' g='0.1' b='0.1'/><maxDepth>2</maxDepth>"
                      "<light y='1' r='1' g='1' b='1'/>")
              .empty()); // red comes through
}
