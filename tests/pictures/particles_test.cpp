// Particles from the lights against paths from the camera: the same pictures by estimators that share neither draws nor
// directions, and by both at once.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <tuple>

#include "camera_view.h"
#include "method.h"
#include "preset.h"
#include "scene_hash.h"
#include "scene_xml.h"
#include "session.h"
#include "shared/constants.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/test_device.h"
#include "support/thorough.h"

using namespace vkvol;
using Catch::Contains;

namespace {

// Small, so that each pixel has its share of particles in every sample.
Scene seen(const Volume& volume, double width, std::vector<Light> lights) {
    Scene scene = scene_of(volume, width, 8, 12.0, glm::dvec3(0.0), {10.0, 25.0, -5.0});
    scene.lights = std::move(lights);
    scene.background = {0.1, 0.15, 0.2};
    scene.settings.spp = 4096;
    return scene;
}

Volume colourful(Volume volume) {
    const Rgb sigma_t = {1.0, 2.0, 3.0};
    volume.sigma_s = Rgb{0.9, 0.8, 0.95} * sigma_t;
    volume.sigma_a = sigma_t - volume.sigma_s;
    return volume;
}

Surface with_material(SurfaceShape shape, MaterialKind kind, double roughness = 0.0) {
    Surface surface;
    surface.shape = std::move(shape);
    surface.material.kind = kind;
    surface.material.color = {0.8, 0.7, 0.6};
    surface.material.roughness = roughness;
    if (kind == MaterialKind::conductor) {
        surface.material.eta = {0.143, 0.375, 1.442};
        surface.material.k = {3.983, 2.386, 1.603};
    }
    return surface;
}

const RectangleSurface floor_piece{{0.0, -1.3, 0.0}, {2.5, 0.0, 0.0}, {0.0, 0.0, -2.5}};
const BallSurface left{{-0.9, -0.6, 0.9}, 0.6}, right{{0.9, -0.6, 0.9}, 0.6};

// A tetrahedron whose corners have the normals of the ball about it.
TriangleSurface smooth_stone() {
    TriangleSurface mesh;
    mesh.vertices = {{0.5, 0.5, 0.5}, {-0.5, -0.5, 0.5}, {-0.5, 0.5, -0.5}, {0.5, -0.5, -0.5}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    for (const glm::uvec3& t : mesh.triangles)
        mesh.normals.push_back(glm::mat3(glm::normalize(mesh.vertices[t.x]), glm::normalize(mesh.vertices[t.y]),
                                         glm::normalize(mesh.vertices[t.z])));
    for (glm::dvec3& vertex : mesh.vertices)
        vertex += glm::dvec3(0.0, -0.4, 0.9);
    return mesh;
}

// On a floor, before a ball of smoke.
Scene still(std::vector<Surface> surfaces, std::vector<Light> lights) {
    Scene scene = seen(smoke(), 5.0, std::move(lights));
    scene.surfaces = std::move(surfaces);
    scene.surfaces.push_back(with_material(floor_piece, MaterialKind::diffuse));
    return scene;
}

struct ParticleCase {
    const char* name;
    Scene scene;
};

// Every kind of light, medium, surface and camera that particles know, and nothing that only paths from the camera
// find.
std::vector<ParticleCase> particle_cases() {
    const auto [point, spot, ball, disk, rectangle, sun, beam] = LightsAbout{};
    RadianceMap map{8, 4, {}, 0};
    for (int i = 0; i < 32; ++i)
        map.texels.emplace_back(0.1 + 0.3 * (i % 5), 0.4, i == 11 ? 9.0 : 0.2);

    std::vector<ParticleCase> all;
    all.push_back({"a ball of fog, point and spot",
                   seen(medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 1.5, 0.95, -0.4), 4.0, {point, spot})});
    all.push_back({"smoke, far lights", seen(smoke(), 4.0, {sun, beam, write_sky(map)})});
    all.push_back({"smoke, lamps", seen(smoke(), 5.5, {ball, disk, rectangle})});
    // Without holes: a pixel that a particle in a thousand comes to is far from the normal limit.
    GridRecipe recipe = cloud_grid();
    recipe.value = [](glm::ivec3 voxel) { return 0.3f + 0.7f * cloud_noise(voxel); };
    const Volume cloud = colourful(medium(write_grid(recipe), 1.0, 0.9, 0.6));
    all.push_back({"a chromatic cloud", seen(cloud, 6.0, {beam})});
    Volume ember = smoke();
    ember.Le = {1.0, 0.5, 0.2};
    all.push_back({"what glows", seen(ember, 4.0, {})});
    Volume layered = medium(Box{{0.0, 0.2, 0.0}, {2.0, 1.8, 2.0}}, 2.0, 0.8); // begins above the lowest layer
    layered.layers = Layers{1, -1.0, 1.0, 0.0, 0.0};
    layered.map.is_transfer = true;
    layered.map.points = {{0.0, 1.0}, {1.0, 0.5}, {2.0, 1.0}};
    for (MapPoint& point_of_map : layered.map.points)
        point_of_map.albedo = {0.8, 0.6, 0.7};
    layered.map.points[1].emission = {0.4, 0.3, 0.1};
    all.push_back({"layers that glow", seen(layered, 4.0, {})});
    // In thin air of which a millionth glows.
    Scene ember_in_air = seen(ember, 4.0, {});
    ember_in_air.volumes.push_back(medium(Box{glm::dvec3(0.0), {300.0, 300.0, 300.0}}, 1e-9, 1.0));
    ember_in_air.background = Rgb(0.0); // else most particles come from there
    all.push_back({"what glows in a wide haze", ember_in_air});
    // A lamp, and a spot of a million times its power that shines past all of it.
    Scene faint = seen(medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 3.0, 0.9), 4.0, {point});
    faint.lights.push_back(SpotLight{{0.0, 3.0, 0.0}, {0.0, 1.0, 0.0}, Rgb(1e8), 20.0, 0.5});
    faint.background = Rgb(0.0);
    all.push_back({"a weak light beside a strong one", faint});
    Scene several = seen(smoke(), 5.0, {point});
    several.volumes.push_back(medium(Box{{-0.9, -0.5, -0.5}, {1.4, 0.6, 0.7}}, 2.0, 0.9));
    several.volumes.back().sigma_s = {1.9, 1.5, 1.8}; // of an extinction that is grey, as the reference wants it
    several.volumes.back().sigma_a = Rgb(2.0) - several.volumes.back().sigma_s;
    several.volumes.back().Le = {0.3, 0.2, 0.6};
    all.push_back({"several media, one of which glows", several});
    // With a lamp within the glass: of particles from outside, what its index does to them cancels on the way out
    // again.
    all.push_back({"rough surfaces", still({with_material(left, MaterialKind::dielectric, 0.3),
                                            with_material(right, MaterialKind::conductor, 0.4)},
                                           {ball, point, SphereLight{left.center, 0.2, {20.0, 15.0, 10.0}}})});
    // All but these are lit by way of them alone.
    const glm::dvec3 aside(2.6, 0.4, 2.2);
    const SpotLight at_stone{aside, glm::normalize(glm::dvec3(0.0, -0.4, 0.9) - aside), Rgb(200.0), 22.0, 0.5};
    for (const auto& [name, kind, roughness] :
         {std::tuple("faces that stand for something round", MaterialKind::diffuse, 0.0),
          std::tuple("likewise, rough", MaterialKind::conductor, 0.4)})
        all.push_back({name, still({with_material(smooth_stone(), kind, roughness)}, {at_stone})});
    Surface shining = with_material(smooth_stone(), MaterialKind::diffuse);
    std::get<TriangleSurface>(shining.shape).normals.clear();
    shining.emission = {2.0, 3.0, 1.0};
    Surface hollow = with_material(BallSurface{{-1.2, 0.8, 0.8}, 0.4}, MaterialKind::diffuse);
    hollow.emission = {1.0, 0.8, 2.0};
    hollow.shines_both_ways = true;
    all.push_back({"surfaces that shine", still({shining, hollow}, {})});
    Scene bare = still({with_material(left, MaterialKind::diffuse)}, {point});
    bare.volumes.clear();
    all.push_back({"no medium", bare});
    return all;
}

// By one or the other, or by both.
void check(const ParticleCase& c, int turn) {
    INFO(c.name);
    const Film reference = render_reference(c.scene, 2);
    for (const char* integrator : {"lightTracing", "bidirectional"})
        if (turn++ % 2 == 0 || thorough())
            CHECK_AGREEMENT(agree(render_here(by(c.scene, integrator), 1).film, reference,
                                  fmt::format("{}, {}", c.name, integrator)));
}

} // namespace

TEST_CASE("particles, paths and both show the same", "[gpu][particles]") {
    int turn = 0;
    for (const ParticleCase& c : in_turn(particle_cases(), 0, 5))
        check(c, turn++);
}

// Glass throws light where looks do not find it: particles find it, and a path from the camera only what the camera
// sees by way of glass.
TEST_CASE("particles and paths share what mirrors and glass show and throw", "[gpu][particles]") {
    const SphereLight ball{{0.8, 1.9, 1.6}, 0.3, {20.0, 16.0, 12.0}};
    const SunLight sun{glm::normalize(glm::dvec3(1.0, 2.0, 0.5)), {1.0, 0.8, 0.6}, 10.0};
    Scene scene =
        still({with_material(left, MaterialKind::dielectric), with_material(right, MaterialKind::mirror)}, {ball, sun});
    scene.surfaces.back().material.kind = MaterialKind::coated;
    scene.settings.spp = 4096;
    const Film reference = render_reference(scene, 2);
    CHECK_AGREEMENT(agree(render_here(by(scene, "bidirectional"), 1).film, reference, "glass, both"));
    const Method particles = choose_method(with_preset(by(scene, "lightTracing")));
    CHECK_THAT(particles.biased, Contains("glass"));
    CHECK(choose_method(with_preset(by(scene, "bidirectional"))).biased.empty());
    CHECK(scene_hash(by(scene, "bidirectional")) == scene_hash(by(scene, "ratioTracking")));
    CHECK(scene_hash(by(scene, "lightTracing")) != scene_hash(by(scene, "ratioTracking")));
    CHECK_THAT(choose_method(with_preset(scene)).by_chance, Contains("glass"));
    // No path from the camera finds what glass throws of lights without extent.
    scene.lights.push_back(PointLight{{1.2, 1.9, 1.5}, {12.0, 9.0, 6.0}});
    CHECK_THAT(choose_method(with_preset(scene)).biased, Contains("bidirectional"));
    // Nor does any find what the one throws, and the other shows.
    CHECK_THAT(choose_method(with_preset(by(scene, "bidirectional"))).biased, Contains("neither particles nor paths"));
    CHECK(scene_hash(by(scene, "bidirectional")) != scene_hash(by(scene, "ratioTracking")));
}

// From lights that are infinitely far they come only to what has an end.
TEST_CASE("what particles do not bring from afar is told", "[cpu][particles]") {
    Scene scene = still({with_material(left, MaterialKind::dielectric)}, {sunlight()});
    Surface ground;
    ground.shape = PlaneSurface{{0.0, -3.0, 0.0}, {0.0, 1.0, 0.0}};
    scene.surfaces.push_back(ground);
    CHECK_THAT(choose_method(with_preset(by(scene, "bidirectional"))).biased, Contains("without end"));
    scene.lights = {SunLight{{0.0, 1.0, 0.0}, Rgb(1.0), 10.0}};
    CHECK(choose_method(with_preset(by(scene, "bidirectional"))).biased.empty());
    CHECK_THAT(choose_method(with_preset(by(scene, "bidirectional"))).by_chance, Contains("suns and skies"));
    scene.surfaces.back().shape = RectangleSurface{{0.0, -3.0, 0.0}, {5.0, 0.0, 0.0}, {0.0, 0.0, -5.0}};
    CHECK(choose_method(with_preset(by(scene, "bidirectional"))).by_chance.empty());
}

// Splats are whole numbers, of which what a far light brings has to have enough.
TEST_CASE("particles of a light far away are as fine as those of a near one", "[gpu][particles]") {
    Scene scene = seen(medium(Sphere{{0.0, 0.0, 0.0}, 1.0}, 2.0, 0.9), 2.4, {PointLight{{0.0, 1e6, 0.0}, Rgb(1e12)}});
    scene.background = Rgb(0.0);
    scene.settings.spp = 64;
    const std::optional<double> paths = relative_noise(render_here(by(scene, "ratioTracking"), 1).film),
                                both = relative_noise(render_here(by(scene, "bidirectional"), 2).film);
    REQUIRE((paths && both));
    CHECK(*both < 1.5 * *paths);
}

// Splats are as bright as what is seen from a three-thousandth of a scene's size, lit by a lamp as near to the ground.
TEST_CASE("particles light what is small in a large scene", "[gpu][particles]") {
    Scene scene =
        still({}, {PointLight{{0.5, 4.0, -20.0}, Rgb(1.0)}}); // by a lamp, which a larger ground changes little
    scene.volumes.clear();
    scene.background = Rgb(0.0);
    Surface ground;
    ground.shape = RectangleSurface{{0.0, 0.0, 0.0}, {1e4, 0.0, 0.0}, {0.0, 0.0, -1e4}};
    scene.surfaces = {ground};
    scene.camera = Camera{};
    scene.camera.position = {0.0, 5.0, -12.0};
    scene.camera.pitch = -35.0;
    scene.camera.fov = 40.0;
    scene.picture = {8, 8, 0.0, 0.0, 8.0, 8.0};
    scene.settings.spp = 1 << 15;
    const RenderResult particles = render_here(by(scene, "lightTracing"), 2);
    CHECK(particles.counts.non_finite == 0);
    scene.surfaces.front().shape = RectangleSurface{{0.0, 0.0, 0.0}, {1e2, 0.0, 0.0}, {0.0, 0.0, -1e2}};
    CHECK_AGREEMENT(agree(particles.film, render_here(by(scene, "lightTracing"), 1).film, "the ground below a lamp"));
}

// Single precision does not tell the cosine with the poles' axis from 1 there.
TEST_CASE("particles at a panorama's pole count as much as paths there", "[gpu][particles]") {
    Scene scene = still({}, {SpotLight{{0.0, -0.01, 0.0}, {0.0, 1.0, 0.0}, Rgb(1.0), 0.1}});
    scene.volumes.clear();
    scene.surfaces = {with_material(left, MaterialKind::diffuse)};
    scene.surfaces.front().shape = DiskSurface{{0.0, 1.0, 0.0}, {0.0, -1.0, 0.0}, 1.2e-4};
    scene.background = Rgb(0.0);
    scene.camera = Camera{};
    scene.camera.projection = Projection::equirectangular;
    scene.picture = {32, 2, 0.0, 0.0, 32.0, 512.0};
    scene.settings.spp = 1 << 14;
    const ImageMean paths = image_mean(render_here(by(scene, "ratioTracking"), 1).film);
    const ImageMean particles = image_mean(render_here(by(scene, "lightTracing"), 2).film);
    REQUIRE(paths.standard_error);
    REQUIRE(particles.standard_error);
    CAPTURE(paths.value.x, particles.value.x, paths.standard_error->x, particles.standard_error->x);
    CHECK(paths.value.x > 10.0 * paths.standard_error->x);
    CHECK(std::abs(paths.value.x - particles.value.x) <
          4.5 * std::hypot(paths.standard_error->x, particles.standard_error->x));
}

TEST_CASE("no particles look for rows beyond a panorama's poles", "[cpu][particles]") {
    Scene scene = still({}, {PointLight{{1.2, 1.9, 1.5}, {12.0, 9.0, 6.0}}});
    scene.camera.projection = Projection::equirectangular;
    scene.picture = {16, 12, 0.0, 0.0, 16.0, 12.0};
    for (const char* integrator : {"lightTracing", "bidirectional"}) {
        CHECK_NOTHROW(choose_method(by(scene, integrator)));
        Scene above = by(scene, integrator), below = above;
        above.picture.start_y = -0.4;
        below.picture.height = 14;
        CHECK_THROWS_WITH(choose_method(above), Catch::Contains("beyond a pole"));
        CHECK_THROWS_WITH(choose_method(below), Catch::Contains("beyond a pole"));
    }
}

TEST_CASE("particles are seen by every camera through every filter", "[gpu][particles]") {
    const PointLight point{{1.2, 1.9, 1.5}, {12.0, 9.0, 6.0}};
    const Scene usual = still({with_material(left, MaterialKind::diffuse)}, {point});
    std::vector<ParticleCase> all;
    Scene scene = usual;
    scene.camera.lens.radius = 0.6;
    scene.camera.lens.focus = 11.0;
    scene.camera.lens.blades = 5;
    all.push_back({"lens", scene});
    scene = usual;
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = 4.0;
    all.push_back({"orthographic", scene});
    scene = usual;
    scene.camera.projection = Projection::equirectangular;
    scene.camera.position = {0.4, 0.3, 2.4};
    all.push_back({"panorama", scene});
    scene.settings.pixel_filter = PixelFilter::tent; // goes on across its seam and the poles
    scene.settings.pixel_filter_radius = 1.0;
    all.push_back({"panorama, filtered", scene});
    // A part of it that begins away from the pole, and one that goes round once and a half.
    scene.picture.start_y = 2.0;
    scene.picture.reference_height = 12.0;
    all.push_back({"part of a panorama, filtered", scene});
    scene = usual;
    scene.camera.projection = Projection::equirectangular;
    scene.camera.position = {0.4, 0.3, 2.4};
    scene.picture.reference_width = 5.0;
    all.push_back({"more than a panorama", scene});
    // From so far away that rays begin before the eye.
    scene = usual;
    scene.camera.position *= 200.0;
    scene.camera.fov /= 200.0;
    all.push_back({"far eye", scene});
    scene = usual;
    scene.settings.pixel_filter = PixelFilter::box;
    scene.settings.pixel_filter_radius = 0.8;
    all.push_back({"wide box", scene});
    scene.settings.pixel_filter = PixelFilter::blackman_harris;
    scene.settings.pixel_filter_radius = 1.7;
    scene.camera.fov = 95.0; // degrees, whose rays are far from parallel
    scene.camera.position *= 0.25;
    all.push_back({"Blackman-Harris, wide", scene});
    for (const ParticleCase& c : in_turn(all, 2)) {
        INFO(c.name);
        CHECK_AGREEMENT(agree(render_here(by(c.scene, "lightTracing"), 5).film, render_reference(c.scene, 6), c.name));
    }
}

// By closed form: whatever loses no light vanishes in an even sky.
TEST_CASE("particles from an even sky leave it even", "[gpu][particles]") {
    Scene scene = seen(medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 2.0, 1.0, 0.5), 2.5, {});
    scene.background = {1.0, 2.0, 0.5};
    scene.surfaces = {with_material(BallSurface{{0.0, 0.0, 0.0}, 0.7}, MaterialKind::conductor, 0.5)};
    scene.surfaces.front().material.color = Rgb(1.0);
    scene.surfaces.front().material.eta = Rgb(0.0);
    scene.surfaces.front().material.k = Rgb(1.0);
    scene.settings.spp = 4096;
    scene = by(scene, "lightTracing");
    const Film film = render_here(scene, 1).film;
    CHECK_AGREEMENT(agree_with_means(film, std::vector<Rgb>(film.mean.size(), scene.background), "even sky"));
    // About the pole of a panorama, beyond which filters reach, and across whose seam.
    scene.camera = Camera{};
    scene.camera.position = {0.0, -3.0, 0.0};
    scene.camera.projection = Projection::equirectangular;
    scene.picture = {8, 4, 0.0, 0.0, 8.0, 4.0};
    scene.settings.pixel_filter = PixelFilter::tent;
    scene.settings.pixel_filter_radius = 1.5;
    const Film round = render_here(scene, 1).film;
    CHECK_AGREEMENT(agree_with_means(round, std::vector<Rgb>(round.mean.size(), scene.background), "all around"));
}

// A particle is in several pixels, or in one of those that count it. Of 48 pictures, the variance of their means over
// the mean of what they say it is: a chi-square of 47 degrees over 47, beyond 0.40 or 1.96 once in 10^4 each (Wilson
// and Hilferty).
TEST_CASE("pixels of particles are parts of a sum whose error is known", "[gpu][particles]") {
    Scene lamp =
        by(seen(medium(Box{glm::dvec3(0.0), glm::dvec3(2.0)}, 10.0, 0.9), 4.0, {PointLight{{0.0, 0.0, 0.0}, Rgb(9.0)}}),
           "lightTracing");
    lamp.background = Rgb(0.0);
    Scene slab = parse(R"(<box y="-0.5"/><periodic x="-0.5 0.5" z="-0.5 0.5"/><sigma_s>20</sigma_s><sigma_a>0</sigma_a>
        <light zenith="60" r="1" g="1" b="1"/><irradiance y="0.2" lookAt="0 -1 0" width="1" height="1"/>
        <width>8</width><height>8</height><integrator>lightTracing</integrator>)");
    for (Scene* scene : {&lamp, &slab}) {
        scene->settings.spp = 32;
        RenderJob job;
        job.disk_cache = false;
        job.crop = {0, scene->picture.width, 0, scene->picture.height};
        Session session(test_device(), *scene, job);
        double sum = 0.0, squares = 0.0, said = 0.0;
        constexpr int pictures = 48;
        for (int i = 0; i < pictures; ++i) {
            job.seed = static_cast<std::uint32_t>(i);
            session.begin_again();
            session.render(32);
            const Film& film = session.result().film;
            CHECK(film.is_correlated);
            const ImageMean mean = image_mean(film);
            REQUIRE(mean.standard_error);
            sum += mean.value.x;
            squares += mean.value.x * mean.value.x;
            said += mean.standard_error->x * mean.standard_error->x / pictures;
        }
        const double found = (squares - sum * sum / pictures) / (pictures - 1);
        CAPTURE(found, said);
        CHECK((found / said > 0.40 && found / said < 1.96));
    }
}

TEST_CASE("the error of a picture's sum is that of its samples' sums", "[gpu][particles]") {
    Scene scene = by(seen(medium(Box{glm::dvec3(0.0), glm::dvec3(2.0)}, 10.0, 0.9), 4.0,
                          {DirectionalLight{{0.0, 1.0, 0.0}, Rgb(9.0, 3.0, 1e-4)}}),
                     "lightTracing");
    scene.background = Rgb(0.0);
    scene.picture = {64, 64, 0.0, 0.0, 64.0, 64.0}; // so many that low words of their sum carry
    scene.settings.spp = 2;
    const Film both = render_here(scene, 5).film;
    scene.settings.spp = 1;
    RenderJob second;
    second.sample_offset = 1;
    const Film a = render_here(scene, 5).film, b = render_here(scene, 5, second).film;
    REQUIRE(both.sum_variance);
    CHECK(!a.sum_variance);
    glm::dvec3 difference(0.0), sum(0.0);
    for (std::size_t i = 0; i < both.pixel_count(); ++i) {
        difference += glm::dvec3(a.mean[i]) - glm::dvec3(b.mean[i]);
        sum += glm::dvec3(both.mean[i]);
    }
    for (int c = 0; c < 3; ++c) { // of two samples' mean; each is rounded to single precision
        CHECK(difference[c] != 0.0);
        CHECK(
            (*both.sum_variance)[c] ==
            Approx(difference[c] * difference[c] / 4.0).epsilon(1e-4).margin(1e-6 * std::abs(difference[c]) * sum[c]));
    }
}

// A lamp in a ceiling: a black one takes nothing of what comes from its lower side, whichever way rounding has it.
TEST_CASE("lamps that lie in the plane of a surface shine before it", "[gpu][particles]") {
    const glm::dvec3 down = glm::normalize(glm::dvec3(-0.13, -1.0, 0.21)), middle(0.37, 1.7, 0.41);
    const glm::dvec3 x = glm::normalize(glm::cross(down, glm::dvec3(0.3, 0.2, 1.0))), z = glm::cross(down, x);
    const std::vector<Light> lamps = {
        PointLight{middle + 0.2 * x, Rgb(5.0)}, SpotLight{middle - 0.3 * z, down, Rgb(9.0), 60.0, 0.5},
        DiskLight{middle + 0.4 * z, down, 0.3, Rgb(6.0)}, RectangleLight{middle, 0.3 * x, 0.2 * z, Rgb(8.0)}};
    const auto square = [&](double half) {
        TriangleSurface square;
        for (const auto& [u, w] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
            square.vertices.push_back(middle + u * half * x + w * half * z);
        square.triangles = {{0, 1, 2}, {0, 2, 3}};
        return square;
    };
    for (const Light& lamp : in_turn(lamps, 2))
        for (const double half : {1.5, 1500.0, 1.5e5}) {
            Surface ceiling = with_material(square(half), MaterialKind::diffuse);
            ceiling.material.color = Rgb(0.0);
            Scene scene = still({}, {lamp});
            scene.volumes.clear();
            scene.background = Rgb(0.0);
            const Film open = render_here(scene, 1).film;
            scene.surfaces.push_back(ceiling);
            for (const char* integrator : {"ratioTracking", "lightTracing"}) {
                if (half > 1e5 && integrator == std::string("lightTracing"))
                    continue; // particles begin half a unit off so large a ceiling
                CHECK_AGREEMENT(agree(render_here(by(scene, integrator), 2).film, open,
                                      fmt::format("lamp {} in a ceiling of {}, {}", lamp.index(), half, integrator)));
            }
        }
}

// Rounding has some of them within it.
TEST_CASE("lamps that lie on a large ball shine before it", "[gpu][particles]") {
    const glm::dvec3 down = glm::normalize(glm::dvec3(-0.13, -1.0, 0.21)), middle(0.37, 1.7, 0.41);
    const glm::dvec3 center(glm::vec3(middle - 1e4 * down));
    std::vector<Light> lamps;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 near = middle + glm::dvec3(std::cos(i), 0.0, std::sin(i)) * 0.5;
        lamps.push_back(PointLight{center + 1e4 * glm::normalize(near - center), Rgb(0.6)});
    }
    Scene scene = still({}, lamps); // about its medium
    scene.background = Rgb(0.0);
    const Film open = render_here(scene, 1).film;
    scene.surfaces.emplace_back().shape = BallSurface{center, 1e4};
    scene.surfaces.back().material.color = Rgb(0.0);
    for (const char* integrator : {"ratioTracking", "lightTracing"})
        CHECK_AGREEMENT(agree(render_here(by(scene, integrator), 2).film, open, integrator));
}

// Splats are numbers of so many digits, and what paths from the camera bring are splats as well.
TEST_CASE("what is seen may be far brighter than what particles bring", "[gpu][particles]") {
    Scene scene =
        seen(medium(Sphere{glm::dvec3(0.0), 1000.0}, 1e-6, 1.0), 100.0, {PointLight{{0.0, 0.0, 0.0}, Rgb(0.01)}});
    scene.settings.spp = 16;
    scene.background = Rgb(1.0); // nothing is lost on the way
    const RenderResult sky = render_here(by(scene, "bidirectional"), 1);
    CHECK(sky.counts.non_finite == 0);
    for (const glm::vec3& pixel : sky.film.mean)
        CHECK(pixel.x == Approx(1.0).epsilon(1e-3));
    scene.background = Rgb(0.0);
    scene.volumes.front().sigma_a = scene.volumes.front().sigma_s = Rgb(1e-3);
    scene.volumes.front().Le = Rgb(1e4);
    CHECK(render_here(by(scene, "bidirectional"), 1).counts.non_finite == 0);
}

// A lamp that a few pixels see a part of brings each far more than all of it would on average.
TEST_CASE("what is seen of a lamp is all there, however little of it", "[gpu][particles]") {
    Scene scene = parse_scene(R"(<options><surfaces><rectangle lookAt="0 1 0" width="200" height="200"/></surfaces>
        <lights><sphere y="1" radius=".05"/></lights><camera y="1" z="1.25" fov="1"/><width>20</width>
        <height>20</height><rayPerPixelCount>4096</rayPerPixelCount></options>)",
                              "lamp.xml");
    const RenderResult result = render_here(by(scene, "lightTracing"), 1);
    CHECK(result.counts.non_finite == 0);
    CHECK_AGREEMENT(agree_with_means(result.film, std::vector<Rgb>(400, Rgb(1.0)), "lamp"));
}

// All of a picture that looks along a beam is the peak of the phase function.
TEST_CASE("peaks of phase functions fit into splats", "[gpu][particles]") {
    Scene scene = seen(medium(Sphere{{0.0, 0.0, 0.0}, 1.0}, 0.5, 1.0, 0.99999), 1.0, {});
    scene.background = Rgb(0.0);
    scene.camera.projection = Projection::orthographic;
    scene.camera.view_height = 1.0;
    scene.lights = {DirectionalLight{-camera_rotation(scene.camera)[2], Rgb(1.0)}};
    scene.settings.spp = 256;
    const Film paths = render_here(by(scene, "ratioTracking"), 1).film;
    CHECK(mean_of(paths) > 1e7);
    for (const char* integrator : {"lightTracing", "bidirectional"}) {
        const RenderResult particles = render_here(by(scene, integrator), 2);
        CHECK(particles.counts.non_finite == 0);
        CHECK_AGREEMENT(agree(particles.film, paths, integrator));
    }
}

TEST_CASE("highlights of facets fit into splats", "[gpu][particles]") {
    const Scene scene = parse_scene(R"(<options><surfaces><box width="2" height=".2" depth="2" material="dielectric"
        ior="1.1" roughness=".001"/></surfaces><lights><directional y="1" r="1" g="1" b="1"/></lights>
        <camera y="-5" pitch="90" projection="orthographic" viewHeight="1"/><width>8</width><height>8</height>
        <rayPerPixelCount>256</rayPerPixelCount></options>)",
                                    "pane.xml");
    const Film paths = render_here(by(scene, "ratioTracking"), 1).film;
    CHECK(mean_of(paths) > 1e6);
    const RenderResult both = render_here(by(scene, "bidirectional"), 2);
    CHECK(both.counts.non_finite == 0);
    CHECK_AGREEMENT(agree(both.film, paths, "highlights"));
}

// So far away that rounding knows nothing of the side from which it is seen.
TEST_CASE("a distant lamp is shared out by particles and paths", "[gpu][particles]") {
    Scene scene = seen(medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 1.5, 0.9), 4.0,
                       {SphereLight{{600.0, 700.0, 400.0}, 1e-4, Rgb(1e13)}});
    scene.background = Rgb(0.0);
    scene.settings.spp = 1024;
    CHECK_AGREEMENT(
        agree(render_here(by(scene, "bidirectional"), 1).film, render_here(by(scene, "ratioTracking"), 2).film, "far"));
}

TEST_CASE("splats are as fine in units of any length", "[gpu][particles]") {
    const auto mean = [](double length) {
        const Scene scene = parse_scene(
            fmt::format(R"(<options><surfaces><plane/></surfaces><lights><point y="{0}" multiplier="{1}"/></lights>
                <camera y="{2}" lookAt="0 0 0" up="0 0 1" fov="30"/><width>8</width><height>8</height>
                <rayPerPixelCount>64</rayPerPixelCount></options>)",
                        length, length * length, 2.0 * length),
            "plane.xml");
        const RenderResult result = render_here(by(scene, "bidirectional"), 1);
        CHECK(result.counts.non_finite == 0);
        return image_mean(result.film).value.x;
    };
    const double usual = mean(1.0);
    CHECK(usual > 0.0);
    for (const double length : {5e-5, 1e5})
        CHECK(mean(length) == Approx(usual).epsilon(1e-3)); // the same paths
}

TEST_CASE("negative estimates are splats too", "[gpu][particles]") {
    Scene scene = seen(smoke(), 4.0, {PointLight{{1.2, 1.9, 1.5}, {12.0, 9.0, 6.0}}});
    scene.settings.march.shadow_step = 0.7;
    const Film reference = render_reference(scene, 2);
    scene = by(scene, "lightTracing");
    scene.settings.choices.transmittance = TRANSMITTANCE_TELESCOPING;
    CHECK_AGREEMENT(agree(render_here(scene, 1).film, reference, "telescoping"));
}

TEST_CASE("particles give the same bits however they are worked on", "[gpu][particles]") {
    Scene scene = seen(smoke(), 5.5, {SphereLight{{1.6, 1.6, 1.2}, 0.4, {9.0, 7.0, 5.0}}});
    scene.settings.spp = 40;
    const char* const integrator = GENERATE("lightTracing", "bidirectional");
    scene = by(scene, integrator);
    const Film whole = render_here(scene, 1).film;
    SECTION("with few at a time, in batches of a few samples") {
        RenderJob job;
        job.plan.schedule = GENERATE(Schedule::fused, Schedule::staged);
        job.plan.slots = 64;
        job.plan.lanes = 64;
        job.plan.budget = 17;
        job.plan.most_batch = 7;
        CHECK(same_bits(render_here(scene, 1, job).film, whole));
    }
    SECTION("resumed, when a batch has been cut short") {
        RenderJob job;
        job.crop = {0, 8, 0, 8};
        job.seed = 1;
        job.plan.most_batch = 7;
        job.plan.submit_seconds = 0.0;
        int asked = 0;
        std::optional<Checkpoint> last;
        job.interrupted = [&] { return ++asked > 12; };
        job.checkpoint_seconds = 1e9;
        job.checkpoint = [&](const Checkpoint& checkpoint) { last = checkpoint; };
        const RenderResult begun = render(test_device(), scene, job);
        REQUIRE(begun.interrupted);
        REQUIRE(last);
        CHECK(begun.samples < 40);
        for (const std::uint32_t count : begun.film.samples)
            CHECK(count == begun.samples); // all or nothing of a batch
        RenderJob rest;
        rest.crop = job.crop;
        rest.seed = 1;
        rest.resume = &*last;
        const RenderResult resumed = render(test_device(), scene, rest);
        CHECK(same_bits(resumed.film, whole));
        REQUIRE((resumed.film.sum_variance && whole.sum_variance)); // of all samples
        CHECK(*resumed.film.sum_variance == *whole.sum_variance);
        const auto paths_of = [](const RenderResult& result) {
            std::uint64_t queued = 0;
            for (const PassFigures& pass : result.passes)
                queued += pass.queued;
            return queued;
        };
        CHECK(resumed.counts.paths == 40 * 64);
        CHECK(paths_of(resumed) > paths_of(begun));
        CHECK(resumed.rounds > begun.rounds);
    }
}

// Within a ball that loses no light none ever ends, but by its depth: a million is soon come to.
TEST_CASE("a batch of particles that would not end is given up whole", "[gpu][particles]") {
    Scene scene = still({with_material(BallSurface{{0.0, 0.0, 0.0}, 20.0}, MaterialKind::diffuse)},
                        {PointLight{{0.0, 3.0, 0.0}, Rgb(1.0)}});
    scene.volumes.clear();
    scene.surfaces.pop_back(); // the floor
    scene.surfaces.front().material.color = Rgb(1.0);
    scene.settings.max_depth = 2'000'000'000;
    scene.settings.roulette_threshold = 0.0;
    scene.settings.spp = 4;
    RenderJob job;
    job.crop = {0, 8, 0, 8};
    job.plan.schedule = GENERATE(Schedule::fused, Schedule::staged);
    int asked = 0;
    std::optional<Checkpoint> last;
    job.interrupted = [&] { return ++asked > 3; };
    job.checkpoint_seconds = 1e9;
    job.checkpoint = [&](const Checkpoint& checkpoint) { last = checkpoint; };
    const RenderResult result = render(test_device(), by(scene, "lightTracing"), job);
    CHECK(result.interrupted);
    CHECK(result.counts.abandoned == 0);
    CHECK(last);
    for (const std::uint32_t count : result.film.samples)
        CHECK(count == 0);
}

TEST_CASE("what particles cannot do is refused, with what can", "[particles]") {
    Scene scene = seen(smoke(), 4.0, {PointLight{{1.2, 1.9, 1.5}, {12.0, 9.0, 6.0}}});
    const auto refusal = [](const Scene& scene) -> std::string {
        try {
            choose_method(with_preset(scene));
        } catch (const std::exception& error) {
            return error.what();
        }
        return "";
    };
    Scene particles = by(scene, "lightTracing"), both = by(scene, "bidirectional");
    CHECK(refusal(particles).empty());
    CHECK(refusal(both).empty());
    SECTION("sensors of flux") {
        particles.camera.projection = both.camera.projection = Projection::irradiance;
        CHECK(refusal(particles).empty());
        CHECK_THAT(refusal(both), Contains("flux") && Contains("ratioTracking"));
    }
    SECTION("layers") {
        particles.layers = both.layers = 1;
        CHECK_THAT(refusal(particles), Contains("layers"));
        CHECK_THAT(refusal(both), Contains("layers"));
    }
    SECTION("what has no end") {
        Surface ground = with_material(PlaneSurface{{0.0, -2.0, 0.0}, {0.0, 1.0, 0.0}}, MaterialKind::diffuse);
        particles.surfaces = both.surfaces = {ground};
        CHECK_THAT(refusal(particles), Contains("no end"));
        CHECK(refusal(both).empty()); // its paths find that
        particles.background = Rgb(0.0);
        CHECK(refusal(particles).empty());
        particles.surfaces.front().emission = Rgb(1.0);
        CHECK_THAT(refusal(particles), Contains("plane"));
    }
    SECTION("no lights to begin at") {
        both.lights.clear();
        const Method method = choose_method(with_preset(both));
        CHECK(method.paths == PATHS_CAMERA);
        REQUIRE(method.warnings.size() == 1);
        CHECK_THAT(method.warnings.front(), Contains("without lights"));
    }
    SECTION("other scattering, and looks from elsewhere") {
        particles.settings.choices.scattering = SCATTERING_SINGLE;
        particles.settings.choices.nee = NEE_TENTATIVE;
        const Method method = choose_method(with_preset(particles));
        CHECK(method.scattering == SCATTERING_MULTIPLE);
        CHECK(method.nee == NEE_COLLISIONS);
        CHECK(method.warnings.size() == 2);
    }
}
