// Cameras of pbrt-v4: where a point of its world is seen. What pbrt itself would do is written out here from its book
// and manual (Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th edition; pbrt.org/fileformat-v4).
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "pbrt_scenes.h"
#include "tests/reference/camera.h"

using namespace vkvol;

namespace {

// Where on the picture a point of this renderer's world is seen, in pixels.
glm::dvec2 pixel_here(const Scene& scene, const glm::dvec3& point) {
    const Picture& picture = scene.picture;
    const auto ray = [&](double x, double y) { return reference::camera_ray(scene.camera, picture, x, y).direction; };
    const glm::dvec3 a = ray(0, 0), b = ray(picture.width, 0), c = ray(0, picture.height);
    const glm::dvec3 middle = reference::camera_ray(scene.camera, {2, 2, 0.0, 0.0, 2.0, 2.0}, 1, 1).direction; // ahead
    const auto flat = [&](const glm::dvec3& d) { return d / glm::dot(d, middle); };
    const glm::dvec3 corner = flat(a), right = flat(b) - corner, down = flat(c) - corner;
    const glm::dvec3 there = flat(point - scene.camera.position) - corner;
    return {picture.width * glm::dot(there, right) / glm::dot(right, right),
            picture.height * glm::dot(there, down) / glm::dot(down, down)};
}

glm::dmat4 pbrt_look_at(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up) {
    const glm::dvec3 z = glm::normalize(target - eye), x = glm::normalize(glm::cross(up, z)), y = glm::cross(z, x);
    glm::dmat4 to_camera(1.0);
    for (int i = 0; i < 3; ++i) {
        to_camera[i] = {x[i], y[i], z[i], 0.0};
        to_camera[3][i] = -glm::dot(i == 0 ? x : i == 1 ? y : z, eye);
    }
    return to_camera;
}

} // namespace

TEST_CASE("pbrt's cameras see every point where pbrt sees it", "[cpu][pbrt]") {
    std::mt19937 rng(4);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int i = 0; i < 60; ++i) {
        const auto vector = [&] { return glm::dvec3(any(rng), any(rng), any(rng)); };
        const glm::dvec3 eye = 5.0 * vector(), target = vector(), up = glm::dvec3(0, 1, 0) + 0.4 * vector();
        const glm::dvec3 axis = vector();
        const double angle = 180.0 * any(rng), size = i % 3 == 0 ? 0.1 + std::abs(any(rng)) : 1.0;
        const bool mirrors = i % 2 == 0, has_window = i % 5 == 0, has_crop = i % 4 == 0, has_map = i % 7 < 3;
        const int width = 60 + i, height = 150 - 2 * i; // wide and high
        const double fov = 20.0 + i;
        const glm::dvec3 scale(mirrors ? -size : size, size, size);
        std::string text = fmt::format("Scale {} {} {}\nRotate {} {} {} {}\nLookAt {} {} {} {} {} {} {} {} {}\n",
                                       scale.x, scale.y, scale.z, angle, axis.x, axis.y, axis.z, eye.x, eye.y, eye.z,
                                       target.x, target.y, target.z, up.x, up.y, up.z);
        const glm::dmat4 to_camera = glm::scale(glm::dmat4(1.0), scale) *
                                     glm::rotate(glm::dmat4(1.0), glm::radians(angle), glm::normalize(axis)) *
                                     pbrt_look_at(eye, target, up);

        const double aspect = double(width) / height;
        glm::dvec4 screen =
            aspect > 1.0 ? glm::dvec4(-aspect, aspect, -1.0, 1.0) : glm::dvec4(-1.0, 1.0, -1.0 / aspect, 1.0 / aspect);
        if (has_window)
            screen = 0.7 * screen + glm::dvec4(0.3, 0.3, -0.2, -0.2);
        text += fmt::format("Camera \"perspective\" \"float fov\" [ {} ]", fov);
        if (has_window)
            text += fmt::format(" \"float screenwindow\" [ {} {} {} {} ]", screen[0], screen[1], screen[2], screen[3]);
        text += fmt::format("\nFilm \"rgb\" \"integer xresolution\" {} \"integer yresolution\" {}", width, height);
        const int left = has_crop ? width / 4 : 0, top = has_crop ? height / 3 : 0;
        if (has_crop)
            text += fmt::format(" \"integer pixelbounds\" [ {} {} {} {} ]", left, width - 3, top, height - 5);
        // Before the camera, whatever that does to the size of things.
        const glm::dvec3 there = glm::dvec3(glm::inverse(to_camera) * glm::dvec4(any(rng), any(rng), 4.0, 1.0));
        text += fmt::format("\nWorldBegin\nLightSource \"point\" \"point3 from\" [ {} {} {} ]\n", there.x, there.y,
                            there.z);
        if (has_map)
            text += fmt::format("Rotate {} {} {} {}\nLightSource \"infinite\" \"string filename\" \"sky.exr\"\n",
                                2 * angle, axis.y, axis.x, axis.z);
        const Scene scene = scene_of(text);
        CAPTURE(text);

        const glm::dvec3 p = glm::dvec3(to_camera * glm::dvec4(there, 1.0));
        const glm::dvec2 s = glm::dvec2(p) / p.z / std::tan(0.5 * glm::radians(fov));
        const glm::dvec2 pbrt((s.x - screen[0]) / (screen[1] - screen[0]) * width - left,
                              (screen[3] - s.y) / (screen[3] - screen[2]) * height - top);
        const glm::dvec2 here = pixel_here(scene, std::get<PointLight>(scene.lights[0]).position);
        CHECK(here.x == Approx(pbrt.x).epsilon(1e-6).margin(1e-6));
        CHECK(here.y == Approx(pbrt.y).epsilon(1e-6).margin(1e-6));
        CHECK(glm::distance(scene.camera.position, std::get<PointLight>(scene.lights[0]).position) ==
              Approx(glm::length(p) / size));
        CHECK(scene.picture.width == (has_crop ? width - 3 - left : width));
    }
}

TEST_CASE("pbrt's other cameras, lenses and films", "[cpu][pbrt]") {
    const Scene scene = scene_of(R"(Scale 2 2 2
        Camera "perspective" "float lensradius" 0.25 "float focaldistance" 8 "float shutterclose" 0.5
        Film "rgb" "float iso" 400 "integer xresolution" 30 "integer yresolution" 20
        PixelFilter "triangle" "float xradius" 1 "float yradius" 1
        Sampler "stratified" "integer xsamples" 5 "integer ysamples" 3
        Integrator "path" "integer maxdepth" 7
        WorldBegin LightSource "infinite" "rgb L" [ 1 2 3 ])");
    CHECK(scene.camera.lens.radius == Approx(0.125)); // of the world
    CHECK(scene.camera.lens.focus == Approx(4.0));
    CHECK(near(scene.background, {2, 4, 6})); // by half a second at ISO 400
    CHECK(scene.settings.pixel_filter == PixelFilter::tent);
    CHECK(scene.settings.pixel_filter_radius == 1.0);
    CHECK(scene.settings.spp == 15);
    CHECK(scene.settings.max_depth == 7u);
    CHECK(scene.warnings.empty());

    const Scene flat = scene_of(R"(Scale 2 2 2 Camera "orthographic" "float screenwindow" [ -3 3 -2 2 ]
        Film "rgb" "integer xresolution" 30 "integer yresolution" 20 WorldBegin)");
    CHECK(flat.camera.projection == Projection::orthographic);
    CHECK(flat.camera.view_height == Approx(2.0));

    // As pbrt leaves it: 1280 by 720, 16 samples, five scatterings, a Gaussian.
    const Scene usual = scene_of("WorldBegin");
    CHECK((usual.picture.width == 1280 && usual.picture.height == 720));
    CHECK((usual.settings.spp == 16 && usual.settings.max_depth == 5u));
    CHECK((usual.settings.pixel_filter == PixelFilter::gaussian && usual.settings.pixel_filter_radius == 1.5));
    CHECK(usual.camera.fov == Approx(90.0)); // of the shorter edge
}

TEST_CASE("pbrt's spherical pictures go round as pbrt's do", "[cpu][pbrt]") {
    // Camera space, x right, y up, z ahead: column c of n shows (cos a, y, sin a), a = 2 pi c / n.
    for (const char* mirror : {"", "Scale -1 1 1 "})
        for (const double column : {10.0, 37.0, 81.0}) {
            const double a = 2.0 * std::numbers::pi * column / 100.0;
            const glm::dvec3 seen(std::cos(a), 0.3, std::sin(a));
            const Scene scene = scene_of(
                fmt::format("{}Camera \"spherical\" \"string mapping\" \"equirectangular\"\nFilm \"rgb\" \"integer "
                            "xresolution\" 100 "
                            "\"integer yresolution\" 50\nWorldBegin LightSource \"point\" \"point3 from\" [ {} {} {} ]",
                            mirror, *mirror ? -seen.x : seen.x, seen.y, seen.z));
            const glm::dvec3 there = only_light<PointLight>(scene).position - scene.camera.position;
            const auto ray = reference::camera_ray(scene.camera, scene.picture, column,
                                                   50.0 * std::acos(0.3 / glm::length(seen)) / std::numbers::pi);
            CAPTURE(mirror, column);
            CHECK(near(ray.direction, glm::normalize(there), 1e-6));
        }
}
