#include <catch2/catch.hpp>
#include <string>

#include "compare_notes.h"

using namespace vkvol;
using Catch::Contains;

namespace {

Metadata render(int seed, int offset, int samples, const char* scene = "abc") {
    return {{"vkvol/seed", std::to_string(seed)},
            {"vkvol/sampleOffset", offset},
            {"samplesPerPixel", samples},
            {"vkvol/sceneHash", std::string(scene)}};
}

std::vector<std::string> notes_of(const Metadata& a, const Metadata& b) {
    CompareOptions options;
    options.a = "a.exr";
    options.b = "b.exr";
    return comparison_notes(options, a, b);
}

} // namespace

TEST_CASE("compare: images that share samples", "[cpu][compare]") {
    const std::vector<std::string> notes = notes_of(render(0, 0, 4096), render(0, 64, 64));
    REQUIRE(notes.size() == 1);
    CHECK_THAT(notes[0], Contains("share samples") && Contains("seed 0, 64-127") && Contains("another --seed"));
    CHECK(notes_of(render(0, 0, 64), render(7, 0, 64)).empty());
    CHECK(notes_of(render(0, 0, 64), render(0, 64, 64)).empty());
    CHECK(notes_of({{"vkvol/ranges", "0:0-64 7:0-64"}}, render(7, 63, 64)).size() == 1);
    CHECK(notes_of(render(0, 0, 64), {}).empty()); // of another program
}

TEST_CASE("compare: images of different scenes, and metadata without sense", "[cpu][compare]") {
    const std::vector<std::string> notes = notes_of(render(0, 0, 64, "abc"), render(7, 0, 64, "def"));
    REQUIRE(notes.size() == 1);
    CHECK_THAT(notes[0], Contains("different scenes") && Contains("'abc' and 'def'"));
    const std::vector<std::string> rubbish = notes_of(render(0, 0, 64), {{"vkvol/ranges", "rub\nbish"}});
    REQUIRE(rubbish.size() == 1);
    CHECK_THAT(rubbish[0], Contains("b.exr: vkvol/ranges is 'rub bish'"));
}
