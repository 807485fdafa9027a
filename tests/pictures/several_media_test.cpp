// Several media: that overlaps add up, that cuts are not seen, and pictures against the reference, whose media race.
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "error.h"
#include "frame_params.h"
#include "loaded_medium.h"
#include "scene_hash.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/thorough.h"
#include "tests/reference/medium.h"

using namespace vkvol;
using Catch::Contains;

namespace {

Scene lit_scene(const Volume& volume, double width = 5.0) {
    Scene scene = scene_of(volume, width, 16, 12.0, glm::dvec3(0.0), {10.0, 25.0, -5.0});
    scene.background = {0.1, 0.2, 0.4};
    scene.lights = {sunlight({1.0, 0.9, 0.8})};
    scene.settings.spp = 128;
    return scene;
}

// The same medium as several of it, each thinned by its share.
Scene shared_out(Scene scene, std::initializer_list<double> shares) {
    const Volume whole = scene.volumes.front();
    scene.volumes.clear();
    for (const double share : shares) {
        scene.volumes.push_back(whole);
        scene.volumes.back().density_scale = share * whole.density_scale;
    }
    return scene;
}

// All combinations are compared in a table of tools/validate.sh; here each choice comes once.
int unusual_choices(const AxisChoices& choices) {
    return (choices.free_flight != FREE_FLIGHT_DELTA) + (choices.transmittance != TRANSMITTANCE_RATIO) +
           (choices.nee != NEE_COLLISIONS) +
           (choices.emission.value_or(EMISSION_AT_COLLISIONS) != EMISSION_AT_COLLISIONS);
}

// Otherwise than the usual ones do.
bool asks_density(const AxisChoices& choices) {
    return choices.free_flight != FREE_FLIGHT_DELTA || choices.transmittance != TRANSMITTANCE_RATIO;
}

Volume noisy_ball() {
    Volume volume = medium(Sphere{{0.2, 0.1, 0.0}, 1.7}, 3.0, 0.8, 0.3);
    volume.noise = Noise{1.3, 3, 0.5, 2.0};
    return volume;
}

Volume dense_cloud() {
    return medium(write_grids({cloud_grid()}), 2.0, 0.9, 0.2);
}

glm::dmat4 turned(double angle, glm::dvec3 axis) {
    return glm::rotate(glm::dmat4(1.0), angle, glm::normalize(axis));
}

// A ball of noise, a cloud that was turned and a box that glows, in one another, each with a phase function of its own.
Scene mixture() {
    Volume box = medium(Box{{0.4, -0.5, 0.3}, {2.0, 1.0, 1.6}}, 0.8, 0.5, 0.0);
    box.phase = PhaseFunction::rayleigh;
    box.Le = {0.3, 0.1, 0.02};
    box.transform = turned(0.6, {1.0, 2.0, -1.0});
    Volume grid = dense_cloud();
    grid.g = -0.4;
    grid.transform = glm::translate(glm::dmat4(1.0), glm::dvec3(0.5, 0.7, -0.4)) * turned(-0.9, {0.0, 1.0, 0.3}) *
                     glm::scale(glm::dmat4(1.0), glm::dvec3(0.5, -0.35, 0.4));
    Scene scene = lit_scene(noisy_ball());
    scene.volumes.push_back(grid);
    scene.volumes.push_back(box);
    scene.volumes.front().sigma_s = {0.9, 1.8, 2.4};
    scene.volumes.front().sigma_a = Rgb(3.0) - scene.volumes.front().sigma_s;
    return scene;
}

// In an even sky, where nothing absorbs green and blue, these are 1. Of throughput the sum over the channels is kept,
// 3: no sample is above that, so that of mean m they vary by m (3 - m) at most, 2 as expected, and 2.25 whatever m is.
void keep_green_and_blue(std::vector<Volume> volumes, const std::string& name) {
    Scene scene = lit_scene(volumes.front());
    scene.volumes = std::move(volumes);
    scene.lights.clear();
    scene.background = Rgb(1.0);
    scene.settings.integrator = "ratioTracking";
    scene.settings.spp = 64;
    const Film film = render_here(scene, 3).film;
    glm::dvec3 mean(0.0);
    double most = 0.0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        mean += glm::dvec3(film.mean[i]) / double(film.pixel_count());
        most = std::max({most, double(film.variance[i].y), double(film.variance[i].z)});
    }
    CAPTURE(name, mean.x, mean.y, mean.z, most);
    CHECK(most * (scene.settings.spp - 1) <= 2.25 * (1.0 + 1e-4));
    const double error = std::sqrt(2.0 / (double(scene.settings.spp) * double(film.pixel_count())));
    CHECK(std::abs(mean.y - 1.0) < 5.0 * error);
    CHECK(std::abs(mean.z - 1.0) < 5.0 * error);
}

} // namespace

TEST_CASE("halves of a medium on top of each other are the whole, in every way to render them",
          "[gpu][image][several]") {
    std::size_t turn = 0;
    const auto check = [&](const std::string& name, const Scene& whole) {
        const Film expected = render_here(whole, 1).film;
        const Scene halves = shared_out(whole, {0.5, 0.3, 0.2});
        std::vector<Combination> one_axis; // of what a density is made of only flights through it ask
        for (const Combination& combination : unbiased_combinations(halves))
            if (unusual_choices(combination.choices) <= (name == "cloud" || asks_density(combination.choices) ? 1 : 0))
                one_axis.push_back(combination);
        for (const Combination& combination : in_turn(one_axis, turn++)) {
            Scene scene = halves;
            scene.settings.choices = combination.choices;
            CHECK_AGREEMENT(agree(render_here(scene, 2).film, expected, name + " " + combination.name));
        }
    };
    check("ball", lit_scene(medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 1.0, 0.9, 0.5)));
    check("noise", lit_scene(noisy_ball()));
    check("cloud", lit_scene(dense_cloud(), 11.0));
}

TEST_CASE("a medium cut along an oblique plane is the whole", "[gpu][image][several][long]") {
    const glm::dmat4 turn = turned(0.7, {1.0, 1.0, 0.4});
    Volume whole = medium(Box{{0.0, 0.0, 0.0}, {2.0, 2.0, 2.0}}, 1.5, 0.9, 0.4);
    whole.transform = turn;
    const Scene alone = lit_scene(whole);
    Scene cut = alone;
    cut.volumes.front().shape = Box{{-0.3, 0.0, 0.0}, {1.4, 2.0, 2.0}};
    cut.volumes.push_back(cut.volumes.front());
    cut.volumes.back().shape = Box{{0.7, 0.0, 0.0}, {0.6, 2.0, 2.0}};
    CHECK_AGREEMENT(agree(render_here(cut, 1).film, render_here(alone, 2).film, "cut"));
}

TEST_CASE("volumes that are moved equal the reference", "[gpu][image][several][long]") {
    const glm::dmat4 map = glm::translate(glm::dmat4(1.0), glm::dvec3(0.2, -0.3, 0.4)) * turned(0.8, {1.0, -2.0, 0.5}) *
                           glm::scale(glm::dmat4(1.0), glm::dvec3(1.3, -0.5, 0.8));
    Volume ball = noisy_ball();
    ball.transform = map;
    check_against_reference(lit_scene(ball), "noise");
    Volume box = medium(Box{{0.3, 0.0, 0.0}, {2.0, 3.0, 1.0}}, 1.0, 0.9, 0.5);
    box.transform = map;
    check_against_reference(lit_scene(box), "box");
    Volume grid = dense_cloud();
    grid.transform = map;
    grid.transform[1][0] += 0.3; // sheared as well
    check_against_reference(lit_scene(grid, 9.0), "cloud");
}

TEST_CASE("media in one another equal the reference's race", "[gpu][image][several]") {
    Scene scene = mixture();
    if (thorough()) {
        check_against_reference(scene, "sun");
        scene.settings.integrator = "ratioNEE";
        scene.settings.choices.emission = EMISSION_AT_STEPS;
        check_against_reference(scene, "at every step");
        scene.settings.integrator = "unbiasedRayMarching";
        check_against_reference(scene, "marched");
        scene.settings.integrator = "";
        scene.settings.choices = {};
    }
    scene.lights.push_back(PointLight{{0.3, 0.2, 0.1}, Rgb(2.0)}); // within all of them
    scene.lights.push_back(SphereLight{{-1.5, 1.0, 1.0}, 0.3, Rgb(4.0)});
    check_against_reference(scene, "lamps");
    scene.settings.choices.distance = DISTANCE_MIXED;
    check_against_reference(scene, "looks from along flights");
}

TEST_CASE("media each with tables of their own equal the reference", "[gpu][image][several]") {
    const auto fire = [](Storage storage, double kelvin) {
        GridRecipe heat{{-6, -5, -4}, {9, 8, 7}, [](glm::ivec3 i) { return 0.6f + 1.8f * cloud_noise(i * 3 + 40); }};
        heat.storage = storage;
        heat.name = "temperature";
        heat.linear = glm::dmat3(0.45);
        GridRecipe albedo = heat;
        albedo.color = [](glm::ivec3 i) { return glm::vec3(0.9f, 0.5f, cloud_noise(i * 5 + 11)); };
        albedo.name = "Cd";
        Volume volume = medium(write_grids({cloud_grid(storage), heat, albedo}), 1.0, 0.5, 0.2);
        volume.temperature.model = TemperatureEmission::Model::blackbody;
        volume.temperature.color = {0.5, 0.4, 0.25};
        volume.temperature.scale = kelvin;
        return volume;
    };
    Scene scene = lit_scene(fire(Storage::float32, 700.0), 12.0);
    scene.volumes.push_back(fire(Storage::fp8, 1000.0));
    scene.volumes.back().albedo_grid = "Cd";
    scene.volumes.back().transform = glm::translate(glm::dmat4(1.0), glm::dvec3(1.5, -1.0, 0.5)) *
                                     turned(1.9, {0.2, 1.0, 0.1}) * glm::scale(glm::dmat4(1.0), glm::dvec3(0.8));
    scene.volumes.push_back(medium(Sphere{{-2.0, 1.0, 1.0}, 2.0}, 0.6, 0.6));
    scene.volumes.back().phase = PhaseFunction::table;
    scene.volumes.back().phase_details.file = write_text("0 9\n10 4\n40 1\n180 .5\n");
    scene.volumes.push_back(medium(Sphere{{2.0, 1.0, 1.5}, 1.5}, 0.6, 0.6));
    scene.volumes.back().phase = PhaseFunction::table;
    scene.volumes.back().phase_details.file = write_text("0 1\n90 .2\n150 3\n180 8\n");
    scene.volumes.push_back(medium(Sphere{{0.0, -2.0, 0.5}, 1.5}, 0.6, 0.6, 0.4));
    scene.volumes.back().phase = PhaseFunction::draine;
    check_against_reference(scene, "tables");
}

TEST_CASE("a camera in the innermost of nested media", "[gpu][image][several]") {
    Scene scene = lit_scene(medium(Sphere{{0.0, 0.0, 0.0}, 4.0}, 0.2, 0.9, 0.6));
    scene.volumes.push_back(medium(Sphere{{0.0, 0.0, 0.0}, 2.0}, 0.4, 0.5, 0.0));
    scene.volumes.push_back(medium(Sphere{{0.1, 0.0, 0.0}, 0.5}, 1.5, 0.95, -0.3));
    scene.camera.position = {0.1, 0.0, 0.2};
    check_against_reference(scene, "nested");
}

TEST_CASE("colours that are taken away differently in several media", "[gpu][image][several]") {
    Volume volume = medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 1.0, 0.9, 0.5);
    volume.sigma_a = {0.1, 0.3, 0.6};
    const Scene whole = lit_scene(volume);
    CHECK_AGREEMENT(agree(render_here(shared_out(whole, {0.6, 0.4}), 1).film, render_here(whole, 2).film, "alike"));
    // One takes red, one takes blue: together as one medium whose sigmas are the sums.
    Scene apart = whole;
    apart.volumes.push_back(volume);
    apart.volumes[0].sigma_a = {0.1, 0.0, 0.0};
    apart.volumes[0].sigma_s = Rgb(0.9) * 0.5;
    apart.volumes[1].sigma_a = {0.0, 0.3, 0.6};
    apart.volumes[1].sigma_s = Rgb(0.9) * 0.5;
    Scene together = whole;
    together.volumes[0].sigma_s = Rgb(0.9);
    CHECK_AGREEMENT(agree(render_here(apart, 1).film, render_here(together, 2).film, "red and blue"));
    apart.settings.integrator = "rayMarching";
    CHECK_THROWS_WITH(render_here(apart, 1), Contains("spectralTracking"));
}

TEST_CASE("several media glow each in its colours, along any flights", "[gpu][image][several][emission]") {
    Volume red = medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 1.0, 0.9, 0.5), blue = red;
    red.sigma_a = {0.1, 0.0, 0.0};
    red.Le = {2.0, 1.0, 1.0};
    red.sigma_s = blue.sigma_s = Rgb(0.45);
    blue.sigma_a = {0.0, 0.3, 0.6};
    blue.Le = {1.0, 0.5, 0.2};
    Scene apart = lit_scene(red), together = apart;
    apart.volumes.push_back(blue);
    together.volumes[0].sigma_a += blue.sigma_a;
    together.volumes[0].sigma_s += blue.sigma_s;
    together.volumes[0].Le = {2.0, 0.5, 0.2}; // no channel is absorbed by both
    const Film expected = render_here(together, 2).film;
    apart.settings.integrator = "ratioTracking";
    for (const int emission : {EMISSION_AT_COLLISIONS, EMISSION_AT_STEPS}) {
        apart.settings.choices.emission = emission;
        CHECK_AGREEMENT(agree(render_here(apart, 1).film, expected, "two that glow"));
    }
    // Grey ones are marched as well: steps of a hundredth of what they are across leave no bias that shows.
    for (Volume& volume : apart.volumes)
        volume.sigma_a = Rgb(0.3);
    apart.settings.choices = {};
    const Film delta = render_here(apart, 3).film;
    apart.settings.choices.free_flight = FREE_FLIGHT_MARCH;
    apart.settings.march.step = 0.03;
    CHECK_AGREEMENT(agree(render_here(apart, 4).film, delta, "marched"));
}

TEST_CASE("media of other colours give a path no weight", "[gpu][image][several]") {
    const auto box = [](const Rgb& sigma_s, const Rgb& sigma_a) {
        Volume volume = medium(Box{{0.0, 0.0, 0.0}, glm::dvec3(4.0)}, 1.0, 1.0);
        volume.sigma_s = sigma_s;
        volume.sigma_a = sigma_a;
        return volume;
    };
    const Rgb none(0.0);
    keep_green_and_blue({box({2.0, 0.0, 0.0}, none), box({0.0, 2.0, 0.0}, none), box({0.0, 0.0, 2.0}, none)},
                        "a medium for each colour");
    keep_green_and_blue({box(Rgb(2.0), none), box(none, {6.0, 0.0, 0.0})}, "a fog with a dye");
}

TEST_CASE("what is nothing beside a medium changes nothing", "[gpu][image][several]") {
    const Scene whole = lit_scene(noisy_ball());
    Scene beside = whole;
    beside.volumes.push_back(medium(Sphere{{0.0, 0.0, 0.0}, 9.0}, 0.0, 0.0));
    CHECK_AGREEMENT(agree(render_here(beside, 1).film, render_here(whole, 2).film, "nothing"));
    beside.volumes.push_back(medium(Everywhere{}, 0.3, 0.5)); // which has no matter, and so no cells without end
    beside.volumes.back().density_scale = 0.0;
    CHECK_AGREEMENT(agree(render_here(beside, 1).film, render_here(whole, 2).film, "and nothing everywhere"));
    Scene boxed = lit_scene(medium(Box{{0.1, 0.0, 0.0}, {2.0, 1.5, 1.0}}, 1.5, 0.9, 0.2));
    beside.volumes.front() = boxed.volumes.front();
    const RenderResult box = render_here(beside, 1);
    CHECK(box.counts.step_caps == 0);
    CHECK_AGREEMENT(agree(box.film, render_here(boxed, 2).film, "beside a box"));
    Scene grids = lit_scene(dense_cloud());
    Scene before = grids;
    GridRecipe dense{{-3, -4, -5}, {6, 7, 8}, [](glm::ivec3) { return 3.0f; }};
    before.volumes.insert(before.volumes.begin(), medium(write_grid(dense), 2.0, 0.5));
    before.volumes.front().density_scale = 0.0;
    CHECK_AGREEMENT(agree(render_here(before, 1).film, render_here(grids, 2).film, "a grid that fades in"));
    // Likewise a medium of colours, before a ball that is seen through it.
    Scene colored = whole;
    colored.volumes = {medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 0.0, 0.0)};
    colored.volumes.front().sigma_a = {0.1, 0.2, 0.4};
    colored.volumes.front().density_scale = 0.0;
    colored.surfaces.emplace_back().shape = BallSurface{{0.5, 0.2, -1.0}, 0.7};
    Scene without = colored;
    without.volumes.clear();
    CHECK_AGREEMENT(agree(render_here(colored, 1).film, render_here(without, 2).film, "before a ball"));
    beside.volumes.resize(2);
    beside.volumes.front().sigma_a = beside.volumes.front().sigma_s = Rgb(0.0);
    const Film empty = render_here(beside, 1).film;
    for (const glm::vec3& pixel : empty.mean)
        CHECK(pixel == glm::vec3(beside.background));
}

TEST_CASE("cells over several media bound their sum, and list all that may be there", "[cpu][several]") {
    const Scene scene = mixture();
    const Assets assets = load_assets(scene, choose_method(scene));
    const Superposition& whole = *assets.superposition;
    std::vector<reference::Medium> media;
    for (const Volume& volume : scene.volumes)
        media.push_back(reference::load(volume));
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> part(0.0, 1.0);
    std::size_t met = 0, empty = 0;
    for (int n = 0; n < 20000; ++n) {
        const glm::dvec3 cell_point =
            glm::mix(whole.low(), whole.high(), glm::dvec3(part(engine), part(engine), part(engine)));
        const glm::ivec3 cell = glm::ivec3(glm::floor(cell_point)) - whole.cells.origin;
        const std::size_t i = whole.entry_of(cell);
        const auto list = whole.list(i);
        double sum = 0.0;
        for (std::uint32_t k = 0; k < media.size(); ++k) {
            const reference::Ray ray{whole.origin + whole.edge * cell_point, {0.0, 0.0, 1.0}};
            const auto parts = support(media[k], ray);
            const bool inside = !parts.empty() && parts.front().t0 == 0.0;
            const double sigma_t = inside ? media[k].largest() * reference::DensityAlong(media[k], ray)(0.0) : 0.0;
            sum += sigma_t;
            met += sigma_t > 0.0;
            if (sigma_t > 0.0)
                CHECK(std::find(list.begin(), list.end(), k) != list.end());
        }
        CHECK(sum <= whole.bound(i));
        empty += whole.bound(i) == 0.0f;
    }
    CHECK(met > 2000);
    CHECK(empty > 2000); // corners of the box around turned ones
}

// Single precision is for what is seen, and not for the air high above it.
TEST_CASE("air above leaves the middle where media are", "[cpu][several]") {
    Scene scene = parse(R"(<volumes><volume><box x="3" y="1" width="2" height="2" depth="2"/></volume>
        <volume><everywhere/><layers scaleHeight="8000"/><sigma_s>1e-6</sigma_s></volume></volumes>)");
    const Method method = choose_method(scene);
    const Assets assets = load_assets(scene, method);
    CHECK(glm::distance(render_origin(scene, assets.media, &*assets.superposition), glm::dvec3(3.0, 1.0, 0.0)) < 1e-6);
    CHECK(assets.superposition->high().y * assets.superposition->edge > 1.6e5 - 10.0);
}

TEST_CASE("what volumes hardly mean is told", "[cpu][xml][several]") {
    const auto warnings = [](const std::string& volumes) {
        const std::vector<std::string> all = parse("<volumes>" + volumes + "</volumes>").warnings;
        return fmt::format("{}", fmt::join(all, "\n"));
    };
    CHECK_THAT(warnings("<volume name='my cloud'><sphere/></volume><volume name='my_cloud'><sphere/></volume>"),
               Contains("one layer, medium.my_cloud"));
    CHECK(warnings("<volume name='a'><sphere/></volume><volume name='a'><sphere/></volume>") == "");
    CHECK_THAT(warnings("<volume><sphere/><emission multiplier='7'/></volume>"), Contains("<emission> is black"));
    CHECK_THAT(warnings("<volume><sphere/><medium multiplier='7'/></volume>"), Contains("<medium> is black"));
    CHECK(warnings("<volume><sphere/><medium r='0' multiplier='7'/></volume>") == "");
}

TEST_CASE("names of volumes have room in names of channels", "[cpu][xml][several]") {
    const auto named = [](std::size_t length) {
        return "<volumes><volume name=\"" + std::string(length, 'n') + "\"><sphere/></volume></volumes>";
    };
    CHECK(parse(named(200)).volumes.front().name.size() == 200);
    CHECK_THROWS_WITH(parse(named(201)), Contains("the name has 201 characters; expected 200 at most"));
}

TEST_CASE("groups of volumes in scene files", "[cpu][xml][several]") {
    const Scene scene = parse(R"(<sphere radius="2"/><sigma_a>1</sigma_a>
        <volumes><volume name="haze"><box width="3"/><sigma_s>.1</sigma_s><phase>rayleigh</phase></volume>
        <volume><sphere/><noise/>
            <transform><scale y="2"/><rotate z="1" angle="90"/><translate x="5"/></transform></volume></volumes>)");
    REQUIRE(scene.volumes.size() == 3);
    CHECK(std::holds_alternative<Sphere>(scene.volumes[0].shape));
    CHECK(scene.volumes[0].sigma_a == Rgb(1.0));
    CHECK(scene.volumes[1].sigma_a == Rgb(0.5)); // the default, not the scene's own
    CHECK(scene.volumes[1].phase == PhaseFunction::rayleigh);
    CHECK(scene.volumes[2].noise);
    const glm::dvec3 up(scene.volumes[2].transform * glm::dvec4(0.0, 1.0, 0.0, 1.0));
    CHECK(glm::distance(up, glm::dvec3(3.0, 0.0, 0.0)) < 1e-12); // stretched, turned to -x, moved
    const glm::dmat4 rows =
        parse_volumes(R"(<volume><sphere/><transform><matrix values="1 2 3 4 0 1 0 5 0 0 -1 6"/></transform></volume>)")
            .volumes.front()
            .transform;
    CHECK(glm::dvec3(rows * glm::dvec4(1.0, 1.0, 1.0, 1.0)) == glm::dvec3(10.0, 6.0, 5.0));
    CHECK(parse_volumes("<volume><sphere/></volume>").volumes.size() == 1);

    const std::pair<const char*, const char*> bad[] = {
        {"<volume/>", "no shape"},
        {"<volume><camera/></volume>", "camera"},
        {"<volume><sphere/><box/></volume>", "a volume has one shape"},
        {"<volume><sphere/><sphere/></volume>", "a second <sphere>"},
        {"<volume><sphere/><transform><scale value='0'/></transform></volume>", "leaves nothing"},
        {"<volume><sphere/><transform><rotate angle='5'/></transform></volume>", "lacks its axis"},
        {"<volume><sphere/><transform><matrix values='1 2 3'/></transform></volume>", "has 3 values"},
        {"<volume><sphere/><transform><matrix values='1 0 0 0 1 0 0 0 1 0 0 0'/></transform></volume>",
         "leaves nothing"},
        {"<volume><sphere/><transform><matrix values='1 0 0 0 0 1 0 0 0 0 1 0 1 0 0 1'/></transform></volume>",
         "last row"},
    };
    for (const auto& [text, message] : bad) {
        INFO(text);
        CHECK_THROWS_WITH(parse_volumes(text), Contains(message));
    }
    CHECK_THROWS_WITH(parse("<volume><sphere/></volume>"), Contains("volumes"));
    const auto hash = [](const char* text) { return scene_hash(parse_volumes(text)); };
    CHECK(hash("<volume><sphere/></volume>") == scene_hash(parse("<sphere/>")));
    CHECK(hash("<volume><sphere/></volume>") !=
          hash("<volume><sphere/><transform><translate x='1'/></transform></volume>"));
    CHECK(hash("<volume><sphere/></volume>") != hash("<volume><sphere/></volume><volume><sphere/></volume>"));
}

TEST_CASE("what is small and dense amid what is large is refused where rays beside it would not get on",
          "[cpu][method][several]") {
    Scene scene = lit_scene(medium(Box{{0.0, 0.0, 0.0}, glm::dvec3(1000.0)}, 1e-4, 1.0));
    scene.volumes.push_back(medium(Sphere{{1.0, 1.0, 1.0}, 0.01}, 4e8, 0.0));
    const auto loads = [&] { load_assets(scene, choose_method(scene)); };
    CHECK_THROWS_WITH(loads(), Contains("tentative collisions"));
    scene.volumes.front().shape = Box{{0.0, 0.0, 0.0}, glm::dvec3(10.0)};
    CHECK_NOTHROW(loads());
}
