// Layers besides radiance in image files and scene files.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>

#include "film_channels.h"
#include "image_io.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"

using namespace vkvol;
using Catch::Contains;

TEST_CASE("layers in image files", "[cpu][image_io][aovs]") {
    const auto file = std::filesystem::temp_directory_path() / fmt::format("vkvol-layers-{}.exr", ::getpid());
    Film film;
    film.picture_width = film.picture_height = 2;
    film.crop = {0, 2, 0, 2};
    film.variance.assign(4, glm::vec3(0.25f));
    film.samples = {70000001u, 2, 3, 4};
    for (const char* name : {"direct", "group.key", "depth", "position", "alpha", "coverage"}) {
        FilmLayer layer{name, {}, {}};
        for (int i = 0; i < 4; ++i) {
            const float x = 0.1f * float(i) + float(film.layers.size());
            const bool single = std::string(layer.channels()).size() == 1;
            layer.mean.push_back(single ? glm::vec3(x) : glm::vec3(x, 2.0f * x, -x));
            if (layer.name != "position")
                layer.variance.push_back(single ? glm::vec3(x * x) : glm::vec3(x * x, x, 1.0f));
        }
        film.layers.push_back(layer);
    }
    film.mean = film.layers.front().mean;
    write_exr(file, film, {});
    Metadata metadata;
    const Film read = read_exr(file, &metadata);
    std::filesystem::remove(file);
    CHECK(same_bits(read, film));
    CHECK(std::get<std::string>(metadata.at(layers_key)) == "direct group.key depth position alpha coverage");

    // What RGB is not multiplied by is no channel A.
    CHECK(channel_name("", film.layers[4], 'A', film.is_premultiplied) == "alpha.A");
    film.is_premultiplied = true;
    CHECK(channel_name("variance.", film.layers[4], 'A', film.is_premultiplied) == "variance.A");
    write_exr(file, film, metadata);
    CHECK(same_bits(read_exr(file, &metadata), film));
    std::filesystem::remove(file);
    film.is_premultiplied = false;

    film.layers.resize(1);
    film.layers.front() = {
        "alpha", std::vector<glm::vec3>{glm::vec3(0.5f), glm::vec3(0.0f), glm::vec3(1.0f), glm::vec3(0.25f)}, {}};
    film.mean.assign(4, glm::vec3(0.25f, 0.0f, 2.0f));
    const std::vector<std::uint8_t> bytes = tone_map(film, {}, film.layers.front());
    REQUIRE(bytes.size() == 16);
    // Through half of the light 0.5, whose sRGB is 187.5 of 255.
    CHECK(std::vector<int>(bytes.begin(), bytes.begin() + 4) == std::vector<int>{188, 0, 255, 128});
    CHECK(std::vector<int>(bytes.begin() + 4, bytes.begin() + 8) == std::vector<int>{0, 0, 0, 0});
    CHECK(std::vector<int>(bytes.begin() + 8, bytes.begin() + 12) == std::vector<int>{137, 0, 255, 255});
}

TEST_CASE("the film of a scene file names its layers", "[cpu][xml][aovs]") {
    const auto parse = [](const std::string& elements) {
        return parse_scene("<options><sphere/>" + elements + "</options>", "s.xml");
    };
    CHECK(parse("").layers == 0);
    CHECK(parse(R"(<film aov="direct, depth indirect"/>)").layers == (layer_direct | layer_depth | layer_indirect));
    const Scene held = parse(R"(<film alpha="true"/>)");
    CHECK(held.holds_out);
    CHECK(held.layers == layer_alpha);
    const Scene lit = parse(R"(<light y="1" r="1" group="key"/><backgroundColor r="1" group="sky"/>
        <lights><point r="1" group="fill"/><sphere r="1" group="key"/></lights>)");
    CHECK(light_groups(lit) == std::vector<std::string>{"key", "fill", "sky"});
    const std::pair<const char*, const char*> errors[] = {
        {R"(<film aov="dept"/>)", "unknown layer 'dept'; did you mean depth?"},
        {R"(<light y="1" r="1" group="a.b"/>)", "'a.b' is no name of a layer"},
        {R"(<light y="1" r="1" group="none"/>)", "and not none"},
        {R"(<fluence>0 0 0</fluence><film alpha="1"/>)", "alpha: is a layer of a camera's rays"}};
    for (const auto& [elements, message] : errors)
        CHECK_THROWS_WITH(parse(elements), Contains(message) && Contains("s.xml:1:"));
    std::string lights;
    for (int i = 0; i < 80; ++i)
        lights += fmt::format("<point r=\"1\" group=\"g{}\"/>", i);
    const Scene many = parse("<film aov=\"groups\"/><lights>" + lights + "</lights>");
    CHECK_THROWS_WITH(plan_layers(many), Contains("64 is the most"));
}
