#include "test_medium.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "estimator_traits.h"
#include "flight_forms.h"
#include "test_meshes.h"
#include "tests/reference/quadrature.h"
#include "transmittance_forms.h"
#include "value_map.h"

namespace vkvol {

using shared::FlightOutput;
using shared::RayInput;

namespace {

Mesh two_cubes() {
    return join(make_box({-2.5, -1.0, -1.0}, {-0.5, 1.0, 1.0}, 1), make_box({0.5, -1.0, -1.0}, {2.5, 1.0, 1.0}, 1));
}

reference::Mesh to_reference(const Mesh& mesh) {
    reference::Mesh result;
    for (const glm::uvec3 t : mesh.triangles)
        result.triangles.push_back({mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]});
    return result;
}

Volume volume_of(const MediumRecipe& recipe) {
    Volume volume;
    volume.sigma_a = 0.4 * recipe.sigma_t;
    volume.sigma_s = 0.6 * recipe.sigma_t;
    volume.unit = CoefficientUnit::world;
    volume.shape = Sphere{{0.2, 0.1, 0.0}, 1.7};
    if (recipe.is_mapped)
        volume.map = bumpy_map();
    if (recipe.kind == MediumKind::noise_sphere || recipe.kind == MediumKind::noise_cubes)
        volume.noise = recipe.noise;
    return volume;
}

bool grey(const Rgb& c) {
    return c == Rgb(c.x);
}

} // namespace

ValueMap bumpy_map() {
    ValueMap map;
    map.points = {{0.05, 0.0}, {0.3, 1.2}, {0.5, 0.2}, {0.5, 0.8}, {0.9, 0.5}, {1.2, 0.0}, {1.2, 0.6}};
    map.rise = 0.5;
    return map;
}

namespace {

// Form of the kernel that a scene needs.
unsigned form_of(const TestScene& scene) {
    return (scene.chromatic ? form_chromatic : 0) | (scene.specialization[SPEC_MAP] != MAP_NONE ? form_full : 0);
}

bool bends(const MediumRecipe& recipe) {
    return recipe.is_mapped && recipe.filter != Filter::nearest;
}

} // namespace

bool is_null_flight(int free_flight) {
    return flight_has(free_flight, TRAIT_NULL);
}

bool is_null_transmittance(int transmittance) {
    return transmittance_has(transmittance, TRAIT_NULL);
}

bool flies(int free_flight, const MediumRecipe& recipe) {
    const bool homogeneous = recipe.kind == MediumKind::sphere || recipe.kind == MediumKind::cubes;
    if (flight_has(free_flight, TRAIT_CLOSED))
        return homogeneous;
    if (flight_has(free_flight, TRAIT_VOXELS) && (recipe.kind != MediumKind::grid || bends(recipe)))
        return false;
    if (recipe.is_mapped && recipe.filter == Filter::stochastic)
        return false;
    if (!is_null_flight(free_flight))
        return recipe.filter != Filter::stochastic;
    return !flight_has(free_flight, TRAIT_GREY) || grey(recipe.sigma_t);
}

bool sees(int transmittance, const MediumRecipe& recipe) {
    const bool homogeneous = recipe.kind == MediumKind::sphere || recipe.kind == MediumKind::cubes;
    if (transmittance_has(transmittance, TRAIT_CLOSED))
        return homogeneous;
    if (transmittance_has(transmittance, TRAIT_VOXELS) && (recipe.kind != MediumKind::grid || bends(recipe)))
        return false;
    if (recipe.is_mapped && recipe.filter == Filter::stochastic)
        return false;
    return is_null_transmittance(transmittance) || recipe.filter != Filter::stochastic;
}

TestMedium::TestMedium(const MediumRecipe& recipe) {
    Volume volume = volume_of(recipe);
    TestEstimators estimators = recipe.estimators;
    estimators.settings.majorant_scale = recipe.majorant_scale;
    const Filter filter = recipe.filter == Filter::nearest ? Filter::nearest : Filter::trilinear;
    if (recipe.kind == MediumKind::grid) {
        grid_ = make_test_grid(recipe.grid);
        if (recipe.is_mapped)
            grid_->change_majorants([&](MajorantGrid& majorants) {
                majorants = make_majorant_grid(grid_->field(), recipe.grid.cell, volume.map);
            });
        grid_->volume.map_knots = make_knots(volume.map);
        add_controls(grid_->volume, volume, estimators);
        const float scale = static_cast<float>(recipe.majorant_scale);
        grid_->change_majorants([&](MajorantGrid& majorants) {
            majorants.leaps = recipe.leaps;
            for (float& bound : majorants.bounds)
                bound *= scale;
        });
        for (shared::ControlCell& cell : grid_->volume.controls)
            cell.residual *= scale;
        scene_ = make_test_scene(grid_->volume, volume, recipe.filter, estimators);
        reference_ = reference::with_grid(make_reference_grid(*grid_), volume, filter);
        return;
    }
    reference_ = reference::load(volume);
    if (recipe.kind == MediumKind::cubes || recipe.kind == MediumKind::noise_cubes) {
        loaded_.mesh = two_cubes();
        loaded_.bvh = build_bvh(*loaded_.mesh, glm::dvec3(0.0));
        volume.shape = MeshFiles{};
        reference_.shape = to_reference(*loaded_.mesh);
    }
    scene_ = make_test_scene(volume, loaded_, estimators);
}

double TestMedium::density_integral(const reference::Ray& ray) const {
    return reference::density_integral(reference_, ray);
}

reference::Ray TestMedium::ray() const {
    const glm::dvec3 d = grid_ ? glm::normalize(glm::dvec3(0.3, -0.5, 1.0)) : glm::normalize(glm::dvec3(1, 0.08, -0.1));
    return {scene_->render_origin + glm::dvec3(0.05, 0.1, -0.07) - 10.0 * d, d};
}

std::vector<reference::Ray> TestMedium::random_rays(std::size_t count, std::uint32_t seed, double least,
                                                    double most) const {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto point = [&](double border) {
        const glm::dvec3 u(uniform(engine), uniform(engine), uniform(engine));
        if (!grid_)
            return scene_->render_origin + u * (glm::dvec3(2.5, 1.0, 1.0) + border);
        const glm::dvec3 middle = 0.5 * glm::dvec3(grid_->voxel_min + grid_->voxel_max);
        const glm::dvec3 half = 0.5 * glm::dvec3(grid_->voxel_max - grid_->voxel_min) + 2.0 * border;
        return glm::dvec3(grid_->field().index_to_world * glm::dvec4(middle + u * half, 1.0));
    };
    std::vector<reference::Ray> rays;
    while (rays.size() < count) {
        const glm::dvec3 from = point(2.0), to = point(-0.8);
        const reference::Ray ray{from, glm::normalize(to - from)};
        const double D = density_integral(ray);
        if (D >= least && D <= most)
            rays.push_back(ray);
    }
    return rays;
}

std::vector<RayInput> TestMedium::flights_along(const reference::Ray& ray, int count, std::uint32_t seed,
                                                glm::vec3 beta) const {
    std::mt19937 engine(seed);
    const auto uniform = [&] { return static_cast<float>((engine() >> 8) * 0x1p-24); };
    std::vector<RayInput> inputs;
    for (int i = 0; i < count; ++i) {
        RayInput input{scene_->to_render(ray.origin), ray.direction, std::uint32_t(engine()), 0.0f, 0.0f, beta};
        input.e = -std::log1p(-uniform());
        input.select = uniform();
        inputs.push_back(input);
    }
    return inputs;
}

std::vector<FlightOutput> TestMedium::fly(const std::vector<RayInput>& inputs) const {
    KernelRunner runner(flight_forms[form_of(*scene_)], scene_->specialization, scene_->kernel);
    runner.push.step_limit = 15000;
    return runner.run<FlightOutput>(inputs);
}

std::vector<double> TestMedium::depths(const reference::Ray& ray, const std::vector<FlightOutput>& flights) const {
    std::vector<std::size_t> order(flights.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return flights[a].t < flights[b].t; });
    std::vector<double> result(flights.size());
    double D = 0.0, t = 0.0;
    for (const std::size_t i : order) {
        D += reference::density_integral(reference_, ray, t, flights[i].t);
        t = flights[i].t;
        result[i] = D;
    }
    return result;
}

std::vector<FlightOutput> TestMedium::see(const std::vector<reference::Ray>& rays, std::uint32_t count,
                                          std::uint32_t seed, shared::Counters* counters) const {
    std::vector<RayInput> inputs;
    for (std::size_t i = 0; i < rays.size(); ++i)
        inputs.push_back({scene_->to_render(rays[i].origin), rays[i].direction, seed + std::uint32_t(i), 0.0f, 0.0f,
                          glm::vec3(1.0f)});
    KernelRunner runner(transmittance_forms[form_of(*scene_)], scene_->specialization, scene_->kernel);
    runner.push.step_limit = 15000;
    runner.push.sample_end = count;
    const auto threads = static_cast<std::uint32_t>(rays.size() * count);
    const auto outputs = runner.run<FlightOutput>(std::span<const RayInput>(inputs), threads, threads);
    if (counters)
        *counters = runner.counters();
    return outputs;
}

} // namespace vkvol
