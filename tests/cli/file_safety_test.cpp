// What a user has is not lost: inputs stay, no output takes another's place, and one that fails takes no other with it.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "checkpoint_file.h"
#include "error.h"
#include "file_uses.h"
#include "image_io.h"
#include "support/command_folder.h"
#include "test_paths.h"

using namespace vkvol;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

nlohmann::json report_of(const Folder& folder, const char* name) {
    return nlohmann::json::parse(folder.text(name));
}

// A checkpoint of the ball, as an interrupted render leaves it.
void leave_checkpoint(const Folder& folder, const std::string& environment = "") {
    const Run run = folder.script(
        environment + " \"$vkvol\" ball.xml -o ball.exr -q --spp 1000000000 --checkpoint 0.1s "
                      "${VKVOL_TEST_DEVICE:+--device \"$VKVOL_TEST_DEVICE\"} & "
                      "until [ -f ball.checkpoint ] || ! kill -0 $!; do sleep 0.05; done; kill -TERM $!; wait $!");
    REQUIRE(run.code == exit_interrupted);
    REQUIRE(fs::exists(folder.file("ball.checkpoint")));
}

} // namespace

TEST_CASE("one file by any name", "[cpu][command]") {
    const Folder folder("");
    const auto in = [&](const char* name) { return folder.file(name); };
    folder.write("a", "");
    fs::create_symlink("a", in("soft"));
    fs::create_hard_link(in("a"), in("hard"));
    fs::create_directory(in("folder"));
    fs::create_directory_symlink("folder", in("door"));
    for (const char* name : {"a", "./a", "folder/../a", "soft", "hard"})
        CHECK(is_same_file(in("a"), in(name)));
    CHECK_FALSE(is_same_file(in("a"), in("folder/a")));
    CHECK(is_same_file(in("folder/none"), in("door/none"))); // once they are there
    CHECK(is_same_file(in("none"), in("folder/../none")));
    CHECK_FALSE(is_same_file(in("none"), in("a")));
    CHECK_FALSE(is_same_file("/dev/null", "/dev/null"));
}

TEST_CASE("what cannot be written as a picture is not rendered to the end", "[gpu][command]") {
    // A copy of the program, without the library that writes pictures.
    const Folder folder("");
    const Run run = folder.script("cp \"$vkvol\" alone && ./alone ball.xml -o ball.exr -q --spp 1000000000");
    INFO(run.text);
    CHECK(run.code == exit_render_failed);
    CHECK_THAT(run.text, Contains("pictures can be neither read nor written") && Contains("libvkvol_codec.so") &&
                             Contains("install vkvol again"));
    CHECK_FALSE(fs::exists(folder.file("ball.exr")));
    CHECK(folder.script("./alone integrators").code == exit_done);
}

TEST_CASE("no output is an input or another output", "[gpu][command]") {
    const Folder folder("");
    const std::string scene = folder.text("ball.xml");
    fs::create_symlink("ball.xml", folder.file("soft.json"));
    fs::create_hard_link(folder.file("ball.xml"), folder.file("hard.json"));
    const auto refused = [&](const std::string& arguments, const char* what, const char* remedy) {
        CAPTURE(arguments);
        const Run run = folder.vkvol(arguments);
        CHECK(run.code == exit_bad_input);
        CHECK_THAT(run.text, Contains(what) && Contains(remedy));
    };
    for (const char* report : {"ball.xml", "./ball.xml", "soft.json", "hard.json"})
        refused(fmt::format("ball.xml -o a.exr --report {}", report), "the scene, and would be lost to the report",
                "with --report");
    refused("ball.xml -o r.png --report r.png", "both a picture and the report", "with --report");
    refused("ball.xml -o r.png --report ./r.png", "the same file as r.png", "with --report");
    refused("ball.xml --report ball.exr", "both a picture and the report", "with --report"); // the default's name
    refused("ball.xml -o a.exr -o ./a.exr", "named twice, as a picture", "once is enough");
    refused("ball.xml -o a.exr --report a.checkpoint --checkpoint 1h", "the checkpoint and the report", "--report");
    CHECK(folder.text("ball.xml") == scene);
    CHECK_FALSE(fs::exists(folder.file("a.exr")));
    CHECK_FALSE(fs::exists(folder.file("r.png")));

    folder.write("ball.exr.xml", scene);
    CHECK(folder.vkvol("ball.exr.xml -q --report /dev/null").code == exit_done);
    CHECK(fs::exists(folder.file("ball.exr.png")));
    fs::create_symlink("/dev/null", folder.file("null.png"));
    CHECK(folder.vkvol("ball.xml -q -o null.png -o null.png").code == exit_done);
}

TEST_CASE("files that the scene names are inputs", "[gpu][command]") {
    const Folder folder("");
    fs::copy_file(VKVOL_TEST_FIELDS "/constant.nvdb", folder.file("c.nvdb"));
    folder.write("grid.xml", "<options><densityField>c.nvdb</densityField></options>");
    const std::string grid = folder.text("c.nvdb");
    for (const char* scene : {"grid.xml", "ball.xml --grid c.nvdb"}) {
        const Run run = folder.vkvol(fmt::format("{} --report c.nvdb -o a.exr", scene));
        CHECK(run.code == exit_bad_input);
        CHECK_THAT(run.text, Contains("c.nvdb is the scene's density field, and would be lost to the report"));
    }
    CHECK(folder.text("c.nvdb") == grid);
    folder.write("cube.obj", "mtllib other.mtl cube.mtl\n");
    folder.write("cube.mtl", "newmtl a\n");
    folder.write("mesh.xml", "<options><models><model>cube.obj</model></models></options>");
    for (const char* name : {"cube.obj", "cube.mtl"}) {
        const Run run = folder.vkvol(fmt::format("mesh.xml --report {} -o a.exr", name));
        CHECK(run.code == exit_bad_input);
        CHECK_THAT(run.text, Contains(fmt::format("{} is", name)) && Contains("would be lost"));
    }
    CHECK(folder.text("cube.mtl") == "newmtl a\n");
}

TEST_CASE("merge and bench keep their inputs", "[gpu][command]") {
    const Folder folder("");
    REQUIRE(folder.vkvol("ball.xml -q -o a.exr").code == exit_done);
    REQUIRE(folder.vkvol("ball.xml -q -o b.exr --seed 1").code == exit_done);
    const std::string old = folder.text("a.exr");
    const auto merged = [&](const char* output) {
        return run(fmt::format("cd '{}' && '{}' merge a.exr b.exr {}", folder.file("").string(), VKVOL_BINARY, output));
    };
    CHECK(merged("-o ./a.exr").code == exit_bad_input);
    CHECK_THAT(merged("-o ./a.exr").text, Contains("an image to be merged, and would be lost to the merged picture"));
    CHECK(merged("-o c.exr -o c.exr").code == exit_bad_input);
    CHECK(folder.text("a.exr") == old);
    const Run bench = folder.vkvol("bench ball.xml -o x --integrators deltaTracking --reference x.bench.csv");
    CHECK(bench.code == exit_bad_input);
    CHECK_THAT(bench.text, Contains("x.bench.csv is the reference"));
}

TEST_CASE("--checkpoint without --resume spares what is there", "[gpu][command][checkpoint]") {
    const Folder folder("");
    leave_checkpoint(folder);
    const std::string kept = folder.text("ball.checkpoint");
    for (const char* seed : {"--seed 0", "--seed 1"}) { // of the same render, or another
        const Run run = folder.vkvol(fmt::format("ball.xml -o ball.exr --checkpoint 1h {}", seed));
        CHECK(run.code == exit_bad_input);
        CHECK_THAT(run.text, Contains("go on from it with --resume, or remove or rename it"));
    }
    CHECK(folder.text("ball.checkpoint") == kept);
    CHECK(folder.vkvol("ball.xml -q -o ball.exr").code == exit_done); // of no concern to it
    CHECK(folder.text("ball.checkpoint") == kept);
}

TEST_CASE("--dry-run says that a checkpoint has more samples than are asked for", "[gpu][command][checkpoint]") {
    const Folder folder("");
    leave_checkpoint(folder);
    for (const char* dry : {"", " --dry-run"}) {
        const Run run = folder.vkvol(fmt::format("ball.xml -o ball.exr --spp 1 --resume{}", dry));
        CHECK(run.code == exit_bad_input);
        CHECK_THAT(run.text, Contains("samples per pixel already, more than the 1 asked for"));
    }
    CHECK(folder.vkvol("ball.xml -o ball.exr --spp 1000000000 --resume --dry-run").code == exit_done);
}

// Machines of a farm differ in how many lanes Mesa's software driver has, which changes no bit.
TEST_CASE("by eight lanes goes on what was begun by sixteen", "[gpu][command][checkpoint]") {
    const Folder folder("");
    leave_checkpoint(folder, "MESA_SHADER_CACHE_DISABLE=true LP_NATIVE_VECTOR_WIDTH=512");
    const Run run = folder.vkvol("ball.xml -o ball.exr --spp 1000000000 --resume --time 0.1s",
                                 "MESA_SHADER_CACHE_DISABLE=true LP_NATIVE_VECTOR_WIDTH=256");
    INFO(run.text);
    CHECK(run.code == exit_done);
}

TEST_CASE("what is no checkpoint is neither replaced nor removed", "[gpu][command][checkpoint]") {
    const Folder folder("");
    folder.write("ball.checkpoint", "a user's own");
    for (const char* how : {"--checkpoint 1h", "--resume", "--checkpoint 1h --resume"}) {
        const Run run = folder.vkvol(fmt::format("ball.xml -o ball.exr {}", how));
        CHECK(run.code == exit_bad_input);
        CHECK_THAT(run.text, Contains("no checkpoint of vkvol") && Contains("rename it"));
    }
    CHECK(folder.text("ball.checkpoint") == "a user's own");
    fs::remove(folder.file("ball.checkpoint"));
    fs::create_directory(folder.file("ball.checkpoint"));
    for (const char* how : {"--checkpoint 1h", "--resume"})
        CHECK_THAT(folder.vkvol(fmt::format("ball.xml -o ball.exr {}", how)).text, Contains("is a directory"));
    fs::remove(folder.file("ball.checkpoint"));
}

TEST_CASE("what takes a checkpoint's place during the render stays", "[cpu][checkpoint]") {
    const Folder folder("");
    RenderOptions options;
    options.outputs = {folder.file("ball.exr")};
    options.checkpoint = 1.0;
    CheckpointFile file(options);
    file.check();
    const Checkpoint checkpoint;
    SECTION("before the first") {
        folder.write("ball.checkpoint", "mine");
        file.keep(checkpoint);
        CHECK(file.advice().empty());
    }
    SECTION("after it") {
        file.keep(checkpoint);
        CHECK(is_checkpoint(file.path()));
        CHECK_THROWS_WITH(file.check(), Contains("a checkpoint is there already"));
        folder.write("ball.checkpoint", "mine");
        file.keep(checkpoint);
    }
    file.remove();
    CHECK(folder.text("ball.checkpoint") == "mine");
    fs::remove(file.path());
    file.keep(checkpoint);
    file.remove(); // its own
    CHECK_FALSE(fs::exists(file.path()));
}

TEST_CASE("one output that fails takes no other with it", "[gpu][command]") {
    const Folder folder("");
    fs::create_symlink("/dev/full", folder.file("full.exr"));
    fs::create_symlink("/dev/full", folder.file("full.json"));
    const Run picture = folder.vkvol("ball.xml -q -o full.exr -o a.png -o b.exr --report r.json");
    CHECK(picture.code == exit_render_failed);
    CHECK_THAT(picture.text, Contains("full.exr: cannot be written: No space left") && Contains("with -o") &&
                                 Contains("; written: b.exr, a.png, r.json"));
    CHECK(fs::exists(folder.file("a.png")));
    CHECK(read_exr(folder.file("b.exr")).width() == 16);
    const auto json = report_of(folder, "r.json");
    CHECK_THAT(json["error"].get<std::string>(), Contains("full.exr: cannot be written"));
    CHECK(json["samplesPerPixel"]["most"] == 8);

    const Run report = folder.vkvol("ball.xml -q -o c.exr --report full.json");
    CHECK(report.code == exit_render_failed);
    CHECK_THAT(report.text,
               Contains("full.json: cannot be written") && Contains("with --report") && Contains("; written: c.exr"));
    CHECK_THAT(report.text, !Contains("with -o"));

    const auto merge =
        run(fmt::format("cd '{}' && '{}' merge b.exr -o full.exr -o d.exr", folder.file("").string(), VKVOL_BINARY));
    CHECK(merge.code == exit_render_failed);
    CHECK_THAT(merge.text, Contains("; written: d.exr"));
}

TEST_CASE("the report says why a render failed", "[gpu][command]") {
    const Folder folder("");
    REQUIRE(folder.vkvol("ball.xml -q -o a.exr --report r.json").code == exit_done);
    CHECK(report_of(folder, "r.json")["error"].is_null());
    const Run device = run(fmt::format("cd '{}' && '{}' ball.xml -q --device none-such --report r.json",
                                       folder.file("").string(), VKVOL_BINARY));
    CHECK(device.code == exit_no_device);
    CHECK_THAT(report_of(folder, "r.json")["error"].get<std::string>(), Contains("none-such"));
    CHECK(report_of(folder, "r.json")["device"].is_null());
    folder.write("grid.xml", "<options><densityField>none.nvdb</densityField></options>");
    CHECK(folder.vkvol("grid.xml -q -o a.exr --report r.json").code == exit_bad_input);
    CHECK_THAT(report_of(folder, "r.json")["error"].get<std::string>(), Contains("none.nvdb"));
    CHECK(report_of(folder, "r.json")["device"].is_object());
    const Run late = folder.vkvol("ball.xml -o none.exr --width 8000 --time 1us --report r.json");
    CHECK(late.code == exit_bad_input); // no such unit: nothing was begun, and the report is the old one
}

TEST_CASE("no frame of a sequence takes another's picture", "[gpu][command]") {
    const Folder folder("");
    std::string scene = folder.text("ball.xml");
    scene.replace(scene.find("<options>"), 9, "<options><russianRoulette threshold=\"${=${F:-1}/100}\"/>");
    folder.write("turn.xml", scene);
    const Run run = folder.vkvol("turn.xml -f 1,11 -q -o 'a.#.png' -o 'a.1#.png'");
    CHECK(run.code == exit_bad_input);
    CHECK_THAT(run.text, Contains("frame 11: a.11.png is frame 1's too") && Contains("####"));
    CHECK_FALSE(fs::exists(folder.file("a.1.png")));
    CHECK(folder.vkvol("turn.xml -f 1,11 -q -o 'a.##.png'").code == exit_done);
    CHECK((fs::exists(folder.file("a.01.png")) && fs::exists(folder.file("a.11.png"))));
}

TEST_CASE("no frame of a sequence writes over what another one reads", "[gpu][command]") {
    const Folder folder("");
    std::string scene = folder.text("ball.xml");
    scene.replace(scene.find("<options>"), 9,
                  "<options><surfaces><rectangle y=\"-2\" lookAt=\"0 1 0\" texture=\"tex.${= F-1}.png\"/></surfaces>");
    REQUIRE(folder.vkvol("ball.xml -q -o tex.0.png").code == exit_done);
    fs::copy_file(folder.file("tex.0.png"), folder.file("tex.1.png"));
    folder.write("turn.xml", scene);
    const std::string kept = folder.text("tex.1.png");
    for (const char* frames : {"1,2", "2,1"}) // where the writer is first, and the reader
        for (const char* dry : {"", " --dry-run"}) {
            const Run run = folder.vkvol(fmt::format("turn.xml -f {} -q -o 'tex.%d.png'{}", frames, dry));
            INFO(run.text);
            CHECK(run.code == exit_bad_input);
            CHECK_THAT(run.text, Contains("is a texture of the scene in frame") &&
                                     Contains("would be lost to a picture of frame"));
        }
    CHECK(folder.text("tex.1.png") == kept);
    CHECK(folder.vkvol("turn.xml -f 1,2 -q -o 'a.%d.png'").code == exit_done);
}

TEST_CASE("one picture that cannot be developed takes no other with it", "[gpu][command]") {
    const Folder folder("");
    REQUIRE(folder.vkvol("ball.xml -q -o a.exr").code == exit_done);
    fs::create_symlink("/dev/full", folder.file("full.png"));
    const Run run = folder.vkvol("develop a.exr -o full.png -o b.png --exposure +1");
    CHECK(run.code == exit_render_failed);
    CHECK_THAT(run.text, Contains("full.png: cannot be written") && Contains("written: b.png"));
    CHECK(fs::exists(folder.file("b.png")));
}

TEST_CASE("the report says what no method renders", "[gpu][command]") {
    const Folder folder("");
    folder.write("r.json", "{\"error\": null}");
    CHECK(folder.vkvol("ball.xml -q --integrator lightTracing --aov depth -o a.exr --report r.json").code ==
          exit_bad_input);
    const auto json = report_of(folder, "r.json");
    CHECK_THAT(json["error"].get<std::string>(), Contains("layers"));
    CHECK(json["sceneHash"].is_null());
}
