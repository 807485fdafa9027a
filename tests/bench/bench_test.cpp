// The bench as its users run it.
#include <catch2/catch.hpp>

#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <unistd.h>

#include "bench.h"
#include "error.h"
#include "image_io.h"
#include "support/shell.h"
#include "test_paths.h"

using namespace vkvol;
using Catch::Contains;

namespace {

// A folder with a ball of optical depth 4 under the sun, and a cache of its own.
class Folder {
public:
    Folder() {
        std::filesystem::create_directories(path_ / "cache" / "vkvol");
        std::ofstream(file("ball.xml")) << "<options><sphere radius=\"1\"/><sigma_a>1</sigma_a><sigma_s>1</sigma_s>"
                                           "<width>16</width><height>16</height><rayPerPixelCount>8</rayPerPixelCount>"
                                           "<camera z=\"5\" fov=\"30\"/><backgroundColor r=\"1\" g=\"1\" b=\"1\"/>"
                                           "<light x=\"0\" y=\"1\" z=\"0\" r=\"1\" g=\"1\" b=\"1\"/></options>";
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    Run vkvol(const std::string& arguments) const { return shell(command(arguments)); }
    std::string command(const std::string& arguments) const {
        const char* device = std::getenv("VKVOL_TEST_DEVICE");
        return fmt::format("'{}' {}{}", VKVOL_BINARY, arguments, device ? fmt::format(" --device '{}'", device) : "");
    }
    Run shell(const std::string& script) const {
        return run(fmt::format("cd '{}' && export XDG_CACHE_HOME='{}' && {{ {}\n}}", path_.string(),
                               (path_ / "cache").string(), script));
    }
    std::filesystem::path file(const std::string& name) const { return path_ / name; }
    nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(std::ifstream(file(name))); }
    std::vector<std::filesystem::path> cached_references() const {
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(path_ / "cache" / "vkvol"))
            if (entry.path().extension() == ".exr")
                files.push_back(entry.path());
        return files;
    }

private:
    std::filesystem::path path_ = std::filesystem::temp_directory_path() / fmt::format("vkvol-bench-{}", getpid());
};

void check_keys(const nlohmann::json& object, const std::vector<const char*>& keys) {
    for (const char* key : keys) {
        CAPTURE(key);
        CHECK(object.contains(key));
    }
}

// Rows of the CSV: integrator and samples -> relMSE of each run.
std::map<std::pair<std::string, std::uint32_t>, std::vector<double>> read_csv(const std::filesystem::path& path) {
    std::map<std::pair<std::string, std::uint32_t>, std::vector<double>> rows;
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    CHECK(line == "integrator,samples,run,seed,seconds,relMse,relMseFromVariance");
    while (std::getline(file, line)) {
        std::vector<std::string> cells;
        std::stringstream stream(line);
        for (std::string cell; std::getline(stream, cell, ',');)
            cells.push_back(cell);
        REQUIRE(cells.size() >= 6);
        std::vector<double>& row = rows[{cells[0], std::uint32_t(std::stoul(cells[1]))}];
        row.push_back(std::stod(cells[5]));
        CHECK(std::stoul(cells[2]) == row.size());
    }
    return rows;
}

void check_estimator(const nlohmann::json& estimator, const Folder& folder) {
    check_keys(estimator, {"integrator", "sameAs", "judged", "noise", "isDefault", "biased", "setupSeconds", "points",
                           "slope", "biasFloor", "efficiency", "secondsToOnePercent", "perPath", "laneUse",
                           "passSeconds", "samplesPerSecond", "image"});
    check_keys(estimator["setupSeconds"], {"load", "upload", "pipeline"});
    check_keys(estimator["perPath"], {"realCollisions", "nullCollisions", "lookups", "majorantCells", "shadowRays"});
    check_keys(estimator["passSeconds"], {"sky", "generate", "track"});
    for (const char* figure : {"slope", "biasFloor", "efficiency"}) {
        check_keys(estimator[figure], {"value", "low", "high"});
        CHECK(estimator[figure]["low"] <= estimator[figure]["value"]);
        CHECK(estimator[figure]["value"] <= estimator[figure]["high"]);
    }
    CHECK(std::filesystem::exists(folder.file(estimator["image"])));
}

} // namespace

TEST_CASE("a bench writes what it measured, as JSON, CSV and pictures", "[gpu][bench][long]") {
    const Folder folder;
    const Run run = folder.vkvol("bench ball.xml --time 2s --integrators ratioTracking,ratioTracking:flight=delta");
    CAPTURE(run.text);
    REQUIRE(run.code == exit_done);
    CHECK_THAT(run.text, Contains("bias floor") && Contains("ratioTracking:flight=delta"));
    CHECK_THAT(run.text, Contains("2 integrators to measure, 2 s of rendering; with a reference of 3 s") &&
                             Contains("in all") && Contains("ratioTracking, default") && Contains("or ball"));
    const nlohmann::json json = folder.json("ball.bench.json");
    check_keys(json, {"format", "version", "scene", "sceneHash", "command", "program", "date", "device", "machine",
                      "image", "budgetSeconds", "seed", "reference", "estimators", "ranking", "secondsToJudge"});
    CHECK(json["format"] == "vkvol-bench");
    check_keys(json["device"], {"name", "driver", "api"});
    check_keys(json["machine"], {"processor", "cores", "load"});
    check_keys(json["reference"], {"file", "integrator", "samples", "seconds", "cached", "relMse"});
    CHECK(json["reference"]["integrator"] != "ratioTracking");
    CHECK(json["reference"]["relMse"] > 0.0);
    REQUIRE(json["estimators"].size() == 2);
    CHECK(json["ranking"].size() == 2);
    CHECK(json["estimators"][0]["isDefault"] == true);
    CHECK(json["estimators"][1]["isDefault"] == false);

    auto rows = read_csv(folder.file("ball.bench.csv"));
    double seconds = 0.0;
    for (const nlohmann::json& estimator : json["estimators"]) {
        check_estimator(estimator, folder);
        for (const nlohmann::json& point : estimator["points"]) {
            check_keys(point, {"samples", "runs", "seconds", "secondsLow", "secondsHigh", "relMse", "relMseError",
                               "relMseFromVariance"});
            seconds += double(point["secondsLow"]) * double(point["runs"]);
            const std::vector<double> row = rows[{estimator["integrator"], point["samples"]}];
            CHECK(point["runs"] == row.size());
            double mean = 0.0;
            for (const double value : row)
                mean += value / double(row.size());
            CHECK(double(point["relMse"]) == Approx(mean).epsilon(1e-12)); // the order of the sum
        }
    }
    CHECK(seconds <= 2.0);
    Metadata metadata;
    CHECK(json["estimators"][0]["image"] == "ball.bench/ratioTracking.exr");
    const Film film = read_exr(folder.file("ball.bench/ratioTracking.exr"), &metadata);
    CHECK(film.samples.front() == json["estimators"][0]["points"].back()["samples"]);
}

// In a homogeneous medium all these flights and transmittances are closed forms.
TEST_CASE("integrators that come to one kernel are measured once, and all their names told", "[gpu][bench][long]") {
    const Folder folder;
    const char* names[] = {"ratioTracking", "deltaTrackingNEE", "residualRatioTracking", "weightedTracking"};
    const Run run = folder.vkvol(
        fmt::format("bench ball.xml --time 1s --integrators {},ratioTracking:flight=delta", fmt::join(names, ",")));
    CAPTURE(run.text);
    REQUIRE(run.code == exit_done);
    CHECK_THAT(run.text, Contains(fmt::format("measured once: {}.", fmt::join(names, " = "))));
    const nlohmann::json json = folder.json("ball.bench.json");
    REQUIRE(json["estimators"].size() == 2);
    CHECK(json["estimators"][0]["sameAs"] == nlohmann::json({names[1], names[2], names[3]}));
    CHECK(json["estimators"][1]["sameAs"].empty());
    std::vector<Film> films;
    for (const char* name : names) {
        REQUIRE(folder.vkvol(fmt::format("ball.xml --spp 4 --integrator {} -o same.exr -q", name)).code == exit_done);
        films.push_back(read_exr(folder.file("same.exr")));
        CHECK(films.back().mean == films.front().mean);
    }
}

TEST_CASE("a bench measures first flights that are drawn and that are split apart", "[gpu][bench]") {
    const Folder folder;
    std::ofstream(folder.file("smoke.xml"))
        << R"(<options><sphere/><noise/><sigma_s>0.3</sigma_s><light y="1" r="3" g="3" b="3"/>
        <camera z="5"/><width>16</width><height>16</height></options>)";
    const Run run = folder.vkvol(
        "bench smoke.xml --time 1s --integrators ratioTracking:firstFlight=split,ratioTracking:firstFlight=drawn");
    CAPTURE(run.text);
    REQUIRE(run.code == exit_done);
    CHECK(folder.json("smoke.bench.json")["estimators"].size() == 2);
}

TEST_CASE("a bench that is too short claims nothing", "[gpu][bench]") {
    const Folder folder;
    REQUIRE(folder.vkvol("ball.xml --spp 64 --seed 9 -o reference.exr -q").code == exit_done);
    const std::string size = "ball.xml --width 512 --height 512 -q ";
    REQUIRE(folder.vkvol(size + "--spp 16 --seed 9 -o reference.exr").code == exit_done);
    REQUIRE(folder.vkvol(size + "--spp 1 --integrator ratioTracking:flight=delta -o one.exr --report one.json").code ==
            exit_done);
    // For a render or two, or none if the machine is slower just then.
    const double seconds = folder.json("one.json")["seconds"]["render"];
    const Run run = folder.vkvol(fmt::format("bench {} --reference reference.exr --time {:.4f}s --integrators "
                                             "ratioTracking:flight=delta,ratioTracking:flight=decomposition",
                                             size, seconds));
    CAPTURE(run.text);
    // If it is faster just then it may judge after all, but not tell the two apart: their pictures are as good.
    if (run.code != exit_done)
        CHECK_THAT(run.text, Contains("--time is too short for a single render"));
    const std::size_t short_one = run.text.find("too short to judge");
    if (short_one != std::string::npos)
        CHECK_THAT(run.text, Contains("give --time "));
    if (short_one != std::string::npos && run.text.find("too short to judge", short_one + 1) != std::string::npos)
        CHECK_THAT(run.text, !Contains("For ball use"));
    CHECK_THAT(run.text, !Contains("times the efficiency"));
}

TEST_CASE("a reference is kept, read again, and rendered anew if it is damaged", "[gpu][bench][long]") {
    const Folder folder;
    const std::string command = "bench ball.xml --time 1s --integrators ratioTracking -q";
    const auto is_cached = [&] {
        const Run run = folder.vkvol(command);
        INFO(run.text);
        REQUIRE(run.code == exit_done);
        return bool(folder.json("ball.bench.json")["reference"]["cached"]);
    };
    const auto used = [&] { return std::string(folder.json("ball.bench.json")["reference"]["file"]); };
    CHECK_FALSE(is_cached());
    const std::string reference = used();
    REQUIRE(folder.cached_references() == std::vector<std::filesystem::path>{reference});
    // Enough for any bench so short, whatever the machine does meanwhile.
    Metadata metadata;
    const Film film = read_exr(reference, &metadata);
    metadata["renderTimeSeconds"] = 3.0f;
    write_exr(reference, film, metadata);
    CHECK(is_cached());
    CHECK(used() == reference);
    std::filesystem::resize_file(reference, std::filesystem::file_size(reference) / 2);
    CHECK_FALSE(is_cached());
    for (const std::filesystem::path& file : folder.cached_references()) {
        metadata["vkvol/sceneHash"] = std::string("0123456789abcdef"); // the name promises another
        write_exr(file, film, metadata);
    }
    CHECK_FALSE(is_cached());
    CHECK(read_exr(used()).samples.front() > 1);
}

TEST_CASE("a bench against a given reference checks what that shows", "[gpu][bench][long]") {
    const Folder folder;
    REQUIRE(folder.vkvol("ball.xml --spp 64 --seed 9 -o reference.exr -q").code == exit_done);
    REQUIRE(folder.vkvol("ball.xml --spp 1 -o one.exr -q").code == exit_done);
    REQUIRE(folder.vkvol("ball.xml --spp 4 --integrator deltaTracking -o dark.exr -q").code == exit_done);
    const std::string command = "bench ball.xml --time 2s --integrators ratioTracking --reference ";
    const Run good = folder.vkvol(command + "reference.exr -o good");
    CAPTURE(good.text);
    CHECK(good.code == exit_done);
    CHECK(folder.json("good.bench.json")["reference"]["samples"] == 64);
    CHECK(folder.cached_references().empty());
    for (const auto& [arguments, message] : {std::pair{"dark.exr", "no unbiased render of this scene"},
                                             {"reference.exr --width 8", "render the reference in that size"},
                                             {"one.exr", "render more"},
                                             {"none.exr", "none.exr"}}) {
        const Run bad = folder.vkvol(command + arguments);
        CAPTURE(arguments, bad.text);
        CHECK(bad.code == exit_bad_input);
        CHECK_THAT(bad.text, Contains(message));
    }
}

TEST_CASE("bench refuses command lines that make no sense", "[gpu][bench][options]") {
    const Folder folder;
    std::ofstream(folder.file("taken.bench")) << "something";
    for (const auto& [arguments, message] : {
             std::pair{"", "no scene given"},
             {"none.xml", "none.xml"},
             {"ball.xml --time fast", "--time"},
             {"ball.xml --width 4 --height 4", "a bench judges by the errors of 32 at least"},
             {"ball.xml --spp 4", "unknown option --spp"},
             {"ball.xml --integrators ratioTraking", "did you mean ratioTracking"},
             {"ball.xml --integrators ratioTracking,", "empty name"},
             {"ball.xml --integrators ratioTracking,ratioTracking", "given twice"},
             {"ball.xml --integrators ratioTracking,deltaTracking", "do not estimate the same picture"},
             {"ball.xml -o none/there", "does not exist"},
             {"ball.xml -o taken", "taken.bench: is no folder"},
         }) {
        const Run run = folder.vkvol(std::string("bench ") + arguments);
        CAPTURE(arguments, run.text);
        CHECK(run.code == exit_bad_input);
        CHECK_THAT(run.text, Contains(message));
    }
}

TEST_CASE("an interrupted bench writes what there is", "[gpu][bench][long]") {
    const Folder folder;
    REQUIRE(folder.vkvol("ball.xml --spp 64 --seed 9 -o reference.exr -q").code == exit_done);
    // After ten measured renders of many.
    const Run run =
        folder.shell(folder.command("bench ball.xml --time 10m --reference reference.exr") + " >log 2>&1 &\n" +
                     "for i in $(seq 6000); do [ $(grep -c ' of 600 s' log) -ge 10 ] && break; kill -0 $! || break; "
                     "sleep 0.1; done\n"
                     "kill -TERM $!; wait $!");
    CAPTURE(run.text);
    CHECK(run.code == exit_interrupted);
    const nlohmann::json json = folder.json("ball.bench.json");
    CHECK(json["interrupted"] == true);
    CHECK_FALSE(json["estimators"].empty());
    CHECK_FALSE(read_csv(folder.file("ball.bench.csv")).empty());
}
