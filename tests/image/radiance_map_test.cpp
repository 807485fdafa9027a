// Pictures of other programs, read as light.
#include <OpenImageIO/imageio.h>
#include <catch2/catch.hpp>

#include "error.h"
#include "radiance_map.h"
#include "support/test_directory.h"

using namespace vkvol;
using Catch::Contains;

namespace {

// 16 x 16 pixels, channel c of which has the value 1 + c.
std::filesystem::path write_map(const TestDirectory& directory, const std::vector<std::string>& channels,
                                const std::function<void(OIIO::ImageSpec&)>& change = {}) {
    const std::filesystem::path file = directory.path / "map.exr";
    OIIO::ImageSpec spec(16, 16, int(channels.size()), OIIO::TypeDesc::FLOAT);
    spec.channelnames = channels;
    if (change)
        change(spec);
    std::vector<float> pixels;
    for (int i = 0; i < spec.width * spec.height; ++i)
        for (std::size_t c = 0; c < channels.size(); ++c)
            pixels.push_back(1.0f + float(c));
    const auto output = OIIO::ImageOutput::create(file.string());
    REQUIRE(output->open(file.string(), spec));
    REQUIRE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
    output->close();
    return file;
}

} // namespace

TEST_CASE("maps have the colours of channels by their names", "[cpu][image_io]") {
    const TestDirectory directory;
    const auto texel = [&](const std::vector<std::string>& channels) {
        return read_radiance_map(write_map(directory, channels)).texels.front();
    };
    CHECK(texel({"R", "G", "B", "A"}) == glm::vec3(1.0f, 2.0f, 3.0f));
    CHECK(texel({"Z", "B", "G", "R"}) == glm::vec3(4.0f, 3.0f, 2.0f));
    CHECK(texel({"AO.R", "Sky.R", "Sky.G", "Sky.B", "Sky.Z"}) == glm::vec3(2.0f, 3.0f, 4.0f));
    CHECK(texel({"AO.R", "AO.G", "AO.B", "R", "G", "B"}) == glm::vec3(4.0f, 5.0f, 6.0f));
    CHECK(texel({"A", "Y", "Z"}) == glm::vec3(2.0f));
    CHECK(texel({"anything"}) == glm::vec3(1.0f));
    CHECK(texel({"R", "A"}) == glm::vec3(1.0f));
    CHECK(texel({"b", "g", "r"}) == glm::vec3(3.0f, 2.0f, 1.0f));
    CHECK(texel({"diffuse.red", "diffuse.green", "diffuse.blue"}) == glm::vec3(1.0f, 2.0f, 3.0f));
    CHECK_THROWS_WITH(texel({"X", "Y", "Z"}), Contains("no channels R, G and B"));
    CHECK_THROWS_WITH(texel({"AO.R", "AO.G", "AO.B", "Combined.R", "Combined.G", "Combined.B"}),
                      Contains("several layers (AO, Combined)"));
    CHECK_THROWS_WITH(texel({"U", "V"}), Contains("no channels R, G and B"));
}

TEST_CASE("maps of whole numbers are sRGB, whatever their format", "[cpu][image_io]") {
    const TestDirectory directory;
    std::string tga(18, '\0'); // Truevision's: 2 x 2 pixels of 24 bits, from the top; blue, green, red
    tga[2] = 2, tga[12] = tga[14] = 2, tga[16] = 24, tga[17] = 0x20;
    const unsigned char pixels[] = {0, 188, 255, 1, 2, 3, 0, 0, 0, 255, 255, 255};
    const RadianceMap map = read_radiance_map(directory.write("a.tga", tga + std::string(pixels, pixels + 12)));
    REQUIRE((map.width == 2 && map.height == 2));
    CHECK(map.texels[0].x == 1.0f);
    CHECK(map.texels[0].y == Approx(0.5029).epsilon(1e-3));
    CHECK(map.texels[0].z == 0.0f);
    CHECK(map.texels[1].x == Approx(3.0 / 255.0 / 12.92));
    CHECK(map.texels[2] == glm::vec3(0.0f));
    CHECK(map.texels[3] == glm::vec3(1.0f));
}

TEST_CASE("maps of other primaries are told, and turned ones refused", "[cpu][image_io]") {
    const TestDirectory directory;
    const auto with_primaries = [&](const std::vector<float>& primaries) {
        return read_radiance_map(write_map(directory, {"R", "G", "B"},
                                           [&](OIIO::ImageSpec& spec) {
                                               spec.attribute("chromaticities",
                                                              OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8),
                                                              primaries.data());
                                           }))
            .warnings;
    };
    CHECK(with_primaries({0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f}).empty());
    const auto aces = with_primaries({0.7347f, 0.2653f, 0.0f, 1.0f, 0.0001f, -0.077f, 0.32168f, 0.33767f});
    REQUIRE(aces.size() == 1);
    CHECK_THAT(aces[0], Contains("map.exr") && Contains("Rec.709"));
    CHECK_THROWS_WITH(read_radiance_map(write_map(directory, {"R", "G", "B"},
                                                  [](OIIO::ImageSpec& spec) { spec.attribute("Orientation", 3); })),
                      Contains("orientation 3"));
    CHECK(read_radiance_map(write_map(directory, {"R", "G", "B"}, [](OIIO::ImageSpec& spec) {
              spec.attribute("Orientation", 0);
          })).width == 16);
    // As cameras do.
    OIIO::ImageSpec spec(16, 8, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("Orientation", 6);
    const auto output = OIIO::ImageOutput::create((directory.path / "photo.jpg").string());
    REQUIRE(output->open((directory.path / "photo.jpg").string(), spec));
    const std::vector<std::uint8_t> pixels(16 * 8 * 3, 99);
    REQUIRE(output->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
    output->close();
    CHECK_THROWS_WITH(read_radiance_map(directory.path / "photo.jpg"), Contains("orientation 6"));
}

TEST_CASE("a small part of a tiled picture is no damage", "[cpu][image_io]") {
    const TestDirectory directory;
    const RadianceMap map = read_radiance_map(write_map(directory, {"R", "G", "B"}, [](OIIO::ImageSpec& spec) {
        spec.tile_width = spec.tile_height = 16;
        spec.x = spec.y = 16;
        spec.full_width = spec.full_height = 128; // 64 tiles' worth in a file of 3 kB
    }));
    CHECK((map.width == 128 && map.height == 128));
    CHECK(map.texels[16 * 128 + 16] == glm::vec3(1.0f, 2.0f, 3.0f));
}

TEST_CASE("what a picture's file says of paper is not meant of its pixels", "[cpu][image_io]") {
    const TestDirectory directory;
    for (const char* name : {"tile.png", "tile.tif"}) {
        CAPTURE(name);
        OIIO::ImageSpec spec(4, 4, 3, OIIO::TypeDesc::UINT8);
        spec.x = 512; // as of a part that was cut out, which then has an offset of its own
        spec.attribute("XPosition", 512.0f);
        const std::string file = (directory.path / name).string();
        const auto output = OIIO::ImageOutput::create(file);
        REQUIRE(output->open(file, spec));
        const std::vector<std::uint8_t> pixels(4 * 4 * 3, 255);
        REQUIRE(output->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
        output->close();
        const RadianceMap map = read_radiance_map(file);
        CHECK((map.width == 4 && map.height == 4));
        CHECK(map.texels == std::vector<glm::vec3>(16, glm::vec3(1.0f)));
    }
}

TEST_CASE("a large board is a small file, and no damage", "[cpu][image_io]") {
    const TestDirectory directory;
    constexpr int edge = 4096;
    OIIO::ImageSpec spec(edge, edge, 3, OIIO::TypeDesc::UINT8);
    const std::string file = (directory.path / "board.png").string();
    const auto output = OIIO::ImageOutput::create(file);
    REQUIRE(output->open(file, spec));
    std::vector<std::uint8_t> pixels(std::size_t(edge) * edge * 3);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        pixels[i] = (i / 3 / 256 + i / 3 / edge / 256) % 2 ? 255 : 0;
    REQUIRE(output->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
    output->close();
    CHECK(read_radiance_map(file).width == edge);
}

TEST_CASE("what a map says of its numbers is told", "[cpu][image_io]") {
    const TestDirectory directory;
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=0.125\n\n-Y 1 +X 1\n";
    const RadianceMap map = read_radiance_map(directory.write("sky.hdr", header + "\x80\x80\x80\x81"));
    REQUIRE(map.warnings.size() == 1);
    CHECK_THAT(map.warnings[0], Contains("EXPOSURE") && Contains("factor of 8 undoes"));
    // gAMA 1.0, as of a picture of numbers that are linear.
    const auto png = [&](float gamma) {
        OIIO::ImageSpec spec(2, 2, 3, OIIO::TypeDesc::UINT8);
        spec.attribute("oiio:ColorSpace", "GammaCorrected");
        spec.attribute("oiio:Gamma", gamma);
        const std::string file = (directory.path / "albedo.png").string();
        const auto output = OIIO::ImageOutput::create(file);
        REQUIRE(output->open(file, spec));
        const std::vector<std::uint8_t> pixels(12, 99);
        REQUIRE(output->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
        output->close();
        return read_radiance_map(file).warnings;
    };
    CHECK(png(2.2f).empty());
    REQUIRE(png(1.0f).size() == 1);
    CHECK_THAT(png(1.0f)[0], Contains("gamma 1"));
}
