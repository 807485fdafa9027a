// Cameras that look at a point, and cameras moved to frame a box. What they see is asked of the reference, which has
// turns of its own.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <random>

#include "camera_view.h"
#include "framing.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "tests/reference/camera.h"

using namespace vkvol;
using Catch::Contains;

namespace {

const Picture square{200, 200, 0.0, 0.0, 200.0, 200.0};

glm::dvec3 middle_ray(const Camera& camera) {
    return reference::camera_ray(camera, square, 100, 100).direction;
}

// Where on the picture a point of the world is seen: 0..1 from left to right and from top to bottom.
glm::dvec2 seen(const Camera& camera, const Picture& picture, glm::dvec3 point) {
    const auto at_depth_1 = [&](glm::dvec3 direction) { return direction / glm::dot(direction, middle_ray(camera)); };
    const auto ray = [&](double x, double y) {
        return at_depth_1(reference::camera_ray(camera, picture, x, y).direction);
    };
    const glm::dvec3 corner = ray(0, 0), right = ray(picture.width, 0) - corner, down = ray(0, picture.height) - corner;
    const glm::dvec3 there = at_depth_1(point - camera.position) - corner;
    return {glm::dot(there, right) / glm::dot(right, right), glm::dot(there, down) / glm::dot(down, down)};
}

bool in_front(const Camera& camera, glm::dvec3 point) {
    return glm::dot(middle_ray(camera), point - camera.position) > 0.0;
}

bool same(glm::dvec3 a, glm::dvec3 b) {
    return glm::distance(a, b) < 1e-12;
}

Camera camera_of(const std::string& attributes) {
    return parse("<sphere/><camera " + attributes + "/>").camera;
}

} // namespace

TEST_CASE("a camera looks at lookAt, with up upwards", "[cpu][xml]") {
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> any(-10.0, 10.0);
    const auto vector = [&] { return glm::dvec3(any(engine), any(engine), any(engine)); };
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 eye = vector(), target = vector(), up = i % 3 ? vector() : glm::dvec3(0, 1, 0);
        const Camera camera = camera_of(fmt::format("x='{}' y='{}' z='{}' lookAt='{} {} {}' up='{} {} {}'", eye.x,
                                                    eye.y, eye.z, target.x, target.y, target.z, up.x, up.y, up.z));
        CHECK(same(middle_ray(camera), glm::normalize(target - eye)));
        const glm::dvec2 above = seen(camera, square, target + 0.1 * up);
        CHECK(std::abs(above.x - 0.5) < 1e-9);
        CHECK(above.y < 0.5);
    }
}

TEST_CASE("looking along the x axis costs no accuracy", "[cpu][xml]") {
    for (const double aside : {0.0, 1e-14, 1e-9, 1e-6}) {
        Camera camera;
        const glm::dvec3 forward = glm::normalize(glm::dvec3(-1.0, aside, -2.0 * aside)), up(0.0, 0.6, 0.8);
        look_along(camera, forward, up);
        CHECK(same(middle_ray(camera), forward));
        CHECK(same(camera_rotation(camera)[0], glm::normalize(glm::cross(forward, up))));
    }
}

TEST_CASE("an orbit: azimuth counter-clockwise from above, elevation upwards", "[cpu][xml]") {
    const std::string orbit = "lookAt='1 2 3' distance='10' ";
    CHECK(same(camera_of(orbit).position, {1, 2, 13}));
    CHECK(same(camera_of(orbit + "azimuth='90'").position, {11, 2, 3}));
    CHECK(same(camera_of(orbit + "azimuth='-90'").position, {-9, 2, 3}));
    CHECK(same(camera_of(orbit + "elevation='90'").position, {1, 12, 3}));
    CHECK(same(camera_of(orbit + "azimuth='30' elevation='-30'").position,
               {1.0 + 10.0 * std::sqrt(0.75) * 0.5, -3.0, 3.0 + 10.0 * 0.75}));
    for (const char* up : {"0 1 0", "0 0 1", "0 -2 0", "1 2 3"})
        for (const char* angles : {"", "azimuth='123' elevation='45'", "azimuth='720'", "elevation='-90'"}) {
            const Camera camera = camera_of(orbit + angles + " up='" + up + "'");
            CAPTURE(up, angles);
            CHECK(same(middle_ray(camera), 0.1 * (glm::dvec3(1, 2, 3) - camera.position)));
        }
    // z up: as with y up, all turned.
    CHECK(same(camera_of(orbit + "up='0 0 1'").position, {1, -8, 3}));
    CHECK(same(camera_of(orbit + "azimuth='90' up='0 0 1'").position, {11, 2, 3}));
    CHECK(same(camera_of(orbit + "elevation='90' up='0 0 1'").position, {1, 2, 13}));
    CHECK(seen(camera_of(orbit + "up='0 0 1'"), square, {1, 2, 4}).y < 0.49);
    // The same camera in plain words.
    const Camera plain = camera_of(orbit + "azimuth='30' elevation='20'");
    CHECK(plain.yaw == 30.0);
    CHECK(plain.pitch == -20.0);
    CHECK(plain.roll == 0.0);
}

TEST_CASE("what a camera is told twice, or half, is an error with a remedy", "[cpu][xml]") {
    const auto wrong = [](const std::string& attributes) { return error_of("<camera " + attributes + "/>"); };
    CHECK(wrong("lookAt='0 0 0' z='5' pitch='3'") ==
          "s.xml:2:30: <camera> pitch: lookAt turns the camera already; remove one of them (up=\"x y z\" tilts the "
          "picture)");
    CHECK_THAT(wrong("distance='3'"), Contains("beside lookAt only"));
    CHECK_THAT(wrong("up='0 1 0' yaw='3'"), Contains("<camera> up: has a meaning beside lookAt only"));
    CHECK_THAT(wrong("lookAt='0 0 0' x='1' distance='3'"), Contains("keep either x, y, z or distance"));
    CHECK_THAT(wrong("lookAt='0 0 0' azimuth='3'"), Contains("add distance"));
    CHECK_THAT(wrong("lookAt='0 0' z='1'"), Contains("three numbers"));
    CHECK_THAT(wrong("lookAt='0 zero 0' z='1'"), Contains("zero"));
    CHECK_THAT(wrong("lookAt='1 2 3' x='1' y='2' z='3'"), Contains("is where the camera is"));
    CHECK_THAT(wrong("lookAt='0 0 0' y='3'"), Contains("give another up"));
    CHECK_THAT(wrong("lookAt='0 0 0' x='3' up='2 0 0'"), Contains("give another up"));
    CHECK_THAT(wrong("lookAt='0 0 0' x='3' up='0 0 0'"), Contains("no direction"));
    CHECK_THAT(wrong("lookAt='0 0 0' distance='3' elevation='91'"), Contains("-90 to 90"));
    CHECK_THAT(wrong("lookAt='0 0 0' distance='0'"), Contains("distance"));
}

TEST_CASE("a framed box fills the picture and is all in it", "[cpu][xml]") {
    std::mt19937 engine(2);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 low = 1000.0 * glm::dvec3(any(engine), any(engine), any(engine));
        const glm::dvec3 size = glm::abs(glm::dvec3(any(engine), any(engine), any(engine))) + 1e-3;
        Corners corners;
        for (int k = 0; k < 8; ++k)
            corners[k] = low + size * glm::dvec3(k & 1, k >> 1 & 1, k >> 2);
        Camera camera;
        camera.pitch = 180.0 * any(engine);
        camera.yaw = 180.0 * any(engine);
        camera.roll = i % 2 ? 180.0 * any(engine) : 0.0;
        camera.fov = i % 5 ? 20.0 + 19.0 * any(engine) : 170.0;
        Picture picture{320, 200, 0.0, 0.0, 320.0, 200.0};
        if (i % 3 == 0)
            picture = {90, 160, 30.0, -20.0, 640.0, 400.0}; // a window aside of the axis
        const glm::dvec3 before = middle_ray(camera);
        frame(camera, picture, corners);
        CHECK(same(middle_ray(camera), before));
        glm::dvec2 least(1.0), most(0.0);
        for (const glm::dvec3& corner : corners) {
            REQUIRE(in_front(camera, corner));
            least = glm::min(least, seen(camera, picture, corner));
            most = glm::max(most, seen(camera, picture, corner));
        }
        CAPTURE(i, least.x, least.y, most.x, most.y);
        CHECK(glm::all(glm::greaterThan(least, glm::dvec2(0.03 - 1e-6))));
        CHECK(glm::all(glm::lessThan(most, glm::dvec2(0.97 + 1e-6))));
        // It touches two opposite borders; between the other two it is in the middle, as perspective has it. A wide
        // view stays away from the box.
        const glm::dvec2 extent = most - least;
        if (camera.fov < 60.0)
            CHECK(std::max(extent.x, extent.y) == Approx(0.94).margin(1e-6));
    }
}

TEST_CASE("what a lens has sharp is so from where the medium is framed", "[cpu][xml]") {
    const char* ball = "<sphere x='3' y='1' z='-20' radius='2'/>";
    FieldCache fields;
    Scene scene = parse(fmt::format("{}<camera x='1' y='2' z='30' lookAt='3 1 -20' lensRadius='.5'/>", ball));
    frame_medium(scene, fields);
    CHECK(glm::dot(glm::dvec3(3, 1, -20) - scene.camera.position, middle_ray(scene.camera)) ==
          Approx(scene.camera.lens.focus));
    CHECK(scene.camera.lens.focus < 10.0); // nearer than before
    scene =
        parse(fmt::format("{}<camera z='30' lensRadius='.5' focus='4'/>", ball)); // before the ball, far behind the eye
    CHECK_THROWS_WITH(frame_medium(scene, fields), Contains("behind it; raise <camera> focus, or give lookAt"));
    scene = parse(fmt::format("{}<camera z='30' focus='4'/>", ball)); // of a pinhole nothing is sharp, or everything
    frame_medium(scene, fields);
    CHECK(scene.camera.lens.focus == 0.0);
}

TEST_CASE("each kind of medium is framed by its box", "[cpu][xml]") {
    FieldCache fields;
    const auto corners = [&](const char* shape) { return *medium_corners(parse(shape), fields); };
    CHECK(same(middle_of(corners("<sphere x='1' y='2' z='3' radius='4'/>")), {1, 2, 3}));
    CHECK(diagonal_of(corners("<sphere radius='4'/>")) == Approx(8.0 * std::sqrt(3.0)));
    CHECK(diagonal_of(corners("<box width='3' height='4' depth='12'/>")) == Approx(13.0));
    // Corners are as high as the layers that a shape holds; what holds nothing has none.
    CHECK(diagonal_of(corners("<box y='500' width='3' height='1000' depth='4'/><layers><layer height='0' sigma_t='1'/>"
                              "<layer height='12' sigma_t='0'/></layers>")) == Approx(13.0));
    CHECK_FALSE(medium_corners(parse("<sphere/><sigma_a>0</sigma_a><sigma_s>0</sigma_s>"), fields));
    CHECK_FALSE(medium_corners(parse("<camera/>"), fields));
    Scene nothing = parse("<camera/>");
    CHECK_THROWS_WITH(frame_medium(nothing, fields), Contains("no medium to frame"));
}

TEST_CASE("surfaces are framed where there are no media", "[cpu][camera][xml]") {
    FieldCache fields;
    const std::string media = R"(<sphere x="3" radius="2"/><camera z="90"/>)",
                      surfaces = R"(<surfaces><sphere x="3" radius="2"/></surfaces><camera z="90"/>)";
    Scene medium = parse(media), surface = parse(surfaces);
    frame_medium(medium, fields);
    frame_medium(surface, fields);
    CHECK(surface.camera.position.z < 20.0);
    CHECK(surface.camera.position == medium.camera.position);
    Scene floor = parse(R"(<surfaces><plane/></surfaces><camera y="2"/>)");
    CHECK_THROWS_WITH(frame_medium(floor, fields), Contains("no surface but planes"));
}

TEST_CASE("a scene without a camera gets one that frames all its media", "[cpu][camera][xml]") {
    const std::string media = R"(<sphere x="40"/><volumes><volume><box y="-9" width="4"/></volume></volumes>)";
    const auto parse = [](const std::string& elements) {
        return parse_scene("<options>" + elements + "</options>", "s.xml");
    };
    FieldCache fields;
    Scene scene = parse(media);
    CHECK(!scene.has_camera);
    const std::string line = give_camera(scene, fields);
    CHECK_THAT(line, Contains("has no <camera>") && Contains("azimuth=\"30\" elevation=\"12\" fov=\"30\"/>"));
    for (const glm::dvec3 corner : {glm::dvec3(41.0, 1.0, 1.0), glm::dvec3(39.0, -1.0, -1.0),
                                    glm::dvec3(-2.0, -9.5, 0.5), glm::dvec3(2.0, -8.5, -0.5)}) {
        const glm::dvec2 at = seen(scene.camera, scene.picture, corner);
        CHECK((at.x > 0.0 && at.x < 1.0 && at.y > 0.0 && at.y < 1.0));
    }
    // What the line says is that view, to its digits.
    const std::string element = line.substr(line.find("<camera "));
    const Camera said = parse(media + element).camera;
    CHECK(glm::distance(said.position, scene.camera.position) < 1e-3);
    CHECK(said.fov == scene.camera.fov);
    Scene given = parse(media + "<camera z=\"3\"/>");
    CHECK(give_camera(given, fields).empty());
    CHECK(given.camera.position == glm::dvec3(0.0, 0.0, 3.0));
    Scene bare = parse("");
    CHECK(give_camera(bare, fields).empty());
}

TEST_CASE("a scene of surfaces alone gets a camera, too", "[cpu][camera][xml]") {
    FieldCache fields;
    Scene balls = parse_scene("<options><surfaces><sphere x='40'/><sphere x='44'/></surfaces></options>", "s.xml");
    CHECK_THAT(give_camera(balls, fields), Contains("frames its surfaces"));
    CHECK(balls.camera.position.x > 30.0);
    // Of files, too.
    Scene mesh;
    mesh.has_camera = false;
    mesh.surfaces.emplace_back().shape = MeshSurface{write_text("v 70 70 70\nv 71 70 70\nv 70 71 70\nf 1 2 3\n")};
    CHECK_THAT(give_camera(mesh, fields), Contains("frames its surfaces"));
    CHECK(mesh.camera.position.y > 60.0);
    Scene plane = parse_scene("<options><surfaces><plane/></surfaces></options>", "s.xml");
    CHECK_THAT(give_camera(plane, fields), Contains("nothing that could be framed"));
}

TEST_CASE("a camera's settings say which luminance is white", "[cpu][camera][xml]") {
    const auto camera = [](const std::string& attributes) {
        return parse_scene("<options><camera " + attributes + "/></options>", "s.xml").camera;
    };
    CHECK(!camera("").exposure);
    // 1.2 * 8^2 * 100 = 7680 cd/m^2 is white; twice the speed, or the time, halves it.
    CHECK(stops_of(*camera("shutter=\".01\" fNumber=\"8\"").exposure) == Approx(-std::log2(7680.0)));
    CHECK(stops_of(*camera("shutter=\".01\" fNumber=\"8\" iso=\"200\"").exposure) == Approx(-std::log2(3840.0)));
    CHECK(stops_of(*camera("shutter=\".02\" fNumber=\"8\" luminanceUnit=\"1000\"").exposure) ==
          Approx(-std::log2(3.84)));
    for (const auto& [attributes, message] :
         {std::pair("iso=\"100\"", "add shutter"), std::pair("shutter=\"1\"", "add fNumber"),
          std::pair("shutter=\"0\" fNumber=\"1\"", "shutter"),
          std::pair("shutter=\"1e-9\" fNumber=\"1e9\" iso=\"1e-9\"", "beyond 100")})
        CHECK_THROWS_WITH(camera(attributes), Contains(message) && Contains("s.xml:1:"));
}

TEST_CASE("the camera that a far scene gets is said with the digits that it takes", "[cpu][camera][xml]") {
    FieldCache fields;
    const std::string far = R"(<box x="4512345" z="780123"/>)";
    Scene scene = parse_scene("<options>" + far + "</options>", "s.xml");
    const std::string line = give_camera(scene, fields);
    const Camera said =
        parse_scene("<options>" + far + line.substr(line.find("<camera ")) + "</options>", "s.xml").camera;
    CHECK(glm::distance(said.position, scene.camera.position) < 1e-3);
}
