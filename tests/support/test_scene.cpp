#include "test_scene.h"

namespace vkvol {

namespace {

TestScene make(const Volume& volume, const LoadedVolume& loaded, Filter filter) {
    Scene scene;
    scene.volumes = {volume};
    scene.settings.filter = filter;
    Integrator integrator{};
    integrator.free_flight = FREE_FLIGHT_DELTA;
    integrator.transmittance = TRANSMITTANCE_RATIO;
    TestScene result;
    result.kernel.frame = make_frame(scene, loaded, Crop{0, 1, 0, 1}, 1);
    result.specialization = specialize(scene, loaded, integrator);
    return result;
}

} // namespace

TestScene make_test_scene(const LoadedVolume& loaded, Volume volume, Filter filter) {
    volume.shape = GridFile{};
    TestScene scene = make(volume, loaded, filter);
    scene.kernel.volume = &loaded;
    const glm::dvec3 middle = 0.5 * glm::dvec3(loaded.field->voxel_min + loaded.field->voxel_max);
    scene.render_origin = glm::dvec3(loaded.field->index_to_world * glm::dvec4(middle, 1.0));
    return scene;
}

TestScene make_test_scene(const Volume& volume) {
    TestScene scene = make(volume, {}, Filter::trilinear);
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
