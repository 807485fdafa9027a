// Estimators agree: with each other and with the reference, in the mean and per pixel. The tables of tools/results come
// from the hidden cases, which tools/validate.sh runs.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <set>

#include "integrators.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "support/test_device.h"
#include "support/thorough.h"

using namespace vkvol;

namespace {

// To standard output, and to the file that the environment names.
class Table {
public:
    explicit Table(const char* variable) {
        if (const char* path = std::getenv(variable))
            file_.open(path);
    }
    void line(const std::string& text) {
        std::cout << text << std::endl;
        file_ << text << std::endl;
    }

private:
    std::ofstream file_;
};

Scene with(Scene scene, const Combination& combination) {
    scene.settings.integrator = "ratioTracking";
    scene.settings.choices = combination.choices;
    return scene;
}

// How much of the light is missing or too much: the images' means, relative, with its standard error.
struct RelativeBias {
    double value, error;
};
RelativeBias bias_of(const Film& film, const Film& exact) {
    double difference = 0.0, variance = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i)
        for (int c = 0; c < 3; ++c) {
            difference += double(film.mean[i][c]) - exact.mean[i][c];
            variance += double(film.variance[i][c]) + exact.variance[i][c]; // channels of one path vary together
            sum += exact.mean[i][c];
        }
    return {difference / sum, std::sqrt(3.0 * variance) / sum};
}

} // namespace

TEST_CASE("each estimator equals the reference's own", "[gpu][agreement]") {
    // One axis at a time, from delta flights with ratio-tracked shadow rays at collisions: the rest is for the table.
    std::size_t turn = 0, scenes = 0;
    std::set<int> flights, transmittances, looks;
    for (const NamedScene& named : agreement_scenes()) {
        if (named.name != "thick cloud" && named.name != "chromatic cloud" && named.name != "fire" &&
            named.name != "noise in a mesh" && named.name != "transfer function" && named.name != "atmosphere")
            continue;
        Scene scene = named.scene;
        scene.settings.spp = 256;
        std::vector<Combination> one_axis;
        for (const Combination& combination : unbiased_combinations(scene)) {
            const AxisChoices& c = combination.choices;
            const int usual = named.name == "chromatic cloud" ? FREE_FLIGHT_SPECTRAL : FREE_FLIGHT_DELTA;
            const int others = (*c.free_flight != usual) + (*c.transmittance != TRANSMITTANCE_RATIO) +
                               (*c.nee != NEE_COLLISIONS) + (*c.emission != EMISSION_AT_COLLISIONS);
            // Only flights through a density ask what it is made of.
            const bool about_flights = *c.free_flight != usual || *c.transmittance != TRANSMITTANCE_RATIO;
            const bool about_density =
                named.name == "noise in a mesh" || named.name == "transfer function" || named.name == "atmosphere";
            if (others == 1 && (!about_density || about_flights))
                one_axis.push_back(combination);
        }
        ++scenes;
        for (const Combination& combination : one_axis) {
            flights.insert(*combination.choices.free_flight);
            transmittances.insert(*combination.choices.transmittance);
            looks.insert(*combination.choices.nee);
        }
        for (const Combination& combination : in_turn(one_axis, turn++)) {
            const Scene chosen = with(scene, combination);
            CHECK_AGREEMENT(
                agree(render_here(chosen, 5).film, render_reference(chosen, 6), named.name + ", " + combination.name));
        }
    }
    CHECK(scenes == 6);
    CHECK(flights == std::set<int>{FREE_FLIGHT_ANALYTIC, FREE_FLIGHT_REGULAR, FREE_FLIGHT_DELTA, FREE_FLIGHT_WEIGHTED,
                                   FREE_FLIGHT_DECOMPOSITION, FREE_FLIGHT_SPECTRAL});
    CHECK(transmittances == std::set<int>{TRANSMITTANCE_ANALYTIC, TRANSMITTANCE_REGULAR, TRANSMITTANCE_DELTA,
                                          TRANSMITTANCE_RATIO, TRANSMITTANCE_RESIDUAL, TRANSMITTANCE_TELESCOPING});
    CHECK(looks == std::set<int>{NEE_COLLISIONS, NEE_TENTATIVE, NEE_CACHED});
}

TEST_CASE("a control density is lit from null collisions too", "[gpu][agreement][long]") {
    // The haze between the spikes is the control: most collisions are certain, and no density is looked up there.
    Scene scene = agreement_scenes()[5].scene;
    scene.settings.spp = 256;
    scene = with(scene, {"", {{}, FREE_FLIGHT_DECOMPOSITION, TRANSMITTANCE_RATIO, NEE_TENTATIVE, {}}});
    CHECK_AGREEMENT(agree(render_here(scene, 11).film, render_reference(scene, 12), "spikes, decomposition"));
}

TEST_CASE("marches equal the reference's of the same steps", "[gpu][agreement]") {
    Scene scene = agreement_scenes()[6].scene; // the chromatic cloud
    scene.settings.spp = 256;
    scene.settings.march.step = 2.0;
    const auto check = [&](int flight, int transmittance, const char* name) {
        const Scene chosen = with(scene, {name, {{}, flight, transmittance, {}, {}}});
        CHECK_AGREEMENT(agree(render_here(chosen, 7).film, render_reference(chosen, 8), name));
    };
    check(FREE_FLIGHT_MARCH, TRANSMITTANCE_RATIO, "march");
    check(FREE_FLIGHT_ADAPTIVE, TRANSMITTANCE_RATIO, "adaptive march");
    check(FREE_FLIGHT_SPECTRAL, TRANSMITTANCE_MARCH, "marched shadow rays");
    check(FREE_FLIGHT_SPECTRAL, TRANSMITTANCE_JACKKNIFE, "jackknifed shadow rays");
}

TEST_CASE("marches through the medium scatter once", "[gpu][agreement]") {
    // Per pixel against the reference's marches; in the mean against paths that scatter once, which are exact, with
    // steps so small that the bias is below the noise. (Not per pixel: where a path of a hundred collides, the normal
    // limit is far off.)
    for (const NamedScene& named : agreement_scenes()) {
        if (named.name == "noise in a mesh" || named.name == "atmosphere") // which has no end to march to
            continue;
        if (!thorough() && named.name != "thick cloud" && named.name != "fire")
            continue;
        Scene scene = named.scene;
        scene.settings.spp = 128;
        scene.settings.integrator = "ratioTracking";
        scene.settings.choices.scattering = SCATTERING_SINGLE;
        const Film expected = render_here(scene, 1).film;
        scene.settings.spp = 32;
        scene.settings.choices.nee = NEE_TENTATIVE;
        scene.settings.march.unit = CoefficientUnit::world;
        scene.settings.march.step = 0.1;
        scene.settings.march.optical_step = 0.1;
        const bool both = named.name == "thick cloud" || named.name == "fire";
        for (const int flight : {FREE_FLIGHT_MARCH, FREE_FLIGHT_ADAPTIVE}) {
            if (flight == FREE_FLIGHT_MARCH && !both) // an adaptive one with another rule for its steps
                continue;
            scene.settings.choices.free_flight = flight;
            const Film marched = render_here(scene, 2).film;
            const std::string name = named.name + (flight == FREE_FLIGHT_MARCH ? ", march" : ", adaptive march");
            if (scene.volumes.size() == 1) // the reference's race has no marches through
                CHECK_AGREEMENT(agree(marched, render_reference(scene, 3), name));
            const RelativeBias bias = bias_of(marched, expected);
            CAPTURE(name, bias.value, bias.error);
            CHECK(normal_p(bias.value / bias.error) > sidak(0.001, 10 + 2));
        }
    }
}

TEST_CASE("all unbiased combinations agree", "[.agreement_table]") {
    constexpr double alpha = 0.01; // that any of all the tests fails by chance
    const std::vector<NamedScene> scenes = agreement_scenes();
    const double share = sidak(alpha, double(scenes.size()));
    Table table("VKVOL_AGREEMENT");
    table.line(fmt::format("Every pair of unbiased combinations of estimators, device and reference: image means by "
                           "t-test, pixels by z-test, three channels.\nSignificance {} over all of it (Sidak).\n",
                           alpha));
    table.line(fmt::format("{:<18} {:>6} {:>9} {:>6} {:>9} {:>18} {:>19}  {}", "scene", "device", "reference", "pairs",
                           "tests", "largest mean z", "largest pixel z", "verdict"));
    for (const NamedScene& named : scenes) {
        std::vector<Estimate> estimates;
        std::uint32_t seed = 100;
        std::size_t on_device = 0;
        for (const Combination& combination : unbiased_combinations(named.scene)) {
            const Scene scene = with(named.scene, combination);
            estimates.push_back({combination.name, render_here(scene, ++seed).film});
            ++on_device;
            estimates.push_back({"reference " + combination.name, render_reference(scene, ++seed)});
        }
        const PairwiseAgreement found = compare_all(estimates);
        const double channels = 3.0 * double(found.pairs);
        const double mean_limit = z_limit(share / 2.0, channels);
        const double pixel_limit = z_limit(share / 2.0, double(found.tests) - channels);
        const bool ok = found.mean_z <= mean_limit && found.pixel_z <= pixel_limit;
        table.line(fmt::format("{:<18} {:>6} {:>9} {:>6} {:>9} {:>8.2f} (of {:.2f}) {:>9.2f} (of {:.2f})  {}",
                               named.name, on_device, estimates.size() - on_device, found.pairs, found.tests,
                               found.mean_z, mean_limit, found.pixel_z, pixel_limit, ok ? "agree" : "DIFFER"));
        if (!ok)
            table.line("    mean: " + found.mean_pair + "\n    pixel: " + found.pixel_pair);
        CHECK(ok);
    }
}

TEST_CASE("the bias of marches shrinks with the step", "[.bias_table]") {
    Table table("VKVOL_BIAS");
    table.line("Relative bias of the image's mean against the step, with its standard error; the order is the slope "
               "between neighbours, where both are seen.\n");
    struct Case {
        const char* name;
        const char* integrator;
        bool jitter, adaptive, single;
    };
    for (const Case& c : {Case{"nanoVDBSimple, jittered", "nanoVDBSimple", true, false, true},
                          Case{"nanoVDBSimple, mid-points", "nanoVDBSimple", false, false, true},
                          Case{"rayMarching, jittered", "rayMarching", true, false, false},
                          Case{"rayMarching, mid-points", "rayMarching", false, false, false},
                          Case{"adaptiveRayMarching", "adaptiveRayMarching", true, true, false}}) {
        Scene scene = agreement_scenes()[4].scene; // the thick cloud
        scene.settings.spp = c.single ? 60000 : 10000;
        scene.settings.integrator = "ratioTracking";
        if (c.single)
            scene.settings.choices.scattering = SCATTERING_SINGLE;
        const Film exact = render_here(scene, 1).film;
        scene.settings.choices = {};
        scene.settings.integrator = c.integrator;
        scene.settings.march.jitter = c.jitter;
        scene.settings.spp = c.single ? 500 : 4000;
        table.line(c.name);
        double before = 0.0;
        for (const double step : {8.0, 4.0, 2.0, 1.0, 0.5}) {
            scene.settings.march.step = step;
            scene.settings.march.optical_step = 0.25 * step;
            const RelativeBias bias = bias_of(render_here(scene, 2).film, exact);
            const bool seen = std::abs(bias.value) > 3.0 * bias.error; // else the order would be noise
            const std::string order =
                seen && before / bias.value > 0.0 ? fmt::format("order {:.1f}", std::log2(before / bias.value)) : "";
            table.line(fmt::format("  step {:>4} {:<14} bias {:>9.5f} +- {:.5f}   {}", step,
                                   c.adaptive ? "/ 4 of depth" : "voxels", bias.value, bias.error, order));
            before = seen ? bias.value : 0.0;
        }
    }
}

TEST_CASE("where a path is laid aside changes nothing", "[gpu][determinism]") {
    // With a budget of three iterations nearly every segment is suspended, several times, in the midst of flights and
    // shadow rays; whatever an estimator's walk needs must survive that bit for bit.
    std::size_t checked = 0;
    const auto check = [&](Scene scene, const std::string& name) {
        scene.settings.spp = 2;
        RenderJob often, seldom;
        often.plan.budget = 3;
        if (test_device().is_cpu()) { // else other kernels, which a GPU's driver may round differently
            often.plan.copies = checked % 2 == 0 ? PathCopies::automatic : PathCopies::in_loops;
            often.plan.schedule = checked / 2 % 2 == 0 ? Schedule::staged : Schedule::fused;
            ++checked;
        }
        seldom.plan.budget = 500;
        seldom.plan.schedule = Schedule::fused; // the other has been compared with it, laid aside often
        CAPTURE(name);
        CHECK(same_bits(render_here(scene, 9, often).film, render_here(scene, 9, seldom).film));
    };
    std::size_t turn = 0;
    for (const NamedScene& named : agreement_scenes()) {
        if (named.name != "chromatic cloud" && named.name != "fire" && named.name != "noise in a mesh")
            continue;
        std::vector<Combination> each_once;
        std::vector<bool> flights(FREE_FLIGHT_COUNT), transmittances(TRANSMITTANCE_COUNT);
        for (const Combination& combination : unbiased_combinations(named.scene)) {
            const auto flight = std::size_t(*combination.choices.free_flight);
            const auto transmittance = std::size_t(*combination.choices.transmittance);
            if (flights[flight] && transmittances[transmittance])
                continue;
            flights[flight] = transmittances[transmittance] = true;
            each_once.push_back(combination);
        }
        for (const Combination& combination : in_turn(each_once, turn++, 4)) {
            // Where flights rest while shadow rays are sent more has to survive: in fire; the rest sends them at
            // collisions.
            Scene scene = with(named.scene, combination);
            scene.settings.choices.nee = named.name == "fire" ? NEE_TENTATIVE : NEE_COLLISIONS;
            check(scene, named.name + ", " + combination.name);
        }
    }
    std::vector<AxisChoices> marches;
    for (const int flight : {FREE_FLIGHT_MARCH, FREE_FLIGHT_ADAPTIVE})
        for (const int transmittance : {TRANSMITTANCE_MARCH, TRANSMITTANCE_JACKKNIFE})
            for (const int scattering : {SCATTERING_SINGLE, SCATTERING_MULTIPLE})
                marches.push_back({scattering, flight, transmittance, {}, {}});
    for (const AxisChoices& choices : in_turn(marches, 0)) { // of each choice one
        Scene scene = agreement_scenes()[7].scene;
        scene.settings.integrator = "rayMarching";
        scene.settings.choices = choices;
        check(scene, "march");
    }
}
