// The program as its users run it: exit codes, what it says, and what it leaves.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "error.h"
#include "image_io.h"
#include "support/command_folder.h"
#include "support/scenes.h"
#include "test_paths.h"

using namespace vkvol;
using Catch::Contains;

TEST_CASE("caps are in the summary, the report and the EXR, and --strict fails", "[gpu][command][hard]") {
    const Folder folder("<maxDepth>1</maxDepth>");
    const Run plain = folder.vkvol("ball.xml --report ball.json");
    CHECK(plain.code == exit_done);
    CHECK_THAT(plain.text, Contains("paths ended at maxDepth"));
    Metadata metadata;
    read_exr(folder.file("ball.exr"), &metadata);
    CHECK(std::get<int>(metadata.at("vkvol/depthCaps")) > 0);
    CHECK(std::get<int>(metadata.at("vkvol/capsHit")) == 1);
    CHECK_THAT(std::get<std::string>(metadata.at("vkvol/biased")), Contains("paths ended at maxDepth"));
    std::ifstream report(folder.file("ball.json"));
    const std::string json((std::istreambuf_iterator<char>(report)), std::istreambuf_iterator<char>());
    CHECK_THAT(json, Contains(fmt::format("\"depth\": {}", std::get<int>(metadata.at("vkvol/depthCaps")))));
    CHECK(folder.vkvol("ball.xml --strict -q").code == exit_caps_hit);
    CHECK(folder.vkvol("ball.xml --strict -q --integrator deltaTracking -D unused=1").code != exit_done);
}

TEST_CASE("voxels that are no density are counted, and --strict fails", "[gpu][command][hard]") {
    const Folder folder("");
    const std::string scene =
        fmt::format("{}/scenes/hard/17-unclean-grid.xml --grid {}/unclean.nvdb --width 4 --spp 2 -q", VKVOL_SOURCE_DIR,
                    VKVOL_TEST_FIELDS);
    CHECK(folder.vkvol(scene + " -o unclean.exr").code == exit_done);
    Metadata metadata;
    read_exr(folder.file("unclean.exr"), &metadata);
    CHECK(std::get<int>(metadata.at("vkvol/capsHit")) == 1);
    CHECK(folder.vkvol(scene + " -o unclean.exr --strict").code == exit_caps_hit);
}

TEST_CASE("paths that would not end are counted as missing", "[gpu][command][hard][long]") {
    const Folder folder("");
    // Most paths come out again soon; one in hundreds wanders, at some forty null collisions a scattering.
    std::ofstream(folder.file("slow.xml"))
        << "<options><sphere radius=\"1\"/><noise octaves=\"4\"/><sigma_a>0</sigma_a><sigma_s>80000</sigma_s>"
           "<heyneygreenstein_g>0.99</heyneygreenstein_g><majorant scale=\"40\"/><width>32</width><height>32</height>"
           "<camera z=\"5\" fov=\"25\"/><backgroundColor r=\"1\" g=\"1\" b=\"1\"/></options>";
    const Run run = folder.vkvol("slow.xml --spp 2 --time 0.5s --strict -o slow.exr");
    CHECK(run.code == exit_caps_hit);
    CHECK_THAT(run.text, Contains("paths had not ended"));
    Metadata metadata;
    read_exr(folder.file("slow.exr"), &metadata);
    CHECK(std::get<int>(metadata.at("vkvol/abandonedPaths")) > 0);
    CHECK_THAT(std::get<std::string>(metadata.at("vkvol/biased")), Contains("paths were abandoned"));
}

TEST_CASE("a picture beyond this machine's memory is refused", "[gpu][command][hard]") {
    const Folder folder("");
    const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
    if (memory > 3e11)
        return; // it would be rendered
    const Run run = folder.vkvol("ball.xml --width 65536 --height 65536 --spp 1");
    CHECK(run.code == exit_bad_input);
    CHECK_THAT(run.text, Contains("GB of memory") && Contains("--crop"));
}

TEST_CASE("a single sample tells no noise", "[gpu][command]") {
    const Folder folder("");
    const Run run = folder.vkvol("ball.xml --spp 1 --report ball.json");
    CHECK_THAT(run.text, Contains(": 1 sample per pixel") && !Contains("noise"));
    std::ifstream report(folder.file("ball.json"));
    const auto json = nlohmann::json::parse(report);
    CHECK(json["mean"]["standardError"].is_null());
    CHECK(json["noise"].is_null());
}

TEST_CASE("summary, report and progress tell one noise, and a black picture has none", "[gpu][command]") {
    const Folder folder("");
    const Run run = folder.vkvol("ball.xml --spp 64 --progress json --report ball.json");
    std::ifstream report(folder.file("ball.json"));
    const double noise = nlohmann::json::parse(report)["noise"];
    CHECK(noise == Approx(*relative_noise(read_exr(folder.file("ball.exr")))).epsilon(1e-12));
    CHECK_THAT(run.text, Contains(fmt::format(", noise {:.2g} %", 100.0 * noise)));
    std::ofstream(folder.file("black.xml")) << "<options><sphere radius=\"1\"/><width>8</width><height>8</height>"
                                               "<camera z=\"5\" fov=\"25\"/></options>";
    const Run black = folder.vkvol("black.xml --spp 8 --report black.json");
    CHECK_THAT(black.text, Contains("noise -"));
    std::ifstream black_report(folder.file("black.json"));
    CHECK(nlohmann::json::parse(black_report)["noise"].is_null());
}

TEST_CASE("the report says how full queues were, and how the render was carried out", "[gpu][command]") {
    const Folder folder("");
    const auto report_by = [&](const std::string& schedule) {
        CHECK(folder.vkvol("ball.xml --spp 4 -q --report r.json --schedule " + schedule).code == exit_done);
        return nlohmann::json::parse(folder.text("r.json"));
    };
    const nlohmann::json staged = report_by("staged"), fused = report_by("fused");
    for (const char* pass : {"generate", "track", "shadow"})
        if (const double part = staged["occupancy"].value(pass, -1.0); pass != std::string("shadow") || part >= 0.0) {
            CAPTURE(pass, part);
            CHECK(part > 0.0);
            CHECK(part <= 1.0);
        }
    CHECK(staged["occupancy"]["accumulate"].get<double>() > 0.0);
    CHECK_FALSE(fused["occupancy"].contains("accumulate"));
    CHECK(staged["plan"]["schedule"] == "staged");
    CHECK(staged["plan"]["waiting"].get<int>() > 0);
    CHECK(fused["plan"]["waiting"] == 0);
    for (const nlohmann::json& report : {staged, fused})
        for (const char* size : {"slots", "lanes", "turns", "steps", "stepLimit"})
            CHECK(report["plan"][size].get<int>() > 0);
}

TEST_CASE("a picture without caps is exact, and --strict is content", "[gpu][command]") {
    const Folder folder("");
    CHECK(folder.vkvol("ball.xml --strict -q").code == exit_done);
    Metadata metadata;
    read_exr(folder.file("ball.exr"), &metadata);
    CHECK(std::get<int>(metadata.at("vkvol/capsHit")) == 0);
    CHECK(metadata.count("vkvol/biased") == 0); // an empty text is not kept
}

// The brightest light there may be, looked at through a medium whose forward peak is 1.6e7 high: beyond what a film
// adds up.
TEST_CASE("a sample that is not finite is dropped, and its path can be followed", "[gpu][command][hard]") {
    const Folder folder("<heyneygreenstein_g>0.9999</heyneygreenstein_g>"
                        "<light x=\"0\" y=\"0\" z=\"-1\" r=\"1\" g=\"1\" b=\"1\" multiplier=\"1e12\"/>");
    const Run render = folder.vkvol("ball.xml --seed 4 -o ball.exr --width 16384 --crop 8184,8200,8184,8200");
    CHECK(render.code == exit_done);
    CHECK_THAT(render.text, Contains("samples were not finite"));
    const std::size_t command = render.text.find("its path: vkvol ");
    REQUIRE(command != std::string::npos);
    const std::string line = render.text.substr(command + 16, render.text.find('\n', command) - command - 16);
    CHECK_THAT(line, Contains("--seed 4") && Contains("--trace"));
    const Run trace = folder.vkvol(line);
    CHECK(trace.code == exit_done);
    CHECK_THAT(trace.text, Contains("camera") && Contains("collision") && Contains("e+1"));
    for (const glm::vec3& mean : read_exr(folder.file("ball.exr")).mean)
        CHECK(glm::all(glm::lessThan(mean, glm::vec3(3e14f))));
    CHECK(folder.vkvol("ball.xml --seed 4 -q --strict --width 16384 --crop 8184,8200,8184,8200").code == exit_caps_hit);
}

TEST_CASE("pictures and scenes whose endings are in upper case", "[gpu][command]") {
    const Folder folder("");
    std::filesystem::rename(folder.file("ball.xml"), folder.file("BALL.XML"));
    REQUIRE(folder.vkvol("BALL.XML -o BALL.EXR -o BALL.PNG --spp 2").code == exit_done);
    CHECK(read_exr(folder.file("BALL.EXR")).samples.front() == 2);
    REQUIRE(folder.vkvol("BALL.XML -o ball.exr -o ball.png --spp 2").code == exit_done);
    CHECK(std::filesystem::file_size(folder.file("BALL.PNG")) == std::filesystem::file_size(folder.file("ball.png")));
    CHECK(run(fmt::format("'{}' compare '{}' '{}'", VKVOL_BINARY, folder.file("BALL.EXR").string(),
                          folder.file("ball.exr").string()))
              .code == exit_done);
}

TEST_CASE("--trace writes no picture that was not asked for", "[gpu][command]") {
    const Folder folder("");
    const Run trace = folder.vkvol("ball.xml --pixel 8,8 --sample 3 --trace");
    CHECK(trace.code == exit_done);
    CHECK_THAT(trace.text, Contains("position (world)"));
    CHECK_FALSE(std::filesystem::exists(folder.file("ball.exr")));
    CHECK_FALSE(std::filesystem::exists(folder.file("ball.png")));
    for (const char* wrong : {"--pixel 8,8", "--sample 1", "--trace", "--pixel 8 --sample 1 --trace",
                              "--pixel 99,8 --sample 1 --trace", "--pixel 8,8 --sample 1 --trace --spp 4"}) {
        CAPTURE(wrong);
        CHECK(folder.vkvol(std::string("ball.xml ") + wrong).code == exit_bad_input);
    }
}

TEST_CASE("a report tells what lights there are, and a warning of a map where the scene asks for it",
          "[gpu][command]") {
    const Folder folder("");
    RadianceMap map{4, 2, std::vector<glm::vec3>(8, glm::vec3(1.0f)), 0};
    map.texels[3].y = -1.0f;
    std::filesystem::copy_file(write_sky(map).file, folder.file("map.exr"));
    folder.write("lit.xml", R"(<options><sphere/><sigma_s>1</sigma_s><lights>
        <sky>map.exr</sky><point x="3" multiplier="9"/><sphere y="4" radius="0.5"/><point x="-3"/></lights>
        <camera z="5"/><width>8</width><height>8</height><rayPerPixelCount>1</rayPerPixelCount></options>)");
    const Run run = folder.vkvol("lit.xml --report lit.json");
    CAPTURE(run.text);
    REQUIRE(run.code == exit_done);
    CHECK_THAT(run.text, Contains("lit.xml:2:9: ") && Contains("1 texels were negative or not finite"));
    const auto lights = nlohmann::json::parse(folder.text("lit.json")).at("lights");
    CHECK(lights.at("kinds") == nlohmann::json{{"sky", 1}, {"point", 2}, {"sphere", 1}});
    CHECK(lights.at("tree") == true);
    CHECK(lights.at("map").at("width") == 4);
    CHECK(lights.at("map").at("height") == 2);
    CHECK(lights.at("map").at("mendedTexels") == 1);
    CHECK(lights.at("map").at("unevenness") > 1.0);
    REQUIRE(folder.vkvol("ball.xml --report ball.json").code == exit_done);
    CHECK(nlohmann::json::parse(folder.text("ball.json")).at("lights").at("map").is_null());
}

TEST_CASE("a crop that can be read in two ways says which was taken", "[gpu][command]") {
    const Folder folder("");
    CHECK_THAT(folder.vkvol("ball.xml --crop 0,1,0,1").text, Contains("is the first pixel alone"));
    CHECK_THAT(folder.vkvol("ball.xml --crop 0.0,1,0,1").text, !Contains("first pixel"));
}

TEST_CASE("--resume without a checkpoint begins, with a damaged one refuses, and when done leaves none",
          "[gpu][command][checkpoint]") {
    const Folder folder("");
    const Run fresh = folder.vkvol("ball.xml -o ball.exr --checkpoint 10s --resume");
    CHECK(fresh.code == exit_done);
    CHECK_THAT(fresh.text, Contains("begins anew"));
    CHECK_FALSE(std::filesystem::exists(folder.file("ball.checkpoint")));
    std::ofstream(folder.file("ball.checkpoint")) << "rubbish";
    const Run damaged = folder.vkvol("ball.xml -o ball.exr --resume");
    CHECK(damaged.code == exit_bad_input);
    CHECK_THAT(damaged.text, Contains("ball.checkpoint: is no checkpoint"));
}
