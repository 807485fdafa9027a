// Cameras of every kind and filters of pixels, against the reference, which knows them by other formulas.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

#include "camera_rays.h"
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

void check_agreement(const Scene& scene, const std::string& name) {
    CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_reference(scene, 2), name));
}

} // namespace

TEST_CASE("lenses equal the reference's", "[gpu][image][sensors]") {
    Scene scene = glowing_cloud(25.0);
    scene.camera.lens = lens(3.0, 15.0);
    check_agreement(scene, "focused before the cloud");
    scene.camera.lens = lens(4.0, 60.0, 3, 20.0);
    check_agreement(scene, "a triangle, focused beyond");
    scene.camera.lens = lens(1.0, 25.0, 7);
    check_agreement(scene, "focused amid");
    scene = glowing_cloud(2000.0); // rays begin before the medium
    scene.camera.lens = lens(300.0, 1990.0, 5, -10.0);
    check_agreement(scene, "from afar");
}

TEST_CASE("other projections equal the reference's", "[gpu][image][sensors]") {
    Scene scene = glowing_cloud(25.0);
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = 9.0;
    scene.picture.reference_width = 30.0; // a part of the frame
    scene.picture.start_x = 4.0;
    check_agreement(scene, "orthographic");
    scene = glowing_cloud(1e5);
    scene.camera.projection = Projection::orthographic;
    check_agreement(scene, "orthographic, from afar");
    scene = glowing_cloud(2.0);
    scene.camera.projection = Projection::equirectangular;
    check_agreement(scene, "around a camera within");
}

TEST_CASE("filters of pixels equal the reference's", "[gpu][image][sensors]") {
    Scene scene = glowing_cloud(25.0);
    for (const PixelFilter filter :
         {PixelFilter::box, PixelFilter::tent, PixelFilter::gaussian, PixelFilter::blackman_harris}) {
        scene.settings.pixel_filter = filter;
        scene.settings.pixel_filter_radius = 2.5; // of 24 pixels
        check_agreement(scene, fmt::format("filter {}", int(filter)));
    }
}

TEST_CASE("quantiles of pixel filters", "[cpu][sensors]") {
    RenderSettings settings;
    CHECK(has_plain_pixels(settings));
    settings.pixel_filter_radius = 2.0;
    CHECK(!has_plain_pixels(settings));
    settings.pixel_filter = PixelFilter::tent;
    const std::vector<double> tent = filter_quantiles(settings, 64);
    REQUIRE(tent.size() == 65);
    // The part within x radii is 1 - (1 - x)^2. A step of the sum is 1 / 4096 wide, and the weight linear in it.
    for (int q = 0; q <= 64; ++q)
        CHECK(tent[q] == Approx(2.0 * (1.0 - std::sqrt(1.0 - q / 64.0))).margin(2.0 / 4096));
    settings.pixel_filter = PixelFilter::gaussian;
    CHECK(filter_quantiles(settings, 2)[1] ==
          Approx(2.0 / 3.0 * 0.6745).epsilon(0.01)); // the quartiles, cut at 3 deviations
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
