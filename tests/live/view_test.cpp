// The page of `vkvol view`: who gets an answer, and which.
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <httplib.h>
#include <nlohmann/json.hpp>
#include <thread>

#include "camera_view.h"
#include "error.h"
#include "image_io.h"
#include "session.h"
#include "shown_layer.h"
#include "support/images.h"
#include "support/scenes.h"
#include "support/test_device.h"
#include "support/view_page.h"
#include "view_json.h"
#include "view_server.h"

using namespace vkvol;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

Film grey_film(int width, int height, float value) {
    Film film;
    film.picture_width = width;
    film.picture_height = height;
    film.crop = {0, width, 0, height};
    film.mean.assign(std::size_t(width) * height, glm::vec3(value));
    film.variance.assign(film.mean.size(), glm::vec3(0.01f));
    film.samples.assign(film.mean.size(), 16);
    return film;
}

Shot shot_of(const Film& film) {
    auto scene = std::make_shared<ViewedScene>();
    scene->name = "a \"b\".xml";
    scene->xml = "<options/>";
    scene->has_view = true;
    scene->lights = {{"light", glm::dvec3(0.0, 1.0, 0.0)}};
    Shot shot;
    shot.scene = scene;
    shot.film = film;
    shot.samples = 16;
    return shot;
}

} // namespace

TEST_CASE("nobody without the key gets an answer", "[cpu][live]") {
    ViewBoard board;
    board.publish(shot_of(grey_film(4, 3, 0.5f)));
    const ViewServer server(board, 0, {"ratioTracking"});
    const auto [root, key, port] = parts(server.address());
    CHECK(key.size() == 32);
    httplib::Client client(root);
    for (const char* path : {"/", "/frame?since=0", "/picture.exr", "/picture.png", "/scene.xml", "/nothing"}) {
        CAPTURE(path);
        const std::string joint = std::strchr(path, '?') ? "&" : "?";
        CHECK(client.Get(path)->status == 403);
        CHECK(client.Get((path + joint + "key=" + std::string(32, '0')).c_str())->status == 403);
        CHECK(client.Get((path + joint + "key=" + key.substr(1)).c_str())->status == 403);
        // By another name of this machine, as pages elsewhere may give it.
        CHECK(client.Get((path + joint + "key=" + key).c_str(), {{"Host", fmt::format("evil.example:{}", port)}})
                  ->status == 403);
        const int good = client.Get((path + joint + "key=" + key).c_str())->status;
        CHECK(good == (std::string(path) == "/nothing" ? 404 : 200));
    }
    // Through a tunnel of another port.
    CHECK_THAT(client.Get(("/?key=" + key).c_str(), {{"Host", "127.0.0.1:1"}})->body,
               Contains(fmt::format("forward its port {}", port)));
    CHECK(
        (is_own_address("127.0.0.1:81", 81) && is_own_address("localhost", 80) && is_own_address("127.0.0.1:80", 80)));
    CHECK_FALSE((is_own_address("localhost", 81) || is_own_address("evil.example", 80) || is_own_address("", 80)));
    CHECK(client.Post("/wish", "{}", "application/json")->status == 403);
    // Bodies have a length, which has a limit.
    const std::string wish = "/wish?key=" + key;
    CHECK(client.Post(wish.c_str(), {{"Transfer-Encoding", "chunked"}}, "{}", "application/json")->status == 411);
    CHECK(client.Post(wish.c_str(), "{}", "application/json")->status == 200);
    const auto page = client.Get(("/?key=" + key).c_str());
    CHECK_THAT(page->get_header_value("Content-Security-Policy"), Contains("default-src 'none'"));
    CHECK_THAT(page->body, Contains("[\"ratioTracking\"]") && !Contains("{{"));
    // No address but this machine's own: the kernel's table of who listens where.
    std::ifstream table("/proc/net/tcp");
    std::string line, listening;
    while (std::getline(table, line))
        if (line.find(fmt::format(":{:04X} 00000000:0000 0A", port)) != std::string::npos)
            listening += line;
    CHECK_THAT(listening, Contains("0100007F:"));
    CHECK_THAT(listening, !Contains("00000000:" + fmt::format("{:04X}", port)));
    CHECK_THROWS_WITH(ViewServer(board, port, {}), Contains("--port"));
}

TEST_CASE("frames are the picture and what is known of it", "[cpu][live]") {
    ViewBoard board;
    const ViewServer server(board, 0, {});
    const auto [root, key, port] = parts(server.address());
    httplib::Client client(root);
    const auto get = [&, &key = key](const std::string& path) { return client.Get((path + "&key=" + key).c_str()); };
    CHECK(frame_of(get("/frame?since=0")->body).first["version"] == 0); // nothing yet
    Film film = grey_film(4, 3, 0.5f);
    film.samples[5] = 0;
    Shot first = shot_of(film);
    first.sketch = std::make_shared<const Film>(grey_film(2, 2, 4.0f));
    board.publish(first);
    const auto [state, pixels] = frame_of(get("/frame?since=0")->body);
    CHECK(state["width"] == 4);
    CHECK(state["height"] == 3);
    CHECK(state["samples"] == 16);
    CHECK(state["noise"].get<double>() == Approx(std::sqrt(0.03 * 11 / (0.75 * 11))));
    CHECK(state["lights"][0]["direction"] == Json({0.0, 1.0, 0.0}));
    REQUIRE(pixels.size() == 4 * 12);
    CHECK(static_cast<unsigned char>(pixels[0]) == 188);     // 0.5 by the sRGB curve
    CHECK(static_cast<unsigned char>(pixels[4 * 5]) == 255); // the sketch, where there is nothing else
    const std::uint64_t version = state["version"].get<std::uint64_t>();
    CHECK(get(fmt::format("/frame?since={}", version))->status == 204);
    board.say("a word");
    const auto told = get(fmt::format("/frame?since={}", version));
    REQUIRE(told->status == 200);
    CHECK(frame_of(told->body).first["message"] == "a word");
    CHECK(get("/scene.xml?x=1")->status == 200);
    auto in_memory = std::make_shared<ViewedScene>(*first.scene);
    in_memory->has_grids = true;
    first.scene = std::move(in_memory);
    board.publish(first);
    CHECK(get("/scene.xml?x=1")->status == 400);
    CHECK_THAT(get("/scene.xml?x=1")->body, Contains("vkvol convert"));
    CHECK(frame_of(get("/frame?since=0")->body).first["hasGrids"] == true);
    first.samples = 1; // as far as all pixels have come
    board.publish(first);
    CHECK(frame_of(get("/frame?since=0")->body).first["noise"].is_null());
    CHECK(frame_of(get("/frame?since=0&exposure=-1&curve=srgb")->body).first["exposure"] == -1.0);
    const auto png = get("/picture.png?x=1");
    CHECK(png->body.substr(1, 3) == "PNG");
    CHECK(png->get_header_value("Content-Disposition") == "attachment; filename=\"a _b_.png\"");
}

// What they are, and what they are not.
TEST_CASE("wishes are taken, and shown", "[cpu][live]") {
    ViewBoard board;
    const ViewServer server(board, 0, {});
    const auto [root, key, port] = parts(server.address());
    httplib::Client client(root);
    board.publish(shot_of(grey_film(4, 3, 0.5f)));
    const auto wish = [&, &key = key](const std::string& json) {
        return client.Post(("/wish?key=" + key).c_str(), json, "application/json");
    };
    for (const char* bad :
         {"", "[]", "{\"density\": -1}", "{\"density\": \"x\"}", "{\"layer\": \"nonsense\"}", "{\"camera\": {}}",
          "{\"integrator\": \"nonsense\"}", "{\"lights\": [{}]}", "{\"lights\": 3}",
          "{\"lights\": [{\"place\": 0, \"factor\": 1e99}]}", "{\"density\": 1e999}"}) {
        CAPTURE(bad);
        CHECK(wish(bad)->status == 400);
    }
    const std::uint64_t before = board.wish_number();
    REQUIRE(wish("{\"layer\": \"noise\", \"density\": 2, \"lights\": [{\"place\": 0, \"factor\": 3}]}")->status == 200);
    CHECK(board.wish_number() == before + 1);
    CHECK(board.wish().edits.density == 2.0);
    CHECK(board.wish().edits.lights.at(0).factor == 3.0);
    const auto [noisy, noise] = frame_of(client.Get(("/frame?since=0&key=" + key).c_str())->body);
    CHECK(noisy["layer"] == "noise");
    CHECK(static_cast<unsigned char>(noise[0]) == std::lround(255 * 0.1 / 0.5 / whitest_noise));
}

TEST_CASE("layers are shown as what they are", "[cpu][live]") {
    Film film = grey_film(2, 1, 0.5f);
    film.layers = {{"depth", {glm::vec3(10.0f), glm::vec3(0.0f)}, {}},
                   {"normal", {glm::vec3(-1.0f, 0.0f, 1.0f), glm::vec3(0.0f)}, {}},
                   {"direct", {glm::vec3(1.0f), glm::vec3(0.0f)}, {}}};
    CHECK(show_layer(film, nullptr, "albedo", {}, {}).rgba.empty());
    const ShownLayer depth = show_layer(film, nullptr, "depth", {}, {});
    CHECK(depth.rgba[0] == 255);
    CHECK(depth.rgba[4] == 0);
    CHECK_THAT(depth.scale, Contains("10"));
    const std::vector<std::uint8_t> normal = show_layer(film, nullptr, "normal", {}, {}).rgba;
    CHECK(std::vector<std::uint8_t>(normal.begin(), normal.begin() + 4) == std::vector<std::uint8_t>{0, 128, 255, 255});
    CHECK(show_layer(film, nullptr, "direct", {}, {}).rgba[0] == 255);
}

TEST_CASE("what a sketch shows is exposed as it is, whatever else is there yet", "[cpu][live]") {
    Film film = grey_film(2, 1, 0.0f);
    film.samples.assign(2, 0u);
    const Film sketch = grey_film(2, 1, 4000.0f);
    ToneRequest automatic;
    automatic.automatic_exposure = true;
    const ShownLayer shown = show_layer(film, &sketch, "picture", automatic, {});
    CHECK(shown.mapping.exposure < -10.0);
    CHECK(shown.clipped == 0);
}

TEST_CASE("a page's camera is one that a scene may have", "[cpu][live]") {
    Json camera{{"position", {0, 0, 1}}, {"forward", {0, 0, -1}}, {"up", {0, 1, 0}}, {"projection", "perspective"},
                {"fov", 1e-4},           {"viewHeight", 1},       {"lensRadius", 0}, {"focus", 1}};
    CHECK(wish_of(Json{{"camera", camera}}.dump()).edits.camera->fov == 1e-4);
    camera["fov"] = 180;
    CHECK_THROWS_WITH(wish_of(Json{{"camera", camera}}.dump()), Contains("fov is 180"));
    camera["fov"] = 90;
    camera["projection"] = "fisheye";
    CHECK_THROWS_WITH(wish_of(Json{{"camera", camera}}.dump()), Contains("no projection 'fisheye'"));
}

TEST_CASE("looks at a render change none of its bits", "[gpu][live]") {
    Scene scene = scene_of(medium(Sphere{}, 3.0, 0.9), 3.0, 24);
    scene.lights = {LightsAbout{}.beam};
    scene.settings.spp = 24;
    const RenderResult alone = render_here(scene, 1);
    std::vector<std::uint32_t> seen;
    RenderJob job;
    job.crop = {0, scene.picture.width, 0, scene.picture.height};
    job.seed = 1;
    job.preview = [&](const RenderResult& result) {
        seen.push_back(result.samples);
        CHECK(result.film.mean.size() == alone.film.mean.size());
    };
    const RenderResult looked = render(test_device(), scene, job);
    CHECK(!seen.empty());
    CHECK(std::is_sorted(seen.begin(), seen.end()));
    CHECK(looked.film.mean == alone.film.mean);
    CHECK(looked.film.variance == alone.film.variance);
}

// Where each takes 80 ms: the first few come soon, and the others are not put off for ever.
TEST_CASE("looks that take long are had nevertheless", "[gpu][live]") {
    Scene scene = scene_of(medium(Sphere{}, 3.0, 0.9), 3.0, 24);
    scene.settings.spp = 1u << 30;
    std::vector<double> at; // seconds
    RenderJob job;
    job.crop = {0, scene.picture.width, 0, scene.picture.height};
    job.time_limit = 300.0; // which no machine reaches
    job.interrupted = [&] { return at.size() == 5; };
    job.preview = [&](const RenderResult& result) {
        at.push_back(result.render_seconds);
        std::this_thread::sleep_for(std::chrono::milliseconds(80));
    };
    render(test_device(), scene, job);
    REQUIRE(at.size() == 5);
    CHECK(at[1] < 100 * 0.08);              // as it would be if none was for free
    CHECK(at[4] >= 100 * (4 * 0.08 - 0.3)); // those beyond 0.3 s are a hundredth of the time
}
