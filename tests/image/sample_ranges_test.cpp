#include <catch2/catch.hpp>
#include <string>

#include "error.h"
#include "sample_ranges.h"

using namespace vkvol;
using Catch::Contains;

namespace {

SampleRanges ranges_of(const std::string& text) {
    return sample_ranges_of({{"vkvol/ranges", text}}, "image.exr");
}

std::string normalised(const std::string& text) {
    return to_text(ranges_of(text));
}

Metadata render_range(int seed, int offset, int samples) {
    return {{"vkvol/seed", std::to_string(seed)}, {"vkvol/sampleOffset", offset}, {"samplesPerPixel", samples}};
}

} // namespace

TEST_CASE("sample ranges are sorted, and joined where they touch", "[cpu][merge]") {
    CHECK(normalised("0:0-4096 7:0-64") == "0:0-4096 7:0-64");
    CHECK(normalised("7:8-9 0:4-8 7:0-8 0:0-4") == "0:0-8 7:0-9");
    CHECK(normalised("0:0-8 0:2-4 0:6-10 0:11-12") == "0:0-10 0:11-12");
    CHECK(normalised("unknown 3:1-2") == "3:1-2 unknown");
    CHECK(normalised("unknown") == "unknown");
    CHECK(normalised("18446744073709551615:0-18446744073709551615") == "18446744073709551615:0-18446744073709551615");
}

TEST_CASE("the sample ranges of a render", "[cpu][merge]") {
    const auto text = [](const Metadata& metadata) { return to_text(sample_ranges_of(metadata, "image.exr")); };
    CHECK(text(render_range(7, 64, 32)) == "7:64-96");
    CHECK(text({{"vkvol/seed", 5}, {"samplesPerPixel", 2}}) == "5:0-2"); // from the beginning
    CHECK(text({}) == "unknown");
    CHECK(text({{"vkvol/seed", 5}}) == "unknown");
    CHECK(text({{"samplesPerPixel", 5}}) == "unknown"); // other programs say that too
}

TEST_CASE("sample ranges that make no sense are refused", "[cpu][merge]") {
    for (const char* text : {"",
                             " ",
                             "0",
                             "0:",
                             "0:0",
                             "0:0-",
                             "0:-4",
                             ":0-4",
                             "0:4-4",
                             "0:5-4",
                             "-1:0-4",
                             "0:0-4x",
                             "0:0-4,1:0-4",
                             "0:0-99999999999999999999",
                             "a:0-4",
                             "0:0-4 rubbish",
                             "0 :0-4",
                             "\n\t",
                             "0:0-4-8",
                             "Unknown"}) {
        INFO("'" << text << "'");
        CHECK_THROWS_AS(ranges_of(text), InputError);
        CHECK_THROWS_WITH(ranges_of(text), Contains("image.exr: vkvol/ranges is"));
    }
    CHECK_THROWS_AS(ranges_of(std::string("0:0-4\0", 6)), InputError);
    CHECK_THROWS_AS(sample_ranges_of({{"vkvol/ranges", 3}}, "image.exr"), InputError);
    CHECK_THROWS_WITH(sample_ranges_of({{"vkvol/seed", "x"}, {"samplesPerPixel", 1}}, "image.exr"),
                      "image.exr: vkvol/seed is 'x'; expected a whole number");
    CHECK_THROWS_AS(sample_ranges_of(render_range(0, -5, 8), "image.exr"), InputError);
    CHECK_THROWS_AS(sample_ranges_of(render_range(0, 5, 0), "image.exr"), InputError);
    Metadata beyond = render_range(0, 0, 5);
    beyond["vkvol/sampleOffset"] = "18446744073709551615";
    CHECK_THROWS_AS(sample_ranges_of(beyond, "image.exr"), InputError);
}

TEST_CASE("shared samples are those of the same seed and number", "[cpu][merge]") {
    const auto shared = [](const char* a, const char* b) {
        const std::string text = shared_samples(ranges_of(a), ranges_of(b));
        CHECK(text == shared_samples(ranges_of(b), ranges_of(a)));
        return text;
    };
    CHECK(shared("0:0-4", "0:0-4") == "seed 0, 0-3");
    CHECK(shared("0:0-4", "0:4-8").empty());
    CHECK(shared("0:0-4", "7:0-4").empty());
    CHECK(shared("0:0-4 7:0-4", "7:2-8") == "seed 7, 2-3");
    CHECK(shared("0:0-4 0:8-12 7:0-4", "0:2-10 7:3-5 9:0-4") == "seed 0, 2-3; seed 0, 8-9; seed 7, 3-3");
    CHECK(shared("0:0-4 unknown", "0:3-9 unknown") == "seed 0, 3-3"); // what is known counts
    CHECK(shared("unknown", "unknown").empty());
}

TEST_CASE("the union of sample ranges", "[cpu][merge]") {
    const auto both = [](const char* a, const char* b) { return to_text(united(ranges_of(a), ranges_of(b))); };
    CHECK(both("0:0-4", "0:4-8") == "0:0-8");
    CHECK(both("7:0-4", "0:0-4") == "0:0-4 7:0-4");
    CHECK(both("0:0-4", "0:8-12") == "0:0-4 0:8-12");
    CHECK(both("0:0-4", "0:0-4") == "0:0-4"); // windows side by side
    CHECK(both("0:0-4", "unknown") == "0:0-4 unknown");
}
