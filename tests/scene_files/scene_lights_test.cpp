// <lights>: what is read of it, and what is refused.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "blackbody.h"
#include "daylight.h"
#include "error.h"
#include "integrators.h"
#include "method.h"
#include "preset.h"
#include "scene_hash.h"
#include "shared/constants.h"
#include "support/scene_text.h"
#include "support/scenes.h"

using namespace vkvol;

TEST_CASE("lights of every kind are read", "[cpu][xml]") {
    const Scene scene = parse(R"(<sphere/><light y="2" r="3"/><lights>
        <directional x="1" r="2" g="1" b=".5" multiplier="2"/>
        <sun z="4" angle="2" limbDarkening=".6"/>
        <point x="1" y="2" z="3" multiplier="7"/>
        <spot y="5" lookAt="0 0 0" angle="30" blend="0" kelvin="2700"/>
        <sky rotation="-30" multiplier=".5">a/sky.exr</sky>
        <sphere radius="2" multiplier="3"/>
        <disk y="2" lookAt="0 0 0" radius=".5"/>
        <rectangle z="-2" lookAt="0 0 0" width="3" height="4"/></lights>)");
    REQUIRE(scene.lights.size() == 9);
    CHECK(std::get<DirectionalLight>(scene.lights[0]).irradiance == Rgb(3, 0, 0));
    CHECK(std::get<DirectionalLight>(scene.lights[1]).irradiance == Rgb(4, 2, 1));
    CHECK(std::get<DirectionalLight>(scene.lights[1]).direction == glm::dvec3(1, 0, 0));
    CHECK(std::get<SunLight>(scene.lights[2]).irradiance == Rgb(1.0));
    CHECK(std::get<SunLight>(scene.lights[2]).angle == 2.0);
    CHECK(std::get<SunLight>(scene.lights[2]).limb_darkening == 0.6);
    CHECK(std::get<PointLight>(scene.lights[3]).position == glm::dvec3(1, 2, 3));
    CHECK(std::get<PointLight>(scene.lights[3]).intensity == Rgb(7.0));
    const auto& spot = std::get<SpotLight>(scene.lights[4]);
    CHECK(spot.direction == glm::dvec3(0, -1, 0));
    CHECK(spot.blend == 0.0);
    const Rgb weights(0.2126, 0.7152, 0.0722); // of luminance, Rec.709
    CHECK(glm::dot(spot.intensity, weights) == Approx(1.0).epsilon(1e-3));
    CHECK(spot.intensity.x > 2.0 * spot.intensity.z);
    const auto& sky = std::get<SkyLight>(scene.lights[5]);
    CHECK(sky.file.filename() == "sky.exr");
    CHECK(sky.rotation == -30.0);
    CHECK(sky.mapping == SkyMapping::equirectangular);
    CHECK(sky.scale == Rgb(0.5));
    CHECK(std::get<SphereLight>(scene.lights[6]).radiance == Rgb(3.0));
    CHECK(std::get<DiskLight>(scene.lights[7]).normal == glm::dvec3(0, -1, 0));
    const auto& rectangle = std::get<RectangleLight>(scene.lights[8]);
    CHECK(glm::distance(rectangle.normal(), glm::dvec3(0, 0, 1)) < 1e-12);
    CHECK(glm::length(rectangle.edge_u) == Approx(1.5));
    CHECK(rectangle.edge_v == glm::dvec3(0, 2, 0));
    CHECK(scene.warnings.empty());
}

// Integrated over directions and surfaces, by midpoints where there is no closed form.
TEST_CASE("power is what a light sends out in all", "[cpu][xml]") {
    constexpr double pi = std::numbers::pi;
    const Scene scene = parse(R"(<sphere/><lights>
        <point x="1" power="100" r="1" g=".5" b="0"/>
        <spot y="5" lookAt="0 0 0" angle="90" blend=".6" power="100"/>
        <sphere radius="2" power="100"/>
        <disk y="2" lookAt="0 0 0" radius=".5" power="100"/>
        <rectangle z="-2" lookAt="0 0 0" width="3" height="4" power="100"/></lights>)");
    REQUIRE(scene.lights.size() == 5);
    const Rgb point = std::get<PointLight>(scene.lights[0]).intensity;
    CHECK(point.x * 4.0 * pi == Approx(100.0));
    CHECK(point.y * 4.0 * pi == Approx(50.0));
    const auto& spot = std::get<SpotLight>(scene.lights[1]);
    double sent = 0.0;
    constexpr int steps = 20000;
    for (int i = 0; i < steps; ++i) {
        const double mu = 1.0 - (1.0 - std::cos(pi / 4.0)) * (i + 0.5) / steps;
        const double edge = std::cos(pi / 4.0), full = std::cos(pi / 4.0 * 0.4);
        const double t = std::clamp((mu - edge) / (full - edge), 0.0, 1.0);
        sent += spot.intensity.x * t * t * (3.0 - 2.0 * t) * 2.0 * pi * (1.0 - edge) / steps;
    }
    CHECK(sent == Approx(100.0).epsilon(1e-6));
    CHECK(std::get<SphereLight>(scene.lights[2]).radiance.x * pi * 4.0 * pi * 4.0 == Approx(100.0));
    CHECK(std::get<DiskLight>(scene.lights[3]).radiance.x * pi * pi * 0.25 == Approx(100.0));
    CHECK(std::get<RectangleLight>(scene.lights[4]).radiance.x * pi * 12.0 == Approx(100.0));
    CHECK(error_of(R"(<lights><point power="1" multiplier="2"/></lights>)").find("remove one of them") !=
          std::string::npos);
    CHECK(error_of(R"(<lights><sphere radius="1e-9" power="1"/></lights>)").find("widen the light") !=
          std::string::npos);
    CHECK(error_of(R"(<lights><sun power="1"/></lights>)") != "no error");
    CHECK(parse(R"(<sphere/><lights><point power="0"/></lights>)").lights.empty());
}

TEST_CASE("directions by zenith and azimuth", "[cpu][xml]") {
    const auto towards = [](const std::string& angles) {
        const Scene scene = parse("<sphere/><lights><directional multiplier=\"2\" " + angles + "/></lights>");
        return std::get<DirectionalLight>(scene.lights.front()).direction;
    };
    CHECK(towards("zenith='0'") == glm::dvec3(0.0, 1.0, 0.0));
    CHECK(glm::distance(towards("zenith='90'"), {0.0, 0.0, 1.0}) < 1e-15);
    CHECK(glm::distance(towards("zenith='90' azimuth='90'"), {1.0, 0.0, 0.0}) < 1e-15);
    CHECK(glm::distance(towards("zenith='60' azimuth='-30'"), {-0.5 * std::sqrt(0.75), 0.5, 0.75}) < 1e-15);
    CHECK(glm::distance(towards("azimuth='40'"), {0.0, 1.0, 0.0}) < 1e-15);
    const Scene old = parse("<sphere/><light zenith='60' azimuth='90' r='1'/>");
    CHECK(glm::distance(std::get<DirectionalLight>(old.lights.front()).direction, {std::sqrt(0.75), 0.5, 0.0}) < 1e-15);
}

TEST_CASE("what is wrong with a light is said at its place", "[cpu][xml]") {
    const auto error = [](const std::string& light) { return error_of("<lights>" + light + "</lights>"); };
    for (const auto& [light, words] : std::vector<std::pair<std::string, std::string>>{
             {"<lamp/>", "2:9"},
             {"<directional/>", "<directional> has no direction"},
             {"<sun r=\"1\"/>", "<sun> has no direction"},
             {"<sun zenith=\"10\" y=\"1\"/>", "<sun> y: zenith and azimuth say the direction already"},
             {"<directional zenith=\"-1\"/>", "from 0 to 180"},
             {"<daylight zenith=\"91\"/>", "below the horizon"},
             {"<sun y=\"1\" angle=\"0\"/>", "from 0.01 to 180"},
             {"<sun y=\"1\" angle=\"0.01\" multiplier=\"1e12\"/>", "widen or dim it"},
             {"<sun y=\"1\" limbDarkening=\"1.5\"/>", "<sun> limbDarkening"},
             // pi sin^2 of half a degree is 2.39e-4: 1e12 of 2.4e8 with an even disc, half as much again with a dark
             // limb
             {"<sun y=\"1\" angle=\"1\" limbDarkening=\"1\" multiplier=\"2e8\"/>", "widen or dim it"},
             {"<point x=\"nan\"/>", "<point> x"},
             {"<point kelvin=\"2700\" r=\"1\"/>", "remove one of them"},
             {"<point kelvin=\"100\"/>", "from 500 to 40000"},
             {"<point multiplier=\"1e20\"/>", "lower"},
             {"<spot/>", "lookAt=\"x y z\""},
             {"<spot lookAt=\"0 0 0\"/>", "is where its middle is"},
             {"<spot lookAt=\"0 1\"/>", "lookAt=\"x y z\""},
             {"<spot lookAt=\"0 1 0\" angle=\"0\"/>", "from 0.1 to 180"},
             {"<spot lookAt=\"0 1 0\" blend=\"2\"/>", "from 0 to 1"},
             {"<sphere radius=\"0\"/>", "<sphere> radius"},
             {"<disk/>", "lookAt=\"x y z\""},
             {"<rectangle lookAt=\"0 1 0\" up=\"0 2 0\"/>", "is the direction that it faces"},
             {"<rectangle lookAt=\"0 1 0\" up=\"0 2\"/>", "expected three numbers"},
             {"<rectangle lookAt=\"0 1 0\" width=\"-1\"/>", "<rectangle> width"},
             {"<sky/>", "names no file"},
             {"<sky>a.exr</sky><sky>b.exr</sky>", "a second map of the sky"},
             {"<sky>a.exr</sky><daylight y=\"1\"/>", "a second map of the sky"},
             {"<daylight x=\"1\" y=\"-0.1\"/>", "below the horizon"},
             {"<daylight/>", "<daylight> has no direction"},
             {"<daylight y=\"1\" turbidity=\"1\"/>", "from 2 (clear)"},
             {"<sky mapping=\"square\">a.exr</sky>", "expected equirectangular or equalArea"},
             {"<sky colour=\"1\">a.exr</sky>", "colour"}}) {
        CAPTURE(light, words);
        CHECK_THAT(error(light), Catch::Contains(words));
    }
}

// Figures by hand from the paper's formulas: turbidity 3, the sun 30 degrees from the zenith.
TEST_CASE("daylight has a sky and a sun", "[cpu][xml]") {
    const Scene scene = parse(R"(<sphere/><lights><daylight x=".5" y=".8660254037844387" multiplier="2"/></lights>)");
    REQUIRE(scene.lights.size() == 2);
    const auto& sky = std::get<SkyLight>(scene.lights[0]);
    const auto& sun = std::get<SunLight>(scene.lights[1]);
    CHECK(sun.angle == 0.53);
    const glm::dvec3 weights(0.2126, 0.7152, 0.0722); // of luminance
    // What air of mass 1.1536 leaves of 133 klx, at 610, 550 and 465 nm: 0.9271 x 0.8166 x 0.9527 by Rayleigh, haze and
    // ozone, and so on.
    const double passed[3] = {0.72123, 0.68273, 0.59408};
    for (int c = 0; c < 3; ++c)
        CHECK(sun.irradiance[c] == Approx(2.0 * 133.0 * passed[c] * blackbody_rgb(5778.0, 5778.0)[c]).epsilon(1e-3));
    const RadianceMap map = make_daylight(*sky.daylight);
    const auto luminance = [&](int column, int row) {
        return glm::dot(glm::dvec3(map.texels[std::size_t(row) * map.width + column]), weights);
    };
    // chi = (4/9 - 1/40) 120 degrees = 50.33; (12.1359 - 4.9710) tan chi - 0.6465 + 2.4192 = 10.41.
    CHECK(luminance(0, 0) == Approx(10.41).epsilon(0.02));
    // The sun is at +x: three quarters across, a third of the way down to the horizon. 60 degrees from the zenith, on
    // its side and on the other, x, y, Y are 0.26948, 0.27913, 15.124 and 0.24414, 0.25936, 6.333; texels are half a
    // degree beside that.
    const auto at = [&](int column, int row) { return glm::dvec3(map.texels[std::size_t(row) * map.width + column]); };
    const glm::dvec3 below_sun = at(3 * map.width / 4, map.height / 3), opposite = at(map.width / 4, map.height / 3);
    const double near[3] = {11.873, 15.237, 23.584}, across[3] = {3.538, 6.606, 11.856};
    for (int c = 0; c < 3; ++c) {
        CHECK(below_sun[c] == Approx(near[c]).epsilon(0.02));
        CHECK(opposite[c] == Approx(across[c]).epsilon(0.02));
    }
    // Below the horizon is the ground, of albedo 0.2, lit by sun and sky.
    glm::dvec3 irradiance = std::cos(std::numbers::pi / 6.0) * sun.irradiance / 2.0;
    for (int row = 0; row < map.height / 2; ++row)
        for (int column = 0; column < map.width; ++column) {
            const double angle = std::numbers::pi * (row + 0.5) / map.height, step = std::numbers::pi / map.height;
            irradiance += at(column, row) * std::cos(angle) * std::sin(angle) * step * 2.0 * step * double(map.height) /
                          double(map.width);
        }
    for (const glm::dvec3& ground : {at(5, map.height - 1), at(300, map.height / 2 + 1)})
        for (int c = 0; c < 3; ++c)
            CHECK(ground[c] == Approx(0.2 / std::numbers::pi * irradiance[c]).epsilon(1e-3));
}

TEST_CASE("black lights are left out", "[cpu][xml]") {
    const Scene scene = parse(R"(<sphere/><lights><point r="0"/><sky multiplier="0">a.exr</sky></lights>)");
    CHECK(scene.lights.empty());
    REQUIRE(scene.black.size() == 2);
    CHECK(scene.black.back().name == "sky");
}

TEST_CASE("integrators that send no shadow rays see what has an extent", "[cpu][xml]") {
    CHECK(warns(parse(R"(<sphere/><integrator>deltaTracking</integrator><lights><point x="3"/></lights>)"),
                "ratioTracking renders it"));
    CHECK_FALSE(warns(parse(R"(<sphere/><integrator>deltaTracking</integrator><lights><sun y="3"/></lights>)"),
                      "ratioTracking"));
}

TEST_CASE("what is scattered once under a sky that no shadow ray asks is another picture", "[cpu][xml]") {
    const auto scene = [](const std::string& attributes) {
        return parse("<sphere/><integrator scattering=\"single\"" + attributes +
                     ">ratioTracking</integrator><lights><sun y=\"3\"/></lights>");
    };
    CHECK(scene_hash(scene("")) != scene_hash(scene(" nee=\"none\"")));
    CHECK(warns(scene(" nee=\"none\""), "what scatters once has no light"));
    CHECK(scene("").warnings.empty());
}

TEST_CASE("too many lamps are refused", "[cpu][xml]") {
    std::string lamps;
    for (int i = 0; i < 4097; ++i)
        lamps += "<sphere/>";
    const Scene scene = parse("<lights>" + lamps + "</lights>");
    CHECK_THROWS_WITH(load_assets(scene, choose_method(scene)), Catch::Contains("make most of them points"));
}

TEST_CASE("what a scene's lights ask for", "[cpu][method]") {
    const auto method_of = [](const std::string& lights, const std::string& integrator = "") {
        return choose_method(with_preset(parse("<box/><noise/>" + integrator + "<lights>" + lights + "</lights>")));
    };
    CHECK(method_of("<directional y=\"1\"/>").nee == NEE_CACHED);
    CHECK(method_of("<directional y=\"1\"/><directional x=\"1\"/>").nee == NEE_CACHED);
    CHECK(method_of("<point/>").nee == NEE_COLLISIONS);
    CHECK(method_of("<point/>", "<integrator>cachedRatioTracking</integrator>").nee == NEE_CACHED);
    CHECK(!method_of("<sun y=\"1\"/>").mis);
    const std::string phase = R"(<integrator mis="phase">ratioTracking</integrator>)";
    CHECK(method_of("<sun y=\"1\"/>", phase).mis == MIS_PHASE);
    CHECK(method_of("<point/>", phase).warnings.size() == 1);
}

TEST_CASE("a map of the sky without light is refused, and what is no number counts as none", "[cpu][lights]") {
    const auto load = [](const SkyLight& sky) {
        Scene scene;
        scene.lights = {sky};
        return load_assets(scene, choose_method(scene));
    };
    CHECK_THROWS_WITH(load(write_sky(make_map(4, 2, [](int, int) { return Rgb(0.0); }))),
                      Catch::Contains("a map without light"));
    SkyLight missing;
    missing.file = "none.exr";
    CHECK_THROWS_WITH(load(missing), Catch::Contains("none.exr"));
    missing.file = "none.bmp";
    CHECK_THROWS_AS(load(missing), InputError);
    const Assets assets = load(write_sky(make_map(4, 2, [](int x, int y) {
        return x == 1 ? Rgb(std::numeric_limits<double>::quiet_NaN()) : y == 1 ? Rgb(-1.0) : Rgb(2.0);
    })));
    CHECK(assets.sky->mended == 5);
    REQUIRE(assets.warnings.size() == 1);
    CHECK_THAT(assets.warnings[0], Catch::Contains("5 texels were negative or not finite"));
}

TEST_CASE("a map of equal areas is square, and another picture", "[cpu][xml]") {
    const auto scene = [](const std::string& mapping) {
        return parse("<sphere/><lights><sky" + mapping + ">a.exr</sky></lights>");
    };
    CHECK(std::get<SkyLight>(scene(R"( mapping="equalArea")").lights[0]).mapping == SkyMapping::equal_area);
    CHECK(scene_hash(scene(R"( mapping="equalArea")")) != scene_hash(scene("")));
    CHECK(scene_hash(scene(R"( mapping="equirectangular")")) == scene_hash(scene("")));
    Scene oblong;
    oblong.lights = {write_sky(make_map(4, 2, [](int, int) { return Rgb(1.0); }), SkyMapping::equal_area)};
    CHECK_THROWS_WITH(load_assets(oblong, choose_method(oblong)),
                      Catch::Contains("4 x 2 texels") && Catch::Contains("mapping=\"equalArea\" is to be left out"));
}
