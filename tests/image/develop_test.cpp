// Tone: what curve and exposure a picture gets where nobody says, and pictures developed again from an EXR.
#include <OpenImageIO/imageio.h>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "error.h"
#include "image_io.h"
#include "support/shell.h"
#include "test_paths.h"
#include "tone_choice.h"

using namespace vkvol;
using Catch::Contains;

namespace {

// `pixels` of a row, grey.
Film row(const std::vector<float>& pixels) {
    Film film;
    film.picture_width = int(pixels.size());
    film.picture_height = 1;
    film.crop = {0, film.picture_width, 0, 1};
    for (const float value : pixels)
        film.mean.push_back(glm::vec3(value));
    film.variance.assign(pixels.size(), glm::vec3(0.0f));
    film.samples.assign(pixels.size(), 1);
    return film;
}

// An empty folder with two balls to render: one that is lit and one that glows, brighter than white.
class Folder {
public:
    Folder() {
        std::filesystem::create_directories(path_);
        for (const auto& [name, elements] :
             {std::pair{"lit", "<light x=\"1\" y=\"1\" z=\"1\" r=\"3\" g=\"3\" b=\"3\"/>"},
              std::pair{"fire", "<medium r=\"8\" g=\"2\" b=\"0.3\"/>"}})
            std::ofstream(path_ / fmt::format("{}.xml", name))
                << "<options><sphere/><sigma_a>2</sigma_a><sigma_s>1</sigma_s><width>24</width><height>16</height>"
                   "<rayPerPixelCount>4</rayPerPixelCount><camera z=\"4\" fov=\"30\"/>"
                   "<backgroundColor r=\"0.1\" g=\"0.2\" b=\"0.4\"/>"
                << elements << "</options>";
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    Run vkvol(const std::string& arguments, bool renders = true) const {
        const char* device = renders ? std::getenv("VKVOL_TEST_DEVICE") : nullptr;
        return run(fmt::format("cd '{}' && '{}' {}{}", path_.string(), VKVOL_BINARY, arguments,
                               device ? fmt::format(" --device '{}'", device) : ""));
    }
    std::filesystem::path file(const std::string& name) const { return path_ / name; }
    std::string bytes(const std::string& name) const {
        std::ifstream stream(path_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    }

private:
    std::filesystem::path path_ = std::filesystem::temp_directory_path() / fmt::format("vkvol-develop-{}", getpid());
};

Metadata recorded(const ToneRequest& request, bool glows) {
    Metadata metadata;
    record_tone(request, glows, metadata);
    return metadata;
}

} // namespace

TEST_CASE("pixels clip that are brighter than the curve tells apart", "[cpu][image_io]") {
    // Narkowicz' curve is 1 at 7.242; AgX ends 4.026 stops above 1, at 16.29 of grey.
    const Film film = row({0.0f, 0.5f, 1.0f, 1.01f, 7.2f, 7.3f, 16.2f, 16.4f});
    CHECK(clipped_pixels(film, {ToneCurve::srgb, 0.0}) == 5);
    CHECK(clipped_pixels(film, {ToneCurve::srgb, 1.0}) == 6);
    CHECK(clipped_pixels(film, {ToneCurve::aces, 0.0}) == 3);
    CHECK(clipped_pixels(film, {ToneCurve::agx, 0.0}) == 1);
    CHECK(clipped_pixels(film, {ToneCurve::agx, 5.0}) == 6);
    CHECK(clipped_pixels(film, {ToneCurve::reinhard, 10.0}) == 0);
    Film red = row({0.5f});
    red.mean[0].x = 1.5f;
    CHECK(clipped_pixels(red, {ToneCurve::srgb, 0.0}) == 1);
    CHECK(clipped_pixels(red, {ToneCurve::agx, 0.0}) == 0);
}

TEST_CASE("screens, files and what is opaque get the same bytes", "[cpu][image_io]") {
    std::vector<float> values{-1.0f, std::numeric_limits<float>::infinity(), 0.0f};
    for (int i = 0; i < 3000; ++i)
        values.push_back(std::exp2(float(i) / 200.0f - 11.0f));
    Film film = row(values);
    for (std::size_t i = 0; i < film.mean.size(); ++i)
        film.mean[i].y *= 0.7f;
    const FilmLayer opaque{"alpha", std::vector<glm::vec3>(film.mean.size(), glm::vec3(1.0f)), {}};
    for (const ToneCurve curve : {ToneCurve::srgb, ToneCurve::aces, ToneCurve::agx, ToneCurve::reinhard}) {
        const ToneMapping mapping{curve, 0.3};
        const std::vector<std::uint8_t> rgb = tone_map(film, mapping),
                                        rgba = tone_map_opaque(film.mean, mapping, film.mean);
        std::vector<std::uint8_t> expected;
        for (std::size_t i = 0; i < rgb.size(); i += 3)
            expected.insert(expected.end(), {rgb[i], rgb[i + 1], rgb[i + 2], 255});
        CAPTURE(int(curve));
        CHECK(rgba == expected);
        CHECK(tone_map(film, mapping, opaque) == expected);
    }
}

TEST_CASE("the curve that has its white of the picture has it of what alpha leaves", "[cpu][image_io]") {
    // Colours of 1, 0.5 and 0.25, of which a tenth is there.
    const Film film = row({0.1f, 0.05f, 0.025f});
    const FilmLayer thin{"alpha", std::vector<glm::vec3>(3, glm::vec3(0.1f)), {}};
    const std::vector<std::uint8_t> bytes = tone_map(film, {ToneCurve::reinhard, 0.0}, thin),
                                    whole = tone_map(row({1.0f, 0.5f, 0.25f}), {ToneCurve::reinhard, 0.0});
    for (int i = 0; i < 3; ++i)
        CHECK(std::abs(bytes[4 * i] - whole[3 * i]) <= 1);
    CHECK(bytes[0] == 255);
    CHECK(bytes[4] < 250);
    // A part of a picture has the whole's.
    const std::vector<std::uint8_t> part =
        tone_map_opaque(row({0.25f}).mean, {ToneCurve::reinhard, 0.0}, row({1.0f, 0.25f}).mean);
    CHECK(part[0] == whole[6]);
}

TEST_CASE("an exposure that suits puts what is bright just below white", "[cpu][image_io]") {
    std::vector<float> pixels(1000, 0.0f); // black ones have no say
    for (int i = 0; i < 400; ++i)
        pixels.push_back(1e-3f * float(1 + i));
    for (const ToneCurve curve : {ToneCurve::srgb, ToneCurve::aces, ToneCurve::agx})
        for (const float brightness : {1e-4f, 1.0f, 1e4f}) {
            Film film = row(pixels);
            for (glm::vec3& mean : film.mean)
                mean *= brightness;
            const double exposure = suitable_exposure(film, curve);
            CAPTURE(int(curve), brightness, exposure);
            const std::vector<std::uint8_t> bytes = tone_map(film, {curve, exposure});
            // The 396th of 400 values is the 99th percentile; a hundredth of a stop is less than half a per cent.
            CHECK(std::abs(bytes[3 * 1395] - 0.9 * 255.0) < 1.6);
            CHECK(clipped_pixels(film, {curve, exposure}) == 0);
        }
    CHECK(suitable_exposure(row({0.0f, 0.0f}), ToneCurve::srgb) == 0.0);
    CHECK(suitable_exposure(row({5.0f, 5.0f}), ToneCurve::reinhard) == 0.0); // white at any exposure
}

TEST_CASE("curve and exposure: what is asked for, what was, what suits", "[cpu][image_io]") {
    const Film film = row({0.1f, 2.0f, 3.0f, 4.0f});
    const auto chosen = [&film](const ToneRequest& request, const Metadata& metadata) {
        return choose_tone(request, film, metadata);
    };
    CHECK(chosen({}, {}).mapping.curve == ToneCurve::srgb);
    CHECK(chosen({}, recorded({}, false)).mapping.curve == ToneCurve::srgb);
    CHECK(chosen({}, recorded({}, true)).mapping.curve == ToneCurve::agx);
    CHECK(chosen({ToneCurve::aces, {}}, recorded({}, true)).mapping.curve == ToneCurve::aces);
    CHECK(chosen({}, recorded({ToneCurve::srgb, {}}, true)).mapping.curve == ToneCurve::srgb);
    CHECK(chosen({}, recorded({{}, 0.1}, true)).mapping.exposure == 0.1); // every bit of it
    CHECK(chosen({{}, -1.0}, recorded({{}, 0.1}, true)).mapping.exposure == -1.0);
    CHECK(chosen({}, recorded({{}, {}, true}, false)).mapping.exposure == suitable_exposure(film, ToneCurve::srgb));
    CHECK(chosen({ToneCurve::agx, {}}, recorded({{}, {}, true}, false)).mapping.exposure ==
          suitable_exposure(film, ToneCurve::agx));
    CHECK(chosen({{}, 0.0}, recorded({{}, {}, true}, false)).mapping.exposure == 0.0);
    for (const char* rubbish : {"", "nan", "1e9", "bright"})
        CHECK(chosen({}, {{"vkvol/exposure", std::string(rubbish)}, {"vkvol/tonemap", std::string(rubbish)}})
                  .mapping.exposure == 0.0);
    CHECK(tone_text(chosen({{}, -3.0}, {})) == "exposure -3");
    CHECK(tone_text(chosen({}, recorded({}, true))) == "tone curve agx since it glows");
    CHECK(tone_text(chosen({}, {})) == "75 % of the pixels clip");
    CHECK(tone_text(choose_tone({}, row({0.5f}), {})).empty());
}

TEST_CASE("what glows is shown by a curve that keeps its colour, and that is said", "[gpu][command]") {
    const Folder folder;
    CHECK_THAT(folder.vkvol("lit.xml --report lit.json").text, !Contains("tone curve"));
    CHECK_THAT(folder.vkvol("fire.xml --report fire.json").text, Contains("tone curve agx since it glows"));
    CHECK_THAT(folder.vkvol("fire.xml -o srgb.png --tonemap srgb --report srgb.json").text,
               !Contains("tone curve") && Contains("% of the pixels clip"));
    const auto tone = [&folder](const char* name) { return nlohmann::json::parse(folder.bytes(name))["tone"]; };
    CHECK(tone("lit.json")["curve"] == "srgb");
    CHECK(tone("fire.json")["curve"] == "agx");
    CHECK(tone("fire.json")["clippedPixels"] == 0);
    CHECK(tone("srgb.json")["clippedPixels"] > 50);
    CHECK(folder.bytes("fire.png") != folder.bytes("srgb.png"));
    CHECK_THAT(folder.vkvol("fire.xml -o fire.exr --report exr.json").text, !Contains("tone"));
    CHECK(tone("exr.json").is_null());
}

TEST_CASE("develop gives the picture that the render gave, bit for bit", "[gpu][command][long]") {
    const Folder folder;
    for (const char* scene : {"lit", "fire"})
        for (const char* tone : {"", "--tonemap aces", "--tonemap reinhard", "--exposure -1.3", "--exposure auto",
                                 "--tonemap agx --exposure auto", "--crop 3,17,2,11"}) {
            CAPTURE(scene, tone);
            REQUIRE(folder.vkvol(fmt::format("{}.xml -q -o a.exr -o a.png {}", scene, tone)).code == exit_done);
            const Run develop = folder.vkvol("develop a.exr -o b.png", false);
            CHECK(develop.code == exit_done);
            CHECK(folder.bytes("a.png") == folder.bytes("b.png"));
        }
}

TEST_CASE("develop gives another picture where it is told to, and says so", "[gpu][command][long]") {
    const Folder folder;
    REQUIRE(folder.vkvol("fire.xml -q -o a.exr -o a.png --exposure 2").code == exit_done);
    REQUIRE(folder.vkvol("fire.xml -q -o c.png --tonemap aces --exposure -1").code == exit_done);
    const Run develop = folder.vkvol("develop a.exr --tonemap aces --exposure -1 -o b.png", false);
    CHECK(develop.text == "b.png: 24x16 pixels, tone curve aces, exposure -1\n");
    CHECK(folder.bytes("b.png") == folder.bytes("c.png"));
    CHECK(folder.vkvol("develop -q a.exr -o b.png", false).text.empty());
    // Merged, the parts' picture is the whole's.
    REQUIRE(folder.vkvol("fire.xml -q -o left.exr --crop 0,9,0,16").code == exit_done);
    REQUIRE(folder.vkvol("fire.xml -q -o right.exr --crop 9,24,0,16").code == exit_done);
    REQUIRE(folder.vkvol("fire.xml -q -o whole.png").code == exit_done);
    REQUIRE(folder.vkvol("merge -q left.exr right.exr -o all.exr -o all.png", false).code == exit_done);
    CHECK(folder.bytes("all.png") == folder.bytes("whole.png"));
    REQUIRE(
        folder.vkvol("merge -q left.exr right.exr -o all.exr -o all.png --exposure -1 --tonemap aces", false).code ==
        exit_done);
    CHECK(folder.bytes("all.png") == folder.bytes("c.png"));
    REQUIRE(folder.vkvol("develop -q all.exr -o b.png", false).code == exit_done);
    CHECK(folder.bytes("b.png") == folder.bytes("c.png"));
}

TEST_CASE("develop refuses what it cannot do", "[cpu][command]") {
    const Folder folder;
    std::ofstream(folder.file("not.exr")) << "rubbish";
    const auto refused = [&folder](const std::string& arguments, const char* why) {
        CAPTURE(arguments);
        const Run run = folder.vkvol("develop " + arguments, false);
        CHECK(run.code == exit_bad_input);
        CHECK_THAT(run.text, Catch::StartsWith("vkvol: error: ") && Contains(why));
        CHECK(std::count(run.text.begin(), run.text.end(), '\n') == 1);
    };
    refused("", "an image and an output are needed");
    refused("a.exr", "an image and an output are needed");
    refused("none.exr -o b.png", "none.exr: no such file");
    refused("not.exr -o b.png", "not.exr");
    refused("a.exr -o b.exr", "expected .png");
    refused("a.exr -o no/b.png", "does not exist");
    refused("a.exr -o b.png --exposure bright", "neither a number from -100 to 100 nor auto");
    refused("a.exr -o b.png --exposure 101", "neither a number");
    refused("a.exr -o b.png --tonemap agxx", "did you mean agx?");
    refused("a.exr -o b.png --exposur 1", "did you mean --exposure?");
    refused("a.exr c.exr -o b.png", "unexpected argument 'c.exr'");
    CHECK_THAT(folder.vkvol("develop --help", false).text, Contains("same bytes") && Contains("--tonemap"));
}

TEST_CASE("how a camera was set is in the picture, and makes the PNG", "[gpu][command]") {
    const Folder folder;
    std::ofstream(folder.file("set.xml"))
        << "<options><sphere/><sigma_a>2</sigma_a><sigma_s>1</sigma_s><width>24</width><height>16</height>"
           "<rayPerPixelCount>4</rayPerPixelCount><backgroundColor r=\"90\" g=\"200\" b=\"400\"/>"
           "<camera z=\"4\" fov=\"30\" shutter=\"0.02\" fNumber=\"4\" iso=\"250\"/></options>";
    REQUIRE(folder.vkvol("set.xml -q -o set.exr -o set.png").code == exit_done);
    // White is a luminance of 1.2 N^2 / t 100 / S = 384: 8.585 stops.
    REQUIRE(folder.vkvol("develop -q set.exr -o same.png --exposure 0", false).code == exit_done);
    CHECK(folder.bytes("same.png") == folder.bytes("set.png"));
    Metadata metadata;
    const Film film = read_exr(folder.file("set.exr"), &metadata);
    CHECK(std::stod(std::get<std::string>(metadata.at(camera_exposure_key))) == Approx(-std::log2(384.0)));
    CHECK(film.mean.front() == glm::vec3(90.0f, 200.0f, 400.0f)); // what came, however the camera was set
    const std::vector<std::uint8_t> bytes = tone_map(film, {ToneCurve::srgb, -std::log2(384.0)});
    CHECK(bytes.at(2) == 255); // 400 of 384
    CHECK(bytes.at(1) == 191); // 255 (1.055 (200 / 384)^(1 / 2.4) - 0.055)
    const auto file = OIIO::ImageInput::open(folder.file("set.exr").string());
    REQUIRE(file);
    CHECK(file->spec().get_float_attribute("ExposureTime") == 0.02f);
    CHECK(file->spec().get_float_attribute("FNumber") == 4.0f);
    CHECK(file->spec().get_float_attribute("isoSpeed") == 250.0f);
}

TEST_CASE("a camera's exposure is where that which is asked for begins", "[cpu][develop]") {
    const Metadata metadata = {{camera_exposure_key, std::string("-3.5")}};
    Film film;
    film.mean = {glm::vec3(1.0f)};
    CHECK(choose_tone({}, film, metadata).mapping.exposure == -3.5);
    ToneRequest brighter;
    brighter.exposure = 2.0;
    CHECK(choose_tone(brighter, film, metadata).mapping.exposure == -1.5);
    brighter.exposure.reset();
    brighter.automatic_exposure = true;
    CHECK(choose_tone(brighter, film, metadata).mapping.exposure == suitable_exposure(film, ToneCurve::srgb));
}
