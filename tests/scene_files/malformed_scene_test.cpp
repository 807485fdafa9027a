// Scenes that can be read but not rendered, and texts that are no scenes: found by tests/fuzz, kept here.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <functional>

#include "error.h"
#include "frame_params.h"
#include "method.h"
#include "preset.h"
#include "scene_xml.h"

using namespace vkvol;
using Catch::Contains;
using Catch::StartsWith;

namespace {

Scene parse_elements(const std::string& elements, const Defines& defines = {}, const SceneOverrides& overrides = {}) {
    return parse_scene("<options>\n" + elements + "</options>", "s.xml", defines, overrides);
}

std::string message_of(const std::function<void()>& use) {
    try {
        use();
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

std::string refusal_of(const std::string& elements, const Defines& defines = {}) {
    return message_of([&] { parse_elements(elements, defines); });
}

// The error of opening the scene's files, or of making what the kernels are given.
std::string render_error_of(const std::string& elements) {
    return message_of([&] {
        const Scene scene = with_preset(parse_elements(elements));
        const Method method = choose_method(scene);
        make_frame(scene, load_assets(scene, method).media, method, {0, 1, 0, 1}, 1);
    });
}

} // namespace

TEST_CASE("numbers that single precision cannot hold are refused where they stand", "[cpu][xml]") {
    const std::pair<const char*, const char*> cases[] = {
        {"<light y=\"1\" r=\"1e38\"/>",
         "s.xml:2:14: <light> r: '1e38' is out of range; expected a number >= 0, at most 1e+30"},
        {"<light y=\"1\" g=\"1e7\" multiplier=\"1e7\"/>", "s.xml:2:14: <light> g times multiplier is 1e+14"},
        {"<backgroundColor b=\"1e20\"/>", "s.xml:2:18: <backgroundColor> b times"},
        {"<sphere/><medium r=\"1e13\"/>", "s.xml:2:18: <medium> r times"},
        {"<sphere/><sigma_s>1e31</sigma_s>", "s.xml:2:19: <sigma_s> '1e31' is out of range"},
        {"<sphere/><sigma_a>1e20</sigma_a><lightRayDensityMultiplier>1e20</lightRayDensityMultiplier>",
         "s.xml:2:33: sigma_a and sigma_s"},
        {"<sphere/><sigma_a>1e-20</sigma_a><sigma_s>0</sigma_s>\n<lightRayDensityMultiplier>1e-20"
         "</lightRayDensityMultiplier>",
         "s.xml:3:1: sigma_a and sigma_s"},
        {"<sphere radius=\"1e-320\"/>", "s.xml:2:9: <sphere> radius: '1e-320' is out of range"},
        {"<sphere radius=\"1e30\"/>", "s.xml:2:9: <sphere> radius: '1e30' is out of range"},
        {"<sphere x=\"1e200\"/>", "s.xml:2:9: <sphere> x: "},
        {"<box depth=\"1e-40\"/>", "s.xml:2:6: <box> depth: "},
        {"<camera z=\"-1e12\"/>", "s.xml:2:9: <camera> z: "},
        {"<camera fov=\"1e-300\"/>", "s.xml:2:9: <camera> fov: "},
        {"<camera fov=\"179.99999999999\"/>", "s.xml:2:9: <camera> fov: 180 cannot be told"},
        {"<width reference=\"1e200\">4</width>", "s.xml:2:8: <width> reference: "},
        {"<width reference=\"0.001\">4</width>", "s.xml:2:8: <width> reference: a frame of 0.001 pixels"},
        {"<width startOffset=\"1e20\">4</width>", "s.xml:2:8: <width> startOffset: "},
        {"<heyneygreenstein_g>0.99999999</heyneygreenstein_g>",
         "s.xml:2:21: <heyneygreenstein_g> 0.99999999 is too near"},
        {"<march step=\"1e-30\"/>", "s.xml:2:8: <march> step: "},
        {"<march opticalStep=\"1e-40\"/>", "s.xml:2:8: <march> opticalStep: "},
        {"<majorant scale=\"1e38\"/>", "s.xml:2:11: <majorant> scale: "},
        {"<majorant scale=\"1e-45\"/>", "s.xml:2:11: <majorant> scale: "},
    };
    for (const auto& [elements, message] : cases) {
        INFO(elements);
        CHECK_THAT(refusal_of(elements), StartsWith(message));
    }
    // What is nearer to 0 than that is 0.
    CHECK(parse_elements("<sphere/><sigma_a>1e-40</sigma_a>").volumes.at(0).sigma_a == Rgb(0.0));
    CHECK(parse_elements("<camera x=\"-1e-310\"/>").camera.position.x == 0.0);
}

TEST_CASE("media that a ray would never get through are refused, with the scene's line", "[cpu][xml]") {
    const std::string delta = "<integrator flight=\"delta\">deltaTracking</integrator>";
    CHECK_THAT(render_error_of("<sphere/><sigma_s>1e8</sigma_s>\n" + delta),
               StartsWith("s.xml:2:1: a ray through the medium meets 2e+08 tentative collisions"));
    CHECK_THAT(render_error_of("<sphere/><sigma_s>1e2</sigma_s><majorant scale=\"1e6\"/>\n" + delta),
               Contains("or the majorant's scale"));
    CHECK_THAT(render_error_of("<sphere/><noise/><sigma_s>1e8</sigma_s>"), Contains("tentative collisions"));
    CHECK_THAT(render_error_of("<sphere/><integrator>adaptiveRayMarching</integrator><march opticalStep=\"1e-9\"/>"),
               Contains("<march> opticalStep: 1e-09 takes 2e+09 steps") && Contains("0.002 takes a thousand"));
    // In closed form any optical depth takes one step.
    CHECK(render_error_of("<sphere/><sigma_s>1e8</sigma_s>") == "no error");
    CHECK_THAT(render_error_of("<sphere radius=\"1e-11\"/><camera x=\"1e11\"/>"), Contains("move the camera"));
    for (const char* shape :
         {"<plane/>", "<sphere y=\"-1\"/>", "<disk lookAt=\"1 1 1\"/>", "<rectangle lookAt=\"1 1 1\"/>"}) {
        const std::string surfaces = fmt::format("<surfaces>{}</surfaces>", shape);
        CHECK_THAT(render_error_of(surfaces + "<fluence>0 0 0</fluence>"), Contains("lies in this surface"));
        CHECK(render_error_of(surfaces + "<fluence>0 0.001 0</fluence>") == "no error");
    }
    const std::string ground = "<surfaces><plane/></surfaces>", sensor = "<irradiance width=\"1\" height=\"1\" lookAt=";
    CHECK_THAT(render_error_of(ground + sensor + "\"0 -1 0\"/>"), Contains("faces into it"));
    CHECK(render_error_of(ground + sensor + "\"0 1 0\"/>") == "no error");
    CHECK(render_error_of(ground + sensor + "\"0 -1 0\" y=\"0.01\"/>") == "no error");
    CHECK_THAT(render_error_of("<sphere radius=\"1e-11\"/><fluence>0 0 0  1e11 0 0</fluence>"),
               Contains("move the point"));
    CHECK_THAT(render_error_of("<sphere/><sigma_s>1</sigma_s><noise frequency=\"1e15\" octaves=\"3\"/>"),
               Contains("octave"));
}

TEST_CASE("errors of a scene's files name the line that names the file", "[cpu][xml]") {
    CHECK_THAT(render_error_of("<sigma_a>1</sigma_a>\n<densityField>missing.nvdb</densityField>"),
               StartsWith("s.xml:3:1: missing.nvdb: no such file"));
    CHECK_THAT(render_error_of("<models><model>missing.obj</model></models>"), StartsWith("s.xml:2:1: missing.obj: "));
    // One from the command line has no line.
    CHECK(parse_elements("<sphere/>", {}, {"other.nvdb", {}}).volumes.at(0).place.empty());
}

TEST_CASE("messages are one line of sane length, whatever the file holds", "[cpu][xml]") {
    const std::string name(5000, 'x');
    for (const std::string& message :
         {refusal_of("<" + name + "/>"), refusal_of("<light " + name + "=\"1\"/>"),
          refusal_of("<filter>a\nb\x01</filter>"), refusal_of("<march unit=\"" + name + "\"/>"),
          refusal_of("<integrator>" + name + "</integrator>"), message_of([] {
              parse_elements("", {}, {{}, "ratioTracking:flight=\n"});
          }),
          refusal_of("<densityField>a\x01.nvdb</densityField>"),
          refusal_of("<densityField>" + name + "</densityField>"), refusal_of("<light r=\"$" + name + "\"/>"),
          refusal_of("<box/>", {{"key", "a\nb" + name}})}) {
        CHECK(message != "no error");
        CHECK(message.size() < 2100);
        CHECK(std::none_of(message.begin(), message.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }));
    }
}

TEST_CASE("no fluence is read where light without extent is", "[cpu][xml][flux]") {
    const std::string lights = R"(<lights><point x="1" y="2" z="3"/><spot x="-1" lookAt="0 0 0"/></lights>)";
    CHECK_THAT(render_error_of(lights + "<fluence>0 0 0  1 2 3</fluence>"), Contains("at the point 1 2 3"));
    CHECK_THAT(render_error_of(lights + "<fluence>-1 0 0</fluence>"), Contains("<point> or <spot>"));
    CHECK(render_error_of(lights + "<fluence>0 0 0  1 2 3.000001</fluence>") == "no error");
}

TEST_CASE("keys by the thousand neither take for ever nor fill the memory", "[cpu][xml]") {
    // Places are counted from the beginning of the file, and so must be asked for in messages alone.
    std::string models;
    for (int i = 0; i < 50000; ++i)
        models += "<model>$k</model>\n";
    CHECK(std::get<MeshFiles>(parse_elements("<models>" + models + "</models>", {{"k", "a.obj"}}).volumes.at(0).shape)
              .paths.size() == 50000);
    CHECK_THAT(refusal_of("<models>" + models + "</models>", {{"k", std::string(1000, 'a')}}), Contains("16 MiB"));
}
