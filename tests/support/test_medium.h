// Media of every kind, the same for the renderer's kernels and for the reference, with rays through them.
#pragma once

#include "statistics.h"
#include "test_grids.h"
#include "test_scene.h"
#include "tests/kernels/test_items.h"
#include "tests/reference/medium.h"

namespace vkvol {

enum class MediumKind { grid, noise_sphere, sphere, cubes, noise_cubes };
constexpr MediumKind all_media[] = {MediumKind::grid, MediumKind::noise_sphere, MediumKind::sphere, MediumKind::cubes,
                                    MediumKind::noise_cubes};

struct MediumRecipe {
    MediumKind kind = MediumKind::grid;
    Rgb sigma_t{1.0}; // at density 1 [1 / world unit]
    TestEstimators estimators{};
    Filter filter = Filter::trilinear;
    double majorant_scale = 1.0;
    GridRecipe grid = rough_recipe();
    bool leaps = true;      // over its empty majorant cells
    bool is_mapped = false; // the grid's values, by bumpy_map()
    Noise noise{1.3, 3, 0.6, 2.1};
};

// Rises, falls, has two steps and goes on rising: for values from 0 to 2.
ValueMap bumpy_map();

bool is_null_flight(int free_flight);
bool is_null_transmittance(int transmittance);
// Where an estimator can be used: analytic with density 1, regular in grids, grey ones only where all channels agree,
// stochastic lookup only where the density enters linearly; of mapped values regular ones only without interpolation.
bool flies(int free_flight, const MediumRecipe& recipe);
bool sees(int transmittance, const MediumRecipe& recipe);

class TestMedium {
public:
    explicit TestMedium(const MediumRecipe& recipe);
    TestMedium(const TestMedium&) = delete; // the scene points into it
    TestMedium& operator=(const TestMedium&) = delete;

    const TestScene& scene() const { return *scene_; }
    const reference::Medium& reference() const { return reference_; }
    double density_integral(const reference::Ray& ray) const;

    reference::Ray ray() const; // through the middle, across both cubes
    // From about the medium into it, all with density integrals in [least, most].
    std::vector<reference::Ray> random_rays(std::size_t count, std::uint32_t seed, double least, double most) const;

    // Flights from the ray's origin, with random numbers; `beta`: the throughput they begin with.
    std::vector<shared::RayInput> flights_along(const reference::Ray& ray, int count, std::uint32_t seed,
                                                glm::vec3 beta = glm::vec3(1.0f)) const;
    std::vector<shared::FlightOutput> fly(const std::vector<shared::RayInput>& inputs) const;
    // Density integral from the ray's origin to where each flight ended.
    std::vector<double> depths(const reference::Ray& ray, const std::vector<shared::FlightOutput>& flights) const;

    // Transmittance: `count` estimates along each ray, those of ray i at i * count. Counters are of this run.
    std::vector<shared::FlightOutput> see(const std::vector<reference::Ray>& rays, std::uint32_t count,
                                          std::uint32_t seed, shared::Counters* counters = nullptr) const;

private:
    std::optional<TestGrid> grid_;
    LoadedMedium loaded_;
    std::optional<TestScene> scene_;
    reference::Medium reference_;
};

// Means of three channels.
struct RgbMean {
    RunningMean channel[3];
    void add(const glm::vec3& v) {
        for (int i = 0; i < 3; ++i)
            channel[i].add(v[i]);
    }
};

} // namespace vkvol
