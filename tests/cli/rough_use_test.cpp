// What users do besides what they are told: names with anything in them, pipes, signals, readers who leave, files that
// may not be read.
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sys/stat.h>
#include <unistd.h>

#include "error.h"
#include "input_file.h"
#include "missing_field.h"
#include "printable.h"
#include "scene_xml.h"
#include "support/command_folder.h"
#include "table_rows.h"
#include "test_paths.h"

using namespace vkvol;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const std::string wicked = "b\xe9\x1b[31m.xml"; // Latin-1, and red

// Root may read everything; nobody may not.
class AsNobody {
public:
    AsNobody() : was_root_(geteuid() == 0) {
        if (was_root_)
            REQUIRE(seteuid(65534) == 0);
    }
    ~AsNobody() {
        if (was_root_ && seteuid(0) != 0)
            std::abort();
    }

private:
    bool was_root_;
};

} // namespace

TEST_CASE("what is printed gives the terminal no orders", "[cpu][command]") {
    for (const char* plain : {"", "scene.xml", "caf\xc3\xa9", "\xe6\x97\xa5\xe6\x9c\xac", "\xf0\x9f\x8c\xa9", "a\\b"})
        CHECK(printable(plain) == plain);
    CHECK(printable("a\x1b[31mb") == "a\\x1b[31mb");
    CHECK(printable("a\nb\x7f") == "a\\x0ab\\x7f");
    CHECK(printable("caf\xe9!") == "caf\\xe9!");
    CHECK(printable("\xc2\x9b") == "\\xc2\\x9b"); // control sequences begin so, too
    for (const char* bad : {"\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe6\x97", "\xff", "\x80"})
        CHECK(printable(bad).find_first_not_of("\\x0123456789abcdef") == std::string::npos);
}

TEST_CASE("a scene of any name renders, and its report is JSON", "[gpu][command]") {
    const Folder folder("");
    fs::copy_file(folder.file("ball.xml"), folder.file(wicked));
    const Run run = folder.vkvol(fmt::format("'{}' --report r.json", wicked));
    CHECK(run.code == exit_done);
    CHECK(run.text.find('\x1b') == std::string::npos);
    CHECK_THAT(run.text, Contains("b\\xe9\\x1b[31m.exr"));
    CHECK(nlohmann::json::parse(folder.text("r.json"))["samplesPerPixel"]["least"] == 8);
    for (const std::string& name : {std::string("none-") + wicked, std::string("a\nvkvol: error: b.xml")}) {
        const Run missing = folder.vkvol(fmt::format("'{}'", name));
        CHECK(missing.code == exit_bad_input);
        CHECK(missing.text.find('\x1b') == std::string::npos);
        CHECK(std::count(missing.text.begin(), missing.text.end(), '\n') == 1);
    }
}

TEST_CASE("the first signal ends the wait for a pipe", "[gpu][command][long]") {
    const Folder folder("");
    const std::string interrupted = "timeout --preserve-status -s INT 5 ";
    for (const char* name : {"p.xml", "p.nvdb", "p.exr", "p.png"})
        REQUIRE(mkfifo(folder.file(name).c_str(), 0600) == 0);
    const Run scene = folder.vkvol("p.xml", interrupted);
    CHECK(scene.code == exit_interrupted);
    CHECK_THAT(scene.text, Contains("p.xml: interrupted while waiting"));
    const Run slow = folder.script("{ echo '<options>'; sleep 30; } >p.xml 2>&1 & " + interrupted + "\"$vkvol\" p.xml");
    CHECK(slow.code == exit_interrupted);
    CHECK_THAT(slow.text, Contains("p.xml: interrupted while waiting"));
    const Run grid = folder.vkvol("ball.xml --grid p.nvdb", interrupted);
    CHECK(grid.code == exit_bad_input);
    CHECK_THAT(grid.text, Contains("p.nvdb: is a pipe or device"));
    // The shell makes its background commands deaf to SIGINT. With a.exr there, p.png is next.
    const Run output = folder.script(
        "\"$vkvol\" ball.xml -q -o a.exr -o p.png & until [ -f a.exr ] || ! kill -0 $!; do sleep 0.1; done; "
        "sleep 1; kill -TERM $!; wait $!");
    CHECK(output.code == exit_render_failed);
    CHECK_THAT(output.text, Contains("p.png: cannot be written: Interrupted") && Contains("start its reader first") &&
                                Contains("; written: a.exr"));
}

TEST_CASE("pipes are read and written", "[gpu][command]") {
    const Folder folder("");
    REQUIRE(mkfifo(folder.file("p.png").c_str(), 0600) == 0);
    const Run read = folder.vkvol("/dev/stdin -q -o a.png", "cat ball.xml |");
    CHECK(read.code == exit_done);
    const Run written =
        folder.script("cat p.png >copy.png & \"$vkvol\" ball.xml -q -o p.png; code=$?; wait; exit $code");
    CHECK(written.code == exit_done);
    CHECK_FALSE(folder.text("a.png").empty());
    CHECK(folder.text("copy.png") == folder.text("a.png"));
    // Whoever writes an EXR goes back in it.
    REQUIRE(mkfifo(folder.file("p.exr").c_str(), 0600) == 0);
    const Run picture = folder.script("cat p.exr >copy.exr & \"$vkvol\" ball.xml -q -o p.exr -o a.exr; code=$?; wait; "
                                      "\"$vkvol\" compare copy.exr a.exr && exit $code");
    CHECK(picture.code == exit_done);
    CHECK_THAT(picture.text, Contains("identical"));
}

TEST_CASE("what goes to standard output has no words amid it", "[gpu][command]") {
    const Folder folder("");
    REQUIRE(folder.script("\"$vkvol\" ball.xml --spp 2 -o a.exr --report /dev/stdout 2>words >a.json").code ==
            exit_done);
    CHECK(nlohmann::json::parse(folder.text("a.json"))["samplesPerPixel"]["most"] == 2);
    CHECK_THAT(folder.text("words"), Contains("a.exr: 2 samples per pixel"));
    REQUIRE(folder.script("ln -s /dev/stdout a.csv; \"$vkvol\" merge a.exr -o a.csv >table 2>words").code == exit_done);
    CHECK_THAT(folder.text("table"), Catch::StartsWith("column,row,") && !Contains("images"));
    CHECK_THAT(folder.text("words"), Contains("1 images"));
}

TEST_CASE("a sequence has no words amid what goes to standard output", "[gpu][command]") {
    const Folder folder("");
    folder.write("turn.xml", "<options><sphere/><sigma_s>${F}</sigma_s><width>8</width><height>8</height></options>");
    REQUIRE(folder.script("\"$vkvol\" turn.xml --spp 2 -f 1..2 -o a.#.exr --report /dev/stdout 2>words >a.json").code ==
            exit_done);
    CHECK_THAT(folder.text("a.json"), Contains("samplesPerPixel") && !Contains("frames"));
    CHECK_THAT(folder.text("words"), Contains("2 frames (1,2)"));
    REQUIRE(
        folder.script("\"$vkvol\" turn.xml --spp 2 -f 1..2 -o a.#.exr --resume --report /dev/stdout 2>words >a.json")
            .code == exit_done);
    CHECK_THAT(folder.text("a.json"), !Contains("is there"));
}

TEST_CASE("numbers of readings are numbers, however the key had them", "[cpu][command]") {
    const TableRows rows{{"mu0", "R", "samples"}, {".5", "1", "16"}, {"-.25", "2", "16"}, {"007", "3", "16"}};
    const nlohmann::json json = nlohmann::json::parse(as_file("t.json", rows));
    CHECK(json[0]["mu0"] == 0.5);
    CHECK(json[1]["mu0"] == -0.25);
    CHECK(json[2]["mu0"] == "007");
}

TEST_CASE("what is up is asked of density files alone", "[gpu][command]") {
    const Folder folder("");
    const Run run = folder.vkvol("init --up z -o new.xml");
    CHECK(run.code == exit_bad_input);
    CHECK_THAT(run.text, Contains("--up: is for density files; name one"));
    CHECK(!fs::exists(folder.file("new.xml")));
}

TEST_CASE("no output takes the place of what a scene of pbrt includes", "[gpu][command][pbrt]") {
    const Folder folder("");
    folder.write("main.pbrt", "Camera \"perspective\" WorldBegin LightSource \"infinite\" Include \"ball.pbrt\"");
    folder.write("ball.pbrt", "Import \"more.pbrt\" Shape \"sphere\"");
    folder.write("more.pbrt", "Translate 0 0 3 Shape \"sphere\"");
    for (const std::string name : {"ball.pbrt", "more.pbrt"}) {
        const std::string before = folder.text(name);
        const Run run = folder.vkvol("main.pbrt --width 8 --height 8 --spp 1 -o a.exr --report " + name);
        CHECK(run.code == exit_bad_input);
        CHECK_THAT(run.text, Contains("a file that the scene includes"));
        CHECK(folder.text(name) == before);
    }
    CHECK(folder.vkvol("main.pbrt --width 8 --height 8 --spp 1 -o a.exr").code == exit_done);
}

TEST_CASE("two signals one after the other are one", "[gpu][command]") {
    const Folder folder("");
    const Run run = folder.script("\"$vkvol\" ball.xml --spp 1000000000 --progress json -o h.exr 2>p.txt & "
                                  "until grep -q progress p.txt || ! kill -0 $!; do sleep 0.1; done; "
                                  "kill -TERM $!; sleep 0.002; kill -TERM $!; wait $!");
    CHECK(run.code == exit_interrupted);
    CHECK(fs::exists(folder.file("h.exr")));
}

TEST_CASE("layers that differ are told of pictures that are the same", "[gpu][command]") {
    const Folder folder("");
    folder.write("dark.xml", "<options><sphere/><sigma_s>1</sigma_s><width>8</width><height>8</height></options>");
    for (const std::string seed : {"1", "2"})
        REQUIRE(folder.vkvol("dark.xml -q --spp 4 --aov depth --seed " + seed + " -o " + seed + ".exr").code ==
                exit_done);
    const Run differ = folder.vkvol("compare 1.exr 2.exr");
    CHECK(differ.code == exit_done);
    CHECK_THAT(differ.text,
               Contains("identical") && Contains("the layer depth differs; what is compared are the colours"));
    CHECK_THAT(folder.vkvol("compare 1.exr 1.exr").text, !Contains("differs"));
}

TEST_CASE("a layer of alpha changes no PNG", "[gpu][command]") {
    const Folder folder("");
    REQUIRE(folder.vkvol("ball.xml -q -o a.png").code == exit_done);
    REQUIRE(folder.vkvol("ball.xml -q --aov alpha -o b.png -o b.exr").code == exit_done);
    CHECK(folder.text("b.png") == folder.text("a.png"));
    REQUIRE(folder.vkvol("ball.xml -q --alpha -o c.png -o c.exr").code == exit_done);
    // Layers that no file holds are told.
    CHECK_THAT(folder.vkvol("ball.xml --aov alpha,depth -o d.png").text, Contains("are lost: depth, alpha"));
    CHECK_THAT(folder.vkvol("ball.xml --alpha -o d.png").text, !Contains("are lost"));
    CHECK_THAT(folder.vkvol("ball.xml --aov depth -o d.png -o d.exr").text, !Contains("are lost"));
    CHECK(folder.text("c.png") != folder.text("a.png"));
    REQUIRE(folder.vkvol("develop c.exr -o d.png").code == exit_done);
    CHECK(folder.text("d.png") == folder.text("c.png"));
}

TEST_CASE("a reader who has seen enough is no error", "[gpu][command][long]") {
    const Folder folder("");
    REQUIRE(folder.vkvol("ball.xml -q -o a.exr").code == exit_done);
    for (const char* trap : {"", "trap '' PIPE; "})
        for (const std::string& arguments :
             {std::string("info " VKVOL_TEST_FIELDS "/constant.nvdb"), std::string("integrators"),
              std::string("integrators --json"), std::string("compare a.exr a.exr"), std::string("--help")}) {
            CAPTURE(arguments);
            const Run run = folder.script(std::string(trap) + "{ sleep 0.2; \"$vkvol\" " + arguments +
                                          "; echo code $? >&2; } | true");
            CHECK(run.text == "code 0\n");
        }
    const Run full = folder.script("\"$vkvol\" integrators >/dev/full");
    CHECK(full.code == exit_render_failed);
    CHECK_THAT(full.text, Contains("check free space"));
    const Run render = folder.script("{ sleep 0.2; \"$vkvol\" ball.xml -o b.exr; } | true; for i in 1 2 3 4 5 6 7 8 9 "
                                     "10; do [ -f b.exr ] || sleep 0.5; done");
    CHECK(fs::exists(folder.file("b.exr")));
}

TEST_CASE("a relative XDG_CACHE_HOME is ignored", "[gpu][command]") {
    const Folder folder("");
    const std::string home = folder.file("").string();
    CHECK(folder.vkvol("ball.xml -q", fmt::format("XDG_CACHE_HOME=here HOME='{}'", home)).code == exit_done);
    CHECK_FALSE(fs::exists(folder.file("here/vkvol"))); // Mesa takes it
    CHECK(fs::exists(folder.file(".cache/vkvol")));
}

TEST_CASE("a file that cannot be read says why", "[cpu][command]") {
    const Folder folder("");
    folder.write("closed.nvdb", "x");
    fs::permissions(folder.file("closed.nvdb"), fs::perms::none);
    {
        const AsNobody nobody;
        CHECK_THROWS_WITH(check_input_file(folder.file("closed.nvdb"), "hint"),
                          Contains("Permission denied; check the permissions") && !Contains("hint"));
    }
    CHECK_THROWS_WITH(check_input_file(folder.file("none"), "hint"), Contains("none: no such file; hint"));
    CHECK_THROWS_WITH(check_input_file(folder.file("ball.xml/none"), "hint"), Contains("no such file; hint"));
    CHECK_THROWS_WITH(check_input_file(folder.file(""), "hint"), Contains("is a directory"));
    CHECK_THROWS_WITH(check_input_file("/dev/null", "hint"), Contains("is a pipe or device"));
    CHECK(read_input_text(folder.file("ball.xml"), 1 << 20, "") == folder.text("ball.xml"));
}

TEST_CASE("a scene in UTF-16 is called that", "[cpu][xml]") {
    using namespace std::string_literals;
    for (const std::string& text : {"\xff\xfe<\0o\0"s, "\xfe\xff\0<\0o"s, "<\0o\0"s, "\0<\0o"s})
        CHECK_THROWS_WITH(parse_scene(text, "s.xml"), "s.xml: is UTF-16; save it as UTF-8");
    CHECK_THROWS_WITH(parse_scene("\xff\xfe\0\0<\0\0\0"s, "s.xml"), "s.xml: is UTF-32; save it as UTF-8");
    CHECK_NOTHROW(parse_scene("\xef\xbb\xbf<options/>", "s.xml")); // UTF-8 may have a mark
}

TEST_CASE("a missing field names the command that makes it", "[cpu][command]") {
    CHECK_THAT(missing_field_hint("fields/cumulus.nvdb"), Contains("make_field cumulus -o fields/cumulus.nvdb`"));
    CHECK_THAT(missing_field_hint("ramp-440-fp8.nvdb"),
               Contains("make_field ramp --size 440 --type fp8 -o ramp-440-fp8.nvdb`"));
    for (const char* other : {"mine.nvdb", "cumulus-mine.nvdb", "440.nvdb", ""})
        CHECK_THAT(missing_field_hint(other), Contains("check the path"));
    CHECK_THAT(missing_field_hint("smoke.####.vdb"), Contains("$F4"));
    // Also where the method asks first what is in the grid.
    CHECK_THROWS_WITH(parse_scene("<options><densityField>none/empty.nvdb</densityField><sigma_a>1</sigma_a>"
                                  "<integrator>densitySampling</integrator></options>",
                                  "s.xml"),
                      Contains("none/empty.nvdb: no such file; make it with `"));
    std::ifstream stream(VKVOL_SOURCE_DIR "/tools/make_field/recipes.cpp");
    const std::string recipes((std::istreambuf_iterator<char>(stream)), {});
    const std::regex name("\\{\"([a-z_0-9]+)\", \"");
    std::set<std::string> there, known(recipe_names.begin(), recipe_names.end());
    for (std::sregex_iterator at(recipes.begin(), recipes.end(), name), end; at != end; ++at)
        there.insert((*at)[1]);
    CHECK(there == known);
}
