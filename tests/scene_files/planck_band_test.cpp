// Black bodies in bands: planck() in scene values.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "planck_band.h"
#include "support/scene_text.h"

using namespace vkvol;

namespace {

double part(double kelvin, double from, double to) {
    return planck_band({kelvin, from, to}) * std::numbers::pi / (5.670374419e-8 * std::pow(kelvin, 4.0));
}

// Midpoints of Planck's law in wavelengths, per micrometre.
double by_sums(double kelvin, double from, double to) {
    constexpr int parts = 100000;
    double sum = 0.0;
    for (int i = 0; i < parts; ++i) {
        const double micrometres = from + (to - from) * (i + 0.5) / parts;
        sum += 1.191042972e8 * std::pow(micrometres, -5.0) / std::expm1(14387.76877 / (micrometres * kelvin));
    }
    return sum * (to - from) / parts;
}

} // namespace

TEST_CASE("bands are integrals of Planck's law", "[cpu][emission][xml]") {
    CHECK(part(300.0, 0.0, 1e7) == Approx(1.0).epsilon(1e-9));
    for (const double kelvin : {2.7, 200.0, 288.0, 1500.0, 6000.0})
        for (const auto& [from, to] :
             {std::pair(8.0, 12.0), std::pair(0.3, 0.7), std::pair(14.9, 15.1), std::pair(3.0, 100.0)})
            CHECK(planck_band({kelvin, from, to}) ==
                  Approx(by_sums(kelvin, from, to))
                      .epsilon(1e-6)
                      .margin(1e-9 * 5.670374419e-8 / std::numbers::pi * std::pow(kelvin, 4.0)));
    // Both series where they meet.
    CHECK(part(14387.76877, 0.0, 1.0 - 1e-9) == Approx(part(14387.76877, 0.0, 1.0 + 1e-9)).epsilon(1e-8));
}

TEST_CASE("planck is for scene values, and refuses what is no band", "[cpu][emission][xml]") {
    const Scene scene = parse(R"(<sphere/><medium r="${= planck(300, 8, 12)}" g="0" b="0"/>)");
    CHECK(scene.volumes.at(0).Le.x == Approx(by_sums(300.0, 8.0, 12.0)));
    for (const char* arguments : {"0, 8, 12", "300, 12, 8", "300, -1, 8", "300, 8, 8"}) {
        CAPTURE(arguments);
        CHECK_THROWS_WITH(parse(std::string(R"(<sphere/><medium r="${= planck()") + arguments + R"()}" g="0" b="0"/>)"),
                          Catch::Contains("kelvin > 0, and the wavelengths of a band"));
    }
    CHECK_THROWS_WITH(parse(R"(<sphere/><medium r="${= planck(300, 8)}"/>)"), Catch::Contains("too few arguments"));
}
