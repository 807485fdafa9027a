#include <catch2/catch.hpp>

#include <OpenImageIO/imageio.h>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

#include "atomic_file.h"
#include "error.h"
#include "image_io.h"

using namespace vkvol;
namespace fs = std::filesystem;

namespace {

// A directory of its own for each test.
struct Scratch {
    fs::path path = fs::temp_directory_path() / ("vkvol_image_io_" + std::to_string(getpid()));
    Scratch() { fs::create_directories(path); }
    ~Scratch() { fs::remove_all(path); }
    std::ptrdiff_t files() const { return std::distance(fs::directory_iterator(path), fs::directory_iterator()); }
};

Film film_with_distinct_values() {
    Film film;
    film.picture_width = 10;
    film.picture_height = 8;
    film.crop = {2, 7, 3, 6};
    for (int i = 0; i < film.width() * film.height(); ++i) {
        const float x = float(i);
        film.mean.emplace_back(x + 0.1f, x + 0.2f, -x);
        film.variance.emplace_back(x + 0.4f, 1e-20f * x, 1e20f);
        film.samples.push_back(1000u + unsigned(i));
    }
    return film;
}

Film constant(float r, float g, float b) {
    Film film;
    film.picture_width = film.picture_height = 2;
    film.crop = {0, 2, 0, 2};
    film.mean.assign(4, {r, g, b});
    film.variance.assign(4, glm::vec3(0));
    film.samples.assign(4, 1);
    return film;
}

} // namespace

TEST_CASE("an EXR file holds every channel, the crop and the metadata", "[cpu][image_io]") {
    const Scratch scratch;
    const Film film = film_with_distinct_values();
    const Metadata metadata = {{"samplesPerPixel", 64},
                               {"renderTimeSeconds", 1.5f},
                               {"Software", "vkvol 0"},
                               {"vkvol/sceneHash", "0123abcd"},
                               {"vkvol/seed", 42},
                               {"vkvol/sampleOffset", -1},
                               {"vkvol/device", "llvmpipe (LLVM 15)"}};
    write_exr(scratch.path / "a.exr", film, metadata);
    CHECK(scratch.files() == 1);
    Metadata read_metadata;
    const Film read = read_exr(scratch.path / "a.exr", &read_metadata);
    CHECK(read.picture_width == 10);
    CHECK(read.picture_height == 8);
    CHECK((read.crop.x0 == 2 && read.crop.x1 == 7 && read.crop.y0 == 3 && read.crop.y1 == 6));
    CHECK(read.mean == film.mean);
    CHECK(read.variance == film.variance);
    CHECK(read.samples == film.samples);
    for (const auto& [key, value] : metadata) {
        INFO(key);
        REQUIRE(read_metadata.count(key) == 1);
        CHECK((read_metadata.at(key) == value));
    }
    const auto input = OIIO::ImageInput::open((scratch.path / "a.exr").string());
    REQUIRE(input);
    CHECK(input->spec().channelnames ==
          std::vector<std::string>{"R", "G", "B", "samples", "variance.R", "variance.G", "variance.B"});
    CHECK(input->spec().get_string_attribute("compression") == "zip");
    for (int channel = 0; channel < 7; ++channel)
        CHECK(input->spec().channelformat(channel) == (channel == 3 ? OIIO::TypeUInt32 : OIIO::TypeFloat));
}

TEST_CASE("samples are whole numbers, and may be floats as they once were", "[cpu][image_io]") {
    const Scratch scratch;
    Film film = constant(1, 2, 3);
    film.samples = {0, 16777217, 4294967295, 1}; // the second is no float
    write_exr(scratch.path / "a.exr", film, {});
    CHECK(read_exr(scratch.path / "a.exr").samples == film.samples);

    const OIIO::TypeDesc type = GENERATE(OIIO::TypeDesc(OIIO::TypeDesc::FLOAT), OIIO::TypeDesc(OIIO::TypeDesc::UINT32));
    const auto samples_of = [&](const std::vector<std::string>& channels) {
        OIIO::ImageSpec spec(2, 2, int(channels.size()), OIIO::TypeDesc::FLOAT);
        spec.channelnames = channels;
        for (const std::string& channel : channels)
            spec.channelformats.push_back(channel == "samples" ? type : OIIO::TypeDesc(OIIO::TypeDesc::FLOAT));
        const std::vector<float> pixels(4 * channels.size(), 8.0f);
        const auto output = OIIO::ImageOutput::create("old.exr");
        REQUIRE(output->open((scratch.path / "old.exr").string(), spec));
        output->write_image(OIIO::TypeDesc::FLOAT, pixels.data());
        output->close();
        return read_exr(scratch.path / "old.exr").samples;
    };
    const std::uint32_t there = type == OIIO::TypeDesc::FLOAT ? 8 : 4294967295; // as floats are made whole numbers
    CHECK(samples_of({"R", "G", "B", "samples", "variance.R", "variance.G", "variance.B"}) ==
          std::vector<std::uint32_t>(4, there));
    // Of which the scatter is not known: no samples without noise, as they would be by a variance of 0.
    CHECK(samples_of({"R", "G", "B", "samples"}) == std::vector<std::uint32_t>(4, 0));
    CHECK(samples_of({"R", "G", "B", "samples", "variance.R"}) == std::vector<std::uint32_t>(4, 0));
}

TEST_CASE("a name that has a ? is one of a file", "[cpu][image_io]") {
    const Scratch scratch;
    std::filesystem::create_directory(scratch.path / "take?");
    const Film film = film_with_distinct_values();
    write_exr(scratch.path / "take?" / "a.exr", film, {});
    CHECK(read_exr(scratch.path / "take?" / "a.exr").mean == film.mean);
    CHECK_THROWS_AS(read_exr(scratch.path / "take?" / "none.exr"), InputError);
    std::ofstream(scratch.path / "take?" / "rubbish.exr") << "rubbish";
    CHECK_THROWS_WITH(read_exr(scratch.path / "take?" / "rubbish.exr"), Catch::Contains("rubbish.exr"));
}

TEST_CASE("values that are not finite survive an EXR file", "[cpu][image_io]") {
    const Scratch scratch;
    Film film = constant(1, 2, 3);
    film.mean[0].x = std::numeric_limits<float>::quiet_NaN();
    film.mean[1].y = std::numeric_limits<float>::infinity();
    write_exr(scratch.path / "a.exr", film, {});
    const Film read = read_exr(scratch.path / "a.exr");
    CHECK(std::isnan(read.mean[0].x));
    CHECK(std::isinf(read.mean[1].y));
}

TEST_CASE("a PNG file holds the tone-mapped crop", "[cpu][image_io]") {
    const Scratch scratch;
    write_image(scratch.path / "a.png", film_with_distinct_values(), {}, {});
    const auto input = OIIO::ImageInput::open((scratch.path / "a.png").string());
    REQUIRE(input);
    CHECK(input->spec().width == 5);
    CHECK(input->spec().height == 3);
    CHECK(input->spec().nchannels == 3);
    std::vector<std::uint8_t> pixels(45);
    REQUIRE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, pixels.data()));
    CHECK(pixels[0] == 89); // sRGB of 0.1
    CHECK(pixels[2] == 0);
}

TEST_CASE("tone curves", "[cpu][image_io]") {
    const auto byte = [](float value, ToneCurve curve, double exposure = 0.0) {
        return int(tone_map(constant(value, value, value), {curve, exposure})[0]);
    };
    CHECK(byte(0.0f, ToneCurve::srgb) == 0);
    CHECK(byte(0.18f, ToneCurve::srgb) == 118);
    CHECK(byte(1.0f, ToneCurve::srgb) == 255);
    CHECK(byte(7.0f, ToneCurve::srgb) == 255);
    CHECK(byte(0.25f, ToneCurve::srgb, 2.0) == 255);
    CHECK(byte(0.72f, ToneCurve::srgb, -2.0) == 118);
    CHECK(byte(0.0f, ToneCurve::aces) == 0);
    CHECK(byte(100.0f, ToneCurve::aces) == 255);
    CHECK(byte(0.0f, ToneCurve::agx) == 0);
    CHECK(byte(100.0f, ToneCurve::agx) >= 250);
    CHECK(std::abs(byte(0.18f, ToneCurve::agx) - 118) < 15); // middle grey stays about where it was
    for (const ToneCurve curve : {ToneCurve::srgb, ToneCurve::aces, ToneCurve::agx})
        for (float v = 0.01f; v < 50.0f; v *= 1.3f)
            CHECK(byte(v, curve) <= byte(v * 1.3f, curve));
    // IEC 61966-2-1, to the nearest byte.
    int differ = 0;
    for (int i = 0; i <= 100000; ++i) {
        const float v = float(i) / 100000.0f;
        const double encoded = v <= 0.0031308 ? 12.92 * double(v) : 1.055 * std::pow(double(v), 1.0 / 2.4) - 0.055;
        differ += byte(v, ToneCurve::srgb) != int(255.0 * encoded + 0.5) ? 1 : 0;
    }
    CHECK(differ == 0);
    // The original's curve: the brightest value is white, a 1 in a bright picture is near one half.
    Film film = constant(1, 1, 1);
    film.mean[3] = glm::vec3(1000.0f);
    CHECK(tone_map(film, {ToneCurve::reinhard, 0.0})[0] == 127);
    CHECK(tone_map(film, {ToneCurve::reinhard, 0.0})[9] == 255);
    film.mean[3].y = std::numeric_limits<float>::quiet_NaN();
    CHECK(tone_map(film, {ToneCurve::reinhard, 0.0})[9] == 0);
    CHECK(tone_map(constant(0, 0, 0), {ToneCurve::reinhard, 0.0})[0] == 0);
}

TEST_CASE("outputs are checked before rendering", "[cpu][image_io]") {
    const Scratch scratch;
    CHECK_NOTHROW(check_writable(scratch.path / "a.exr"));
    CHECK(scratch.files() == 0);
    CHECK_THROWS_WITH(check_writable(scratch.path / "a.gif"), Catch::Contains("'.gif'; expected .exr, .png or .csv"));
    CHECK_THROWS_AS(check_writable("exr"), InputError);
    CHECK_THROWS_WITH(check_writable(scratch.path / "none" / "a.exr"), Catch::Contains("does not exist"));
    CHECK_THROWS_AS(check_writable("/proc/a.exr"), InputError); // not even root may
    fs::create_directory(scratch.path / "d.exr");
    CHECK_THROWS_WITH(check_writable(scratch.path / "d.exr"), Catch::Contains("is a directory"));
}

TEST_CASE("a failed write leaves nothing and keeps the old file", "[cpu][image_io]") {
    const Scratch scratch;
    write_text(scratch.path / "a.exr", "old");
    Film film = constant(1, 1, 1);
    film.samples.clear();
    CHECK_THROWS_AS(write_exr(scratch.path / "a.exr", film, {}), RenderError);
    CHECK(scratch.files() == 1);
    std::ifstream stream(scratch.path / "a.exr");
    std::string text;
    stream >> text;
    CHECK(text == "old");
    fs::create_directory(scratch.path / "d.png");
    CHECK_THROWS_AS(write_display(scratch.path / "d.png", constant(1, 1, 1), {}), RenderError);
    CHECK(scratch.files() == 2);
    CHECK_THROWS_AS(write_exr(scratch.path / "none" / "a.exr", constant(1, 1, 1), {}), RenderError);
}

TEST_CASE("a link stays a link, and a device a device", "[cpu][image_io]") {
    const Scratch scratch;
    write_text(scratch.path / "real.json", "1");
    fs::create_symlink("real.json", scratch.path / "link.json");
    write_text(scratch.path / "link.json", "22");
    CHECK(fs::is_symlink(scratch.path / "link.json"));
    CHECK(fs::file_size(scratch.path / "real.json") == 2);
    CHECK_NOTHROW(check_directory_writable("/dev/null"));
    write_text("/dev/null", "x");
    CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("links that lead to what is not there yet", "[cpu][image_io]") {
    const Scratch scratch;
    fs::create_directories(scratch.path / "far" / "away");
    fs::create_symlink("far/away/second.json", scratch.path / "first.json");
    fs::create_symlink("../later.json", scratch.path / "far" / "away" / "second.json");
    CHECK(behind_links(scratch.path / "first.json").lexically_normal() == scratch.path / "far" / "later.json");
    CHECK_NOTHROW(check_directory_writable(scratch.path / "first.json"));
    write_text(scratch.path / "first.json", "22");
    CHECK(fs::is_symlink(scratch.path / "first.json"));
    CHECK(fs::file_size(scratch.path / "far" / "later.json") == 2);
    fs::create_symlink("none/a.json", scratch.path / "lost.json");
    CHECK_THROWS_WITH(check_directory_writable(scratch.path / "lost.json"), Catch::Contains("none does not exist"));
    fs::create_symlink("round.json", scratch.path / "round.json");
    CHECK_NOTHROW(behind_links(scratch.path / "round.json"));
}

// Processes in containers may have the same number, and what one of them writes another must not take away.
TEST_CASE("files that are not whole yet have names that nobody else gives", "[cpu][image_io]") {
    const fs::path target = fs::path("far") / "a.exr";
    std::set<fs::path> names;
    for (int i = 0; i < 100; ++i)
        names.insert(temporary_name(target));
    CHECK(names.size() == 100);
    CHECK(names.begin()->parent_path() == "far");
    CHECK(names.begin()->extension() == ".exr");
    CHECK(temporary_name(std::string(250, 'a') + ".exr").filename().string().size() < 143);
}

TEST_CASE("links that lead to a pipe somebody has open", "[cpu][image_io]") {
    const Scratch scratch;
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    const fs::path link = scratch.path / "table.csv";
    fs::create_symlink("/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(ends[1]), link);
    CHECK(is_special(link));
    CHECK_NOTHROW(check_directory_writable(link));
    write_text(link, "22");
    char text[2] = {};
    CHECK(read(ends[0], text, sizeof text) == 2);
    CHECK(text[1] == '2');
    close(ends[0]);
    close(ends[1]);
}

TEST_CASE("who may see a file still may, and nobody else", "[cpu][image_io]") {
    const Scratch scratch;
    const fs::path name = scratch.path / "a.json";
    write_text(name, "1");
    fs::permissions(name, fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
    write_text(name, "22");
    CHECK(fs::status(name).permissions() == (fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read));
    fs::permissions(name, fs::perms::owner_read);
    if (geteuid() == 0) // who may write it nevertheless
        return;
    CHECK_THROWS_WITH(check_directory_writable(name), Catch::Contains("not to be written"));
}

TEST_CASE("a file is whole or not there", "[cpu][image_io]") {
    const Scratch scratch;
    const fs::path name = scratch.path / "a.json";
    const auto text = [&] {
        std::ifstream stream(name);
        return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    {
        AtomicFile file(name);
        REQUIRE(file.write("67", 2, 5));
        REQUIRE(file.write("12345", 5, 0));
        CHECK_FALSE(fs::exists(name));
        file.put_in_place();
    }
    CHECK(text() == "1234567");
    {
        AtomicFile file(name);
        CHECK(file.write("8", 1, 0));
    }
    CHECK(text() == "1234567");
    CHECK(scratch.files() == 1);
    AtomicFile full("/dev/full");
    CHECK(full.write("9", 1, 0)); // once all is there
    CHECK_THROWS_AS(full.put_in_place(), std::system_error);
}

TEST_CASE("files that are no renders are refused", "[cpu][image_io]") {
    const Scratch scratch;
    CHECK_THROWS_WITH(read_exr(scratch.path / "none.exr"), Catch::Contains("no such file"));
    write_text(scratch.path / "garbage.exr", "this is no image");
    CHECK_THROWS_AS(read_exr(scratch.path / "garbage.exr"), InputError);
    write_display(scratch.path / "a.png", constant(1, 1, 1), {});
    CHECK_THROWS_WITH(read_exr(scratch.path / "a.png"), Catch::Contains("expected an .exr"));

    Film film;
    film.picture_width = film.picture_height = 64;
    film.crop = {0, 64, 0, 64};
    for (int i = 0; i < 4096; ++i)
        film.mean.emplace_back(std::sin(float(i)), std::cos(float(i)), float(i));
    film.variance.resize(4096);
    film.samples.resize(4096);
    write_exr(scratch.path / "cut.exr", film, {});
    fs::resize_file(scratch.path / "cut.exr", fs::file_size(scratch.path / "cut.exr") / 2);
    CHECK_THROWS_AS(read_exr(scratch.path / "cut.exr"), InputError);

    OIIO::ImageSpec spec(2, 2, 1, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {"Y"};
    const auto output = OIIO::ImageOutput::create("y.exr");
    const std::vector<float> pixels(4);
    REQUIRE(output->open((scratch.path / "y.exr").string(), spec));
    output->write_image(OIIO::TypeDesc::FLOAT, pixels.data());
    output->close();
    CHECK_THROWS_WITH(read_exr(scratch.path / "y.exr"), Catch::Contains("R, G and B are needed"));
}
