// The validation layer, with synchronization validation, has nothing to say about any pass over any medium.
#include <catch2/catch.hpp>

#include "support/images.h"
#include "support/scenes.h"
#include "support/test_device.h"
#include "support/thorough.h"

using namespace vkvol;

namespace {

void check_silent(Scene scene) {
    scene.lights = {sunlight()};
    scene.background = Rgb(0.5);
    scene.settings.spp = 2;
    for (const char* integrator : {"deltaTracking", "ratioTracking"})
        for (const Filter filter : {Filter::nearest, Filter::trilinear, Filter::stochastic}) {
            if (scene.volumes.empty() || !std::holds_alternative<GridFile>(scene.volumes.front().shape))
                if (filter != Filter::stochastic)
                    continue; // nothing to filter
            scene.settings.integrator = integrator;
            scene.settings.filter = filter;
            CAPTURE(integrator, int(filter));
            const std::size_t before = test_device_messages().size();
            const RenderResult result = render_here(scene, 1);
            CHECK(result.samples == scene.settings.spp);
            const std::vector<std::string> messages = test_device_messages();
            CHECK(std::vector<std::string>(messages.begin() + std::ptrdiff_t(before), messages.end()).empty());
        }
}

} // namespace

TEST_CASE("validation is silent for homogeneous media and for none", "[gpu][validation]") {
    Volume ember = medium(Sphere{}, 1.0, 0.5);
    ember.Le = Rgb(1.0);
    check_silent(scene_of(ember, 2.0, 5));
    check_silent(scene_of(medium(Box{}, 1.0, 0.5), 2.0, 5));
    Scene nothing = scene_of(ember, 2.0, 5);
    nothing.volumes.clear();
    check_silent(nothing);
}

TEST_CASE("validation is silent for every type of grid", "[gpu][validation][long]") {
    const std::vector<Storage> storages(std::begin(all_storages), std::end(all_storages));
    const Storage storage = GENERATE_REF(from_range(in_turn(storages, 0)));
    CAPTURE(storage_name(storage));
    check_silent(scene_of(medium(write_grid(cloud_grid(storage)), 1.0, 0.5), 8.0, 5, 20.0));
}
