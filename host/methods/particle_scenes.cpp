#include "particle_scenes.h"

#include <algorithm>
#include <cmath>

#include "camera_view.h"
#include "method.h"
#include "scene_facts.h"

namespace vkvol {

namespace {

bool is_lit_from_afar(const Scene& scene) {
    const auto is_far = [](const Light& light) { return !has_place(light); };
    return scene.background != Rgb(0.0) || std::any_of(scene.lights.begin(), scene.lights.end(), is_far);
}

template <class Is> bool any_surface(const Scene& scene, Is is) {
    return std::any_of(scene.surfaces.begin(), scene.surfaces.end(), is);
}

bool is_plane(const Surface& surface) {
    return std::holds_alternative<PlaneSurface>(surface.shape);
}

int repeated_axes(const Scene& scene) {
    const glm::dvec3 size = scene.periodic->size();
    return (size.x > 0.0) + (size.y > 0.0) + (size.z > 0.0);
}

// World units.
glm::dvec2 sensor_size(const Scene& scene) {
    const Picture& picture = scene.picture;
    return scene.camera.size *
           glm::dvec2(picture.width / picture.reference_width, picture.height / picture.reference_height);
}

// As camera_ray does, which goes on beyond them; but for rounding.
bool shows_beyond_poles(const Picture& picture) {
    return picture.start_y < -1e-6 || picture.start_y + picture.height > picture.reference_height + 1e-6;
}

// In domains that repeat particles are counted, and the sensor, which repeats as well, is passed once in each.
const char* why_no_particles_in_domain(const Scene& scene) {
    if (!has_plain_pixels(scene.settings) && scene.camera.projection != Projection::absorption)
        return "a pixel filter reaches beyond a sensor that counts particles in a domain that repeats";
    if (!reads_flux(scene.camera))
        return "a camera sees all domains that repeat, and particles look for it from one";
    const glm::dvec3 size = scene.periodic->size();
    const glm::dmat3 sensor = camera_rotation(scene.camera);
    const glm::dvec2 edges = sensor_size(scene);
    const bool is_box = scene.camera.projection == Projection::absorption;
    for (int axis = 0; axis < 3; ++axis) {
        if (size[axis] == 0.0)
            continue;
        if (!is_box && std::abs(sensor[2][axis]) > 1e-6)
            return "a sensor that counts particles has to lie along all axes that repeat";
        const double wide = is_box ? scene.camera.edges[axis]
                                   : std::abs(sensor[0][axis]) * edges.x + std::abs(sensor[1][axis]) * edges.y;
        if (wide > size[axis] * (1.0 + 1e-6))
            return "a sensor that counts particles cannot be wider than a domain that repeats";
    }
    if (is_lit_from_afar(scene) && repeated_axes(scene) != 2)
        return "particles come from afar into domains that repeat along two axes";
    return nullptr;
}

} // namespace

bool particles_come_from_afar(const Scene& scene) {
    return !any_medium(scene, is_everywhere) && (scene.periodic || !any_surface(scene, is_plane));
}

const char* why_no_particles(const Scene& scene, bool both, bool emits) {
    const auto shines = [](const Surface& surface) { return is_plane(surface) && surface.emission != Rgb(0.0); };
    const auto is_model = [](const Volume& volume) { return std::holds_alternative<MeshFiles>(volume.shape); };
    if (scene.camera.projection == Projection::fluence)
        return "no particle passes a point";
    if (reads_flux(scene.camera) && both)
        return "a sensor of flux is met by its own paths or passed by particles, and no weights are known for both";
    if (scene.layers != 0)
        return "layers are filled by paths from the camera alone";
    if (scene.camera.projection == Projection::equirectangular && !has_plain_pixels(scene.settings) &&
        scene.settings.pixel_filter_radius > 0.5 * scene.picture.reference_height + 0.5)
        return "a pixel filter that reaches beyond both poles of a panorama has a point in too many pixels";
    if (scene.camera.projection == Projection::equirectangular && shows_beyond_poles(scene.picture))
        return "rows of a panorama beyond a pole see what others see, and particles look for one of them";
    if (scene.periodic)
        if (const char* why = why_no_particles_in_domain(scene))
            return why;
    if (both) // paths from the camera find what particles do not
        return nullptr;
    const bool has_no_end = any_medium(scene, is_everywhere);
    if (!particles_come_from_afar(scene) && is_lit_from_afar(scene))
        return "light from infinitely far has no end where a medium is everywhere, or a plane, and particles can come "
               "from some of it only";
    if (any_surface(scene, shines))
        return "a plane that shines has no end, and particles can come from some of it only";
    if (emits && (has_no_end || any_medium(scene, is_model)))
        return "particles of a medium's own light need a box or a grid that it is in";
    return nullptr;
}

bool gains_by_particles(const Scene& scene) {
    const AxisChoices& choices = scene.settings.choices;
    if (scene.camera.projection == Projection::absorption)
        return true; // nothing else does
    if (!scene.periodic || !is_lit_from_afar(scene) || !any_medium(scene, can_scatter) || emits(scene) ||
        choices.paths || choices.nee || choices.scattering || why_no_particles(scene, false, false))
        return false;
    const glm::dvec3 size = scene.periodic->size();
    const double domain = (size.x > 0.0 ? size.x : 1.0) * (size.y > 0.0 ? size.y : 1.0) * (size.z > 0.0 ? size.z : 1.0);
    const glm::dvec2 edges = sensor_size(scene);
    return repeated_axes(scene) == 2 && edges.x * edges.y >= 0.25 * domain;
}

} // namespace vkvol
