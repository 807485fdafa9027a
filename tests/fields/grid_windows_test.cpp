// Grids that lie in windows, because no storage buffer may be as large: the same numbers as from one buffer. The
// windows here are of a few kilobytes, so that nodes and grids straddle their borders.
#include <catch2/catch.hpp>
#include <random>

#include "kernels/test_items.h"
#include "lookup.spv.h"
#include "lookup_windows.spv.h"
#include "support/images.h"
#include "support/scenes.h"
#include "support/test_device.h"
#include "support/test_scene.h"

using namespace vkvol;
using shared::DensityInput;
using shared::DensityOutput;

namespace {

// False, with a word about it, where the device reaches no buffers by address.
bool can_test() {
    if (!test_device().has_addresses())
        WARN("the device lacks bufferDeviceAddress: grids in windows are not tested");
    return test_device().has_addresses();
}

// Every voxel, that of the last word of each window too, and points anywhere.
std::vector<DensityInput> points_in(const TestGrid& grid, int count) {
    std::mt19937 engine(8);
    std::uniform_real_distribution<float> uniform;
    const auto random = [&] { return glm::vec3(uniform(engine), uniform(engine), uniform(engine)); };
    const glm::vec3 low = glm::vec3(grid.voxel_min) - 2.0f, high = glm::vec3(grid.voxel_max) + 2.0f;
    std::vector<DensityInput> inputs;
    for (int z = grid.voxel_min.z; z <= grid.voxel_max.z; ++z)
        for (int y = grid.voxel_min.y; y <= grid.voxel_max.y; ++y)
            for (int x = grid.voxel_min.x; x <= grid.voxel_max.x; ++x)
                inputs.push_back({glm::vec3(x, y, z), random()});
    for (int i = 0; i < count; ++i)
        inputs.push_back({low + random() * (high - low), random()});
    return inputs;
}

bool same(const DensityOutput& a, const DensityOutput& b) {
    return a.voxel == b.voxel && a.nearest == b.nearest && a.trilinear == b.trilinear && a.stochastic == b.stochastic;
}

} // namespace

TEST_CASE("lookups in windows equal those in one buffer", "[gpu][windows][density]") {
    if (!can_test())
        return;
    const Storage storage = GENERATE(Storage::float32, Storage::fp4, Storage::fp8, Storage::fp16, Storage::fpn);
    const TestGrid grid = make_test_grid(cloud_grid(storage));
    TestScene scene = make_test_scene(grid.volume, {}, Filter::trilinear);
    const std::vector<DensityInput> inputs = points_in(grid, 5000);
    const auto one = KernelRunner(lookup_spv, scene.specialization, scene.kernel).run<DensityOutput>(inputs);
    scene.kernel.most_grid_bytes = 1;
    const auto many = KernelRunner(lookup_windows_spv, scene.specialization, scene.kernel).run<DensityOutput>(inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i)
        REQUIRE(same(one[i], many[i]));
}

TEST_CASE("a picture of grids in windows has the same bits", "[gpu][windows][determinism]") {
    if (!can_test())
        return;
    const bool chromatic = GENERATE(false, true), burns = GENERATE(false, true);
    GridRecipe temperature = cloud_grid();
    temperature.name = "temperature";
    temperature.value = [](glm::ivec3 voxel) { return 2000.0f * cloud_noise(voxel); };
    Scene scene = scene_of(medium(write_grids({cloud_grid(), temperature}), 2.0, 0.7, 0.5), 13.0, 24);
    scene.lights = {sunlight()};
    scene.settings.spp = 8;
    if (chromatic)
        scene.volumes.front().sigma_s *= Rgb(1.0, 0.7, 0.2);
    if (burns)
        scene.volumes.front().temperature.color = Rgb(1.0);
    RenderJob job;
    const Film one = render_here(scene, 3, job).film;
    job.plan.most_grid_bytes = 1;
    CHECK(same_bits(one, render_here(scene, 3, job).film));
    CHECK(mean_of(one) > 0.01);
}
