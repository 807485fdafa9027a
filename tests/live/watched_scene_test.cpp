// `vkvol view` itself: that what its page shows is what a render would be, whatever becomes of the scene meanwhile.
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <functional>
#include <httplib.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <signal.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "error.h"
#include "image_io.h"
#include "stopwatch.h"
#include "support/command_folder.h"
#include "support/view_page.h"
#include "test_paths.h"

using namespace vkvol;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

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

// Who looks at ball.xml, and has wishes.
class Onlooker {
public:
    Onlooker()
        : folder("<light x=\"1\" y=\"1\" z=\"0\" r=\"3\" g=\"2\" b=\"1\"/>"), watched(folder, "ball.xml --spp 8") {
        const auto [root, key, port] = watched.address();
        key_ = key;
        client_.emplace(root);
    }

    static bool is_done(Json state) {
        return state.value("done", false) && state["wish"] == state["sceneWish"] && state["message"] == "";
    }

    Json wait_for(const std::function<bool(Json)>& condition) { return until(*client_, key_, condition); }

    std::uint64_t wish_only(const Json& json) {
        const auto answer = client_->Post(("/wish?key=" + key_).c_str(), json.dump(), "application/json");
        REQUIRE(answer->status == 200);
        return Json::parse(answer->body)["wish"].get<std::uint64_t>();
    }

    Json wish(const Json& json) {
        const std::uint64_t number = wish_only(json);
        return wait_for([&](Json state) { return is_done(state) && state["wish"] == number; });
    }

    // In a file of that name behind "kept-".
    void keep(const std::string& name) {
        const auto answer = client_->Get(("/" + name + "?key=" + key_).c_str());
        REQUIRE(answer->status == 200);
        folder.write("kept-" + name, answer->body);
    }

    // As the page is told to save it.
    std::string name_of(const std::string& name) {
        return client_->Get(("/" + name + "?key=" + key_).c_str())->get_header_value("Content-Disposition");
    }

    const Folder folder;
    Watched watched;

private:
    std::string key_;
    std::optional<httplib::Client> client_;
};

} // namespace

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
    Onlooker onlooker;
    const Folder& folder = onlooker.folder;
    // The same picture as a render's, and again once it was changed and kept.
    const Json state = onlooker.wait_for(Onlooker::is_done);
    onlooker.keep("picture.exr");
    REQUIRE(folder.vkvol("ball.xml --spp 8 -q -o plain.exr").code == exit_done);
    CHECK(read_exr(folder.file("kept-picture.exr")).mean == read_exr(folder.file("plain.exr")).mean);
    Json camera = state["camera"];
    camera["position"] = {2.0, 1.0, 4.0};
    camera["forward"] = {-0.4, -0.2, -0.8};
    const Json changed = onlooker.wish({{"camera", camera},
                                        {"density", 0.5},
                                        {"lights", {{{"place", 0}, {"factor", 2.0}, {"direction", {0.0, 0.0, 1.0}}}}},
                                        {"integrator", "deltaTrackingNEE"}});
    CHECK(changed["integrator"] == "deltaTrackingNEE");
    CHECK(std::abs(changed["camera"]["position"][2].get<double>() - 4.0) < 1e-6);
    onlooker.keep("picture.exr");
    onlooker.keep("scene.xml");
    REQUIRE(folder.vkvol("kept-scene.xml --spp 8 -q -o changed.exr").code == exit_done);
    CHECK(read_exr(folder.file("kept-picture.exr")).mean == read_exr(folder.file("changed.exr")).mean);
    CHECK(read_exr(folder.file("changed.exr")).mean != read_exr(folder.file("plain.exr")).mean);
    // A layer, of the same samples; the scene as it was. One whose name ends another's is one by itself.
    CHECK(onlooker.wish({{"layer", "depth"}})["width"] == 16);
    CHECK(onlooker.wish({{"layer", "indirect"}})["width"] == 16);
    CHECK(onlooker.wish({{"layer", "direct"}})["width"] == 16);
    onlooker.wish(Json::object());
    onlooker.keep("picture.exr");
    CHECK(read_exr(folder.file("kept-picture.exr")).mean == read_exr(folder.file("plain.exr")).mean);
    CHECK(onlooker.watched.end(SIGTERM) == exit_done);
}

TEST_CASE("a scene's file is viewed as it comes to be", "[gpu][live]") {
    Onlooker onlooker;
    const Folder& folder = onlooker.folder;
    onlooker.wait_for(Onlooker::is_done);
    const std::string before = folder.text("ball.xml");
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = before;
        text.replace(text.find(from), from.size(), to);
        folder.write("ball.xml", text);
    };
    with("<width>16</width>", "<width>20</width>");
    onlooker.wait_for([](Json now) { return Onlooker::is_done(now) && now["width"] == 20; });
    with("</options>", "");
    onlooker.wait_for(
        [](Json now) { return now["message"].get<std::string>().find("ball.xml:1") != std::string::npos; });
    // The word stays when what could be read is rendered anew.
    onlooker.wish_only({{"density", 0.25}});
    onlooker.wait_for(
        [](Json now) { return now.value("done", false) && now["density"] == 0.25 && now["wish"] == now["sceneWish"]; });
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    CHECK_THAT(onlooker.wait_for([](const Json&) { return true; })["message"].get<std::string>(),
               Contains("ball.xml:1"));
    onlooker.wish_only(Json::object());
    with("<width>16</width>", "<width>24</width>");
    onlooker.wait_for([](Json now) { return Onlooker::is_done(now) && now["width"] == 24; });
    CHECK(onlooker.watched.end(SIGTERM) == exit_done);
}

TEST_CASE("what cannot be viewed is refused", "[cpu][live]") {
    const Folder folder("");
    CHECK(folder.vkvol("view").code == exit_bad_input);
    CHECK(folder.vkvol("view nothing.xml").code == exit_bad_input);
    folder.write("part.pbrt", "Camera \"perspective\"\nWorldBegin\nShape \"cylinder\"\n");
    const Run strict = folder.vkvol("view part.pbrt --strict", "timeout 20");
    CHECK(strict.code == exit_bad_input);
    CHECK_THAT(strict.text, Contains("part.pbrt:3") && Contains("--strict"));
}

TEST_CASE("a view that is dragged about is shown meanwhile", "[gpu][live]") {
    Onlooker onlooker;
    Json camera = onlooker.wait_for(Onlooker::is_done)["camera"];
    std::set<double> shown;
    const Stopwatch watch;
    for (int i = 0; watch.seconds() < 20.0 && shown.size() < 4; ++i) { // faster than any render begins
        camera["position"][0] = 0.001 * i;
        onlooker.wish_only({{"camera", camera}});
        if (i % 20 == 19) {
            const Json now = onlooker.wait_for([](const Json&) { return true; });
            if (now["samples"] > 0)
                shown.insert(now["camera"]["position"][0].get<double>());
        }
    }
    CHECK(shown.size() == 4);
}

TEST_CASE("what is changed while a view is paused is shown", "[gpu][live]") {
    Onlooker onlooker;
    onlooker.wait_for(Onlooker::is_done);
    const std::uint64_t paused = onlooker.wish_only({{"paused", true}, {"density", 0.25}});
    const Json state = onlooker.wait_for([&](Json now) { return now["sceneWish"] == paused; });
    CHECK(state["density"] == 0.25);
    CHECK(state["width"] == 16);
    // Kept, it is by its name no picture of all samples.
    CHECK_THAT(onlooker.name_of("picture.exr"), Contains("ball-sketch.exr"));
    onlooker.wish({{"density", 0.25}});
    CHECK_THAT(onlooker.name_of("picture.exr"), Contains("ball.exr"));
}
