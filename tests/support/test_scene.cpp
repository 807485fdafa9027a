#include "test_scene.h"

#include "frame_params.h"
#include "kernel_constants.h"
#include "scene_facts.h"

#include <algorithm>

namespace vkvol {

namespace {

TestScene make(const Volume& volume, const LoadedMedium& loaded, Filter filter, const TestEstimators& estimators) {
    Scene scene;
    scene.volumes = {volume};
    scene.settings = estimators.settings;
    scene.settings.filter = filter;
    const bool homogeneous = density_kind(scene) == FIELD_CONSTANT;
    Method method{};
    method.first_flight = FIRST_FLIGHT_DRAWN; // else chosen by how thin the medium is
    method.scattering = SCATTERING_MULTIPLE;
    method.free_flight = estimators.free_flight >= 0 ? estimators.free_flight
                         : homogeneous               ? FREE_FLIGHT_ANALYTIC
                                                     : FREE_FLIGHT_DELTA;
    method.transmittance = estimators.transmittance >= 0 ? estimators.transmittance
                           : homogeneous                 ? TRANSMITTANCE_ANALYTIC
                                                         : TRANSMITTANCE_RATIO;
    method.nee = NEE_COLLISIONS;
    method.filter = filter;
    method.jitter = scene.settings.march.jitter;
    TestScene result;
    result.kernel.frame = make_frame(scene, Media(&loaded, 1), method, Crop{0, 1, 0, 1}, 1);
    result.specialization = specialize(scene, Media(&loaded, 1), method);
    result.chromatic = is_chromatic(scene);
    return result;
}

} // namespace

void add_controls(LoadedMedium& loaded, const Volume& volume, const TestEstimators& estimators) {
    const Rgb sigma_t = volume.sigma_a + volume.sigma_s;
    const double largest = std::max({sigma_t.x, sigma_t.y, sigma_t.z}) * loaded.field->voxel_size();
    const bool decomposes = estimators.free_flight == FREE_FLIGHT_DECOMPOSITION;
    loaded.controls = make_controls(*loaded.field, *loaded.majorants, decomposes ? 0.0 : largest, volume.map);
}

TestScene make_test_scene(const LoadedMedium& loaded, Volume volume, Filter filter, const TestEstimators& estimators) {
    volume.shape = GridFile{};
    TestScene scene = make(volume, loaded, filter, estimators);
    scene.kernel.volume = &loaded;
    const glm::dvec3 middle = 0.5 * glm::dvec3(loaded.field->voxel_min + loaded.field->voxel_max);
    scene.render_origin = glm::dvec3(loaded.field->index_to_world * glm::dvec4(middle, 1.0));
    return scene;
}

TestScene make_test_scene(const Volume& volume, const LoadedMedium& loaded, const TestEstimators& estimators) {
    TestScene scene = make(volume, loaded, Filter::trilinear, estimators);
    if (loaded.mesh) {
        scene.kernel.volume = &loaded;
        scene.render_origin = glm::dvec3(0.0);
        return scene;
    }
    scene.render_origin = std::visit(
        [](const auto& shape) {
            if constexpr (requires { shape.center; })
                return shape.center;
            else
                return glm::dvec3(0.0);
        },
        volume.shape);
    return scene;
}

} // namespace vkvol
