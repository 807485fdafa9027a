#include <catch2/catch.hpp>
#include <iterator>
#include <sstream>

#include "error.h"
#include "options.h"
#include "requested_scene.h"

using namespace vkvol;

namespace {

Options parse_command_line(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "vkvol");
    return parse_options(static_cast<int>(arguments.size()), arguments.data());
}

std::string command_line_error(const std::vector<const char*>& arguments) {
    try {
        parse_command_line(arguments);
    } catch (const InputError& error) {
        const std::string message = error.what();
        return message.find('\n') == std::string::npos ? message : "more than one line: " + message;
    }
    return "no error";
}

Crop crop_of(const char* text, int width, int height) {
    Picture picture;
    picture.width = width;
    picture.height = height;
    return resolve_crop(parse_command_line({"s.xml", "--crop", text}).render.crop, picture);
}

} // namespace

TEST_CASE("a scene alone is rendered to EXR and PNG in the current directory", "[cpu][options]") {
    for (const auto& arguments : {std::vector<const char*>{"scenes/cloud.xml"}, {"render", "scenes/cloud.xml"}}) {
        const Options options = parse_command_line(arguments);
        CHECK(options.command == Command::render);
        CHECK(options.render.scene == "scenes/cloud.xml");
        CHECK(options.render.outputs == std::vector<std::filesystem::path>{"cloud.exr", "cloud.png"});
        CHECK(options.render.seed == 0);
        CHECK_FALSE(options.render.spp);
        CHECK(options.render.device.choice == "auto");
        CHECK(options.render.progress == ProgressStyle::automatic);
    }
}

TEST_CASE("every option is read, before or after the scene", "[cpu][options]") {
    std::istringstream text(
        "-o a.exr -D g=0.5 --spp 16 s.xml -o b.png -Dk=a=b --seed=7 --time 5m --noise 2.5% --width 64 "
        "--integrator ratioTracking:flight=weighted --height 32 --grid x.vdb --sample-offset 48 "
        "--device cpu --report r.json --progress json --tonemap agx --exposure -1.5 --quiet "
        "--strict --robust --validate --no-cache --crop 0,8,4,16");
    const std::vector<std::string> words{std::istream_iterator<std::string>(text), {}};
    std::vector<const char*> arguments;
    for (const std::string& word : words)
        arguments.push_back(word.c_str());
    const Options options = parse_command_line(arguments);
    const RenderOptions& render = options.render;
    CHECK(render.scene == "s.xml");
    CHECK(render.outputs == std::vector<std::filesystem::path>{"a.exr", "b.png"});
    CHECK(render.defines == std::map<std::string, std::string>{{"g", "0.5"}, {"k", "a=b"}});
    CHECK(render.spp.value() == 16);
    CHECK(render.seed == 7);
    CHECK(render.sample_offset == 48);
    CHECK(render.integrator.value() == "ratioTracking:flight=weighted");
    CHECK(render.time_limit.value() == 300.0);
    CHECK(render.noise_goal.value() == 0.025);
    CHECK(render.width.value() == 64);
    CHECK(render.height.value() == 32);
    CHECK(render.grid.value() == "x.vdb");
    CHECK(render.device.choice == "cpu");
    CHECK(render.report.value() == "r.json");
    CHECK(render.progress == ProgressStyle::json);
    CHECK(render.tone.curve.value() == ToneCurve::agx);
    CHECK(render.tone.exposure.value() == -1.5);
    CHECK((render.quiet && render.strict && render.device.robust && render.device.validate && render.no_cache));
    CHECK(render.crop.value().window == std::array<double, 4>{0, 8, 4, 16});
}

TEST_CASE("the other commands", "[cpu][options]") {
    CHECK(parse_command_line({"devices"}).command == Command::devices);
    CHECK(parse_command_line({"devices", "--json"}).devices_json);
    CHECK(parse_command_line({"integrators"}).command == Command::integrators);
    CHECK(parse_command_line({"integrators", "--json"}).integrators_json);
    CHECK(parse_command_line({"info", "a.nvdb"}).info_file == "a.nvdb");
    const Options compare = parse_command_line({"compare", "a.exr", "b.exr", "--max-relmse", "1e-3", "--json"});
    CHECK(compare.command == Command::compare);
    CHECK(compare.compare.a == "a.exr");
    CHECK(compare.compare.b == "b.exr");
    CHECK(compare.compare.max_relmse.value() == 1e-3);
    CHECK(compare.compare.json);
    const Options merge = parse_command_line({"merge", "a.exr", "b.exr", "-o", "c.exr", "d.exr"});
    CHECK(merge.command == Command::merge);
    CHECK(merge.merge.inputs.size() == 3);
    CHECK(merge.merge.outputs == std::vector<std::filesystem::path>{"c.exr"});
}

TEST_CASE("help and version are printed", "[cpu][options]") {
    for (const char* flag : {"--help", "-h"}) {
        const Options help = parse_command_line({flag});
        CHECK(help.command == Command::print);
        CHECK_THAT(help.text, Catch::Contains("--spp") && Catch::Contains("Exit codes") &&
                                  Catch::Contains("vkvol merge") && Catch::Contains("vkvol integrators"));
    }
    CHECK_THAT(parse_command_line({"compare", "--help"}).text, Catch::Contains("--max-relmse"));
    CHECK(parse_command_line({"--version"}).text.substr(0, 6) == "vkvol ");
}

TEST_CASE("a bad command line is one line with a hint", "[cpu][options]") {
    CHECK_THAT(command_line_error({}), Catch::Contains("no scene given"));
    CHECK_THAT(command_line_error({"s.xml", "--sp", "4"}), Catch::Contains("unknown option --sp; did you mean --spp?"));
    CHECK_THAT(command_line_error({"--ssp=4", "s.xml"}), Catch::Contains("unknown option --ssp; did you mean --spp?"));
    CHECK_THAT(command_line_error({"s.xml", "t.xml"}), Catch::Contains("unexpected argument 't.xml'"));
    CHECK_THAT(command_line_error({"comapre", "a", "b"}),
               Catch::Contains("unknown command 'comapre'; did you mean compare?"));
    for (const char* spp : {"0", "-1", "1.5", "many", "4294967296"})
        CHECK_THAT(command_line_error({"s.xml", "--spp", spp}),
                   Catch::StartsWith("command line: ") && Catch::Contains("--spp"));
    CHECK_THAT(command_line_error({"s.xml", "--spp"}), Catch::Contains("--spp"));
    CHECK_THAT(command_line_error({"s.xml", "--width", "0"}), Catch::Contains("--width"));
    CHECK_THAT(command_line_error({"s.xml", "--time", "5d"}), Catch::Contains("30s, 5m or 2h"));
    CHECK_THAT(command_line_error({"s.xml", "--time", "-5"}), Catch::Contains("30s, 5m or 2h"));
    for (const char* noise : {"1", "100%", "0%", "-1%", "nan", "1 %"})
        CHECK_THAT(command_line_error({"s.xml", "--noise", noise}), Catch::Contains("--noise: '"));
    CHECK(parse_command_line({"s.xml", "--noise", "0.03"}).render.noise_goal.value() == 0.03);
    CHECK_THAT(command_line_error({"s.xml", "-D", "novalue"}), Catch::Contains("key=value"));
    CHECK_THAT(command_line_error({"s.xml", "-D", "a=1", "-D", "a=2"}), Catch::Contains("a given twice"));
    CHECK_THAT(command_line_error({"s.xml", "--tonemap", "acs"}), Catch::Contains("did you mean aces?"));
    CHECK_THAT(command_line_error({"s.xml", "--progress", "xml"}), Catch::Contains("--progress: unknown value 'xml'"));
    CHECK_THAT(command_line_error({"s.xml", "--integrator", "ratioTracking:fligth=delta"}),
               Catch::Contains("did you mean flight?"));
    CHECK_THAT(command_line_error({"s.xml", "--integrator", "ratioTracking:flight=dleta"}),
               Catch::Contains("did you mean delta?"));
    CHECK_THAT(command_line_error({"integrators", "--jsno"}), Catch::Contains("did you mean --json?"));
    CHECK_THAT(command_line_error({"s.xml", "--integrator", "ratio"}), Catch::Contains("unknown integrator 'ratio'"));
    CHECK_THAT(command_line_error({"s.xml", "--exposure", "nan"}), Catch::Contains("--exposure"));
    CHECK_THAT(command_line_error({"s.xml", "--crop", "1,2,3"}), Catch::Contains("x0,x1,y0,y1"));
    CHECK_THAT(command_line_error({"s.xml", "--crop", "1,2,3,x"}), Catch::Contains("'x' is not a number"));
    CHECK_THAT(command_line_error({"s.xml", "--crop", "1.5,2,3,4"}), Catch::Contains("whole numbers"));
    CHECK_THAT(command_line_error({"compare", "a.exr"}), Catch::Contains("two images are needed"));
    CHECK_THAT(command_line_error({"merge", "a.exr", "b.exr"}), Catch::Contains("-o all.exr"));
    CHECK_THAT(command_line_error({"info"}), Catch::Contains("no file given"));
}

TEST_CASE("durations", "[cpu][options]") {
    CHECK(parse_duration("30s") == 30.0);
    CHECK(parse_duration("1.5m") == 90.0);
    CHECK(parse_duration("2h") == 7200.0);
    CHECK(parse_duration("0.25") == 0.25);
    for (const char* text : {"", "s", "0", "nan", "inf", "5 m", "5mm"})
        CHECK_THROWS_AS(parse_duration(text), InputError);
}

TEST_CASE("crops are pixels or fractions", "[cpu][options]") {
    const Crop pixels = crop_of("2,8,1,5", 10, 6);
    CHECK((pixels.x0 == 2 && pixels.x1 == 8 && pixels.y0 == 1 && pixels.y1 == 5));
    const Crop one = crop_of("0,1,0,1", 10, 6); // no dot: pixels
    CHECK((one.x1 == 1 && one.y1 == 1));
    const Crop left = crop_of("0.0,0.33,0,1", 10, 6);
    const Crop right = crop_of("0.33,1,0,1", 10, 6);
    CHECK(left.x1 == right.x0);
    CHECK((right.x1 == 10 && right.y1 == 6));
    for (const char* bad : {"0,11,0,6", "-1,5,0,6", "5,5,0,6", "5,4,0,6", "0.0,0.01,0,1", "-0.5,1,0,1"})
        CHECK_THROWS_AS(crop_of(bad, 10, 6), InputError);
    const Crop whole = resolve_crop(std::nullopt, Picture{});
    CHECK((whole.x0 == 0 && whole.x1 == 400 && whole.y1 == 400));
}

TEST_CASE("numbers out of range say the range", "[cpu][options]") {
    for (const char* width : {"0", "65537", "1e2", "-1", "1.5", "0x10", "12px"})
        CHECK_THAT(command_line_error({"s.xml", "--width", width}),
                   Catch::Contains("--width") && Catch::Contains(width) &&
                       Catch::Contains("a whole number from 1 to 65536"));
    CHECK_THAT(command_line_error({"s.xml", "--seed", "4294967296"}),
               Catch::Contains("a whole number from 0 to 4294967295"));
    CHECK_THAT(command_line_error({"bench", "s.xml", "--seed", "-1"}),
               Catch::Contains("a whole number from 0 to 4294967295"));
    CHECK_THAT(command_line_error({"s.xml", "--spp", "1e3"}), Catch::Contains("a whole number from 1 to 2147483647"));
    CHECK(parse_command_line({"s.xml", "--width", "010"}).render.width.value() == 10); // not eight
    CHECK(parse_command_line({"s.xml", "--seed", "4294967295"}).render.seed == 4294967295u);
}

TEST_CASE("what is empty is an error, and takes no other word's place", "[cpu][options]") {
    for (const char* option : {"--device", "--report", "-o", "--output", "--grid", "-D", "--define", "--integrator",
                               "--time", "--noise", "--width", "--crop", "--checkpoint"}) {
        CAPTURE(option);
        CHECK_THAT(command_line_error({"s.xml", option, ""}), Catch::Contains(std::string(option) + ": is empty"));
    }
    CHECK_THAT(command_line_error({"s.xml", "--report", ""}), Catch::Contains("expected FILE.json"));
    CHECK_THAT(command_line_error({"--report=", "s.xml"}), Catch::Contains("--report: is empty"));
    CHECK_THAT(command_line_error({"bench", "s.xml", "--reference", ""}), Catch::Contains("--reference: is empty"));
    CHECK_THAT(command_line_error({""}), Catch::Contains("word 1 is empty"));
    CHECK_THAT(command_line_error({"s.xml", "-q", ""}), Catch::Contains("word 3 is empty"));
    CHECK(parse_command_line({"s.xml", "-D", "key="}).render.defines.at("key").empty());
}

TEST_CASE("after -- nothing is an option", "[cpu][options]") {
    CHECK(parse_command_line({"--", "s.xml"}).render.scene == "s.xml");
    CHECK(parse_command_line({"--spp", "4", "--", "-s.xml"}).render.scene == "-s.xml");
    CHECK(parse_command_line({"info", "--", "-a.nvdb"}).info_file == "-a.nvdb");
    CHECK_THAT(command_line_error({"--", "s.xml", "t.xml"}), Catch::Contains("unexpected argument 't.xml'"));
}

TEST_CASE("half of a path to follow names the other half", "[cpu][options]") {
    CHECK_THAT(command_line_error({"s.xml", "--pixel", "8,9"}),
               Catch::Contains("add --sample K and --trace") && Catch::Contains("--crop 8,9,9,10"));
    CHECK_THAT(command_line_error({"s.xml", "--trace"}), Catch::Contains("add --pixel X,Y and --sample K"));
    CHECK_THAT(command_line_error({"s.xml", "--trace", "--pixel", "8,9"}), Catch::EndsWith("add --sample K"));
}
