// Sequences by -f, and --dry-run.
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <set>
#include <thread>
#include <unistd.h>

#include "error.h"
#include "field_cache.h"
#include "frames.h"
#include "image_io.h"
#include "support/command_folder.h"
#include "support/shell.h"
#include "support/thorough.h"
#include "test_paths.h"

using namespace vkvol;
using Catch::Contains;

namespace {

std::string frames_error(const std::string& text) {
    try {
        parse_frames(text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

std::string options_error(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "vkvol");
    try {
        parse_options(int(arguments.size()), arguments.data());
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

void copy_field(const char* field, const std::filesystem::path& to) {
    std::filesystem::copy_file(std::filesystem::path(VKVOL_TEST_FIELDS) / field, to,
                               std::filesystem::copy_options::overwrite_existing);
}

// A ball that glows as brightly as its frame says.
class Turntable {
public:
    explicit Turntable(const std::string& glow) {
        std::filesystem::create_directories(path_);
        std::ofstream(path_ / "ball.xml") << "<options><sphere radius=\"1\"/><sigma_a>1</sigma_a><sigma_s>0</sigma_s>"
                                             "<width>8</width><height>8</height><rayPerPixelCount>2</rayPerPixelCount>"
                                             "<camera z=\"5\" fov=\"30\"/><medium r=\""
                                          << glow << "\"/></options>";
    }
    ~Turntable() { std::filesystem::remove_all(path_); }
    Turntable(const Turntable&) = delete;
    Turntable& operator=(const Turntable&) = delete;

    Run vkvol(const std::string& arguments) const {
        const char* device = std::getenv("VKVOL_TEST_DEVICE");
        return run(fmt::format("cd '{}' && '{}' {}{}", path_.string(), VKVOL_BINARY, arguments,
                               device ? fmt::format(" --device '{}'", device) : ""));
    }
    std::set<std::string> files() const {
        std::set<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(path_))
            names.insert(entry.path().filename().string());
        return names;
    }
    std::filesystem::path file(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_ = std::filesystem::temp_directory_path() / fmt::format("vkvol-frames-{}", getpid());
};

} // namespace

TEST_CASE("frames are read", "[cpu][options]") {
    CHECK(parse_frames("3") == std::vector<int>{3});
    CHECK(parse_frames("1..4") == std::vector<int>{1, 2, 3, 4});
    CHECK(parse_frames("1..8x3") == std::vector<int>{1, 4, 7});
    CHECK(parse_frames("3..0") == std::vector<int>{3, 2, 1, 0});
    CHECK(parse_frames("9..1x4") == std::vector<int>{9, 5, 1});
    CHECK(parse_frames("1,5,9") == std::vector<int>{1, 5, 9});
    CHECK(parse_frames("1..3,10..20x5,7") == std::vector<int>{1, 2, 3, 10, 15, 20, 7});
    CHECK(parse_frames("7..7") == std::vector<int>{7});
    CHECK(parse_frames("1..100000").size() == 100000);
    for (const char* wrong : {"", "a", "-1", "1..", "..3", "1-3", "1..3x", "1..3x0", "1,", "1..3 ", "1.5", "99999999"})
        CHECK_THAT(frames_error(wrong), Contains("expected frames such as 3, 1..8, 1..48x4 or 1,5,9"));
    CHECK_THAT(frames_error("1..3,2"), Contains("has frame 2 twice"));
    CHECK_THAT(frames_error("0..100000"), Contains("more than 100000"));
    for (const char* text : {"3", "1..4", "1..7x3", "3..0", "1,5", "1,2", "1..3,10..20x5,7"})
        CHECK(frames_text(parse_frames(text)) == text);
}

TEST_CASE("a frame's number has its place in the names of files", "[cpu][options]") {
    CHECK(frame_file("a/b.exr", 7) == "a/b.0007.exr");
    CHECK(frame_file("b.####.exr", 7) == "b.0007.exr");
    CHECK(frame_file("b##-#.exr", 7) == "b07-7.exr");
    CHECK(frame_file("b%04d.exr", 7) == "b0007.exr");
    CHECK(frame_file("b%d.exr", 12) == "b12.exr");
    CHECK(frame_file("b$F.exr", 7) == "b7.exr");
    CHECK(frame_file("b$F4.exr", 7) == "b0007.exr");
    CHECK(frame_file("b${F3}c${F}.exr", 7) == "b007c7.exr");
    CHECK(frame_file("b.##.exr", 12345) == "b.12345.exr");
    CHECK(frame_file("100%.$X.exr", 7) == "100%.$X.0007.exr");
    CHECK(frame_file("c#/b.exr", 7) == "c#/b.0007.exr"); // of the file alone
    CHECK(frame_file("/dev/null", 7) == "/dev/null");
}

TEST_CASE("what does not go together with frames is refused", "[cpu][options]") {
    CHECK_THAT(options_error({"s.xml", "-f", "1..3", "-D", "F=2"}), Contains("-D F=2: with -f, F is the number"));
    CHECK_THAT(options_error({"s.xml", "-f", "1..3", "-D", "F4=2"}), Contains("with -f, F is the number"));
    CHECK_THAT(options_error({"s.xml", "-f", "1..3", "--trace", "--pixel", "1,1", "--sample", "0"}),
               Contains("choose the frame with -D F=3"));
    CHECK_THAT(options_error({"s.xml", "-f", ""}), Contains("-f: is empty"));
    CHECK(options_error({"s.xml", "-f", "1..3", "-D", "speed=2"}) == "no error");
}

TEST_CASE("a kept grid is the file's, and read again once that changes", "[cpu][density]") {
    const std::filesystem::path copy =
        std::filesystem::temp_directory_path() / fmt::format("vkvol-kept-{}.nvdb", getpid());
    copy_field("ramp.nvdb", copy);
    FieldCache cache;
    const GridFile file{copy, "density"};
    DensityField field = cache.take(file);
    CHECK(field.max_value() == 1.0f);
    const DensityField again = cache.take(file);
    CHECK(again.bytes.data() == field.bytes.data()); // the same memory
    CHECK(again.leaf_table.data() == field.leaf_table.data());
    field.bytes.edit()[0] = std::byte{1}; // a copy of its own then
    CHECK(again.bytes.data() != field.bytes.data());
    CHECK(again.bytes.data()[0] != std::byte{1});
    CHECK(cache.has(file));
    CHECK_FALSE(cache.has({copy, "temperature"}));
    cache.retain({file});
    CHECK(cache.take(file).bytes.data() == again.bytes.data());
    cache.retain({});
    CHECK(cache.take(file).bytes.data() != again.bytes.data());
    copy_field("sphere.nvdb", copy);
    CHECK(cache.take(file).active_voxels == 14328);
    std::filesystem::remove(copy);
    CHECK_THROWS_AS(cache.take(file), InputError);
}

TEST_CASE("a foreseen grid is the file's as it is when it is taken", "[cpu][density]") {
    const std::filesystem::path copy =
        std::filesystem::temp_directory_path() / fmt::format("vkvol-foreseen-{}.nvdb", getpid());
    copy_field("ramp.nvdb", copy);
    FieldCache cache;
    const GridFile file{copy, "density"}, missing{copy, "temperature"};
    cache.foresee({file, missing, {copy, ""}});
    cache.retain({});
    const DensityField field = cache.take(file);
    CHECK(field.max_value() == 1.0f);
    CHECK_THROWS_AS(cache.take(missing), InputError);
    cache.foresee({file}); // which is here
    CHECK(cache.take(file).bytes.data() == field.bytes.data());
    cache.retain({});
    cache.foresee({file});
    std::this_thread::sleep_for(std::chrono::milliseconds(200)); // in which it is read, as a rule
    copy_field("sphere.nvdb", copy);
    CHECK(cache.take(file).active_voxels == 14328);
    cache.foresee({file});
    cache.foresee({});
    std::filesystem::remove(copy);
    CHECK_THROWS_AS(cache.take(file), InputError);
}

TEST_CASE("a sequence is the pictures of its frames", "[gpu][command]") {
    const Turntable scene("${= 0.5*$F}");
    const Run run = scene.vkvol("ball.xml -f 1..5x2 --report r.json");
    INFO(run.text);
    CHECK(run.code == exit_done);
    CHECK_THAT(run.text, Contains("3 frames (1..5x2)"));
    CHECK(scene.files() == std::set<std::string>{"ball.xml", "ball.0001.exr", "ball.0001.png", "ball.0003.exr",
                                                 "ball.0003.png", "ball.0005.exr", "ball.0005.png", "r.0001.json",
                                                 "r.0003.json", "r.0005.json"});
    CHECK(scene.vkvol("ball.xml -D F=3 -o alone.exr -q").code == exit_done);
    const Film alone = read_exr(scene.file("alone.exr")), frame = read_exr(scene.file("ball.0003.exr"));
    CHECK(alone.mean == frame.mean);
    CHECK(frame.mean != read_exr(scene.file("ball.0005.exr")).mean);
    CHECK(scene.vkvol("ball.xml -f 12,3 -o 'a.##.png' -q").text.empty());
    CHECK(scene.files().count("a.03.png") == 1);
    CHECK(scene.files().count("a.12.png") == 1);
}

TEST_CASE("an interrupted sequence says how to go on, and does", "[gpu][command]") {
    const Folder folder("");
    folder.write("two.xml", "<options><sphere/><sigma_a>1</sigma_a><width>16</width><height>16</height><camera z='5'/>"
                            "<rayPerPixelCount>${= max(1, (F - 1) * 400000000)}</rayPerPixelCount></options>");
    const Run stopped =
        folder.script("\"$vkvol\" two.xml -f 1..3 -o a.#.exr --checkpoint 0.1s & "
                      "until [ -f a.2.checkpoint ] || ! kill -0 $!; do sleep 0.02; done; kill -TERM $!; wait $!");
    INFO(stopped.text);
    CHECK(stopped.code == exit_interrupted);
    CHECK_THAT(stopped.text, Contains("interrupted at frame 2: 1 of 3 frames are done; -f 2,3 goes on, with --resume"));
    CHECK_FALSE(std::filesystem::exists(folder.file("a.3.exr")));
    const std::uint32_t before = read_exr(folder.file("a.2.exr")).samples.front();
    // What was interrupted is not there, also without its checkpoint.
    std::filesystem::rename(folder.file("a.2.checkpoint"), folder.file("kept"));
    CHECK_THAT(folder.vkvol("two.xml -f 1..1 -o a.#.exr --resume").text, Contains("frame 1: a.1.exr is there"));
    CHECK_THAT(folder.vkvol("two.xml -f 2..2 -o a.#.exr --resume", "timeout --preserve-status -s INT 1 ").text,
               !Contains("is there"));
    std::filesystem::rename(folder.file("kept"), folder.file("a.2.checkpoint"));
    const Run on = folder.vkvol("two.xml -f 2..3 -o a.#.exr --checkpoint 0.1s --resume --time 0.2s -q");
    INFO(on.text);
    CHECK(on.code == exit_done);
    CHECK(read_exr(folder.file("a.2.exr")).samples.front() > before);
    CHECK(read_exr(folder.file("a.3.exr")).samples.front() > 0);
}

TEST_CASE("a sequence that is gone on with passes over the frames that are there", "[gpu][command]") {
    const Turntable scene("${= 0.5*$F}");
    REQUIRE(scene.vkvol("ball.xml -f 1..3 -o a.#.exr -o a.#.png -q").code == exit_done);
    const auto written = [&](const char* name) { return std::filesystem::last_write_time(scene.file(name)); };
    const auto first = written("a.1.exr"), second = written("a.2.exr"), third = written("a.3.exr");
    std::filesystem::remove(scene.file("a.2.png"));
    const Run on = scene.vkvol("ball.xml -f 1..4 -o a.#.exr -o a.#.png --resume");
    INFO(on.text);
    CHECK(on.code == exit_done);
    CHECK_THAT(on.text, Contains("frame 1: a.1.exr is there") && Contains("frame 3: a.3.exr is there") &&
                            !Contains("frame 2:") && Contains("4 frames (1..4)"));
    CHECK((written("a.1.exr") == first && written("a.3.exr") == third && written("a.2.exr") != second));
    CHECK(std::filesystem::exists(scene.file("a.4.png")));
    // With other samples, or another integrator or window, they are no longer what was asked for.
    const std::vector<const char*> others{"--spp 3",        "--seed 4",        "--integrator ratioTracking",
                                          "--crop 0,4,0,4", "--noise 50%",     "--time 0.2",
                                          "--aov depth",    "--report r.json", "-D unused=1"};
    for (const char* other : in_turn(others, 2)) {
        const bool is_wrong = std::string(other).starts_with("-D");
        CAPTURE(other);
        const Run again = scene.vkvol(fmt::format("ball.xml -f 1..2 -o a.#.exr --resume {}", other));
        CHECK(again.code == (is_wrong ? exit_bad_input : exit_done));
        CHECK_THAT(again.text, !Contains("is there"));
    }
    // A picture that would show otherwise is not there.
    REQUIRE(scene.vkvol("ball.xml -f 1..1 -o t.#.exr -o t.#.png --exposure 1 -q").code == exit_done);
    CHECK_THAT(scene.vkvol("ball.xml -f 1..1 -o t.#.exr -o t.#.png --exposure 1 --resume").text, Contains("is there"));
    CHECK_THAT(scene.vkvol("ball.xml -f 1..1 -o t.#.exr --resume").text, Contains("is there"));
    CHECK_THAT(scene.vkvol("ball.xml -f 1..1 -o t.#.exr -o t.#.png --exposure 2 --resume").text, !Contains("is there"));
    // Nor one that is older than the samples it would be of.
    REQUIRE(scene.vkvol("ball.xml -f 1..1 -o u.#.exr -o v.#.png -q").code == exit_done);
    std::filesystem::last_write_time(scene.file("v.1.png"),
                                     std::filesystem::last_write_time(scene.file("u.1.exr")) - std::chrono::seconds(9));
    CHECK_THAT(scene.vkvol("ball.xml -f 1..1 -o u.#.exr -o v.#.png --resume").text, !Contains("is there"));
    // Nor is one that the camera exposes otherwise, or whose layers are of other lights.
    const auto write_with = [&](const char* iso, const char* group) {
        std::ofstream(scene.file("lit.xml"))
            << "<options><sphere/><sigma_a>1</sigma_a><sigma_s>1</sigma_s><width>8</width><height>8</height><camera "
               "z=\"5\" yaw=\"$F\" fov=\"30\" shutter=\"0.01\" fNumber=\"8\" iso=\""
            << iso << "\"/><light y=\"1\" r=\"1\" group=\"" << group << "\"/></options>";
    };
    const std::string lit = "lit.xml -f 1..1 -o g.#.exr --aov groups --resume";
    for (const auto& [iso, group] : {std::pair("100", "key"), std::pair("800", "key"), std::pair("800", "sun")}) {
        CAPTURE(iso, group);
        write_with(iso, group);
        CHECK_THAT(scene.vkvol(lit).text, !Contains("is there"));
        CHECK_THAT(scene.vkvol(lit).text, Contains("is there"));
    }
    // A frame whose time is over is done.
    const std::string timed = "ball.xml -f 1..1 -o l.#.exr --time 0.3 --checkpoint 0.05s --resume";
    REQUIRE(scene.vkvol(timed + " -q").code == exit_done);
    CHECK_THAT(scene.vkvol(timed).text, Contains("l.1.exr is there"));
    // What only shows says nothing of itself.
    REQUIRE(scene.vkvol("ball.xml -f 1..2 -o p.#.png -q").code == exit_done);
    CHECK_THAT(scene.vkvol("ball.xml -f 1..2 -o p.#.png --resume").text, !Contains("is there"));
}

TEST_CASE("a report that tells of a failure is no frame's", "[gpu][command][long]") {
    const Turntable scene("${= 0.5*$F}");
    REQUIRE(scene.vkvol("ball.xml -f 1..2 -o a.#.exr -q").code == exit_done);
    CHECK_THAT(scene.vkvol("ball.xml -f 1..3 -o a.#.exr --resume --dry-run").text,
               Contains("frame 1: a.1.exr is there") && Contains("would write a.3.exr") &&
                   !Contains("would write a.1"));
    const std::string reported = "ball.xml -f 1..1 -o a.#.exr --report r.#.json --resume";
    CHECK(run(fmt::format("cd '{}' && '{}' {} --device none", scene.file("").string(), VKVOL_BINARY, reported)).code ==
          exit_no_device);
    CHECK(std::filesystem::exists(scene.file("r.1.json")));
    CHECK_THAT(scene.vkvol(reported).text, !Contains("is there"));
    CHECK_THAT(scene.vkvol(reported).text, Contains("is there"));
}

TEST_CASE("a frame without a picture ends its sequence by name", "[gpu][command]") {
    const Turntable scene("${= 0.5*$F}");
    const Run nothing = scene.vkvol("ball.xml -f 7..9 -o a.#.exr --time 0.00000001");
    INFO(nothing.text);
    CHECK(nothing.code == exit_render_failed);
    CHECK_THAT(nothing.text, Contains("frame 7 has no picture: 0 of 3 frames are done"));
}

TEST_CASE("a sequence that is killed again and again has the bits of one that is not", "[gpu][command][long]") {
    const Folder folder("");
    folder.write("turn.xml",
                 "<options><sphere/><noise octaves='4'/><sigma_s>20</sigma_s><width>32</width><height>32</height>"
                 "<camera lookAt='0 0 0' distance='5' azimuth='${= 40*F}' fov='30'/><light y='1' r='3' g='3' b='3'/>"
                 "<rayPerPixelCount>100</rayPerPixelCount></options>");
    REQUIRE(folder.vkvol("turn.xml -f 1..6 -o whole.#.exr -q").code == exit_done);
    int kills = 0;
    const int times = thorough() ? 10 : 2;
    for (int k = 0; k < times; ++k) // after 0.5 to 1.4 s, at random as the machine goes
        kills += folder
                     .script(fmt::format("timeout -s KILL {} \"$vkvol\" turn.xml -f 1..6 -o a.#.exr --checkpoint 0.05s "
                                         "--resume -q",
                                         0.5 + 0.9 * k / (times - 1)))
                     .code != exit_done;
    REQUIRE(folder.vkvol("turn.xml -f 1..6 -o a.#.exr --checkpoint 0.05s --resume -q").code == exit_done);
    CHECK(kills > 0);
    for (int frame = 1; frame <= 6; ++frame) {
        const Film whole = read_exr(folder.file(fmt::format("whole.{}.exr", frame))),
                   parts = read_exr(folder.file(fmt::format("a.{}.exr", frame)));
        CHECK(whole.mean == parts.mean);
        CHECK(whole.variance == parts.variance);
        CHECK(whole.samples == parts.samples);
    }
}

TEST_CASE("a file that a late frame lacks is missed before the first one is rendered", "[gpu][command]") {
    const Folder folder("");
    folder.write("s.xml",
                 "<options><sphere/><sigma_s>1</sigma_s><surfaces><mesh file='m.${F}.obj'/></surfaces></options>");
    folder.write("m.1.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Run run = folder.vkvol("s.xml -f 1,2 -q --spp 1 -o 'a.#.png'");
    CHECK(run.code == exit_bad_input);
    CHECK_THAT(run.text, Contains("frame 2: ") && Contains("m.2.obj: no such file") && !Contains("is done"));
    CHECK(folder.text("a.1.png").empty());
    const Run measured = folder.vkvol("measure s.xml -D F=1,2 -q");
    CHECK(measured.code == exit_bad_input);
    CHECK_THAT(measured.text, Contains("m.2.obj: no such file"));
}

TEST_CASE("grids of a sequence go by its frames", "[gpu][command][long]") {
    const Folder folder("");
    folder.write("grid.xml", "<options><densityField>none.nvdb</densityField><sigma_a>0.1</sigma_a><width>8</width>"
                             "<height>8</height><rayPerPixelCount>2</rayPerPixelCount>"
                             "<backgroundColor r='1' g='1' b='1'/></options>");
    const auto field = [&](const char* name, const char* as) {
        std::filesystem::copy_file(fmt::format("{}/{}.nvdb", VKVOL_TEST_FIELDS, name), folder.file(as));
    };
    field("sphere", "smoke.0002.nvdb");
    field("ramp", "smoke.0010.nvdb");
    field("ramp", "smoke.10.nvdb"); // as long as this is no name of the pattern's
    const Run run = folder.vkvol("grid.xml --grid smoke.####.nvdb -f files");
    INFO(run.text);
    CHECK(run.code == exit_done);
    CHECK_THAT(run.text, Contains("2 frames (2,10)"));
    REQUIRE(folder.vkvol("grid.xml --grid smoke.0002.nvdb -o two.exr -q").code == exit_done);
    REQUIRE(folder.vkvol("grid.xml --grid smoke.0010.nvdb -o ten.exr -q").code == exit_done);
    CHECK(read_exr(folder.file("grid.0002.exr")).mean == read_exr(folder.file("two.exr")).mean);
    CHECK(read_exr(folder.file("grid.0010.exr")).mean == read_exr(folder.file("ten.exr")).mean);
    CHECK_THAT(folder.vkvol("grid.xml --grid smoke.####.nvdb -f 1..2").text,
               Contains("frame 1: ") && Contains("smoke.0001.nvdb"));
    CHECK_THAT(folder.vkvol("grid.xml --grid fog.####.nvdb -f files").text, Contains("there is no file fog.####.nvdb"));
    CHECK_THAT(folder.vkvol("grid.xml --grid fog.nvdb -f files").text, Contains("has no place for the number"));
    CHECK_THAT(folder.vkvol("grid.xml -f files").text, Contains("add e.g. --grid"));
    CHECK_THAT(folder.vkvol("grid.xml --grid smoke.0002.nvdb -f 1..2").text, Contains("all frames would be the same"));
}

TEST_CASE("errors of a sequence say in which frame, before any is rendered", "[gpu][command]") {
    const Turntable scene("${= 1/(3-F)}");
    const Run run = scene.vkvol("ball.xml -f 1..5");
    CHECK(run.code == exit_bad_input);
    CHECK_THAT(run.text, Contains("frame 3: ball.xml:1:") && Contains("division by zero"));
    CHECK(scene.files() == std::set<std::string>{"ball.xml"});
    const Turntable still("1");
    CHECK_THAT(still.vkvol("ball.xml -f 1..5").text, Contains("all frames would be the same; write $F"));
}

TEST_CASE("--dry-run checks everything and leaves nothing", "[gpu][command]") {
    const Turntable scene("${F:-1}");
    const Run one = scene.vkvol("ball.xml --dry-run --report r.json --width 4");
    INFO(one.text);
    CHECK(one.code == exit_done);
    CHECK_THAT(one.text, Contains("ball.xml: 4x4 pixels, 2 samples per pixel, deltaTracking (unbiased)"));
    CHECK_THAT(one.text, Contains("would write ball.exr, ball.png, r.json"));
    const Run frames = scene.vkvol("ball.xml --dry-run -f 2..3 -o 'x.#.png'");
    CHECK(frames.code == exit_done);
    CHECK_THAT(frames.text,
               Contains("ball.xml, frame 3: 8x8") && Contains("would write x.3.png") && Contains("2 frames checked"));
    CHECK(scene.files() == std::set<std::string>{"ball.xml"});
    CHECK(scene.vkvol("ball.xml --dry-run -q").text.empty());
    CHECK(scene.vkvol("ball.xml --dry-run --report r.json -o ball.xml.exr --grid none.nvdb").code == exit_bad_input);
    CHECK(scene.vkvol("ball.xml --dry-run -o none/a.exr").code == exit_bad_input);
    CHECK(scene.vkvol("ball.xml --dry-run --grid none.nvdb").code == exit_bad_input);
    CHECK(scene.vkvol("ball.xml --dry-run --crop 0,9,0,1").code == exit_bad_input);
    CHECK(run(fmt::format("'{}' '{}' --dry-run --device no-such-device", VKVOL_BINARY, scene.file("ball.xml").string()))
              .code == exit_no_device);
    CHECK(scene.files() == std::set<std::string>{"ball.xml"});
}
