// <phase>: what is read of it and of its file, and what is refused.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

#include "error.h"
#include "phase_table.h"
#include "scene_hash.h"
#include "support/scene_text.h"
#include "support/scenes.h"

using namespace vkvol;
using Catch::Contains;

namespace {

Volume volume_of(const std::string& phase) {
    return parse("<sphere/>" + phase).volumes.at(0);
}

std::string trouble_with(const std::string& text) {
    const std::filesystem::path file = write_text(text);
    try {
        load_phase_table(file);
    } catch (const InputError& error) {
        const std::string message = error.what();
        REQUIRE(message.starts_with(file.string() + ":"));
        return message.substr(file.string().size() + 1);
    }
    return "";
}

} // namespace

TEST_CASE("phase functions of every kind are read", "[cpu][xml]") {
    CHECK(volume_of("<heyneygreenstein_g>.5</heyneygreenstein_g>").g == 0.5);
    CHECK(volume_of("<phase>rayleigh</phase>").phase == PhaseFunction::rayleigh);
    const Volume two = volume_of("<heyneygreenstein_g>.8</heyneygreenstein_g>"
                                 R"(<phase second="-.3" share=".2">doubleHenyeyGreenstein</phase>)");
    CHECK(two.phase == PhaseFunction::double_henyey_greenstein);
    CHECK(two.g == 0.8);
    CHECK(two.phase_details.g2 == -0.3);
    CHECK(two.phase_details.share == 0.2);
    CHECK(volume_of(R"(<phase alpha="3">draine</phase>)").phase_details.alpha == 3.0);
    CHECK(volume_of(R"(<phase diameter="15">droplets</phase>)").phase_details.diameter == 15.0);
    const PhaseDetails water =
        volume_of(R"(<phase index="1.2" backscatter=".03">fournierForand</phase>)").phase_details;
    CHECK(water.index == 1.2);
    CHECK(water.backscatter == 0.03);
    const Volume table = volume_of(R"(<phase file="a/bow.txt">table</phase>)");
    CHECK(table.phase == PhaseFunction::table);
    CHECK(table.phase_details.file.filename() == "bow.txt");
    CHECK(parse("<sphere/><heyneygreenstein_g>.5</heyneygreenstein_g><phase>droplets</phase>").warnings.size() == 1);
}

TEST_CASE("phase functions that make no sense are refused", "[cpu][xml]") {
    CHECK(error_of("<sphere/><phase>mie</phase>").find("unknown phase function 'mie'") != std::string::npos);
    for (const char* phase :
         {R"(<phase alpha="-1">draine</phase>)", R"(<phase alpha="251">draine</phase>)",
          R"(<phase diameter="0">droplets</phase>)", R"(<phase diameter="51">droplets</phase>)",
          R"(<phase share="1.1">doubleHenyeyGreenstein</phase>)", R"(<phase second="1">doubleHenyeyGreenstein</phase>)",
          R"(<phase second=".999999">doubleHenyeyGreenstein</phase>)", "<phase>table</phase>",
          R"(<phase index="1">fournierForand</phase>)", R"(<phase index="1.7">fournierForand</phase>)",
          R"(<phase backscatter="0">fournierForand</phase>)", R"(<phase backscatter=".5">fournierForand</phase>)",
          R"(<phase alpha="1">droplets</phase>)", R"(<phase g=".5">henyeyGreenstein</phase>)"}) {
        CAPTURE(phase);
        CHECK_THROWS_AS(volume_of(phase), InputError);
    }
}

TEST_CASE("scenes of other phase functions have other hashes", "[cpu][method]") {
    std::vector<std::string> hashes;
    for (const NamedPhase& phase : all_phases()) {
        Scene scene = scene_of(phase.of(medium(Sphere{}, 1.0, 0.9)), 3.0, 8);
        hashes.push_back(scene_hash(scene));
    }
    std::sort(hashes.begin(), hashes.end());
    CHECK(std::adjacent_find(hashes.begin(), hashes.end()) == hashes.end());
}

TEST_CASE("tables of phase functions are read, and their mistakes named by line", "[cpu][phase]") {
    CHECK(trouble_with("0 1\n180 1\n").empty());
    CHECK(trouble_with("\xef\xbb\xbf" + std::string("0 1\n180 1\n")).empty()); // as some editors save UTF-8
    CHECK(trouble_with("# x\n\n0, 1; # start\n90\t0\r\n180 2e0\n").empty());
    CHECK(trouble_with("0 1\n90 x\n180 1\n").starts_with("2: 'x' is no number"));
    CHECK(trouble_with("0 1\n90 -1\n180 1\n").starts_with("2: value -1"));
    CHECK(trouble_with("0 1\n90 nan\n180 1\n").starts_with("2: 'nan'"));
    CHECK(trouble_with("0 1\n90 1\n90 1\n180 1\n").starts_with("3: angle 90; "));
    CHECK(trouble_with("0 1\n90 1\n181 1\n").starts_with("3: angle 181; "));
    CHECK(trouble_with("0 1\n90 1 1\n180 1\n").starts_with("2: has 3 numbers"));
    CHECK(trouble_with("0 1 1\n180 1 1\n").starts_with("1: has 3 numbers"));
    CHECK(trouble_with("1 1\n180 1\n").find("goes from 1 to 180 degrees") != std::string::npos);
    CHECK(trouble_with("0 0\n180 0\n").find("every value is 0") != std::string::npos);
    CHECK(trouble_with("0 0\n179.9999 1\n180 0\n").find("scatters nowhere") != std::string::npos);
    CHECK(trouble_with("").find("holds 0 lines") != std::string::npos);
    CHECK(trouble_with("2\n1\n").starts_with("1: the first moment is 2"));
    CHECK(trouble_with("1\n1.5\n").starts_with("2: moment 1.5"));
    CHECK(trouble_with("1\n.99\n.98\n").find("is negative over") != std::string::npos);
    CHECK_THROWS_AS(load_phase_table("/nowhere/to.txt"), InputError);
}

// Henyey and Greenstein's moments are g^l.
TEST_CASE("Legendre moments are summed", "[cpu][phase]") {
    constexpr double g = 0.7, pi = 3.14159265358979;
    std::string text;
    for (int l = 0; l < 80; ++l)
        text += fmt::format("{}\n", std::pow(g, l));
    const PhaseTable table = load_phase_table(write_text(text));
    CHECK(table.warnings.empty());
    for (const shared::PhaseNode& node : table.nodes) {
        const double exact = (1.0 - g * g) / (4.0 * pi) / std::pow((1.0 - g) * (1.0 - g) + 2.0 * g * node.x, 1.5);
        // The series' rest is below the sum of (2 l + 1) g^l over l >= 80, over 4 pi: 2e-11. Between nodes 0.011
        // degrees apart the density is linear, by which the integral and so all values err by h^2 / 8 of the
        // curvature's mean.
        REQUIRE(node.value == Approx(exact).epsilon(1e-5));
    }
    CHECK(load_phase_table(write_text("1\n.6\n.2\n")).warnings.size() == 1);
}

TEST_CASE("moments that stand beside their indices are not angles without a word", "[cpu][phase][xml]") {
    std::string text;
    for (int l = 0; l <= 180; ++l)
        text += fmt::format("{} {:.6g}\n", l, std::pow(0.85, l));
    const PhaseTable table = load_phase_table(write_text(text));
    REQUIRE(table.warnings.size() == 1);
    CHECK_THAT(table.warnings.front(), Contains("leave out their indices"));
    CHECK_THROWS_WITH(load_phase_table(write_text("0 1\n1 0.85\n2 0.72\n")), Contains("leave out their indices"));
    CHECK(load_phase_table(write_text("0 2\n90 1\n180 1\n")).warnings.empty());
}
