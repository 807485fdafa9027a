// That Mesa's lavapipe compiles a kernel once, and not for numbers of a scene: it does so for those that alone decide a
// branch or end a loop, at every submit, and renders took up to four times as long. See by_lane in
// shaders/lib/buffers.glsl. And that how many lanes it has is nothing that a picture shows.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "image_io.h"
#include "support/command_folder.h"
#include "support/images.h"
#include "support/test_device.h"

using namespace vkvol;
namespace fs = std::filesystem;

namespace {

// Number of kernels in Mesa's cache; it has one of its own for this folder.
std::ptrdiff_t entries(const Folder& folder) {
    const fs::recursive_directory_iterator files(folder.file("cache"));
    return std::count_if(begin(files), end(files), [](const fs::directory_entry& entry) {
        return entry.is_regular_file() && entry.path().filename() != "index" && entry.file_size() > 0;
    });
}

void check_one_kernel_for(const std::string& scene, const std::string& options) {
    const Folder folder("");
    fs::create_directory(folder.file("cache"));
    folder.write("scene.xml", scene);
    folder.write("cube.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    const auto render = [&](double x) {
        const Run run = folder.vkvol(fmt::format("scene.xml -q {} -D x={} --spp 6", options, x),
                                     fmt::format("MESA_SHADER_CACHE_DIR='{}'", folder.file("cache").string()));
        INFO(run.text);
        REQUIRE(run.code == 0);
        return entries(folder);
    };
    const std::ptrdiff_t kernels = render(0.25);
    CHECK(kernels > 0);
    CHECK(render(0.75) == kernels);
}

} // namespace

TEST_CASE("the driver compiles a kernel once", "[gpu][command]") {
    if (test_device().info().name.find("llvmpipe") == std::string::npos) {
        WARN("skipped: it is about Mesa's lavapipe");
        return;
    }
    const std::string picture = "<width>8</width><height>8</height>";
    const std::string camera = R"(<camera x="$x" y="1.5" z="6" pitch="-4" lensRadius="0.1" focus="6" blades="6"/>)";
    // Planes, a hierarchy, lamps, suns and a sky, a lens, layers.
    const std::string still_life = "<options>" + picture + camera + R"(
        <film aov="depth direct"/>
        <box width="3" height="2" depth="2"/><sigma_a>0.2</sigma_a><sigma_s>0.6</sigma_s>
        <lights><sphere x="2" y="3" radius="0.3" r="9" g="$x" b="5"/><sun y="1" x="$x" r="1" angle="2"/>
          <daylight y="1" z="$x"/></lights>
        <surfaces><plane y="-1" lookAt="0 5 0" r="0.5" g="$x" b="0.5"/><sphere x="$x" y="-0.5" radius="0.4"/></surfaces>
        </options>)";
    check_one_kernel_for(still_life, "--schedule fused");
    check_one_kernel_for(still_life, "--schedule staged");
    // A mesh with noise, and particles.
    check_one_kernel_for("<options>" + picture + camera + R"(
        <models><model>cube.obj</model></models><noise frequency="3" octaves="3"/>
        <sigma_a>0.2</sigma_a><sigma_s>$x</sigma_s><backgroundColor r="$x"/>
        <lights><point x="2" y="3" z="$x" r="9" g="9" b="5"/></lights></options>)",
                         "--integrator bidirectional");
}

// A lane knows nothing of its neighbours.
TEST_CASE("the driver's lanes change no bit", "[gpu][command][long]") {
    if (test_device().info().name.find("llvmpipe") == std::string::npos) {
        WARN("skipped: it is about Mesa's lavapipe");
        return;
    }
    const Folder folder("");
    folder.write("scene.xml", R"(<options><width>24</width><height>16</height><rayPerPixelCount>16</rayPerPixelCount>
        <camera y="1" z="6" pitch="-4"/><sphere radius="1.5"/><noise frequency="3" octaves="3"/><sigma_s>4</sigma_s>
        <lights><sun y="1" x="1" r="3" g="3" b="3"/><daylight y="1"/></lights>
        <surfaces><plane y="-1.5" lookAt="0 5 0"/><sphere x="1" y="-1" z="1" radius="0.4" material="dielectric"/></surfaces>
        </options>)");
    const auto picture = [&](const char* name, const char* environment) {
        const Run run = folder.vkvol(fmt::format("scene.xml -q --schedule fused --seed 3 -o {}.exr", name),
                                     fmt::format("MESA_SHADER_CACHE_DISABLE=true {}", environment));
        INFO(run.text);
        REQUIRE(run.code == 0);
        return read_exr(folder.file(std::string(name) + ".exr"));
    };
    const Film eight = picture("eight", "LP_NATIVE_VECTOR_WIDTH=256");
    CHECK(same_bits(eight, picture("four", "LP_NATIVE_VECTOR_WIDTH=128")));
    CHECK(same_bits(eight, picture("all", "")));
    const Run devices = folder.vkvol("devices", "LP_NATIVE_VECTOR_WIDTH=256");
    CHECK_THAT(devices.text, Catch::Contains("256 bits"));
}
