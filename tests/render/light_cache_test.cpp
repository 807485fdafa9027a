// The cache of transmittances towards the light. That its use is unbiased is the agreement tests' business, where the
// reference has a cache of its own; here is what the cache holds, and what it saves.
#include <catch2/catch.hpp>
#include <cmath>

#include "light_cache.h"
#include "support/images.h"
#include "support/scenes.h"
#include "support/test_device.h"
#include "support/test_scene.h"

using namespace vkvol;

namespace {

// Optical depths at the nodes, as the device finds them, in one direction after the other.
std::vector<float> depths_at_nodes(const TestScene& scene, const shared::LatticeParams& lattice,
                                   const std::vector<glm::vec3>& directions, bool texels) {
    Commands commands(test_device());
    SceneBuffers buffers(test_device(), commands, Media(scene.kernel.volume, 1), nullptr, std::uint64_t{1} << 27,
                         texels ? std::uint64_t{4} * test_device().limits().maxTexelBufferElements : 1);
    shared::FrameParams frame = scene.kernel.frame;
    frame.lattice = lattice;
    buffers.set_frame(commands, frame);
    Specialization constants = scene.specialization;
    constants[SPEC_TEXELS] = buffers.texels() ? 1 : 0;
    LightCache cache(test_device(), buffers.bound(), lattice, directions, buffers.texels());
    cache.compile(constants, 0, VK_NULL_HANDLE);
    cache.fill(commands);
    std::vector<glm::vec4> entries(cache.buffer().bytes() / sizeof(glm::vec4));
    commands.download(cache.buffer(), std::as_writable_bytes(std::span(entries)));
    std::vector<float> depths;
    for (std::size_t i = entries.size() / (1 + directions.size()); i < entries.size(); ++i)
        depths.push_back(entries[i].x);
    return depths;
}

} // namespace

TEST_CASE("lattices are cubes where they can be, and no finer than the grid", "[cpu][light_cache]") {
    const auto same = make_lattice({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}, {8.0, 4.0, 2.0}, glm::ivec3(0), 64);
    CHECK(same.dims == glm::ivec3(64, 33, 17));
    for (int axis = 0; axis < 3; ++axis)
        CHECK(same.spacing[axis] * float(same.dims[axis] - 1) == Approx(2.0));
    const auto small = make_lattice({-1.0, -1.0, -1.0}, {10.0, 1.0, 5.0}, {1.1, 0.2, 0.6}, {10, 1, 5}, 64);
    CHECK(small.dims == glm::ivec3(12, 3, 7));
    const auto flat = make_lattice({0.0, 0.0, 0.0}, {100.0, 1.0, 100.0}, {100.0, 1e-9, 100.0}, glm::ivec3(0), 64);
    CHECK(flat.dims == glm::ivec3(64, 2, 64));
}

TEST_CASE("the cache knows the depth of a uniform block to a cell of the lattice", "[gpu][light_cache]") {
    // Density 1 in a block of 40 x 30 x 20 voxels. The march is exact within; at the border, where a node's mean is
    // over a cell that is half outside, and where interpolation goes down to 0 over a voxel, it errs by less than the
    // density of one spacing and one voxel at each end.
    GridRecipe recipe{{0, 0, 0}, {39, 29, 19}, nullptr, Storage::float32};
    recipe.value = [](glm::ivec3) { return 1.0f; };
    const TestGrid grid = make_test_grid(recipe);
    Volume volume;
    volume.sigma_a = volume.sigma_s = Rgb(0.05);
    volume.unit = CoefficientUnit::world;
    TestScene scene = make_test_scene(grid.volume, volume, Filter::trilinear);
    const DirectionalLight sun{glm::normalize(glm::dvec3(0.3, 1.0, -0.2)), Rgb(1.0)};
    const std::vector<Light> lights = GENERATE_COPY(std::vector<Light>{sun}, std::vector<Light>{sun, PointLight{}});
    Scene lit;
    lit.lights = lights;
    const std::vector<glm::vec3> directions = cache_layout(lit).directions;
    REQUIRE(directions.size() == (lights.size() == 1 ? 1 : CACHE_DIRECTIONS));
    const glm::dvec3 low(-1.0), high(40.0, 30.0, 20.0);
    const auto lattice = make_lattice(low, high, high - low, {12, 9, 6}, 64);
    const double spacing = lattice.spacing.x;
    const bool texels = GENERATE(false, true);
    const std::vector<float> depths = depths_at_nodes(scene, lattice, directions, texels);
    const double per_voxel = double(scene.kernel.frame.media[0].sigma_t) *
                             glm::length(glm::dmat3(grid.field().index_to_world) * glm::dvec3(1.0, 0.0, 0.0));
    std::size_t i = 0;
    for (const glm::dvec3 light : directions)
        for (int x = 0; x < lattice.dims.x; ++x)
            for (int y = 0; y < lattice.dims.y; ++y)
                for (int z = 0; z < lattice.dims.z; ++z, ++i) {
                    const glm::dvec3 p = low + glm::dvec3(x, y, z) * glm::dvec3(lattice.spacing);
                    double end = 1e300;  // to the faces of the voxels, in voxels
                    bool grazes = false; // goes along a face, where nodes' means are of less than there is within
                    for (int axis = 0; axis < 3; ++axis) {
                        const double face = light[axis] > 0.0 ? high[axis] - 0.5 : -0.5;
                        if (light[axis] == 0.0)
                            grazes = grazes || p[axis] < spacing || p[axis] > high[axis] - 1.0 - spacing;
                        else
                            end = std::min(end, std::max((face - p[axis]) / light[axis], 0.0));
                    }
                    CAPTURE(x, y, z, light.x, light.y, light.z, texels);
                    CHECK((grazes || std::abs(depths[i] - per_voxel * end) <=
                                         per_voxel * 2.0 * (std::sqrt(3.0) * spacing + 1.0)));
                }
    REQUIRE(i == depths.size());
}

TEST_CASE("few collisions look at the light, and the picture is the same whatever reads the cache",
          "[gpu][light_cache][determinism]") {
    Scene scene = scene_of(medium(write_grid(cloud_grid()), 4.0, 0.99, 0.3), 11.0, 24);
    scene.lights = {sunlight()};
    if (GENERATE(false, true))
        scene.lights.push_back(PointLight{{2.0, 6.0, 3.0}, Rgb(40.0, 20.0, 10.0)});
    scene.settings.spp = 8;
    scene.settings.integrator = "cachedRatioTracking";
    RenderJob job;
    const RenderResult result = render_here(scene, 3, job);
    CHECK(result.counts.shadow_rays > 0);
    CHECK(result.counts.shadow_rays < result.counts.real_collisions);
    job.plan.most_texel_bytes = 1; // storage buffers
    CHECK(same_bits(result.film, render_here(scene, 3, job).film));
    job.plan.budget = 3; // laid aside amid shadow rays
    CHECK(same_bits(result.film, render_here(scene, 3, job).film));
}

// Columns along the light, every other one empty, and thinner than the lattice's cells: where light is scattered the
// cache has exp(-d) for what is exp(-2 d). With little to contribute few collisions look, and those correct it for all.
TEST_CASE("a cache that is wrong everywhere is corrected by the few that look", "[gpu][light_cache]") {
    GridRecipe columns{{0, 0, 0}, {319, 15, 15}, nullptr, Storage::float32};
    columns.value = [](glm::ivec3 voxel) { return voxel.x / 3 % 2 == 0 ? 2.0f : 0.0f; };
    columns.linear = glm::dmat3(0.05);
    columns.translation = -center_of(columns);
    Scene scene = scene_of(medium(write_grid(columns), 2.0, 0.2), 4.0, 24);
    const DirectionalLight above{{0.0, 1.0, 0.0}, Rgb(3.0, 2.0, 1.0)};
    scene.lights = GENERATE_COPY(std::vector<Light>{above},
                                 std::vector<Light>{above, PointLight{{0.3, 9.0, -0.2}, Rgb(80.0, 100.0, 120.0)}});
    scene.settings.spp = 256;
    scene.settings.integrator = "cachedRatioTracking";
    const RenderResult cached = render_here(scene, 3);
    // More collisions look where there is a table of lights: what is known of it is known less well.
    CHECK((scene.lights.size() == 1 ? 2 : 1) * cached.counts.shadow_rays < cached.counts.real_collisions);
    scene.settings.integrator = "ratioTracking";
    CHECK_AGREEMENT(agree(cached.film, render_here(scene, 4).film, "columns of light"));
}
