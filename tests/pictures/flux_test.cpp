// Sensors that read flux: against closed forms, the integral equation of transport, other sensors, and the reference,
// whose rays go evenly in all directions and which looks at nothing but lights without extent.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "camera_view.h"
#include "film_table.h"
#include "framing.h"
#include "scene_hash.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/thorough.h"
#include "tests/reference/reference.h"
#include "tests/reference/transport.h"

using namespace vkvol;
using Catch::Contains;
using std::numbers::pi;

namespace {

// A sensor of `across` by `across` pixels.
Scene rectangle(glm::dvec3 middle, glm::dvec3 facing, glm::dvec2 size, int across, std::uint32_t spp) {
    Scene scene;
    scene.camera.projection = Projection::irradiance;
    scene.camera.position = middle;
    const glm::dvec3 y(0.0, 1.0, 0.0);
    look_along(scene.camera, facing, is_parallel(facing, y) ? glm::dvec3(0.0, 0.0, 1.0) : y);
    scene.camera.size = size;
    scene.picture = {across, across, 0.0, 0.0, double(across), double(across)};
    scene.settings.spp = spp;
    return scene;
}

Scene at_points(const std::vector<glm::dvec3>& points, std::uint32_t spp) {
    Scene scene;
    scene.camera.projection = Projection::fluence;
    scene.camera.position = points.front();
    scene.camera.points = points;
    scene.picture = {int(points.size()), 1, 0.0, 0.0, double(points.size()), 1.0};
    scene.settings.spp = spp;
    return scene;
}

const glm::dvec3 down(0.0, 0.0, -1.0), zenith(0.0, 0.0, 1.0);

// A map that shines 1 from z > 0 alone, but for the texels between the halves.
SkyLight half_sky() {
    // Columns are longitudes: 0 in the middle is -z, and +z are the outer quarters.
    return write_sky(
        make_map(1024, 512, [](int column, int) { return Rgb(column < 256 || column >= 768 ? 1.0 : 0.0); }));
}

} // namespace

TEST_CASE("uniform radiance is read as pi and as 4 pi of it, exactly", "[gpu][image][flux][long]") {
    for (const bool in_furnace : {false, true})
        for (Scene scene : {rectangle({1.0, 2.0, 3.0}, {1.0, -1.0, 0.5}, {2.0, 1.0}, 4, 16),
                            at_points({{0.0, 0.0, 0.0}, {5.0, 0.0, 1.0}}, 16)}) {
            scene.background = {1.0, 2.0, 0.5};
            if (in_furnace)
                scene.volumes = {medium(Sphere{{0.0, 0.0, 0.0}, 2.0}, 3.0, 1.0)};
            const double unit = reading_of_unit_radiance(scene.camera);
            CHECK(unit == Approx(scene.camera.points.empty() ? pi : 4.0 * pi));
            for (const glm::vec3& pixel : render_here(scene, 1).film.mean)
                for (int channel = 0; channel < 3; ++channel)
                    CHECK(pixel[channel] == Approx(unit * scene.background[channel]).epsilon(1e-6));
        }
    // In the plane of a surface it is before that.
    Scene scene = rectangle({0.1, 0.0, 0.0}, {0.0, 1.0, 0.0}, {2.0, 2.0}, 4, 64);
    scene.background = Rgb(1.0);
    scene.surfaces.emplace_back();
    scene.surfaces.back().shape = RectangleSurface{glm::dvec3(0.0), {2.5, 0.0, 0.0}, {0.0, 0.0, -2.5}};
    for (const glm::vec3& pixel : render_here(scene, 1).film.mean)
        CHECK(pixel.x == Approx(pi).epsilon(1e-6));
}

// What is known at once has no noise: exp in single precision errs by some 1e-6 of these depths.
TEST_CASE("light without extent is read straight from its source", "[gpu][image][flux]") {
    const double cosine = 0.8;
    const glm::dvec3 towards(0.6, 0.0, cosine);
    for (const double tau : {0.0, 0.5, 2.0}) {
        const double through = std::exp(-tau / cosine);
        const auto reads = [&](Scene scene, const Light& light, double expected) {
            scene.lights = {light};
            if (tau > 0.0)
                scene.volumes = {slab(tau, 0.0)};
            scene.settings.integrator = "ratioTracking";
            CAPTURE(tau, scene.camera.points.size(), light.index());
            for (const glm::vec3& pixel : render_here(scene, 1).film.mean)
                CHECK(pixel.x == Approx(expected).epsilon(3e-6));
        };
        const DirectionalLight sun{towards, Rgb(2.0)};
        const double distance = 100.0; // of a point light, from one below the slab
        const glm::dvec3 place(0.0, 0.0, -3.0);
        const PointLight lamp{place + distance * towards, Rgb(5e4)};
        reads(rectangle(place, zenith, {1.0, 1.0}, 2, 8), sun, 2.0 * cosine * through);
        reads(rectangle(place, down, {1.0, 1.0}, 2, 8), sun, 0.0);
        reads(at_points({place}, 8), sun, 2.0 * through);
        reads(rectangle(place, zenith, {1e-4, 1e-4}, 2, 8), lamp, 5.0 * cosine * through);
        reads(at_points({place}, 8), lamp, 5.0 * through);
    }
}

// By power over squared distance the spot is asked 180 times as often as the other, or one sample in 180 misses it: of
// 2^16, standard errors of 3e-4. The other, by the cosine of its place, adds at most 0.0015.
TEST_CASE("a spot that shines on a sensor, and past all media, is read", "[gpu][image][flux]") {
    Scene scene = rectangle(glm::dvec3(0.0), zenith, {1e-3, 1e-3}, 2, 1 << 16);
    scene.volumes = {medium(Sphere{{0.0, 30.0, 5.0}, 0.5}, 1.0, 0.5)};
    scene.lights = {SpotLight{{0.0, 0.0, 2.0}, down, Rgb(8.0), 20.0, 0.5}, PointLight{{0.0, 30.0, 4.0}, Rgb(10.0)}};
    scene.settings.integrator = "ratioTracking";
    for (const glm::vec3& pixel : render_here(scene, 1).film.mean)
        CHECK(pixel.x == Approx(2.0007).epsilon(2e-3));
}

// A disc above the horizon gives its irradiance times the cosine to its middle, a ball pi L (R / d)^2 times that.
TEST_CASE("light with an extent is read however it is found", "[gpu][image][flux]") {
    const int mis = GENERATE(MIS_BALANCE, MIS_POWER, MIS_LIGHT, MIS_PHASE);
    const bool absorbs = GENERATE(false, true); // ... a ball about the sensor, of depth 1
    if (absorbs && mis != MIS_BALANCE)
        return;
    if (!thorough() && !absorbs && mis != MIS_PHASE)
        return;
    const double T = absorbs ? std::exp(-1.0) : 1.0;
    const glm::dvec3 towards(0.6, 0.0, 0.8);
    const auto reads = [&](Scene scene, const Light& light, double expected, const char* name) {
        scene.lights = {light};
        if (absorbs)
            scene.volumes = {medium(Sphere{{0.0, 0.0, 0.0}, 1.0}, 1.0, 0.0)};
        scene.settings.integrator = "ratioTracking";
        scene.settings.choices.mis = mis;
        check_means(scene, expected, fmt::format("{}, mis {}, {}", name, mis, absorbs));
    };
    const Scene facing = rectangle({0.0, 0.0, 0.0}, zenith, {1e-5, 1e-5}, 4, 1 << 14),
                points = at_points(std::vector<glm::dvec3>(8, glm::dvec3(0.0)), 1 << 15);
    const SunLight sun{towards, Rgb(3.0), 40.0, 0.6};
    reads(facing, sun, 3.0 * 0.8 * T, "sun through a rectangle");
    // Even radiance L over 1 - cos: L 2 pi (1 - cos); its irradiance is L pi sin^2.
    const SunLight even{towards, Rgb(3.0), 40.0};
    const double half = 20.0 * pi / 180.0;
    reads(points, even, 3.0 / (pi * std::pow(std::sin(half), 2.0)) * 2.0 * pi * (1.0 - std::cos(half)) * T,
          "sun at points");
    const SphereLight ball{5.0 * towards, 2.0, Rgb(2.0)};
    reads(facing, ball, pi * 2.0 * 0.16 * 0.8 * T, "ball through a rectangle");
    reads(points, ball, 2.0 * 2.0 * pi * (1.0 - std::sqrt(1.0 - 0.16)) * T, "ball at points");
    const DiskLight disk{3.0 * zenith, down, 1.5, Rgb(2.0)};
    reads(facing, disk, pi * 2.0 * 0.2 * T, "disk through a rectangle"); // R^2 / (R^2 + d^2) = 1 / 5
    reads(points, disk, 2.0 * 2.0 * pi * (1.0 - std::sqrt(0.8)) * T, "disk at points");
}

// What the solutions have of energy shows how far they are off: 1e-4 of it, a fortieth of a picture's standard error.
TEST_CASE("irradiance above and below a conservative slab", "[gpu][image][hard][flux][long]") {
    const double tau = GENERATE(1.0, 5.0, 10.0);
    const int cells = tau < 2.0 ? 200 : 800;
    const reference::SlabSolution beam = reference::slab_in_beam(1.0, tau, 1.0, cells);
    const reference::SlabSolution diffuse = reference::slab_in_half_sky(1.0, tau, cells);
    CHECK(beam.reflected + beam.transmitted == Approx(1.0).epsilon(1e-4));
    CHECK(diffuse.reflected + diffuse.transmitted == Approx(pi).epsilon(1e-4));
    // The asymptote of thick slabs is off by less than 1e-4; at a depth of 1, 0.553 passes by van de Hulst's tables.
    const double known = tau < 2.0 ? 0.553 : reference::diffuse_transmission_asymptote(tau);
    CHECK(diffuse.transmitted / pi == Approx(known).margin(tau < 2.0 ? 1e-3 : 1e-4));
    for (const bool above : {true, false}) {
        Scene scene = above ? rectangle({0.0, 0.0, 1.0}, down, {1.0, 1.0}, 8, 1024)
                            : rectangle({0.0, 0.0, -2.0}, zenith, {1.0, 1.0}, 8, 1024);
        scene.volumes = {slab(tau, 1.0)};
        scene.settings.integrator = "ratioTracking";
        scene.lights = {DirectionalLight{zenith, Rgb(1.0)}};
        check_means(scene, above ? beam.reflected : beam.transmitted, fmt::format("slab {}, beam, {}", tau, above));
        scene.lights = {half_sky()};
        check_means(scene, above ? diffuse.reflected : diffuse.transmitted,
                    fmt::format("slab {}, half a sky, {}", tau, above));
    }
}

// The sum over the times that light goes to and fro between slab and ground: of the slab, R and T are for the beam, R'
// and T' for even light, from either side.
TEST_CASE("a slab over a ground has the flux of the adding formula", "[gpu][image][hard][flux][long]") {
    const double tau = GENERATE(1.0, 5.0), albedo = GENERATE(0.9, 1.0), ground = 0.3;
    const reference::SlabSolution beam = reference::slab_in_beam(albedo, tau, 1.0, 400);
    const reference::SlabSolution even = reference::slab_in_half_sky(albedo, tau, 400);
    const double on_ground = beam.transmitted / (1.0 - ground * even.reflected / pi);
    const double leaving = beam.reflected + ground * on_ground * even.transmitted / pi;
    for (const bool above : {true, false}) {
        Scene scene = above ? rectangle({0.0, 0.0, 1.0}, down, {1.0, 1.0}, 8, 1024)
                            : rectangle({0.0, 0.0, -1.2}, zenith, {1.0, 1.0}, 8, 1024);
        scene.volumes = {slab(tau, albedo)};
        scene.surfaces.emplace_back().shape = PlaneSurface{{0.0, 0.0, -1.5}, zenith};
        scene.surfaces.back().material.color = Rgb(ground);
        scene.lights = {DirectionalLight{zenith, Rgb(1.0)}};
        check_means(scene, above ? leaving : on_ground, fmt::format("slab {} of {}, {}", tau, albedo, above));
    }
}

TEST_CASE("irradiance above a semi-infinite medium is Chandrasekhar's", "[gpu][image][hard][flux]") {
    const double albedo = GENERATE(0.5, 0.9, 0.99);
    Scene scene = rectangle({0.0, 0.0, 1.0}, down, {1.0, 1.0}, 8, 512);
    scene.volumes = {slab(200.0, albedo)};
    scene.lights = {DirectionalLight{zenith, Rgb(1.0)}};
    check_means(scene, reference::plane_albedo(albedo), fmt::format("semi-infinite, albedo {}", albedo));
}

TEST_CASE("irradiance of light scattered once by a slab", "[gpu][image][hard][flux]") {
    const double tau = 0.7, mu0 = 0.8, albedo = 0.6;
    const auto integral = [&](auto radiance) {
        double sum = 0.0; // of 2 pi mu L, by the midpoint rule
        for (int i = 0; i < 4000; ++i) {
            const double mu = (i + 0.5) / 4000;
            sum += 2.0 * pi * mu * radiance(albedo, 1.0 / (4.0 * pi), tau, mu0, mu) / 4000.0;
        }
        return sum;
    };
    for (const char* const integrator : {"ratioTracking", "ratioNEE"}) {
        Scene scene = rectangle({0.0, 0.0, 1.0}, down, {1.0, 1.0}, 8, 512);
        scene.volumes = {slab(tau, albedo)};
        scene.lights = {DirectionalLight{{0.6, 0.0, mu0}, Rgb(1.0)}};
        scene.settings.integrator = integrator;
        scene.settings.max_depth = 1;
        check_means(scene, integral(reference::slab_single_reflection), std::string("reflected once, ") + integrator);
        scene = rectangle({0.0, 0.0, -2.0}, zenith, {1.0, 1.0}, 8, 512);
        scene.volumes = {slab(tau, albedo)};
        scene.lights = {DirectionalLight{{0.6, 0.0, mu0}, Rgb(1.0)}};
        scene.settings.integrator = integrator;
        scene.settings.max_depth = 1;
        check_means(scene, integral(reference::slab_single_transmission) + mu0 * std::exp(-tau / mu0),
                    std::string("transmitted once, ") + integrator);
    }
}

TEST_CASE("fluence within a slab in a beam", "[gpu][image][hard][flux]") {
    const double tau = 2.0, albedo = 0.9;
    constexpr int cells = 400;
    const reference::SlabSolution solution = reference::slab_in_beam(albedo, tau, 1.0, cells);
    std::vector<glm::dvec3> points;
    std::vector<Rgb> means;
    for (const int cell : {0, 100, 200, 399}) {
        points.emplace_back(3.0, -2.0, -(cell + 0.5) / cells);
        means.emplace_back(solution.fluence[std::size_t(cell)]);
    }
    Scene scene = at_points(points, 1 << 16);
    scene.picture = {2, 2, 0.0, 0.0, 2.0, 2.0}; // in two rows
    scene.volumes = {slab(tau, albedo)};
    scene.lights = {DirectionalLight{zenith, Rgb(1.0)}};
    CHECK_AGREEMENT(agree_with_means(render_here(scene, 5).film, means, "fluence within a slab"));
}

TEST_CASE("fluence amid a ball that glows", "[gpu][image][flux][long]") {
    const double radius = GENERATE(0.5, 2.0, 5.0), albedo = GENERATE(0.0, 0.6, 0.95);
    if (albedo == 0.0)
        CHECK(reference::fluence_amid_ball(albedo, radius, 400) ==
              Approx(4.0 * pi * -std::expm1(-radius)).epsilon(1e-9));
    Scene scene = at_points({{4.0, 5.0, 6.0}}, 1 << 17);
    scene.volumes = {medium(Sphere{{4.0, 5.0, 6.0}, 3.0}, radius / 3.0, albedo)};
    scene.volumes.front().Le = Rgb(1.0);
    check_means(scene, reference::fluence_amid_ball(albedo, radius, 400),
                fmt::format("amid a ball of {}, albedo {}", radius, albedo));
}

TEST_CASE("a panorama's mean over directions is fluence / 4 pi", "[gpu][image][flux]") {
    Volume volume = medium(write_grid(cloud_grid()), 1.2, 0.8, 0.5);
    volume.Le = {0.2, 0.1, 0.05};
    Scene scene = at_points({{0.3, 0.1, -0.2}}, 1 << 16);
    scene.volumes = {volume};
    scene.background = {0.1, 0.2, 0.3};
    scene.lights = {SunLight{glm::normalize(glm::dvec3(1.0, 2.0, 0.5)), {3.0, 2.5, 2.0}, 8.0},
                    SphereLight{{4.5, 5.5, 2.0}, 1.2, {14.0, 10.0, 6.0}}, write_sky(sunset_map())};
    const Film point = render_here(scene, 1).film;
    scene.camera.projection = Projection::equirectangular;
    scene.picture = {64, 32, 0.0, 0.0, 64.0, 32.0};
    scene.settings.spp = 64;
    const Film panorama = render_here(scene, 2).film;
    for (int channel = 0; channel < 3; ++channel) {
        double sum = 0.0, variance = 0.0;
        for (int row = 0; row < 32; ++row) {
            // Samples are even in latitude: this is the row's mean, off from one even in its solid angle by 1 / 10000.
            const double share = (std::cos(pi * row / 32.0) - std::cos(pi * (row + 1) / 32.0)) / 2.0 / 64.0;
            for (int column = 0; column < 64; ++column) {
                const auto i = std::size_t(row * 64 + column);
                sum += share * panorama.mean[i][channel];
                variance += share * share * panorama.variance[i][channel];
            }
        }
        const double fluence = point.mean[0][channel] / (4.0 * pi);
        const double error = std::sqrt(variance + point.variance[0][channel] / std::pow(4.0 * pi, 2.0));
        CAPTURE(channel, sum, fluence, error);
        CHECK(std::abs(sum - fluence) < 4.0 * error + 1e-3 * fluence);
    }
}

TEST_CASE("flux equals the reference's", "[gpu][image][flux][long]") {
    const std::vector<Light> far = {sunlight({3.0, 2.5, 1.5})};
    const std::vector<Light> all = {
        sunlight(),
        SunLight{glm::normalize(glm::dvec3(1.0, 2.0, 0.5)), {3.0, 2.5, 2.0}, 60.0},
        PointLight{{6.0, 5.0, 4.0}, {120.0, 90.0, 60.0}},
        SpotLight{{0.0, 9.0, 3.0}, glm::normalize(glm::dvec3(0.0, -3.0, -1.0)), {200.0, 250.0, 300.0}, 40.0, 0.5},
        SphereLight{{6.5, 6.5, 2.0}, 2.5, {14.0, 10.0, 6.0}},
        write_sky(sunset_map()),
        RectangleLight{{0.0, -6.0, 1.0}, {0.0, 0.0, 1.0}, {2.0, 0.0, 0.0}, {9.0, 6.0, 12.0}}};
    const bool many = GENERATE(false, true);
    const std::string integrator = GENERATE(as<std::string>(), "ratioTracking", "cachedRatioTracking", "ratioNEE",
                                            "deltaTracking", "regularTracking");
    if (!thorough() && integrator != (many ? "ratioNEE" : "cachedRatioTracking"))
        return;
    if (!many && integrator != "ratioTracking" && integrator != "cachedRatioTracking")
        return; // one light is what `many` has among others; these two have a way of their own for it
    const Volume cloud = medium(write_grid(cloud_grid()), 1.0, 0.7, 0.4);
    for (Scene scene : {rectangle({0.5, -3.0, 0.2}, {0.1, 1.0, 0.3}, {8.0, 6.0}, 2, 1 << 14),
                        at_points({{0.0, 0.0, 0.0}, {2.0, -1.0, 3.0}, {-9.0, 4.0, 0.0}}, 1 << 14)}) {
        scene.volumes = {cloud};
        scene.background = {0.05, 0.1, 0.15};
        scene.lights = many ? all : far;
        scene.settings.integrator = integrator;
        scene.settings.filter = Filter::trilinear;
        check_against_reference(scene, fmt::format("{}, {}, {} lights", projection_name(scene.camera.projection),
                                                   integrator, scene.lights.size()));
    }
}

TEST_CASE("flux among several media equals the reference's", "[gpu][image][flux][long]") {
    Scene scene = at_points({{0.0, 0.0, 0.0}, {2.0, -1.0, 1.0}}, 1 << 14);
    scene.volumes = {medium(write_grid(cloud_grid()), 1.0, 0.7, 0.4), medium(Sphere{{1.0, 0.0, 0.0}, 2.0}, 0.5, 0.9)};
    scene.lights = {sunlight(), SphereLight{{4.5, 5.5, 2.0}, 1.2, {14.0, 10.0, 6.0}}};
    check_against_reference(scene, "points in several media");
}

TEST_CASE("sensors of flux in scene files", "[cpu][xml][flux]") {
    const auto parse = [](const std::string& elements) {
        return parse_scene("<options><sphere/>" + elements + "</options>", "s.xml");
    };
    const Scene facing = parse(R"(<irradiance x="1" y="2" z="3" lookAt="1 5 3" width="4" height="2"/>)");
    CHECK(facing.camera.projection == Projection::irradiance);
    CHECK(facing.camera.size == glm::dvec2(4.0, 2.0));
    CHECK(facing.picture.width * facing.picture.height == 1);
    CHECK(glm::distance(-camera_rotation(facing.camera)[2], glm::dvec3(0.0, 1.0, 0.0)) < 1e-12);
    CHECK(parse(R"(<irradiance lookAt="0 1 0"/><width>7</width><height>3</height>)").picture.width == 7);
    // As a rectangle, nearly upwards too: its width along x.
    const Scene aslant = parse(R"(<irradiance lookAt="0.02 1 0"/><lights><rectangle lookAt="0.02 1 0"/></lights>)");
    const auto& rectangle = std::get<RectangleLight>(aslant.lights.at(0));
    const glm::dvec3 across = camera_rotation(aslant.camera)[0];
    CHECK(std::abs(std::abs(glm::dot(across, glm::normalize(rectangle.edge_u))) - 1.0) < 1e-12);
    CHECK(std::abs(across.x) > 0.99);
    const Scene points = parse("<fluence>0 1 2\n 3 4 5  6 7 8</fluence>");
    CHECK(points.camera.points == std::vector<glm::dvec3>{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}});
    CHECK(points.picture.width == 3);
    CHECK(points.picture.height == 1);
    CHECK(parse("<fluence>0 1 2 3 4 5 6 7 8 9 0 1</fluence><width>2</width>").picture.height == 2);
    CHECK(parse("<fluence>0 1 2 3 4 5 6 7 8 9 0 1</fluence><height>4</height>").picture.width == 1);
    const auto in_file = [&](const char* text) {
        return parse(fmt::format("<fluence file=\"{}\" baseDir=\"/\"/>", write_text(text).string().substr(1)));
    };
    CHECK(in_file("x, y, z\n1, 2, 3 # here\n\n4;5;6\r\n").camera.points ==
          std::vector<glm::dvec3>{{1, 2, 3}, {4, 5, 6}});
    CHECK_THROWS_WITH(in_file("1 2 3\nx y z\n"), Contains(":2: 'x' is no number"));
    CHECK_THROWS_WITH(in_file("1 2\n"), Contains(":1: has 2 numbers") && Contains("x y z"));
    CHECK_THROWS_WITH(in_file("1 2 1e12\n"), Contains(":1: 1e+12 is out of range"));
    CHECK_THROWS_WITH(in_file("x y z\n"), Contains("holds no points"));
    CHECK_THROWS_WITH(in_file("nan nan nan\n1 2 3\n"), Contains(":1: 'nan' is no number")); // no heading
    const std::pair<const char*, const char*> errors[] = {
        {R"(<irradiance/>)", "needs lookAt"},
        {R"(<irradiance lookAt="0 0 0"/>)", "is where the sensor is"},
        {R"(<irradiance lookAt="0 1 0" up="0 2 0"/>)", "is the direction that it faces"},
        {R"(<irradiance lookAt="0 1 0" width="0"/>)", "width"},
        {R"(<camera/><fluence>0 0 0</fluence>)", "a <fluence> beside the <camera> at s.xml:1:"},
        {"<fluence/>", "needs points"},
        {"<fluence file=\"a\">0 0 0</fluence>", "one of the two"},
        {"<fluence>0 0 0 1</fluence>", "has 4 numbers"},
        {"<fluence>0 0 x</fluence>", "'x'"},
        {"<fluence file=\"nowhere.csv\"/>", "nowhere.csv"},
        {"<fluence>0 0 0 1 1 1</fluence><width>3</width>", "do not fill rows of 3"},
        {"<fluence>0 0 0 1 1 1</fluence><width>2</width><height>2</height>", "do not fill rows of 2 by 2"},
        {"<fluence>0 0 0 1 1 1</fluence><width reference=\"9\">2</width>", "reference"}};
    for (const auto& [elements, message] : errors) {
        CAPTURE(elements);
        CHECK_THROWS_WITH(parse(elements), Contains(message));
    }
    Scene scene = points;
    CHECK_THROWS_WITH(resize_picture(scene, 9, std::nullopt), Contains("<fluence> has a pixel for each"));
    FieldCache fields;
    CHECK_THROWS_WITH(frame_medium(scene, fields), Contains("<fluence> reads flux where the scene has it"));
    CHECK(scene_hash(points) != scene_hash(parse("<fluence>0 1 2 3 4 5 6 7 8.5</fluence>")));
    CHECK(scene_hash(parse(R"(<irradiance lookAt="0 1 0"/>)")) !=
          scene_hash(parse(R"(<irradiance lookAt="0 1 0" width="2"/>)")));
}

TEST_CASE("films as tables", "[cpu][image_io][flux]") {
    Film film;
    film.picture_width = film.picture_height = 9;
    film.crop = {3, 5, 2, 3};
    film.mean = {{1.0f, 2.0f, 0.1f}, {4.0f, 5.0f, 6.0f}};
    film.variance = {{0.25f, 0.0f, 4.0f}, {0.0f, 0.0f, 0.0f}};
    film.samples = {7, 1};
    CHECK(film_table(film) == "column,row,R,G,B,standardError.R,standardError.G,standardError.B,samples\n"
                              "3,2,1,2,0.1,0.5,0,2,7\n"
                              "4,2,4,5,6,,,,1\n");
    film.places = {{0.1, 2.0, -3.0}, {1e10, 0.0, 0.0}};
    CHECK_THAT(film_table(film), Contains("column,row,x,y,z,R") && Contains("\n3,2,0.1,2,-3,1,2,0.1,"));
}
