// What merge knows of the images it is given, says of the one it makes, and warns of.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <limits>
#include <unistd.h>

#include "error.h"
#include "image_io.h"
#include "merge.h"
#include "support/shell.h"
#include "test_paths.h"

using namespace vkvol;
using Catch::Contains;

namespace {

constexpr Crop whole{0, 4, 0, 2};

Film film_of(const Crop& crop, std::uint32_t samples = 4) {
    Film film;
    film.picture_width = 4;
    film.picture_height = 2;
    film.crop = crop;
    const auto pixels = std::size_t(film.width() * film.height());
    film.mean.assign(pixels, glm::vec3(0.5f));
    film.variance.assign(pixels, glm::vec3(0.01f));
    film.samples.assign(pixels, samples);
    return film;
}

// Samples 0 to 3 of a seed.
MergeInput part(const std::string& name, int seed, const Crop& crop = whole, const Metadata& more = {}) {
    Metadata metadata = more;
    metadata.insert({{"vkvol/seed", std::to_string(seed)}, {"vkvol/sampleOffset", 0}, {"samplesPerPixel", 4}});
    return {name, film_of(crop), metadata};
}

MergeInput merged(const std::vector<MergeInput>& inputs) {
    const MergeResult result = merge_films(inputs);
    return {"merged.exr", result.film, result.metadata};
}

std::string text_at(const MergeInput& image, const char* key) {
    return std::get<std::string>(image.metadata.at(key));
}

int int_at(const MergeInput& image, const char* key) {
    return std::get<int>(image.metadata.at(key));
}

// The bias of two renders merged.
std::string bias_of(const std::string& a, const std::string& b) {
    const MergeInput both =
        merged({part("a", 0, whole, {{"vkvol/biased", a}}), part("b", 7, whole, {{"vkvol/biased", b}})});
    return text_at(both, "vkvol/biased");
}

} // namespace

TEST_CASE("a merged image of several seeds knows its samples", "[cpu][merge]") {
    const MergeInput a = part("a.exr", 0), b = part("b.exr", 7), c = part("c.exr", 9);
    const MergeInput both = merged({a, b});
    CHECK(text_at(both, "vkvol/ranges") == "0:0-4 7:0-4");
    for (const MergeInput& again : {a, b, both})
        CHECK_THROWS_WITH(merge_films({both, again}), Contains("the same samples"));
    CHECK_THROWS_WITH(merge_films({both, b}), Contains("seed 7, 0-3"));
    const MergeInput all = merged({both, c});
    CHECK(text_at(all, "vkvol/ranges") == "0:0-4 7:0-4 9:0-4");
    CHECK(all.film.samples.front() == 12);
    CHECK_THROWS_WITH(merge_films({c, all}), Contains("seed 9, 0-3"));
}

TEST_CASE("windows of merged images are put side by side", "[cpu][merge]") {
    const Crop left{0, 2, 0, 2}, right{2, 4, 0, 2};
    const MergeInput l = merged({part("l0", 0, left), part("l7", 7, left)});
    const MergeInput r = merged({part("r0", 0, right), part("r7", 7, right)});
    const MergeInput both = merged({l, r});
    CHECK(text_at(both, "vkvol/ranges") == "0:0-4 7:0-4");
    CHECK(int_at(both, "samplesPerPixel") == 8);
    CHECK(both.film.samples == std::vector<std::uint32_t>(8, 8));
    CHECK_THROWS_WITH(merge_films({both, part("whole", 7)}), Contains("seed 7, 0-3"));
    CHECK_NOTHROW(merge_films({both, part("whole", 8)}));
}

TEST_CASE("an image that does not tell its samples is merged with a warning", "[cpu][merge]") {
    const MergeInput known = part("known.exr", 0), unknown{"unknown.exr", film_of(whole), {}};
    CHECK(merge_films({known, part("b", 7)}).warnings.empty());
    const MergeResult result = merge_films({known, unknown});
    REQUIRE(result.warnings.size() == 1);
    CHECK_THAT(result.warnings[0], Contains("unknown.exr") && Contains("cannot be checked"));
    const MergeInput both{"both.exr", result.film, result.metadata};
    CHECK(text_at(both, "vkvol/ranges") == "0:0-4 unknown");
    CHECK_THROWS_WITH(merge_films({both, known}), Contains("the same samples"));
    CHECK(merge_films({both, part("b", 7)}).warnings.size() == 1);
    CHECK(merge_films({unknown}).warnings.empty()); // with what might it share samples?
    const MergeInput beside{"beside.exr", film_of({0, 2, 0, 2}), {}};
    CHECK(merge_films({beside, part("b", 0, {2, 4, 0, 2})}).warnings.empty());
    MergeInput rubbish = part("rubbish.exr", 7);
    rubbish.metadata["vkvol/ranges"] = "7:x";
    CHECK_THROWS_WITH(merge_films({known, rubbish}), Contains("rubbish.exr: vkvol/ranges is '7:x'"));
    CHECK_THROWS_AS(merge_films({rubbish}), InputError);
}

TEST_CASE("pixels that no image holds are counted", "[cpu][merge]") {
    const MergeInput corner = part("corner", 0, {0, 1, 0, 1}), other = part("other", 0, {2, 4, 1, 2});
    const MergeResult result = merge_films({corner, other});
    REQUIRE(result.warnings.size() == 1);
    CHECK_THAT(result.warnings[0], Contains("5 of 8 pixels")); // 1 and 2 of 4x2 are there
    MergeInput interrupted = part("interrupted", 0);
    interrupted.film.samples[3] = 0;
    REQUIRE(merge_films({interrupted}).warnings.size() == 1);
    CHECK_THAT(merge_films({interrupted}).warnings[0], Contains("1 of 8 pixels"));
    CHECK(merge_films({interrupted, part("full", 7)}).warnings.empty());
}

TEST_CASE("a merged image is biased for all reasons of its parts", "[cpu][merge]") {
    CHECK(bias_of("steps; 3 paths ended at maxDepth", "steps; 4 paths ended at maxDepth") ==
          "steps; 7 paths ended at maxDepth");
    CHECK(bias_of("steps", "") == "steps");
    CHECK(bias_of("", "2 segments were cut") == "2 segments were cut");
    CHECK(bias_of("steps; 1 a", "other; 2 b; 3 a") == "steps; 4 a; other; 2 b");
    CHECK(bias_of("5 a", "a") == "5 a; a"); // nothing is lost
    CHECK(bias_of("99999999999999999999 a", "1 a") == "99999999999999999999 a; 1 a");
    CHECK(bias_of("18446744073709551615 a", "1 a") == "18446744073709551615 a");
    CHECK(bias_of("; ;x; 12", ";") == ";x; 12; ;");
    const MergeInput one_of_two = merged({part("exact", 0), part("b", 7, whole, {{"vkvol/biased", "steps"}})});
    CHECK(text_at(one_of_two, "vkvol/biased") == "steps");
    CHECK(merged({part("a", 0), part("b", 7)}).metadata.count("vkvol/biased") == 0);
}

TEST_CASE("a merged image adds up what its parts count", "[cpu][merge]") {
    const Metadata few{{"vkvol/stepCaps", 3},
                       {"vkvol/depthCaps", 0},
                       {"vkvol/nonFiniteSamples", 2},
                       {"vkvol/capsHit", 1},
                       {"vkvol/majorantViolations", 9},
                       {"vkvol/queueOverflows", 1},
                       {"vkvol/cleanedVoxels", 5},
                       {"other", "one"},
                       {"vkvol/nullCollisions", "4000000000"}};
    const Metadata many{{"vkvol/stepCaps", 4},
                        {"vkvol/depthCaps", 0},
                        {"vkvol/cleanedVoxels", 5},
                        {"vkvol/capsHit", 1},
                        {"vkvol/majorantViolations", std::numeric_limits<int>::max()},
                        {"other", "two"},
                        {"vkvol/nullCollisions", "4000000001"}};
    const MergeInput both = merged({part("a", 0, whole, few), part("b", 7, whole, many)});
    CHECK(int_at(both, "vkvol/stepCaps") == 7);
    CHECK(int_at(both, "vkvol/depthCaps") == 0);
    CHECK(int_at(both, "vkvol/nonFiniteSamples") == 2); // the other part does not tell
    CHECK(int_at(both, "vkvol/queueOverflows") == 1);
    CHECK(int_at(both, "vkvol/cleanedVoxels") == 5);
    CHECK(int_at(both, "vkvol/majorantViolations") == std::numeric_limits<int>::max());
    CHECK(int_at(both, "vkvol/capsHit") == 1);
    CHECK(text_at(both, "vkvol/nullCollisions") == "8000000001");
    CHECK(both.metadata.count("other") == 0);
    const MergeInput all = merged({both, part("c", 9, whole, {{"vkvol/capsHit", 0}, {"vkvol/stepCaps", 0}})});
    CHECK(int_at(all, "vkvol/stepCaps") == 7);
    CHECK(int_at(all, "vkvol/capsHit") == 1);
    CHECK_THROWS_WITH(merge_films({part("bad.exr", 0, whole, {{"vkvol/stepCaps", -1}})}),
                      "bad.exr: vkvol/stepCaps is '-1'; expected a whole number");
}

TEST_CASE("merge and compare say what they met, and exit as ever", "[cpu][merge][command]") {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / fmt::format("vkvol-merge-{}", getpid());
    std::filesystem::create_directories(folder);
    const auto write = [&](const MergeInput& image) { write_exr(folder / image.name, image.film, image.metadata); };
    const auto vkvol = [&](const char* arguments) {
        return run(fmt::format("cd '{}' && '{}' {}", folder.string(), VKVOL_BINARY, arguments));
    };
    write(part("left.exr", 0, {0, 1, 0, 2}));
    write(part("right.exr", 0, {3, 4, 0, 2}));
    const Run holes = vkvol("merge left.exr right.exr -o all.exr -o all.png");
    CHECK(holes.code == exit_done);
    CHECK_THAT(holes.text, Contains("vkvol: warning: 4 of 8 pixels") && Contains("all.exr, all.png: 2 images"));
    CHECK(vkvol("merge left.exr right.exr -q -o all.exr").text.empty());
    write(part("a.exr", 0));
    MergeInput brighter = part("b.exr", 0);
    brighter.film.mean[0].x += 0.01f;
    write(brighter);
    CHECK(vkvol("merge a.exr b.exr -o all.exr").code == exit_bad_input);
    const Run shared = vkvol("compare a.exr b.exr");
    CHECK(shared.code == exit_done);
    CHECK_THAT(shared.text, Contains("vkvol: note: the images share samples") && Contains("same: noise explains"));
    const Run identical = vkvol("compare a.exr a.exr");
    CHECK(identical.code == exit_done);
    CHECK_THAT(identical.text, Contains("same: identical") && !Contains("note"));
    write(part("c.exr", 7));
    CHECK(vkvol("merge a.exr c.exr -o all.exr").code == exit_done);
    std::ifstream all(folder / "all.exr", std::ios::binary); // a type that readers know, and look for
    const std::string bytes(std::istreambuf_iterator<char>(all), {});
    const std::string name("chromaticities\0", 15);
    CHECK(bytes.find(name + name) != std::string::npos);
    CHECK_THAT(vkvol("merge c.exr all.exr -o twice.exr").text, Contains("seed 7, 0-3")); // read back from the file
    CHECK_FALSE(std::filesystem::exists(folder / "twice.exr"));
    std::filesystem::remove_all(folder);
}
