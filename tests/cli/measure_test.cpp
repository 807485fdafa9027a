// Tables of readings, and values that a scene's $keys have one after the other.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "bench.h"
#include "error.h"
#include "measure_options.h"
#include "spectral_bands.h"
#include "support/command_folder.h"
#include "support/shell.h"

using namespace vkvol;
using Catch::Contains;

namespace {

// Fluence in and beside a ball that glows, at two points.
constexpr const char* ball =
    "<options><sphere radius=\"1\"/><sigma_a>$sigma</sigma_a><sigma_s>0</sigma_s>"
    "<medium r=\"1\" g=\"2\" b=\"1\" multiplier=\"$glow\"/><fluence>0 0 0  0 3 0</fluence></options>";

std::vector<std::vector<std::string>> lines_of(const std::string& csv) {
    std::vector<std::vector<std::string>> lines;
    std::istringstream text(csv);
    for (std::string line; std::getline(text, line);) {
        lines.emplace_back();
        std::istringstream words(line);
        for (std::string word; std::getline(words, word, ',');)
            lines.back().push_back(word);
    }
    return lines;
}

} // namespace

TEST_CASE("values one after the other", "[cpu][options]") {
    CHECK(parse_sweep("g=0.8").values == std::vector<std::string>{"0.8"});
    CHECK(parse_sweep("g=0.8,0.9,x").values == std::vector<std::string>{"0.8", "0.9", "x"});
    CHECK(parse_sweep("g=0..1x5").values == std::vector<std::string>{"0", "0.25", "0.5", "0.75", "1"});
    CHECK(parse_sweep("g=1..-1x3").values == std::vector<std::string>{"1", "0", "-1"});
    CHECK(parse_sweep("g=0.4..0x4").values.back() == "0"); // not -5.6e-17
    CHECK(parse_sweep("g=-0.4..0.4x7").values[3] == "0");
    CHECK(parse_sweep("g=-1e-20..1e-20x3").values == std::vector<std::string>{"-1e-20", "0", "1e-20"});
    CHECK(parse_sweep("g=").values == std::vector<std::string>{""}); // the scene's default
    for (const char* text : {"g=0.1,", "g=,0.1", "g=0.1,,0.2"})
        CHECK_THROWS_WITH(parse_sweep(text), Contains("-D g: ") && Contains("nothing between two commas"));
    CHECK(parse_sweep("file=../box.obj").values == std::vector<std::string>{"../box.obj"});
    CHECK_THROWS_WITH(parse_sweep("g=0..1x1"), Contains("whole number from 2"));
    CHECK_THROWS_WITH(parse_sweep("g=0..axb3"), Contains("is not a number"));
    CHECK_THROWS_WITH(parse_sweep("g"), Contains("key=value"));
}

TEST_CASE("tables of bands", "[cpu][options]") {
    const Folder folder("");
    const auto read = [&](const std::string& text) {
        folder.write("bands.csv", text);
        return read_bands(folder.file("bands.csv"));
    };
    const std::vector<SpectralBand> bands =
        read("# of two\nweight, sigma,sun\n0.25,1.5, a b # the first\n\n1e-3,2,c\r\n");
    REQUIRE(bands.size() == 2);
    CHECK(bands[0].weight == 0.25);
    CHECK(bands[0].values == std::map<std::string, std::string>{{"sigma", "1.5"}, {"sun", "a b"}});
    CHECK(bands[1].weight == 1e-3);
    CHECK_THROWS_WITH(read(""), Contains("has no bands"));
    CHECK_THROWS_WITH(read("weight,sigma\n"), Contains("has no bands"));
    CHECK_THROWS_WITH(read("sigma,sun\n1,2\n"), Contains("bands.csv:1: ") && Contains("one is weight"));
    CHECK_THROWS_WITH(read("weight,sigma,sigma\n"), Contains("a name of its own"));
    CHECK_THROWS_WITH(read("weight,sigma\n1\n"), Contains("bands.csv:2: 1 values under 2 names"));
    CHECK_THROWS_WITH(read("weight,sigma,sun\n1,,2\n"), Contains("bands.csv:2: sigma has no value"));
    CHECK_THROWS_WITH(read("weight,sigma\nx,1\n"), Contains("bands.csv:2: the weight is 'x'"));
    CHECK_THROWS_WITH(read("weight,sigma\n1e20,1\n"), Contains("choose another unit"));
    CHECK_THROWS_WITH(read("weight,sigma\n1e-20,1\n"), Contains("choose another unit"));
    CHECK(read("weight,sigma\n0,1\n").front().weight == 0.0);
    CHECK_THROWS_WITH(read_bands(folder.file("nowhere.csv")), Contains("nowhere.csv"));
}

// What is known of each band adds up, and so do the squares of errors.
TEST_CASE("readings are sums over bands", "[gpu][command]") {
    const Folder folder("");
    folder.write("glow.xml", ball);
    folder.write("bands.csv", "weight,sigma,glow\n0.5,0.5,1\n2,2,3\n");
    const auto reading = [&](const std::string& options) {
        const Run run = folder.vkvol("measure glow.xml --spp 4096 -o table.csv " + options);
        CAPTURE(run.text);
        REQUIRE(run.code == exit_done);
        return lines_of(folder.text("table.csv"));
    };
    const auto sum = reading("--bands bands.csv");
    const auto first = reading("-D sigma=0.5 -D glow=1"),
               second = reading(fmt::format("-D sigma=2 -D glow=3 --seed {}", seed_of_run(0, 1)));
    for (std::size_t row = 1; row <= 2; ++row)
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const auto number = [&](const auto& lines, std::size_t before, std::size_t column) {
                return std::stod(lines[row][before + column + channel]);
            };
            CHECK(number(sum, 0, 5) == Approx(0.5 * number(first, 2, 5) + 2.0 * number(second, 2, 5)).epsilon(1e-6));
            CHECK(number(sum, 0, 8) ==
                  Approx(std::hypot(0.5 * number(first, 2, 8), 2.0 * number(second, 2, 8))).epsilon(1e-5));
        }
    const Run twice = folder.vkvol("measure glow.xml --bands bands.csv -D glow=1");
    CHECK(twice.code == exit_bad_input);
    CHECK_THAT(twice.text, Contains("-D glow: is a column of"));
    folder.write("bands.csv", "weight,sigma,glow\n0.5,0.5,1\n2,x,3\n");
    CHECK_THAT(folder.vkvol("measure glow.xml --bands bands.csv").text, Contains("band of glow=3: band of sigma=x: "));
    folder.write("wide.xml", "<options><width>$n</width><height>1</height><sphere/><sigma_s>1</sigma_s></options>");
    folder.write("bands.csv", "weight,n\n1,2\n1,3\n");
    const Run wide =
        folder.vkvol("measure wide.xml --bands bands.csv --spp 1000000000"); // found before any is rendered
    CHECK(wide.code == exit_bad_input);
    CHECK_THAT(wide.text, Contains("bands are of pictures of one size"));
}

TEST_CASE("readings are a table, a row for each point and combination of values", "[gpu][command]") {
    const Folder folder("");
    folder.write("glow.xml", ball);
    const Run run = folder.vkvol("measure glow.xml -D sigma=0.5,2 -D glow=1,3 --spp 4096 -o table.csv");
    REQUIRE(run.code == exit_done);
    const auto lines = lines_of(folder.text("table.csv"));
    REQUIRE(lines.size() == 1 + 2 * 2 * 2);
    CHECK(lines[0] == std::vector<std::string>{"sigma", "glow", "column", "row", "x", "y", "z", "R", "G", "B",
                                               "standardError.R", "standardError.G", "standardError.B", "samples"});
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const double sigma = std::stod(lines[i][0]), glow = std::stod(lines[i][1]);
        CHECK(sigma == (i <= 4 ? 0.5 : 2.0));
        CHECK(glow == ((i - 1) / 2 % 2 == 0 ? 1.0 : 3.0));
        CHECK(lines[i][2] == std::to_string((i - 1) % 2));
        CHECK(std::stod(lines[i][8]) == Approx(2.0 * std::stod(lines[i][7])));
        if ((i - 1) % 2 != 0)
            continue;
        // In the middle 4 pi Le (1 - exp(-sigma)), in every direction, in single precision.
        const double expected = 4.0 * std::numbers::pi * glow * -std::expm1(-sigma);
        CHECK(std::stod(lines[i][7]) == Approx(expected).epsilon(1e-6));
        CHECK(std::stod(lines[i][10]) < 1e-6 * expected);
    }
    // The same random numbers: three times the glow is three times the reading, bit for bit.
    CHECK(std::stof(lines[3][7]) == Approx(3.0 * std::stof(lines[1][7])).epsilon(1e-6));
    // What was cut short is told.
    folder.write("deep.xml", "<options><sphere/><sigma_a>0</sigma_a><sigma_s>9</sigma_s><maxDepth>2</maxDepth>"
                             "<light y='1' r='1' g='1' b='1'/><fluence>0 0 0</fluence></options>");
    const Run deep = folder.vkvol("measure deep.xml --spp 64");
    CHECK(deep.code == exit_done);
    CHECK_THAT(deep.text, Contains("paths ended at maxDepth"));
    const Run means = folder.vkvol("measure glow.xml -D sigma=1 -D glow=1 --spp 64 --mean");
    CHECK(means.code == exit_done);
    CHECK_THAT(means.text, Contains("sigma  glow") && Contains("standardError.R") && Contains("128\n"));
    const Run dark = folder.vkvol("measure glow.xml -D sigma=0 -D glow=1 --noise 5%");
    CHECK(dark.code == exit_done);
    CHECK_THAT(dark.text, Contains("no light came in 2097152 samples"));
    const Run unlit = folder.vkvol("measure glow.xml -D sigma=0 -D glow=1 --spp 64");
    CHECK(unlit.code == exit_done);
    CHECK_THAT(unlit.text, Contains("no light came in 64 samples: such readings are 0 as far as these tell"));
    folder.write("seen.xml", "<options><width>2</width><height>1</height><film aov='depth'/><sphere/></options>");
    const Run seen = folder.vkvol("measure seen.xml --spp 2");
    CHECK(seen.code == exit_done);
    CHECK_THAT(seen.text, Contains("a table has no layers") && Contains("<camera"));
    const Run plain = folder.vkvol("measure glow.xml -D sigma=1 -D glow=1 --noise 5%");
    CHECK(plain.code == exit_done);
    CHECK(std::count(plain.text.begin(), plain.text.end(), '\n') == 3);
}

TEST_CASE("readings of cameras have what is behind the media, also where pictures hold it out", "[gpu][command]") {
    const Folder folder("");
    folder.write("seen.xml",
                 "<options><width>1</width><height>1</height><film alpha='true'/><box width='4' height='4' "
                 "depth='2'/><sigma_a>0.5"
                 "</sigma_a><sigma_s>0</sigma_s><backgroundColor r='1' g='1' b='1'/><camera z='9' fov='1'/></options>");
    const Run seen = folder.vkvol("measure seen.xml --spp 64");
    CHECK(seen.code == exit_done);
    CHECK_THAT(seen.text, Contains("<film alpha>: a table has none") && !Contains("no light"));
}

TEST_CASE("readings are not lost", "[gpu][command]") {
    const Folder folder("");
    folder.write("glow.xml", ball);
    std::filesystem::create_symlink("/dev/full", folder.file("full.csv"));
    const Run full = folder.vkvol("measure glow.xml -D sigma=1 -D glow=1 --spp 64 -o full.csv");
    CHECK(full.code == exit_render_failed);
    CHECK_THAT(full.text, Contains("sigma,glow,") && Contains("No space left") && Contains("on standard output"));
    // As soon as they are there.
    const Run killed =
        folder.script("$vkvol measure glow.xml -D sigma=1..8x8 -D glow=1 --spp 1000000000 --time 1 -o t.csv "
                      "& i=0; until [ -s t.csv ] || [ $i = 600 ]; do sleep 0.1; i=$((i + 1)); done; "
                      "kill -KILL $!; wait $!; true");
    CHECK(killed.code == 0);
    CHECK(lines_of(folder.text("t.csv")).size() >= 1 + 2); // two of each reading
    CHECK(lines_of(folder.text("t.csv")).size() < 1 + 2 * 8);
}

TEST_CASE("what is wrong with one of many values says which", "[gpu][command]") {
    const Folder folder("");
    folder.write("glow.xml", ball);
    const Run bad = folder.vkvol("measure glow.xml -D sigma=0.5,-2 -D glow=1 --spp 1");
    CHECK(bad.code == exit_bad_input);
    CHECK_THAT(bad.text, Contains("-D sigma=-2: -D glow=1: ") && Contains("glow.xml:1:"));
    CHECK(folder.vkvol("measure glow.xml -D sigma=1 -D glow=1 -D sigma=2").code == exit_bad_input);
    CHECK(folder.vkvol("measure glow.xml -D sigma=1 -D glow=1 -o glow.xml").code == exit_bad_input);
    CHECK(folder.text("glow.xml") == ball);
    CHECK(folder.vkvol("measure").code == exit_bad_input);
    // A key of the name of a column, where there is one.
    folder.write("seen.xml", "<options><width>2</width><height>1</height><camera x='$x' z='5'/><sphere/>"
                             "<light y='1' r='1' g='1' b='1'/></options>");
    CHECK(folder.vkvol("measure seen.xml -D x=1,2 --spp 2").code == exit_done);
    folder.write("read.xml",
                 "<options><sphere x='$x'/><light y='1' r='1' g='1' b='1'/><fluence>0 0 0</fluence></options>");
    CHECK_THAT(folder.vkvol("measure read.xml -D x=1,2").text, Contains("-D x: the table has a column of that name"));
    CHECK(folder.vkvol("measure read.xml -D x=1,2 --mean --spp 2").code == exit_done);
    // What is read more than once cannot come through a pipe.
    CHECK_THAT(folder.script("cat glow.xml | \"$vkvol\" measure /dev/stdin -D sigma=1 -D glow=1").text,
               Contains("/dev/stdin: a pipe is read once, but measure"));
}

TEST_CASE("a table of readings as JSON has its numbers, and null for what is not known", "[gpu][command]") {
    const Folder folder("");
    folder.write("glow.xml", ball);
    const auto table = [&](const std::string& options) {
        const Run run = folder.vkvol("measure glow.xml -D sigma=0.5,2 -D glow=1 " + options);
        CAPTURE(run.text);
        REQUIRE(run.code == exit_done);
    };
    table("--spp 64 -o table.json");
    const auto json = nlohmann::json::parse(folder.text("table.json"));
    table("--spp 64 -o table.csv");
    const auto lines = lines_of(folder.text("table.csv"));
    REQUIRE(json.size() == 4);
    REQUIRE(lines.size() == 5);
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < lines[0].size(); ++k)
            CHECK(json[i].at(lines[0][k]).get<double>() == std::stod(lines[i + 1][k]));
    table("--spp 1 -o one.json");
    CHECK(nlohmann::json::parse(folder.text("one.json"))[0].at("standardError.R").is_null());
    // Values of keys are texts where they are no plain numbers.
    folder.write("named.xml", R"(<options><sphere/><sigma_a>1</sigma_a><sigma_s>0</sigma_s><medium r="$glow"/>
        <integrator>$name</integrator><fluence>0 0 0</fluence></options>)");
    REQUIRE(folder.vkvol("measure named.xml -D name=ratioTracking -D glow=1,01 --spp 4 -o named.json").code ==
            exit_done);
    const auto named = nlohmann::json::parse(folder.text("named.json"));
    CHECK(named[0].at("name") == "ratioTracking");
    CHECK(named[0].at("glow") == 1.0);
    CHECK(named[1].at("glow") == "01");
    CHECK_THAT(folder.vkvol("measure glow.xml -D sigma=1 -D glow=1 -o table.exr").text,
               Contains("expected .csv or .json"));
}

TEST_CASE("counts in a table of readings as JSON are whole numbers", "[gpu][command]") {
    const Folder folder("");
    folder.write("glow.xml", ball);
    REQUIRE(folder.vkvol("measure glow.xml -D sigma=1 -D glow=1 --spp 16 -o table.json").code == exit_done);
    const auto json = nlohmann::json::parse(folder.text("table.json"));
    for (const char* column : {"column", "row", "samples"})
        CHECK(json[1].at(column).is_number_integer());
    CHECK(json[1].at("column") == 1);
    CHECK(json[1].at("y") == 3.0);
}

TEST_CASE("readings of a scene that is changed between them end", "[gpu][command]") {
    const Folder folder("");
    folder.write("glow.xml", ball);
    const Run changed = folder.script(
        "\"$vkvol\" measure glow.xml -D sigma=1..8x8 -D glow=1 --spp 1000000000 --time 0.5 -o t.csv 2>said & "
        "i=0; until [ -s t.csv ] || [ $i = 600 ]; do sleep 0.1; i=$((i + 1)); done; "
        "printf '<!-- another -->\\n' >>glow.xml; wait $!; echo ended with $?; cat said");
    CHECK_THAT(changed.text, Contains(fmt::format("ended with {}", exit_bad_input)) &&
                                 Contains("glow.xml: the scene was changed while it was rendered"));
    CHECK(lines_of(folder.text("t.csv")).size() >= 1 + 2); // what was read before stays
}

TEST_CASE("bands whose sensors are at other places are no sum", "[gpu][command]") {
    const Folder folder("");
    folder.write("glow.xml", "<options><sphere radius='$r'/><sigma_a>1</sigma_a><sigma_s>0</sigma_s>"
                             "<medium r='1' g='1' b='1'/><fluence>0 $y 0</fluence></options>");
    folder.write("apart.csv", "weight,r,y\n1,1,0\n1,1,3\n");
    const Run apart = folder.vkvol("measure glow.xml --bands apart.csv --spp 4");
    CHECK(apart.code == exit_bad_input);
    CHECK_THAT(apart.text, Contains("band of y=3: ") && Contains("are no sum"));
    folder.write("together.csv", "weight,r,y\n1,1,3\n1,2,3\n");
    CHECK(folder.vkvol("measure glow.xml --bands together.csv --spp 4").code == exit_done);
}

TEST_CASE("what the validation layer objects to fails measurements as it does renders", "[gpu][command]") {
    const Folder folder("<light y=\"1\" r=\"1\" g=\"1\" b=\"1\"/>");
    // Which it has something to say of: that it is there.
    const std::string strict = "VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_BEST_PRACTICES_EXT";
    const Run render = folder.vkvol("ball.xml --validate --spp 4 -o ball.exr", strict);
    if (render.text.find("the validation layer has ") == std::string::npos) {
        WARN("skipped: this validation layer objects to nothing");
        return;
    }
    CHECK(std::filesystem::exists(folder.file("ball.exr"))); // which is not lost for that
    for (const char* command : {"measure ball.xml --validate --spp 4", "bench ball.xml --validate --time 2s"}) {
        const Run run = folder.vkvol(command, strict);
        CHECK(run.code == exit_render_failed);
        CHECK_THAT(run.text, Contains("vkvol: validation: ") && Contains("the validation layer has "));
    }
}
