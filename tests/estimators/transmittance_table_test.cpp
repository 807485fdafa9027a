// What transmittance costs: every estimator on random segments through the demo's cloud, hidden since it takes a
// minute.
//   build/vkvol_tests "[.transmittance_table]"     prints the table; VKVOL_TABLE names a file to write it to as well
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <random>

#include "support/numbers.h"
#include "support/statistics.h"
#include "support/test_scene.h"
#include "test_paths.h"
#include "tests/kernels/test_items.h"
#include "tests/reference/quadrature.h"
#include "transmittance.spv.h"

using namespace vkvol;
using shared::FlightOutput;
using shared::RayInput;
using test_numbers::left;

namespace {

constexpr std::uint32_t samples_per_segment = 8;

struct Estimator {
    const char* name;
    int id;
    double shadow_step; // voxels; 0: the default, half a voxel, or 8 for telescoping
    bool unbiased;
};
constexpr Estimator estimators[] = {{"regular", TRANSMITTANCE_REGULAR, 0.0, true},
                                    {"delta", TRANSMITTANCE_DELTA, 0.0, true},
                                    {"ratio", TRANSMITTANCE_RATIO, 0.0, true},
                                    {"residual", TRANSMITTANCE_RESIDUAL, 0.0, true},
                                    {"telescoping", TRANSMITTANCE_TELESCOPING, 0.0, true},
                                    {"march, 1/2 voxel", TRANSMITTANCE_MARCH, 0.5, false},
                                    {"march, 2 voxels", TRANSMITTANCE_MARCH, 2.0, false},
                                    {"march, 8 voxels", TRANSMITTANCE_MARCH, 8.0, false}};

struct Segments {
    std::vector<reference::Ray> rays;
    std::vector<double> D; // density integrals
};

// From a random point in the field's box toward another, to where the box ends: what shadow rays are like.
Segments random_segments(const DensityField& field, const reference::Medium& medium, int count) {
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> uniform;
    const auto point = [&] {
        const glm::dvec3 at(uniform(engine), uniform(engine), uniform(engine));
        const glm::dvec3 low(field.voxel_min), high(field.voxel_max);
        return glm::dvec3(field.index_to_world * glm::dvec4(low + at * (high - low), 1.0));
    };
    Segments segments;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 from = point(), to = point();
        segments.rays.push_back({from, glm::normalize(to - from)});
        segments.D.push_back(reference::density_integral(medium, segments.rays.back()));
    }
    return segments;
}

struct Row {
    double error = 0.0, variance = 0.0, lookups = 0.0, steps = 0.0;
    double z = 0.0; // the mean error in standard errors
};

Row measure(const LoadedMedium& loaded, const Volume& volume, const Segments& segments, const Estimator& estimator) {
    TestEstimators chosen;
    chosen.transmittance = estimator.id;
    chosen.settings.march.shadow_step = estimator.shadow_step;
    LoadedMedium with_controls = loaded;
    add_controls(with_controls, volume, chosen);
    const TestScene scene = make_test_scene(with_controls, volume, Filter::trilinear, chosen);
    std::vector<RayInput> inputs;
    for (std::size_t i = 0; i < segments.rays.size(); ++i)
        inputs.push_back({scene.to_render(segments.rays[i].origin), segments.rays[i].direction, std::uint32_t(i), 0.0f,
                          0.0f, glm::vec3(1.0f)});
    KernelRunner runner(transmittance_spv, scene.specialization, scene.kernel);
    runner.push.step_limit = 60000; // software drivers leave loops silently after 65535 iterations
    runner.push.sample_end = samples_per_segment;
    const auto threads = static_cast<std::uint32_t>(inputs.size() * samples_per_segment);
    const auto outputs = runner.run<FlightOutput>(std::span<const RayInput>(inputs), threads, threads);
    Row row;
    RunningMean errors;
    for (std::size_t segment = 0; segment < inputs.size(); ++segment) {
        const double T = std::exp(-volume.sigma_a.x * segments.D[segment]);
        RunningMean mean;
        for (std::uint32_t k = 0; k < samples_per_segment; ++k) {
            const FlightOutput& o = outputs[segment * samples_per_segment + k];
            row.lookups += o.lookups / double(threads);
            row.steps += o.steps / double(threads);
            if (o.event == left) // telescoping: all but one in 2^13
                mean.add(o.weight.x);
        }
        if (mean.count() > 1.0) {
            errors.add(mean.mean() - T); // segments are independent, and so are their means
            row.variance += mean.variance() / double(inputs.size());
        }
    }
    row.error = errors.mean();
    row.z = row.error / std::max(errors.standard_error(), 1e-30);
    return row;
}

std::string describe(const Estimator& estimator, const Row& row) {
    return fmt::format("{:18} {:>11.2e} {:>9.1f} {:>11.3e} {:>9.1f} {:>9.1f} {:>13.3e}{}\n", estimator.name, row.error,
                       row.z, row.variance, row.lookups, row.steps, row.variance * row.lookups,
                       estimator.unbiased ? "" : "  biased");
}

} // namespace

TEST_CASE("table of transmittance estimators", "[.transmittance_table]") {
    const GridFile file{VKVOL_SOURCE_DIR "/density_fields/cumulus.nvdb"};
    if (!std::filesystem::exists(file.path)) {
        WARN("make " << file.path.string() << " first: build/make_field cumulus --output FILE");
        return;
    }
    LoadedMedium loaded;
    loaded.field = load_density_field(file);
    Volume volume;
    volume.unit = CoefficientUnit::world;
    volume.sigma_s = Rgb(0.0);
    volume.sigma_a = Rgb(1.0);
    const reference::Medium medium =
        reference::with_grid(reference::load_grid(file.path, file.grid), volume, Filter::trilinear);
    const Segments segments = random_segments(*loaded.field, medium, 10000);
    RunningMean D;
    for (const double d : segments.D)
        D.add(d);
    std::string table =
        "Transmittance along 10000 random segments through density_fields/cumulus.nvdb, 8 estimates each; "
        "trilinear lookup.\nFrom a random point of the field's box toward another, to the box's end. "
        "Printed by vkvol_tests \"[.transmittance_table]\".\n"
        "error: of the mean against quadrature, and in standard errors (rounding is all that regular "
        "has of it);\nvariance: of one estimate; lookups and steps: per estimate.\n";
    for (const double mean_tau : {1.0, 20.0}) { // thin and dense
        volume.sigma_a = Rgb(mean_tau / D.mean());
        loaded.majorants =
            std::make_shared<const Majorants>(make_majorant_grid(*loaded.field, mean_tau > 10.0 ? 32 : 64));
        table += fmt::format("\nmean optical depth {}, sigma_t {:.4f} per voxel, majorant cells of {} voxels\n",
                             mean_tau, volume.sigma_a.x * loaded.field->voxel_size(), loaded.majorants->cell);
        table += fmt::format("{:18} {:>11} {:>9} {:>11} {:>9} {:>9} {:>13}\n", "estimator", "error", "in s.e.",
                             "variance", "lookups", "steps", "var x lookups");
        for (const Estimator& estimator : estimators) {
            const Row row = measure(loaded, volume, segments, estimator);
            table += describe(estimator, row);
            CAPTURE(estimator.name, mean_tau, row.error, row.z);
            if (estimator.id == TRANSMITTANCE_REGULAR) // exact to rounding, which has no standard error to speak of
                CHECK(std::abs(row.error) < 1e-5);
            else if (estimator.unbiased)
                CHECK(std::abs(row.z) < 4.0);
        }
    }
    std::cout << table;
    if (const char* path = std::getenv("VKVOL_TABLE"))
        std::ofstream(path) << table;
}
