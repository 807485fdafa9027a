// Media that are everywhere, and densities by height: against closed forms, boxes that come to the same, and the
// reference.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "error.h"
#include "layers.h"
#include "loaded_medium.h"
#include "scene_hash.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/thorough.h"
#include "tests/reference/mapped.h"
#include "tests/reference/medium.h"

using namespace vkvol;
using Catch::Contains;

namespace {

Volume atmosphere(double sigma_t, double albedo, Layers layers = {1, 0.0, 20.0, 1.0, 0.0}) {
    Volume volume = medium(Everywhere{}, sigma_t, albedo, 0.3);
    volume.layers = layers;
    return volume;
}

// A table of heights from -1 to 3, with a step; its values are heights above -1.
Volume table(double sigma_t, double albedo) {
    Volume volume = atmosphere(sigma_t, albedo, {1, -1.0, 3.0, 0.0, 0.0});
    volume.map.points = {{0.0, 0.2}, {1.0, 1.0}, {1.0, 0.4}, {2.5, 0.1}, {4.0, 0.0}};
    return volume;
}

// All rays alike: from `position`, down or up at an angle with the vertical.
Scene parallel_rays(const Volume& volume, glm::dvec3 position, double pitch) {
    Scene scene;
    scene.volumes = {volume};
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = 1e-3;
    scene.camera.position = position;
    scene.camera.pitch = pitch;
    scene.camera.yaw = 35.0;
    scene.picture = {8, 8, 0.0, 0.0, 8.0, 8.0};
    scene.background = Rgb(1.0);
    scene.settings.spp = 2000;
    return scene;
}

void check_transmittance(const Scene& scene, double depth, const std::string& name) {
    CAPTURE(name, depth);
    const std::vector<double> p(64, std::exp(-depth));
    CHECK_AGREEMENT(agree_with_escapes(render_here(scene, 1).film, p, Rgb(1.0), Rgb(0.0), name));
}

Scene lit_from_above(const Volume& volume, glm::dvec3 from = glm::dvec3(0.0, 1.0, 12.0)) {
    Scene scene = scene_of(volume, 8.0, 16);
    scene.camera.position = from;
    scene.camera.fov = 50.0;
    scene.background = {0.1, 0.2, 0.4};
    scene.lights = {sunlight({1.0, 0.9, 0.8})};
    scene.settings.spp = 128;
    return scene;
}

Volume endless_fog(double sigma_t, double albedo) {
    return medium(Everywhere{}, sigma_t, albedo, 0.5);
}

} // namespace

TEST_CASE("rays through an exponential atmosphere have its optical depth", "[gpu][image][layers]") {
    const double sigma_t = 0.7, H = 1.5, reference = 0.5;
    const Volume air = atmosphere(sigma_t, 0.0, {1, 0.0, 30.0, H, reference});
    const auto depth = [&](double low, double high, double cosine) {
        return sigma_t * H * (std::exp((reference - low) / H) - std::exp((reference - high) / H)) / cosine;
    };
    for (const double pitch : {-90.0, -50.0, -20.0}) {
        const double cosine = std::sin(glm::radians(-pitch));
        check_transmittance(parallel_rays(air, {3.0, 60.0, -2.0}, pitch), depth(0.0, 30.0, cosine), "from above");
        check_transmittance(parallel_rays(air, {3.0, 2.0, -2.0}, pitch), depth(0.0, 2.0, cosine), "from within, down");
        check_transmittance(parallel_rays(air, {3.0, 2.0, -2.0}, -pitch), depth(2.0, 30.0, cosine), "from within, up");
    }
    // Turned onto its side, its height along -x: a box of the same.
    Volume box = air;
    box.shape = Box{{0.0, 15.0, 0.0}, {2e3, 30.0, 2e3}};
    box.transform = glm::rotate(glm::dmat4(1.0), glm::radians(90.0), glm::dvec3(0.0, 0.0, 1.0));
    Scene scene = parallel_rays(box, {5.0, 0.0, 0.0}, 0.0);
    scene.camera.yaw = 90.0; // along -x
    check_transmittance(scene, depth(0.0, 30.0, 1.0), "a box on its side");
    for (const int flight :
         {FREE_FLIGHT_DELTA, FREE_FLIGHT_WEIGHTED, FREE_FLIGHT_DECOMPOSITION, FREE_FLIGHT_SPECTRAL}) {
        Scene other = parallel_rays(air, {3.0, 60.0, -2.0}, -50.0);
        other.settings.integrator = "deltaTracking";
        other.settings.choices.free_flight = flight;
        check_transmittance(other, depth(0.0, 30.0, std::sin(glm::radians(50.0))), fmt::format("flight {}", flight));
    }
}

TEST_CASE("air that is tilted and moved is as dense as a box of it", "[gpu][image][layers]") {
    const Layers layers{1, 10.0, 60.0, 5.0, 12.0};
    Volume air = atmosphere(0.3, 0.0, layers), box = air;
    box.shape = Box{{0.0, 35.0, 0.0}, {4e3, 50.0, 4e3}};
    const glm::dmat4 to = glm::translate(glm::dmat4(1.0), glm::dvec3(3.0, 30.0, -4.0));
    const glm::dmat4 tilts[] = {glm::rotate(glm::dmat4(1.0), 0.1, glm::dvec3(0.0, 0.0, 1.0)),
                                glm::rotate(glm::dmat4(1.0), 0.2, glm::normalize(glm::dvec3(1.0, 0.0, 1.0)))};
    for (const glm::dmat4& tilt : tilts) {
        air.transform = box.transform = to * tilt;
        const Film tilted = render_here(parallel_rays(air, {3.0, 120.0, -2.0}, -60.0), 1).film;
        const Film expected = render_here(parallel_rays(box, {3.0, 120.0, -2.0}, -60.0), 2).film;
        CHECK_AGREEMENT(agree(tilted, expected, "tilted air"));
        CHECK(image_mean(expected).value.x < 0.9);
        CHECK(image_mean(expected).value.x > 0.03);
    }
}

TEST_CASE("an exponential is what it is hundreds of scale heights up", "[gpu][image][layers]") {
    for (const double top : {30.0, 80.0, 88.0, 300.0}) {
        CAPTURE(top);
        Volume air = medium(Box{{0.0, 0.5 * top, 0.0}, {1e4, top, 1e4}}, 1.0, 0.0, 0.3);
        air.layers = {1, 0.0, top, 1.0, 0.0};
        check_transmittance(parallel_rays(air, {3.0, top + 5.0, -2.0}, -50.0), 1.0 / std::sin(glm::radians(50.0)),
                            "through all of it");
        // In closed forms, and by null collisions, of one channel and of three.
        for (const Rgb& albedo : {Rgb(0.8), Rgb(0.9, 0.6, 0.3)}) {
            air.sigma_s = albedo;
            air.sigma_a = Rgb(1.0) - albedo;
            Scene scene = parallel_rays(air, {3.0, top + 5.0, -2.0}, -70.0);
            scene.lights = {sunlight()};
            scene.settings.spp = 256;
            Scene tracked = scene;
            tracked.settings.integrator = "ratioTracking";
            tracked.settings.choices.free_flight = FREE_FLIGHT_DELTA;
            tracked.settings.choices.transmittance = TRANSMITTANCE_RATIO;
            CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_here(tracked, 2).film, "lit from above"));
        }
    }
}

TEST_CASE("rays through layers of a table have the sum of its slabs", "[gpu][image][layers]") {
    const double sigma_t = 0.8;
    // Trapezes: 1 high from 0.2 to 1, 1.5 high from 0.4 to 0.1, 1.5 high from 0.1 to 0.
    const double slabs = 1.0 * 0.6 + 1.5 * 0.25 + 1.5 * 0.05;
    for (const double pitch : {-90.0, -35.0, -10.0})
        check_transmittance(parallel_rays(table(sigma_t, 0.0), {1.0, 9.0, 0.0}, pitch),
                            sigma_t * slabs / std::sin(glm::radians(-pitch)), "table");
    check_transmittance(parallel_rays(table(sigma_t, 0.0), {1.0, 0.0, 0.0}, 90.0), sigma_t * (0.375 + 0.075), "up");
    // A box that begins above the lowest layer, from 0 to 2: 0.4 to 0.1, and half a unit on toward 0.
    Volume boxed = table(sigma_t, 0.0);
    boxed.shape = Box{{0.0, 1.0, 0.0}, {2e3, 2.0, 2e3}};
    check_transmittance(parallel_rays(boxed, {1.0, 9.0, 0.0}, -90.0), sigma_t * (0.375 + 0.5 * (0.1 + 0.2 / 3.0) / 2.0),
                        "a box above the lowest layer");
    Scene two = parallel_rays(table(0.3 * sigma_t, 0.0), {1.0, 9.0, 0.0}, -35.0);
    two.volumes.push_back(table(0.7 * sigma_t, 0.0));
    check_transmittance(two, sigma_t * slabs / std::sin(glm::radians(35.0)), "two tables");
}

TEST_CASE("nothing is seen through fog without end but its own glow", "[gpu][layers][long]") {
    Volume volume = endless_fog(0.3, 0.0);
    volume.Le = {2.0, 1.0, 0.5};
    Scene scene = lit_from_above(volume);
    scene.lights.clear();
    scene.background = Rgb(100.0);
    scene.settings.spp = 4;
    for (const glm::vec3& pixel : render_here(scene, 1).film.mean) // every sample is what one absorption sends out
        for (int c = 0; c < 3; ++c)
            CHECK(pixel[c] == Approx(volume.Le[c]).epsilon(1e-6));
    // What scatters as well glows as much: (1 - a) (1 + a + a^2 + ...) = 1.
    scene.volumes.front().sigma_s = Rgb(0.2);
    scene.volumes.front().sigma_a = Rgb(0.1);
    scene.settings.spp = 1000;
    const Film film = render_here(scene, 1).film;
    CHECK_AGREEMENT(agree_with_means(film, std::vector<Rgb>(film.pixel_count(), volume.Le), "glow"));
    scene.settings.integrator = "deltaTracking";
    for (const int flight : {FREE_FLIGHT_DELTA, FREE_FLIGHT_WEIGHTED}) {
        scene.settings.choices.free_flight = flight;
        const Film other = render_here(scene, 2).film;
        CHECK_AGREEMENT(agree_with_means(other, std::vector<Rgb>(film.pixel_count(), volume.Le), "glow, null flights"));
    }
}

TEST_CASE("fog without end equals a box of it that is larger than any path", "[gpu][image][layers][long]") {
    Scene scene = lit_from_above(endless_fog(0.25, 0.8));
    scene.lights = {PointLight{{1.0, 2.0, 3.0}, Rgb(30.0)}, SphereLight{{-2.0, 0.0, 4.0}, 0.5, Rgb(4.0)}};
    Scene box = scene;
    box.volumes.front().shape = Box{{0.0, 0.0, 0.0}, glm::dvec3(2000.0)}; // exp(-250) is seen through it
    CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_here(box, 2).film, "lamps in fog"));
    // And so among others, whose cells it goes beyond.
    const Volume cloud = medium(write_grids({cloud_grid()}), 1.0, 0.9, 0.2);
    for (Scene* each : {&scene, &box}) {
        each->lights = {sunlight(), SphereLight{{-2.0, 0.0, 4.0}, 0.5, Rgb(4.0)}};
        each->volumes.push_back(cloud);
        each->volumes.push_back(medium(Sphere{{6.0, 0.0, 0.0}, 1.5}, 0.6, 0.5));
    }
    CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_here(box, 2).film, "a cloud in fog"));
}

TEST_CASE("media that are everywhere equal the reference", "[gpu][image][layers]") {
    std::vector<std::pair<const char*, Scene>> all;
    Scene air = lit_from_above(atmosphere(0.8, 0.9));
    all.emplace_back("atmosphere, in closed forms", air);
    air.settings.integrator = "ratioTracking";
    air.settings.choices.free_flight = FREE_FLIGHT_DELTA;
    air.settings.choices.transmittance = TRANSMITTANCE_RATIO;
    all.emplace_back("atmosphere", air);
    all.emplace_back("table", lit_from_above(table(0.8, 0.9)));
    Volume colors = table(1.0, 1.0);
    colors.map.is_transfer = true;
    colors.map.points[1].albedo = {0.9, 0.5, 0.2};
    colors.map.points[2].albedo = {0.2, 0.6, 0.9};
    colors.map.points[2].emission = {0.3, 0.1, 0.0};
    all.emplace_back("colours by height", lit_from_above(colors));
    colors.shape = Box{{0.0, 1.2, 0.0}, {5.0, 3.0, 4.0}}; // begins above the lowest
    all.emplace_back("colours by height in a box", lit_from_above(colors));
    Volume boxed = table(1.2, 0.9);
    boxed.shape = Box{{0.0, 0.5, 0.0}, {5.0, 4.0, 4.0}};
    boxed.transform = glm::rotate(glm::dmat4(1.0), 0.6, glm::normalize(glm::dvec3(1.0, 0.3, -0.5)));
    all.emplace_back("a box that leans", lit_from_above(boxed));
    Scene several = lit_from_above(atmosphere(0.4, 0.95));
    several.volumes.push_back(endless_fog(0.03, 0.7));
    several.volumes.push_back(medium(write_grids({cloud_grid()}), 1.0, 0.9, 0.2));
    several.volumes.push_back(boxed);
    all.emplace_back("several", several);
    Scene grounded = lit_from_above(atmosphere(0.8, 0.9));
    grounded.surfaces.emplace_back().shape = PlaneSurface{{0.0, 0.3, 0.0}, {0.0, 1.0, 0.0}};
    all.emplace_back("an atmosphere over a ground", grounded);
    Scene alone = lit_from_above(endless_fog(0.2, 0.9));
    alone.lights = {PointLight{{1.0, 2.0, 3.0}, Rgb(30.0)}};
    all.emplace_back("a lamp in fog", alone);
    for (const auto& [name, each] : in_turn(all, 1, 2))
        check_against_reference(each, name);
}

// Near a lamp collisions find its light with a variance that has no bound, however many they are.
TEST_CASE("lamps in air that thins with height are looked at from along flights", "[gpu][image][layers]") {
    Scene scene = lit_from_above(atmosphere(0.4, 0.9));
    scene.settings.integrator = "ratioTracking";
    scene.lights = {SphereLight{{0.5, 1.0, 2.0}, 0.4, Rgb(20.0)}};
    check_against_reference(scene, "a ball of light");
    scene.lights = {PointLight{{0.5, 1.0, 2.0}, Rgb(10.0)}};
    const Film along = render_here(scene, 1).film;
    scene.settings.choices.distance = DISTANCE_FLIGHTS;
    const auto noise = [](const Film& film) { return relative_noise(film).value(); };
    CHECK(noise(along) < 0.6 * noise(render_here(scene, 1).film));
}

TEST_CASE("parts of a medium that is everywhere are the whole", "[gpu][image][layers][long]") {
    for (const Volume& whole : {atmosphere(0.8, 0.9), table(0.8, 0.9), endless_fog(0.2, 0.7)}) {
        const Scene alone = lit_from_above(whole);
        Scene parts = alone;
        parts.volumes.push_back(whole);
        parts.volumes[0].density_scale = 0.35;
        parts.volumes[1].density_scale = 0.65;
        CHECK_AGREEMENT(agree(render_here(parts, 1).film, render_here(alone, 2).film, "parts"));
    }
}

TEST_CASE("cells of what is everywhere bound it, beyond their grid too", "[cpu][layers]") {
    Scene scene = lit_from_above(atmosphere(0.4, 0.95, {1, -3.0, 17.0, 1.0, 0.0}));
    scene.volumes.push_back(table(0.5, 0.5));
    scene.volumes.back().transform = glm::rotate(glm::dmat4(1.0), glm::radians(90.0), glm::dvec3(0.0, 0.0, 1.0));
    scene.volumes.push_back(endless_fog(0.03, 0.7));
    scene.volumes.push_back(medium(Sphere{{2.0, 1.0, 0.0}, 1.5}, 0.6, 0.5));
    const Assets assets = load_assets(scene, choose_method(scene));
    const Superposition& whole = *assets.superposition;
    REQUIRE(whole.unbounded);
    std::vector<reference::Medium> media;
    for (const Volume& volume : scene.volumes)
        media.push_back(reference::load(volume));
    std::mt19937 engine(3);
    std::normal_distribution<double> normal;
    int beyond = 0;
    for (int n = 0; n < 20000; ++n) {
        const glm::dvec3 p = 12.0 * glm::dvec3(normal(engine), normal(engine), normal(engine));
        const glm::dvec3 in_cells = (p - whole.origin) / whole.edge - glm::dvec3(whole.cells.origin);
        const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(in_cells)), glm::ivec3(0), whole.dims() - 1);
        beyond += glm::ivec3(glm::floor(in_cells)) != cell;
        const std::size_t entry = whole.entry_of(cell);
        const auto list = whole.list(entry);
        double sum = 0.0;
        for (std::uint32_t k = 0; k < media.size(); ++k) {
            const reference::Ray ray{p, glm::normalize(glm::dvec3(0.3, 0.5, 1.0))};
            const auto parts = support(media[k], ray);
            const bool inside = !parts.empty() && parts.front().t0 == 0.0;
            const double sigma_t = inside ? media[k].largest() * reference::DensityAlong(media[k], ray)(0.0) : 0.0;
            sum += sigma_t;
            if (sigma_t > 0.0)
                CHECK(std::find(list.begin(), list.end(), k) != list.end());
        }
        CHECK(sum <= whole.bound(entry));
    }
    CHECK(beyond > 2000);
}

// These go on for ever: walks that left the medium would meet null collisions without end.
TEST_CASE("what ends bounds no outermost cell of what does not", "[cpu][layers]") {
    Scene scene = lit_from_above(atmosphere(0.4, 0.95, {1, -3.0, 17.0, 1.0, 0.0}));
    scene.volumes.push_back(medium(Sphere{{2.0, 1.0, 0.0}, GENERATE(0.02, 0.5, 3.0)}, 0.6, 0.5));
    scene.volumes.push_back(medium(Sphere{{40.0, 22.0, 0.0}, 4.0}, 0.6, 0.5)); // above all layers
    GridRecipe grid{{0, 0, 0}, {51, 51, 51}, [](glm::ivec3) { return 1.0f; }}; // not of whole majorant cells
    grid.cell = 16;
    grid.translation = {-26.0, 30.0, -26.0};
    scene.volumes.push_back(medium(write_grid(grid), 1.0, 0.5));
    const Assets assets = load_assets(scene, choose_method(scene));
    const Superposition& whole = *assets.superposition;
    const glm::ivec3 dims = whole.dims();
    std::size_t layers = 0, wrong = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const int face : {0, dims[axis] - 1})
            for (int a = 0; a < dims[(axis + 1) % 3]; ++a)
                for (int b = 0; b < dims[(axis + 2) % 3]; ++b) {
                    glm::ivec3 cell;
                    cell[axis] = face;
                    cell[(axis + 1) % 3] = a;
                    cell[(axis + 2) % 3] = b;
                    for (const std::uint32_t k : whole.list(whole.entry_of(cell))) {
                        layers += k == 0;
                        wrong += k > 0 || axis == 1;
                    }
                }
    CAPTURE(dims.x, dims.y, dims.z, whole.edge, whole.bits);
    CHECK(wrong == 0);
    CHECK(layers > 0);
}

TEST_CASE("thin layers want no smaller cells than they are worth", "[cpu][layers]") {
    const auto edge_of = [](double sigma_t) {
        Scene scene = lit_from_above(table(sigma_t, 0.7)); // 4 high, in slabs of less than a tenth
        scene.volumes.push_back(medium(Sphere{{0.0, 20.0, 0.0}, 15.0}, 0.6, 0.5));
        return load_assets(scene, choose_method(scene)).superposition->edge;
    };
    CHECK(edge_of(0.01) > 1.5);
    CHECK(edge_of(10.0) < 0.5);
}

TEST_CASE("bounds across layers are the extrema there", "[cpu][layers]") {
    for (const Volume& volume : {atmosphere(1.0, 0.5, {1, -2.0, 18.0, 1.3, 0.4}), table(1.0, 0.5)}) {
        const MajorantGrid cells = layer_cells(volume);
        const auto controls = layer_controls(volume);
        const LayerBox box = layer_box(volume);
        const double edge = box.size.y / double(cells.bounds.size());
        for (std::size_t i = 0; i < cells.bounds.size(); ++i) {
            double most = 0.0;
            for (int k = 0; k <= 100; ++k) {
                const double height = box.low.y + (double(i) + k / 100.0) * edge;
                const double density = volume.layers->scale_height > 0.0
                                           ? std::exp(-(height - 0.4) / 1.3)
                                           : reference::mapped(volume.map, height + 1.0).density;
                CHECK(density <= cells.bounds[i] * (1.0 + 1e-7));
                CHECK(std::abs(density - controls[i].control) <= controls[i].residual + 1e-7);
                most = std::max(most, density);
            }
            if (volume.layers->scale_height > 0.0)
                CHECK(cells.bounds[i] <= most * std::exp(1e-3 * edge / 1.3) * (1.0 + 2e-5)); // a margin about each cell
        }
    }
}

TEST_CASE("what has no end in the way of an integrator is said", "[cpu][method][layers]") {
    Scene scene = lit_from_above(atmosphere(0.8, 0.9));
    CHECK(choose_method(scene).nee == NEE_COLLISIONS); // no lattice covers it
    scene.settings.integrator = "rayMarching";
    const Method marched = choose_method(scene);
    CHECK(marched.free_flight == FREE_FLIGHT_ANALYTIC);
    CHECK(marched.transmittance == TRANSMITTANCE_ANALYTIC);
    REQUIRE(marched.warnings.size() == 2);
    CHECK_THAT(marched.warnings[0], Contains("a march comes to no end of what is everywhere"));
    scene.settings.integrator = "regularTracking";
    CHECK(choose_method(scene).free_flight == FREE_FLIGHT_ANALYTIC);
    scene.volumes = {table(0.8, 0.9)};
    CHECK_THROWS_WITH(choose_method(scene), Contains("layers have none"));
    scene = lit_from_above(endless_fog(1.0, 1.0));
    CHECK_THROWS_WITH(load_assets(scene, choose_method(scene)), Contains("keeps its paths for ever"));
    scene.volumes.push_back(endless_fog(0.01, 0.0)); // in which they end
    CHECK_NOTHROW(load_assets(scene, choose_method(scene)));
    std::swap(scene.volumes.front(), scene.volumes.back());
    CHECK_NOTHROW(load_assets(scene, choose_method(scene)));
    scene.volumes.erase(scene.volumes.begin());
    scene.settings.max_depth = 10;
    CHECK_NOTHROW(load_assets(scene, choose_method(scene)));
    scene = lit_from_above(endless_fog(1e-20, 0.5));
    CHECK_THROWS_WITH(load_assets(scene, choose_method(scene)), Contains("too thin to be <everywhere>"));
    scene = lit_from_above(table(1.0, 0.5));
    scene.volumes.push_back(endless_fog(1.0, 0.5));
    scene.volumes.front().transform = glm::rotate(glm::dmat4(1.0), 0.3, glm::dvec3(0.0, 0.0, 1.0));
    CHECK_THROWS_WITH(load_assets(scene, choose_method(scene)), Contains("leave the tilt out"));
}

TEST_CASE("how dense layers would be below their box is of no concern", "[cpu][xml][layers]") {
    CHECK_NOTHROW(parse("<box y='5' width='10' height='10' depth='10'/><layers scaleHeight='1' bottom='-100'/>"));
    CHECK_THROWS_AS(parse("<box y='-95' height='10'/><layers scaleHeight='1' bottom='-100'/>"), InputError);
}

TEST_CASE("layers in scene files", "[cpu][xml][layers]") {
    const Volume air = parse(R"(<everywhere/><layers scaleHeight="8" height="2"/>)").volumes.front();
    CHECK(is_everywhere(air));
    REQUIRE(air.layers);
    CHECK(air.layers->bottom == 2.0);
    CHECK(air.layers->top == 162.0);
    CHECK(air.layers->reference == 2.0);
    const Volume box = parse(R"(<box y="5" height="10"/><layers up="y" scaleHeight="2" height="-3"/>)").volumes.front();
    CHECK(box.layers->bottom == 0.0);
    CHECK(box.layers->top == 10.0);
    const Volume slabs = parse(R"(<everywhere/><layers up="z"><layer height="-5" density="1"/>
        <layer height="10" density="2"/><layer height="10" density="0.5"/><layer height="20" density="0"/></layers>)")
                             .volumes.front();
    CHECK(slabs.layers->axis == 2);
    CHECK(slabs.layers->bottom == -5.0);
    CHECK(slabs.layers->top == 20.0);
    CHECK(layer_density(slabs, -6.0) == 0.0);
    CHECK(layer_density(slabs, 2.5) == Approx(1.5));
    CHECK(layer_density(slabs, 10.0) == 0.5);
    CHECK(layer_density(slabs, 21.0) == 0.0);
    const Volume colored = parse(R"(<everywhere/><layers><layer height="0" sigma_t="3" albedo=".5"/>
        <layer height="1" sigma_t="1"/></layers>)")
                               .volumes.front();
    CHECK(colored.map.is_transfer);
    CHECK(colored.sigma_s == Rgb(1.0));

    const std::pair<const char*, const char*> bad[] = {
        {"<everywhere/><box/>", "a volume has one shape"},
        {"<everywhere x='1'/>", "unknown attribute 'x'"},
        {"<everywhere/><noise/>", "would have no end in <everywhere>"},
        {"<sphere/><layers scaleHeight='1'/>", "are for a <box>, or <everywhere>"},
        {"<box/><noise/><layers scaleHeight='1'/>", "a volume has one density"},
        {"<everywhere/><layers/>", "lacks scaleHeight"},
        {"<everywhere/><layers up='w' scaleHeight='1'/>", "expected x, y or z"},
        {"<everywhere/><layers scaleHeight='0'/>", "scaleHeight"},
        {"<everywhere/><layers scaleHeight='1' bottom='5' top='4'/>", "reach from 5 to 4"},
        {"<everywhere/><layers scaleHeight='1' bottom='-100'/>", "denser at the bottom"},
        {"<box/><layers><layer height='3' density='1'/><layer height='4' density='1'/></layers>", "reach from 3 to 4"},
        {"<everywhere/><layers><layer height='3' density='1'/></layers>", "reach from 3 to 3"},
        {"<everywhere/><layers><layer height='3' density='1'/><layer height='2' density='1'/></layers>",
         "2 after 3; values ascend"},
        {"<everywhere/><layers><layer height='3' density='1'/><layer height='4' sigma_t='1'/></layers>", "sigma_t"},
        {"<everywhere/><layers scaleHeight='1'><layer height='3' density='1'/></layers>",
         "each <layer> has its height"},
        {"<everywhere/><sigma_a>1</sigma_a><layers><layer height='0' sigma_t='1'/><layer height='1' "
         "sigma_t='1'/></layers>",
         "beside points that have sigma_t"},
        {"<everywhere/><densityMap/>", "maps the values of a <densityField>"},
    };
    for (const auto& [text, message] : bad) {
        INFO(text);
        CHECK_THROWS_WITH(parse(text), Contains(message));
    }
    const auto hash = [](const char* text) { return scene_hash(parse(text)); };
    CHECK(hash("<everywhere/>") != hash("<box/>"));
    CHECK(hash("<everywhere/><layers scaleHeight='1'/>") != hash("<everywhere/>"));
    CHECK(hash("<everywhere/><layers scaleHeight='1'/>") != hash("<everywhere/><layers scaleHeight='2'/>"));
}
