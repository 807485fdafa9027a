// Images that promise more than they hold: found by tests/fuzz, kept here.
#include <OpenImageIO/imageio.h>
#include <catch2/catch.hpp>
#include <unistd.h>

#include "error.h"
#include "image_io.h"
#include "merge.h"
#include "options.h"

using namespace vkvol;
using Catch::Contains;

namespace {

struct File {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("vkvol_malformed_" + std::to_string(getpid()) + ".exr");
    ~File() { std::filesystem::remove(path); }

    void write(OIIO::ImageSpec spec) const {
        spec.channelnames = {"R", "G", "B"};
        const auto output = OIIO::ImageOutput::create(path.string());
        REQUIRE(output->open(path.string(), spec));
        const std::vector<float> pixels(std::size_t(spec.width) * std::size_t(spec.height) * 3, 1.0f);
        REQUIRE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
        output->close();
    }
};

} // namespace

TEST_CASE("windows beyond any picture are refused", "[cpu][image_io]") {
    const File file;
    OIIO::ImageSpec spec(2, 2, 3, OIIO::TypeDesc::HALF);
    spec.x = 70000;
    spec.full_width = spec.full_height = 10;
    file.write(spec);
    CHECK_THROWS_WITH(read_exr(file.path), Contains("data window"));
    spec.x = 0;
    spec.full_width = 70000;
    file.write(spec);
    CHECK_THROWS_WITH(read_exr(file.path), Contains("data window"));
}

TEST_CASE("specks far apart are not merged into a huge picture", "[cpu][merge]") {
    const auto speck = [](int at) {
        Film film;
        film.picture_width = film.picture_height = 65536;
        film.crop = {at, at + 1, at, at + 1};
        film.mean = film.variance = {glm::vec3(1.0f)};
        film.samples = {1};
        return MergeInput{"speck.exr", film, {}};
    };
    CHECK_THROWS_WITH(merge_films({speck(0), speck(65535)}), Contains("65536x65536"));
    CHECK(merge_films({speck(0), speck(1000)}).film.pixel_count() == 1001 * 1001);
}

TEST_CASE("times and samples that leave nothing to do are refused", "[cpu][options]") {
    const auto error_of = [](std::vector<const char*> arguments) -> std::string {
        arguments.insert(arguments.begin(), {"vkvol", "s.xml"});
        try {
            parse_options(static_cast<int>(arguments.size()), arguments.data());
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    };
    CHECK_THAT(error_of({"--time", "1e308h"}), Contains("--time"));
    CHECK_THAT(error_of({"--time", "1e10"}), Contains("--time"));
    CHECK_THAT(error_of({"--time", "1", "--sample-offset", "2147483647"}), Contains("--sample-offset"));
}
