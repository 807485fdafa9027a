// The page of `vkvol view`: who gets an answer, and which; and that what it shows is what a render would be.
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <httplib.h>
#include <nlohmann/json.hpp>
#include <signal.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "camera_view.h"
#include "error.h"
#include "image_io.h"
#include "session.h"
#include "shown_layer.h"
#include "support/command_folder.h"
#include "support/images.h"
#include "support/scenes.h"
#include "support/test_device.h"
#include "test_paths.h"
#include "view_json.h"
#include "view_server.h"

using namespace vkvol;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

struct Address {
    std::string root, key;
    int port = 0;
};

Address parts(const std::string& address) {
    Address result;
    result.root = address.substr(0, address.find("/?"));
    result.key = address.substr(address.find("key=") + 4);
    while (!result.key.empty() && result.key.back() == '\n')
        result.key.pop_back();
    result.port = std::stoi(result.root.substr(result.root.rfind(':') + 1));
    return result;
}

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

// The state, and behind it the pixels.
std::pair<Json, std::string> frame_of(const std::string& body) {
    REQUIRE(body.size() > 4);
    std::uint32_t length = 0;
    std::memcpy(&length, body.data(), 4);
    return {Json::parse(body.substr(4, length)), body.substr(4 + length)};
}

// `vkvol view`, until it goes.
class Watched {
public:
    Watched(const Folder& folder, const std::string& arguments) {
        int ends[2];
        REQUIRE(pipe(ends) == 0);
        child_ = fork();
        if (child_ == 0) {
            dup2(ends[1], STDOUT_FILENO);
            const char* device = std::getenv("VKVOL_TEST_DEVICE");
            const std::string command =
                fmt::format("cd '{}' && exec '{}' view {} -q {}", folder.file(".").string(), VKVOL_BINARY, arguments,
                            device ? std::string("--device ") + device : "");
            execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
            _exit(127);
        }
        close(ends[1]);
        char c = 0;
        std::string line;
        while (read(ends[0], &c, 1) == 1 && c != '\n')
            line += c;
        close(ends[0]);
        REQUIRE_THAT(line, Contains("?key="));
        address_ = parts(line);
    }
    ~Watched() {
        if (child_ > 0)
            end(SIGKILL);
    }
    const Address& address() const { return address_; }
    // The exit code.
    int end(int signal) {
        int status = 0;
        kill(child_, signal);
        waitpid(child_, &status, 0);
        child_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

private:
    pid_t child_ = -1;
    Address address_;
};

// Frames until one is as wanted, or a minute is over. A copy of each is asked, where what is missing is null; of a
// const one nobody may ask.
Json until(httplib::Client& client, const std::string& key, const std::function<bool(Json)>& wanted) {
    Json state;
    for (int i = 0; i < 600; ++i) {
        const auto answer = client.Get(("/frame?since=0&key=" + key).c_str());
        REQUIRE(answer);
        REQUIRE(answer->status == 200);
        state = frame_of(answer->body).first;
        if (wanted(state))
            return state;
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    FAIL("it did not come: " << state.dump());
    return state;
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
    // Wishes: what they are, and what they are not.
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
    const auto [noisy, noise] = frame_of(get("/frame?since=0")->body);
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

TEST_CASE("a scene is viewed by the integrator that is asked for", "[gpu][live]") {
    const Folder folder("");
    folder.write(
        "noise.xml",
        "<options><sphere radius=\"1\"/><noise/><sigma_a>1</sigma_a><sigma_s>1</sigma_s><width>8</width>"
        "<height>8</height><camera z=\"4\"/><light y=\"1\"/><integrator>regularTracking</integrator></options>");
    CHECK(folder.vkvol("noise.xml -o a.exr").code == exit_bad_input); // exact optical depths of noise are not known
    Watched watched(folder, "noise.xml --spp 1 --integrator ratioTracking");
    CHECK(watched.end(SIGTERM) == exit_done);
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

TEST_CASE("what a viewer asks for in vain does not stay asked for", "[gpu][live]") {
    const Folder folder("");
    const auto write = [&](const std::string& more) {
        folder.write("turn.xml", "<options><sphere/><sigma_s>1</sigma_s><width>16</width><height>16</height>"
                                 "<camera z=\"${= 4 + distance + F}\" fov=\"${angle}\"/>"
                                 "<backgroundColor r=\"1\" g=\"1\" b=\"1\"/>" +
                                     more + "</options>");
    };
    write("");
    Watched watched(folder, "turn.xml --spp 8 -D distance=1 -D angle=40 -D F=0");
    const auto [root, key, port] = watched.address();
    httplib::Client client(root);
    const auto wish = [&, &key = key](const Json& json) {
        const auto answer = client.Post(("/wish?key=" + key).c_str(), json.dump(), "application/json");
        REQUIRE(answer->status == 200);
        return Json::parse(answer->body)["wish"].get<std::uint64_t>();
    };
    const auto done = [&, &key = key](std::uint64_t number) {
        return until(client, key, [&](Json state) {
            return state.value("done", false) && state["wish"] == number && state["sceneWish"] == number &&
                   state["message"] == "";
        });
    };
    const Json first = until(client, key, [](Json state) { return state.value("done", false); });
    done(wish({{"layer", "position"}}));
    write("<motionBlur/>"); // of what moves there is none
    until(client, key, [](Json state) { return state["message"] != ""; });
    done(wish({{"layer", "depth"}}));
    // A camera that takes the place of the keys that stood there.
    Json camera = first["camera"];
    camera["position"] = {2.0, 1.0, 4.0};
    const Json turned = done(wish({{"camera", camera}, {"lights", Json::array()}}));
    CHECK(turned["wishesCamera"] == true);
    CHECK(done(wish(Json::object()))["wishesCamera"] == false);
}

TEST_CASE("what was wrong is no longer told once it is not", "[gpu][live]") {
    const Folder folder("");
    folder.write("ball.xml", "<options><motionBlur/><sphere/><sigma_s>1</sigma_s><width>16</width><height>16</height>"
                             "<camera z=\"${= 5 + F}\" fov=\"40\"/><backgroundColor r=\"1\"/></options>");
    Watched watched(folder, "ball.xml --spp 100000000 --noise 0.0001% -D F=0");
    const auto [root, key, port] = watched.address();
    httplib::Client client(root);
    const auto wish = [&, &key = key](const char* layer) {
        const std::string text = Json{{"layer", layer}}.dump();
        return Json::parse(client.Post(("/wish?key=" + key).c_str(), text, "application/json")->body)["wish"];
    };
    wish("position");
    until(client, key, [](Json state) { return state["message"] != ""; });
    const Json number = wish("depth");
    until(client, key, [&](Json state) {
        return state["sceneWish"] == number && state["samples"] > 0 && !state.value("done", false) &&
               state["message"] == "";
    });
}

TEST_CASE("values of a grid within a pbrt scene are followed", "[gpu][live]") {
    const Folder folder("");
    const auto scene = [](const std::string& density) {
        return "LookAt 0 0 5 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 30 Film \"rgb\" \"integer xresolution\" "
               "16 "
               "\"integer yresolution\" 16 WorldBegin LightSource \"infinite\" \"rgb L\" [ 1 1 1 ] MakeNamedMedium "
               "\"g\" "
               "\"string type\" \"uniformgrid\" \"rgb sigma_a\" [ 2 2 2 ] \"integer nx\" 1 \"integer ny\" 1 "
               "\"integer nz\" 1 \"point3 p0\" [ -1 -1 -1 ] \"point3 p1\" [ 1 1 1 ] \"float density\" [ " +
               density + " ] MediumInterface \"g\" \"\" Material \"interface\" Shape \"sphere\" \"float radius\" 2\n";
    };
    folder.write("s.pbrt", scene("1"));
    Watched watched(folder, "s.pbrt --spp 8");
    const auto [root, key, port] = watched.address();
    httplib::Client client(root);
    const auto mean = [&, &key = key] {
        const auto answer = client.Get(("/picture.exr?key=" + key).c_str());
        REQUIRE(answer->status == 200);
        folder.write("kept.exr", answer->body);
        return read_exr(folder.file("kept.exr")).mean;
    };
    until(client, key, [](Json state) { return state.value("done", false); });
    const std::vector<glm::vec3> before = mean();
    folder.write("s.pbrt", scene("0.25"));
    until(client, key, [&](Json state) { return state.value("done", false) && mean() != before; });
    CHECK(watched.end(SIGTERM) == exit_done);
}

TEST_CASE("a scene is viewed, changed and kept", "[gpu][live]") {
    const Folder folder("<light x=\"1\" y=\"1\" z=\"0\" r=\"3\" g=\"2\" b=\"1\"/>");
    Watched watched(folder, "ball.xml --spp 8");
    const auto [root, key, port] = watched.address();
    httplib::Client client(root);
    const auto done = [](Json state) {
        return state.value("done", false) && state["wish"] == state["sceneWish"] && state["message"] == "";
    };
    const auto wish_only = [&, &key = key](const Json& json) {
        const auto answer = client.Post(("/wish?key=" + key).c_str(), json.dump(), "application/json");
        REQUIRE(answer->status == 200);
        return Json::parse(answer->body)["wish"].get<std::uint64_t>();
    };
    const auto wish = [&, &key = key](const Json& json) {
        const std::uint64_t number = wish_only(json);
        return until(client, key, [&](Json state) { return done(state) && state["wish"] == number; });
    };
    const auto kept = [&, &key = key](const std::string& name) {
        const auto answer = client.Get(("/" + name + "?key=" + key).c_str());
        REQUIRE(answer->status == 200);
        folder.write("kept-" + name, answer->body);
    };
    // The same picture as a render's, and again once it was changed and kept.
    const Json state = until(client, key, done);
    kept("picture.exr");
    REQUIRE(folder.vkvol("ball.xml --spp 8 -q -o plain.exr").code == exit_done);
    CHECK(read_exr(folder.file("kept-picture.exr")).mean == read_exr(folder.file("plain.exr")).mean);
    Json camera = state["camera"];
    camera["position"] = {2.0, 1.0, 4.0};
    camera["forward"] = {-0.4, -0.2, -0.8};
    const Json changed = wish({{"camera", camera},
                               {"density", 0.5},
                               {"lights", {{{"place", 0}, {"factor", 2.0}, {"direction", {0.0, 0.0, 1.0}}}}},
                               {"integrator", "deltaTrackingNEE"}});
    CHECK(changed["integrator"] == "deltaTrackingNEE");
    CHECK(std::abs(changed["camera"]["position"][2].get<double>() - 4.0) < 1e-6);
    kept("picture.exr");
    kept("scene.xml");
    REQUIRE(folder.vkvol("kept-scene.xml --spp 8 -q -o changed.exr").code == exit_done);
    CHECK(read_exr(folder.file("kept-picture.exr")).mean == read_exr(folder.file("changed.exr")).mean);
    CHECK(read_exr(folder.file("changed.exr")).mean != read_exr(folder.file("plain.exr")).mean);
    // A layer, of the same samples; the scene as it was. One whose name ends another's is one by itself.
    CHECK(wish({{"layer", "depth"}})["width"] == 16);
    CHECK(wish({{"layer", "indirect"}})["width"] == 16);
    CHECK(wish({{"layer", "direct"}})["width"] == 16);
    wish(Json::object());
    kept("picture.exr");
    CHECK(read_exr(folder.file("kept-picture.exr")).mean == read_exr(folder.file("plain.exr")).mean);
    // The file, changed, broken and mended.
    const std::string before = folder.text("ball.xml");
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = before;
        text.replace(text.find(from), from.size(), to);
        folder.write("ball.xml", text);
    };
    with("<width>16</width>", "<width>20</width>");
    until(client, key, [&](Json now) { return done(now) && now["width"] == 20; });
    with("</options>", "");
    until(client, key,
          [](Json now) { return now["message"].get<std::string>().find("ball.xml:1") != std::string::npos; });
    // The word stays when what could be read is rendered anew.
    wish_only({{"density", 0.25}});
    until(client, key, [](Json now) {
        return now.value("done", false) && now["density"] == 0.25 && now["wish"] == now["sceneWish"];
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    CHECK_THAT(until(client, key, [](const Json&) { return true; })["message"].get<std::string>(),
               Contains("ball.xml:1"));
    wish_only(Json::object());
    with("<width>16</width>", "<width>24</width>");
    until(client, key, [&](Json now) { return done(now) && now["width"] == 24; });
    CHECK(watched.end(SIGTERM) == exit_done);
    CHECK(folder.vkvol("view").code == exit_bad_input);
    CHECK(folder.vkvol("view nothing.xml").code == exit_bad_input);
    folder.write("part.pbrt", "Camera \"perspective\"\nWorldBegin\nShape \"cylinder\"\n");
    const Run strict = folder.vkvol("view part.pbrt --strict", "timeout 20");
    CHECK(strict.code == exit_bad_input);
    CHECK_THAT(strict.text, Contains("part.pbrt:3") && Contains("--strict"));
}
