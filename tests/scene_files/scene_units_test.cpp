// Readings as parts of what the light brings.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "error.h"
#include "scene_xml.h"
#include "support/images.h"
#include "support/statistics.h"

using namespace vkvol;
using Catch::Contains;

namespace {

constexpr const char* light = "<light zenith=\"60\" azimuth=\"20\" r=\"3\" g=\"2\" b=\"0.5\"/>";

// A slab 1 thick in a domain that repeats, its top at 0.
Scene slab(const std::string& rest) {
    return parse_scene(
        "<options><box y=\"-0.5\"/><periodic x=\"-0.5 0.5\" z=\"-0.5 0.5\"/><width>2</width><height>2</height>"
        "<rayPerPixelCount>20000</rayPerPixelCount>" +
            rest + "</options>",
        "s.xml");
}

std::string unit_complaint(const std::string& rest) {
    try {
        slab(rest);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

} // namespace

TEST_CASE("a slab that absorbs lets through what Beer's law says, as a part", "[gpu][xml][long]") {
    const Film film =
        render_here(slab(std::string("<sigma_a>0.7</sigma_a><sigma_s>0</sigma_s><units>transmittance</units>"
                                     "<irradiance y=\"-1\" lookAt=\"0 0 0\" width=\"1\" height=\"1\"/>") +
                         light),
                    1)
            .film;
    const ImageMean mean = image_mean(film);
    for (int c = 0; c < 3; ++c)
        CHECK(std::abs(mean.value[c] - std::exp(-0.7 / 0.5)) <= 4.5 * (*mean.standard_error)[c] + 1e-6);
}

TEST_CASE("fluxes over mu0 F0, radiances pi times", "[gpu][xml]") {
    const std::string medium = "<sigma_s>2</sigma_s><sigma_a>0.2</sigma_a>";
    const std::pair<const char*, double> sensors[] = {
        {"<irradiance y=\"0.2\" lookAt=\"0 -1 0\" width=\"1\" height=\"1\"/>", 1.0},
        {"<absorption y=\"-0.5\" cells=\"1 2 1\"/>", 1.0},
        {"<camera projection=\"orthographic\" viewHeight=\"1\" y=\"2\" lookAt=\"0 0 0\" up=\"0 0 1\"/>",
         std::numbers::pi}};
    for (const auto& [sensor, factor] : sensors) {
        CAPTURE(sensor);
        std::uint32_t seed = 1; // of their own
        const bool is_box = std::string(sensor).find("<absorption") != std::string::npos;
        const std::string scene = medium + light + sensor;
        const auto of = [&](const std::string& text) {
            // The box's pixels are its cells.
            Scene made = is_box ? parse_scene("<options><box y=\"-0.5\"/><periodic x=\"-0.5 0.5\" z=\"-0.5 0.5\"/>" +
                                                  text + "</options>",
                                              "s.xml")
                                : slab(text);
            made.settings.spp = 20000;
            return image_mean(render_here(made, seed++).film);
        };
        const ImageMean plain = of(scene), parts = of("<units>reflectance</units>" + scene);
        const Rgb irradiance(3.0, 2.0, 0.5);
        for (int c = 0; c < 3; ++c) { // whether a path lives on goes by its light, too
            const double scale = factor / (0.5 * irradiance[c]);
            const double error = std::hypot((*parts.standard_error)[c], scale * (*plain.standard_error)[c]);
            CHECK(std::abs(parts.value[c] - scale * plain.value[c]) < 4.0 * error);
            CHECK(error < 0.02 * parts.value[c]);
        }
    }
    CHECK(slab(medium + light + "<units>radiance</units>").units.empty());
    CHECK(slab(medium + light + "<units>reflectance</units>").units == "reflectance");
    // A channel without light has no parts.
    const Scene red = slab(medium + "<light y=\"1\" r=\"3\"/><units>reflectance</units>");
    CHECK(std::get<DirectionalLight>(red.lights.front()).irradiance == Rgb(std::numbers::pi, 0.0, 0.0));
}

TEST_CASE("units beside an emission without effect", "[cpu][xml]") {
    const std::string scene = std::string("<sigma_s>1</sigma_s><sigma_a>1</sigma_a><emission r=\"1\"/>") + light;
    CHECK(slab(scene + "<units>reflectance</units>").units == "reflectance");
}

TEST_CASE("what would glow if it absorbed does not", "[cpu][xml]") {
    const std::string light =
        "<light y=\"1\" r=\"1\" g=\"1\" b=\"1\"/><units>reflectance</units><medium r=\"1\"/>"
        "<irradiance y=\"2\" lookAt=\"0 0 0\"/><sigma_s>1</sigma_s>";
    CHECK_NOTHROW(slab(light + "<sigma_a>0</sigma_a>"));
    CHECK_THROWS_AS(slab(light + "<sigma_a>0.1</sigma_a>"), InputError);
}

TEST_CASE("units that readings cannot have are refused", "[cpu][xml]") {
    const std::string units = "<units>reflectance</units>";
    CHECK_THAT(unit_complaint("<units>brightness</units>"),
               Contains("s.xml:1:") && Contains("unknown units 'brightness'"));
    CHECK_THAT(unit_complaint(units), Contains("one light far away"));
    CHECK_THAT(unit_complaint(units + light + "<backgroundColor r=\"1\"/>"), Contains("nothing else that shines"));
    CHECK_THAT(unit_complaint(units + light + "<medium r=\"1\"/>"), Contains("nothing else that shines"));
    CHECK_THAT(unit_complaint(units + light +
                              "<layers><layer height=\"-1\" sigma_t=\"1\"/><layer height=\"0\" sigma_t=\"1\" "
                              "emission=\"1 1 1\"/></layers>"),
               Contains("nothing else that shines"));
    CHECK_THAT(unit_complaint(units + light + "<lights><sun y=\"1\"/></lights>"), Contains("one light far away"));
    CHECK_THAT(unit_complaint(units + "<light x=\"1\" y=\"0\" z=\"0\" r=\"1\"/>"), Contains("the light is level"));
    CHECK_THAT(unit_complaint(units + "<lights><sun zenith=\"85\" angle=\"20\"/></lights>"), Contains("partly below"));
    CHECK(unit_complaint(units + "<lights><sun zenith=\"75\" angle=\"20\"/></lights>") == "no error");
    const auto points = [&](const std::string& rest) {
        try {
            parse_scene("<options><sphere/><fluence>0 0 0</fluence>" + rest + "</options>", "s.xml");
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    CHECK_THAT(points(units + light), Contains("comes from all around"));
}
