// Cameras of every kind and filters of pixels, against the reference, which knows them by other formulas.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "camera_rays.h"
#include "frame_params.h"
#include "framing.h"
#include "pixel_filter.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "tests/reference/camera.h"

using namespace vkvol;
using Catch::Contains;

namespace {

// A cloud that glows, and does not scatter: what blurs it is the camera.
Scene glowing_cloud(double distance) {
    Volume volume = medium(write_grid(cloud_grid()), 3.0, 0.0);
    volume.Le = {1.0, 0.7, 0.2};
    Scene scene = scene_of(volume, 11.0, 24, distance, glm::dvec3(0.0), {10.0, 25.0, -5.0});
    scene.background = {0.1, 0.2, 0.4};
    scene.settings.spp = 192;
    return scene;
}

Lens lens(double radius, double focus, int blades = 0, double rotation = 0.0) {
    Lens lens;
    lens.radius = radius;
    lens.focus = focus;
    lens.blades = blades;
    lens.rotation = rotation;
    return lens;
}

// The part of a filter within x radii of the middle, x in [0, 1].
double part_within(PixelFilter filter, double x) {
    const double pi = std::numbers::pi;
    switch (filter) {
    case PixelFilter::tent:
        return 1.0 - (1.0 - x) * (1.0 - x);
    case PixelFilter::gaussian:
        return std::erf(3.0 * x / std::sqrt(2.0)) / std::erf(3.0 / std::sqrt(2.0));
    case PixelFilter::blackman_harris:
        return x + (0.48829 * std::sin(pi * x) + 0.14128 / 2.0 * std::sin(2.0 * pi * x) +
                    0.01168 / 3.0 * std::sin(3.0 * pi * x)) /
                       (0.35875 * pi);
    default:
        return x;
    }
}

constexpr PixelFilter all_filters[] = {PixelFilter::box, PixelFilter::tent, PixelFilter::gaussian,
                                       PixelFilter::blackman_harris};

// What kernels draw from quantiles, as part_within: `part` by linear interpolation between nodes, which are even in
// 1 - sqrt(1 - part). It rises from node to node just as the filter's own, so that between two they differ by no more
// than that rise.
struct Drawn {
    double part, rise;
};

Drawn drawn_within(const RenderSettings& settings, double x) {
    const std::vector<double> nodes = filter_quantiles(settings, FILTER_QUANTILES);
    const double place = x * settings.pixel_filter_radius;
    int i = 0;
    while (i + 2 < int(nodes.size()) && nodes[i + 1] < place)
        ++i;
    const auto part = [](double node) { return 1.0 - std::pow(1.0 - node / FILTER_QUANTILES, 2.0); };
    return {part(i + (place - nodes[i]) / (nodes[i + 1] - nodes[i])), part(i + 1) - part(i)};
}

} // namespace

TEST_CASE("lenses equal the reference's", "[gpu][image][sensors][long]") {
    Scene scene = glowing_cloud(25.0);
    scene.camera.lens = lens(3.0, 15.0);
    check_against_reference(scene, "focused before the cloud");
    scene.camera.lens = lens(4.0, 60.0, 3, 20.0);
    check_against_reference(scene, "a triangle, focused beyond");
    scene.camera.lens = lens(1.0, 25.0, 7);
    check_against_reference(scene, "focused amid");
    scene = glowing_cloud(2000.0); // rays begin before the medium
    scene.camera.lens = lens(300.0, 1990.0, 5, -10.0);
    check_against_reference(scene, "from afar");
}

TEST_CASE("other projections equal the reference's", "[gpu][image][sensors][long]") {
    Scene scene = glowing_cloud(25.0);
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = 9.0;
    scene.picture.reference_width = 30.0; // a part of the frame
    scene.picture.start_x = 4.0;
    check_against_reference(scene, "orthographic");
    scene = glowing_cloud(1e5);
    scene.camera.projection = Projection::orthographic;
    check_against_reference(scene, "orthographic, from afar");
    scene = glowing_cloud(2.0);
    scene.camera.projection = Projection::equirectangular;
    check_against_reference(scene, "around a camera within");
}

TEST_CASE("filters of pixels equal the reference's", "[gpu][image][sensors][long]") {
    Scene scene = glowing_cloud(25.0);
    for (const PixelFilter filter : all_filters) {
        scene.settings.pixel_filter = filter;
        scene.settings.pixel_filter_radius = 2.5; // of 24 pixels
        check_against_reference(scene, fmt::format("filter {}", int(filter)));
    }
}

TEST_CASE("quantiles of pixel filters", "[cpu][sensors]") {
    RenderSettings settings;
    CHECK(has_plain_pixels(settings));
    settings.pixel_filter_radius = 2.0;
    CHECK(!has_plain_pixels(settings));
    for (const PixelFilter filter : all_filters) {
        settings.pixel_filter = filter;
        const std::vector<double> nodes = filter_quantiles(settings, 64);
        REQUIRE(nodes.size() == 65);
        CHECK(nodes.back() == 2.0);
        // Midpoints of steps h = 1 / 4096 of a weight w of integral W err by h^2 w'' / 24 W, lines across a step by h^2
        // w' / 8 W. Blackman and Harris's have the largest: |w''| < 11.4, |w'| < 2.6, W = 0.359, which makes 1.3e-7.
        for (int i = 0; i <= 64; ++i)
            CHECK(part_within(filter, nodes[i] / 2.0) == Approx(1.0 - std::pow(1.0 - i / 64.0, 2.0)).margin(2e-7));
    }
}

TEST_CASE("what is drawn between quantiles is as much as the filter has there", "[cpu][sensors]") {
    RenderSettings settings;
    settings.pixel_filter_radius = 1.5;
    for (const PixelFilter filter : all_filters) {
        settings.pixel_filter = filter;
        for (double x = 0.0125; x < 1.0; x += 0.0125) {
            const Drawn drawn = drawn_within(settings, x);
            CAPTURE(int(filter), x, part_within(filter, x));
            CHECK(drawn.part == Approx(part_within(filter, x)).margin(drawn.rise + 2e-7));
        }
        CHECK(drawn_within(settings, 0.9999).rise < 0.00025); // the tail's, which is to be fine
    }
}

TEST_CASE("samples lie where the filter of their pixel has them", "[gpu][sensors]") {
    // A column of pixels of one world unit, before a strip that glows and lets nothing through.
    Scene scene;
    scene.camera.projection = Projection::orthographic;
    scene.camera.position = {0.0, 0.0, 10.0};
    scene.camera.view_height = 64.0;
    scene.picture = {1, 64, 0.0, 0.0, 1.0, 64.0};
    scene.settings.spp = 2048;
    scene.settings.pixel_filter_radius = 8.0;
    const double samples = 64.0 * scene.settings.spp;
    const std::pair<double, double> strips[] = {{0.2, 0.5}, {0.5, 0.9}, {0.9, 1.0}}; // radii
    for (const PixelFilter filter : all_filters)
        for (const auto& [low, high] : strips) {
            scene.settings.pixel_filter = filter;
            const Box strip{{4.0 * (low + high), 0.0, 0.0}, {8.0 * (high - low), 1000.0, 1.0}};
            scene.volumes = {medium(strip, 1e4, 0.0)};
            scene.volumes.front().Le = Rgb(1.0);
            // On one side of the middle. Five deviations of the number of samples, and what interpolation may err.
            const double part = 0.5 * (part_within(filter, high) - part_within(filter, low));
            const double rise =
                filter == PixelFilter::box
                    ? 0.0
                    : 0.5 * (drawn_within(scene.settings, low).rise + drawn_within(scene.settings, high).rise);
            CAPTURE(int(filter), low);
            CHECK(mean_of(render_here(scene, 1).film) == Approx(part).margin(5.0 * std::sqrt(part / samples) + rise));
        }
}

TEST_CASE("angles that go around many times are those of the last turn", "[cpu][sensors]") {
    const auto sensor = [](const Scene& scene) {
        return make_frame(scene, {}, choose_method(scene), {0, 1, 0, 1}, 1).sensors[0];
    };
    Scene scene;
    scene.camera.lens = lens(1.0, 10.0, 5, 20.0 + 1e9 * 72.0); // of five blades, every 72 degrees is a turn
    CHECK(sensor(scene).blade_rotation == Approx(glm::radians(20.0)).epsilon(1e-6));
    scene.camera.lens = {};
    scene.camera.projection = Projection::equirectangular;
    scene.picture = {400, 200, 100.0 - 1e6 * 400.0, 50.0, 400.0, 200.0};
    // In double precision 2e6 pi radians are known to 1e-9.
    CHECK(sensor(scene).first_angle.x == Approx(-std::numbers::pi / 2.0).epsilon(1e-6));
    CHECK(sensor(scene).first_angle.y == Approx(std::numbers::pi / 4.0).epsilon(1e-6));
}

// What is twice as far as what is sharp is seen as far from the axis as its ray's point of the lens, on the other side.
// Of a triangle whose corner is along an axis ((1 - x) / 1.5)^2 is beyond x, and 1 - that is before.
TEST_CASE("light comes through the whole aperture, and no more", "[gpu][sensors]") {
    const auto lit = [](double rotation, glm::dvec3 along, double edge, int blades) { // part of the lens
        Scene scene;
        scene.camera.position = {0.0, 0.0, 10.0};
        scene.camera.fov = 0.001;
        scene.camera.lens = lens(1.0, 5.0, blades, rotation);
        scene.picture = {8, 8, 0.0, 0.0, 8.0, 8.0};
        scene.surfaces.emplace_back().shape =
            RectangleSurface{(edge + 50.0) * along, 50.0 * along, 50.0 * glm::cross({0.0, 0.0, 1.0}, along)};
        scene.surfaces.back().emission = Rgb(1.0);
        scene.settings.spp = 4096;
        return double(mean_of(render_here(scene, 1).film));
    };
    const glm::dvec3 right(1.0, 0.0, 0.0), up(0.0, 1.0, 0.0);
    const double samples = 64.0 * 4096.0, error = 5.0 * 0.5 / std::sqrt(samples);
    const auto beyond = [](double x) { return (1.0 - x) * (1.0 - x) / 2.25; };
    CHECK(lit(0.0, right, 0.25, 3) == Approx(1.0 - beyond(-0.25)).margin(error));
    CHECK(lit(0.0, right, -0.25, 3) == Approx(1.0 - beyond(0.25)).margin(error));
    CHECK(lit(0.0, right, 0.51, 3) == 0.0);
    CHECK(lit(180.0, right, 0.25, 3) == Approx(beyond(0.25)).margin(error));
    CHECK(lit(300.0, right, 0.25, 3) == Approx(beyond(0.25)).margin(error)); // a third of a turn on
    CHECK(lit(90.0, up, -0.25, 3) == Approx(1.0 - beyond(0.25)).margin(error));
    CHECK(lit(0.0, up, 0.0, 4) == Approx(0.5).margin(error));
    CHECK(lit(45.0, right, 0.70, 4) == Approx(0.5 - 0.7 * std::sqrt(0.5)).margin(error)); // a square's side is at 0.707
    CHECK(lit(0.0, right, 0.5, 0) ==
          Approx(0.1955011).margin(error)); // the circle's cap: (acos x - x sqrt(1 - x^2)) / pi
}

TEST_CASE("rays of the host are the reference's", "[cpu][sensors]") {
    const Picture picture{120, 80, 13.0, -7.0, 200.0, 100.0};
    Camera camera;
    camera.position = {1.0, -2.0, 3.0};
    camera.pitch = 20.0;
    camera.yaw = -50.0;
    camera.roll = 10.0;
    camera.view_height = 7.0;
    for (const Projection projection :
         {Projection::perspective, Projection::orthographic, Projection::equirectangular}) {
        camera.projection = projection;
        const CameraRays rays = camera_rays(camera, picture);
        for (const glm::dvec2 p : {glm::dvec2(0, 0), glm::dvec2(120, 80), glm::dvec2(31.25, 66.5)}) {
            const reference::Ray ray = reference::camera_ray(camera, picture, p.x, p.y);
            CHECK(glm::distance(rays.origin(p.x, p.y), ray.origin) < 1e-12);
            CHECK(glm::distance(glm::normalize(rays.direction(p.x, p.y)), ray.direction) < 1e-12);
        }
    }
}

TEST_CASE("an orthographic view is framed by its height", "[cpu][sensors]") {
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.pitch = -20.0;
    camera.yaw = 30.0;
    const Picture picture{150, 80, 20.0, 5.0, 200.0, 100.0};
    Corners corners;
    for (int i = 0; i < 8; ++i)
        corners[i] = glm::mix(glm::dvec3(90, 1, -5), glm::dvec3(97, 4, 2), glm::dvec3(i & 1, i >> 1 & 1, i >> 2));
    frame(camera, picture, corners);
    const CameraRays rays = camera_rays(camera, picture);
    const glm::dmat3 to_picture = glm::inverse(glm::dmat3(rays.right, rays.down, rays.forward));
    glm::dvec3 low(1e9), high(-1e9);
    for (const glm::dvec3& corner : corners) {
        const glm::dvec3 seen = to_picture * (corner - rays.origin(0, 0));
        low = glm::min(low, seen);
        high = glm::max(high, seen);
    }
    CHECK(low.z > 0.0);
    CHECK(low.x + high.x == Approx(150.0));
    CHECK(low.y + high.y == Approx(80.0));
    CHECK(std::max((high.x - low.x) / 150.0, (high.y - low.y) / 80.0) == Approx(0.94));
}

TEST_CASE("sensors in scene files", "[cpu][xml][sensors]") {
    const auto parse = [](const std::string& elements) {
        return parse_scene("<options><sphere/>" + elements + "</options>", "s.xml");
    };
    const Camera lens = parse(R"(<camera z="8" lookAt="0 0 2" lensRadius=".5" blades="6" bladeRotation="15"/>)").camera;
    CHECK(lens.lens.radius == 0.5);
    CHECK(lens.lens.focus == Approx(6.0));
    CHECK(lens.lens.blades == 6);
    CHECK(lens.lens.rotation == 15.0);
    CHECK(parse(R"(<camera lensRadius=".5" focus="3"/>)").camera.lens.focus == 3.0);
    const Camera flat = parse(R"(<camera projection="orthographic" viewHeight="3"/>)").camera;
    CHECK(flat.projection == Projection::orthographic);
    CHECK(flat.view_height == 3.0);
    CHECK(parse(R"(<camera projection="equirectangular"/>)").camera.projection == Projection::equirectangular);
    const Scene filtered = parse(R"(<pixelFilter radius="2">gaussian</pixelFilter>)");
    CHECK(filtered.settings.pixel_filter == PixelFilter::gaussian);
    CHECK(filtered.settings.pixel_filter_radius == 2.0);
    CHECK(parse("<pixelFilter>tent</pixelFilter>").settings.pixel_filter_radius == 1.0);

    CHECK_THAT(parse(R"(<camera blades="5"/>)").warnings.front(), Contains("add lensRadius"));
    const std::pair<const char*, const char*> errors[] = {
        {R"(<camera lensRadius="1"/>)", "what is sharp?"},
        {R"(<camera lensRadius="1" focus="0"/>)", "focus"},
        {R"(<camera lensRadius="1" focus=".0009"/>)", "raise focus"},
        {R"(<camera lensRadius="1" focus="2" blades="2"/>)", "no aperture"},
        {R"(<camera projection="fisheye"/>)", "'fisheye' is unknown"},
        {R"(<camera projection="orthographic" fov="30"/>)", "viewHeight says"},
        {R"(<camera projection="equirectangular" lensRadius="1"/>)", "only perspective cameras"},
        {R"(<camera viewHeight="3"/>)", "fov says"},
        {R"(<camera projection="equirectangular" viewHeight="3"/>)", "all directions are in view"},
        {"<pixelFilter>sinc</pixelFilter>", "unknown pixelFilter 'sinc'"},
        {R"(<pixelFilter radius="0">box</pixelFilter>)", "radius"}};
    for (const auto& [elements, message] : errors)
        CHECK_THROWS_WITH(parse(elements), Contains(message) && Contains("s.xml:1:"));
}
