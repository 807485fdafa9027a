// Particles from the lights against paths from the camera: the same pictures by estimators that share neither draws nor
// directions, and by both at once.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <tuple>

#include "method.h"
#include "preset.h"
#include "scene_hash.h"
#include "session.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/surface_scenes.h"
#include "support/thorough.h"

using namespace vkvol;
using Catch::Contains;

namespace {

Volume colourful(Volume volume) {
    const Rgb sigma_t = {1.0, 2.0, 3.0};
    volume.sigma_s = Rgb{0.9, 0.8, 0.95} * sigma_t;
    volume.sigma_a = sigma_t - volume.sigma_s;
    return volume;
}

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

struct ParticleCase {
    const char* name;
    Scene scene;
};

std::vector<ParticleCase> cases_of_media() {
    const auto [point, spot, ball, disk, rectangle, sun, beam] = LightsAbout{};
    RadianceMap map{8, 4, {}, 0};
    for (int i = 0; i < 32; ++i)
        map.texels.emplace_back(0.1 + 0.3 * (i % 5), 0.4, i == 11 ? 9.0 : 0.2);

    std::vector<ParticleCase> all;
    all.push_back({"a ball of fog, point and spot",
                   small_picture(medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 1.5, 0.95, -0.4), 4.0, {point, spot})});
    all.push_back({"smoke, far lights", small_picture(smoke(), 4.0, {sun, beam, write_sky(map)})});
    all.push_back({"smoke, lamps", small_picture(smoke(), 5.5, {ball, disk, rectangle})});
    // Without holes: a pixel that a particle in a thousand comes to is far from the normal limit.
    GridRecipe recipe = cloud_grid();
    recipe.value = [](glm::ivec3 voxel) { return 0.3f + 0.7f * cloud_noise(voxel); };
    const Volume cloud = colourful(medium(write_grid(recipe), 1.0, 0.9, 0.6));
    all.push_back({"a chromatic cloud", small_picture(cloud, 6.0, {beam})});
    Volume ember = smoke();
    ember.Le = {1.0, 0.5, 0.2};
    all.push_back({"what glows", small_picture(ember, 4.0, {})});
    Volume layered = medium(Box{{0.0, 0.2, 0.0}, {2.0, 1.8, 2.0}}, 2.0, 0.8); // begins above the lowest layer
    layered.layers = Layers{1, -1.0, 1.0, 0.0, 0.0};
    layered.map.is_transfer = true;
    layered.map.points = {{0.0, 1.0}, {1.0, 0.5}, {2.0, 1.0}};
    for (MapPoint& point_of_map : layered.map.points)
        point_of_map.albedo = {0.8, 0.6, 0.7};
    layered.map.points[1].emission = {0.4, 0.3, 0.1};
    all.push_back({"layers that glow", small_picture(layered, 4.0, {})});
    // In thin air of which a millionth glows.
    Scene ember_in_air = small_picture(ember, 4.0, {});
    ember_in_air.volumes.push_back(medium(Box{glm::dvec3(0.0), {300.0, 300.0, 300.0}}, 1e-9, 1.0));
    ember_in_air.background = Rgb(0.0); // else most particles come from there
    all.push_back({"what glows in a wide haze", ember_in_air});
    // A lamp, and a spot of a million times its power that shines past all of it.
    Scene faint = small_picture(medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 3.0, 0.9), 4.0, {point});
    faint.lights.push_back(SpotLight{{0.0, 3.0, 0.0}, {0.0, 1.0, 0.0}, Rgb(1e8), 20.0, 0.5});
    faint.background = Rgb(0.0);
    all.push_back({"a weak light beside a strong one", faint});
    Scene several = small_picture(smoke(), 5.0, {point});
    several.volumes.push_back(medium(Box{{-0.9, -0.5, -0.5}, {1.4, 0.6, 0.7}}, 2.0, 0.9));
    several.volumes.back().sigma_s = {1.9, 1.5, 1.8}; // of an extinction that is grey, as the reference wants it
    several.volumes.back().sigma_a = Rgb(2.0) - several.volumes.back().sigma_s;
    several.volumes.back().Le = {0.3, 0.2, 0.6};
    all.push_back({"several media, one of which glows", several});
    return all;
}

std::vector<ParticleCase> cases_of_surfaces() {
    const LightsAbout lights;
    std::vector<ParticleCase> all;
    // With a lamp within the glass: of particles from outside, what its index does to them cancels on the way out
    // again.
    all.push_back({"rough surfaces",
                   before_smoke({surface_of(left_ball, MaterialKind::dielectric, 0.3),
                                 surface_of(right_ball, MaterialKind::conductor, 0.4)},
                                {lights.ball, lights.point, SphereLight{left_ball.center, 0.2, {20.0, 15.0, 10.0}}})});
    // All but these are lit by way of them alone.
    const glm::dvec3 aside(2.6, 0.4, 2.2);
    const SpotLight at_stone{aside, glm::normalize(glm::dvec3(0.0, -0.4, 0.9) - aside), Rgb(200.0), 22.0, 0.5};
    for (const auto& [name, kind, roughness] :
         {std::tuple("faces that stand for something round", MaterialKind::diffuse, 0.0),
          std::tuple("likewise, rough", MaterialKind::conductor, 0.4)})
        all.push_back({name, before_smoke({surface_of(smooth_stone(), kind, roughness)}, {at_stone})});
    Surface shining = surface_of(smooth_stone(), MaterialKind::diffuse);
    std::get<TriangleSurface>(shining.shape).normals.clear();
    shining.emission = {2.0, 3.0, 1.0};
    Surface hollow = surface_of(BallSurface{{-1.2, 0.8, 0.8}, 0.4}, MaterialKind::diffuse);
    hollow.emission = {1.0, 0.8, 2.0};
    hollow.shines_both_ways = true;
    all.push_back({"surfaces that shine", before_smoke({shining, hollow}, {})});
    Scene bare = before_smoke({surface_of(left_ball, MaterialKind::diffuse)}, {lights.point});
    bare.volumes.clear();
    all.push_back({"no medium", bare});
    return all;
}

// Every kind of light, medium, surface and camera that particles know, and nothing that only paths from the camera
// find.
std::vector<ParticleCase> particle_cases() {
    std::vector<ParticleCase> all = cases_of_media();
    for (const ParticleCase& c : cases_of_surfaces())
        all.push_back(c);
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
    int turn = 1;
    for (const ParticleCase& c : in_turn(particle_cases(), 0, 5))
        check(c, turn++);
}

// tools/validate.sh prints the table. Pixels to which few particles come are far from a normal limit.
TEST_CASE("paths, particles, both together and the reference agree, each with each", "[.particles_table]") {
    std::vector<AgreementRow> rows;
    std::uint32_t seed = 100;
    for (const ParticleCase& c : particle_cases()) {
        std::vector<Estimate> all{{"reference", render_reference(c.scene, ++seed)}};
        for (const char* integrator : {"ratioTracking", "bidirectional"})
            all.push_back({integrator, render_here(by(c.scene, integrator), ++seed).film});
        const PairwiseAgreement pixels = compare_all(all);
        all.push_back({"lightTracing", render_here(by(c.scene, "lightTracing"), ++seed).film});
        rows.push_back({fmt::format("{:<42}", c.name), compare_all(all), pixels});
    }
    check_rows(
        "ratioTracking, lightTracing, bidirectional and the reference: every pair; pixels of all but lightTracing.",
        fmt::format("{:<42}", "scene"), rows, 0.01);
}

// Which paths find by looks, and where they leave, weighed against particles each time.
TEST_CASE("paths and particles share the light of a sky, in smoke and on what is before it", "[gpu][particles]") {
    RadianceMap map{8, 4, {}, 0};
    for (int i = 0; i < 32; ++i)
        map.texels.emplace_back(0.2 + 0.5 * (i % 5), 0.4, i / 8 < 2 ? 1.5 : 0.2);
    const Scene lit = before_smoke(
        {surface_of(left_ball, MaterialKind::diffuse), surface_of(right_ball, MaterialKind::dielectric, 0.3)},
        {write_sky(map)});
    Scene bare = small_picture(medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 2.0, 0.95, 0.8), 4.0, {write_sky(map)});
    for (Scene scene : {lit, bare}) {
        scene.background = Rgb(0.0);
        CHECK_AGREEMENT(agree(render_here(by(scene, "bidirectional"), 1).film, render_reference(scene, 2), "a sky"));
    }
}

// Glass throws light where looks do not find it: particles find it, and a path from the camera only what the camera
// sees by way of glass.
TEST_CASE("particles and paths share what mirrors and glass show and throw", "[gpu][particles]") {
    const SphereLight ball{{0.8, 1.9, 1.6}, 0.3, {20.0, 16.0, 12.0}};
    const SunLight sun{glm::normalize(glm::dvec3(1.0, 2.0, 0.5)), {1.0, 0.8, 0.6}, 10.0};
    Scene scene = before_smoke(
        {surface_of(left_ball, MaterialKind::dielectric), surface_of(right_ball, MaterialKind::mirror)}, {ball, sun});
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

// Splats are whole numbers, of which what a far light brings has to have enough.
TEST_CASE("particles of a light far away are as fine as those of a near one", "[gpu][particles]") {
    Scene scene =
        small_picture(medium(Sphere{{0.0, 0.0, 0.0}, 1.0}, 2.0, 0.9), 2.4, {PointLight{{0.0, 1e6, 0.0}, Rgb(1e12)}});
    scene.background = Rgb(0.0);
    scene.settings.spp = 64;
    const std::optional<double> paths = relative_noise(render_here(by(scene, "ratioTracking"), 1).film),
                                both = relative_noise(render_here(by(scene, "bidirectional"), 2).film);
    REQUIRE((paths && both));
    CHECK(*both < 1.5 * *paths);
}

// Splats are as bright as what is seen from a three-thousandth of a scene's size, lit by a lamp as near to the ground.
TEST_CASE("particles light what is small in a large scene", "[gpu][particles][long]") {
    Scene scene =
        before_smoke({}, {PointLight{{0.5, 4.0, -20.0}, Rgb(1.0)}}); // by a lamp, which a larger ground changes little
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
    Scene scene = before_smoke({}, {SpotLight{{0.0, -0.01, 0.0}, {0.0, 1.0, 0.0}, Rgb(1.0), 0.1}});
    scene.volumes.clear();
    scene.surfaces = {surface_of(left_ball, MaterialKind::diffuse)};
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

TEST_CASE("that particles alone are noisy about an eye in fog is told", "[gpu][particles]") {
    const auto told = [](const std::string& camera, const char* integrator) {
        Scene scene = parse("<box width='4' height='4' depth='4'/><sigma_a>0.1</sigma_a><sigma_s>0.1</sigma_s>"
                            "<lights><point y='1'/></lights><rayPerPixelCount>1</rayPerPixelCount>"
                            "<width>8</width><height>8</height>" +
                            camera);
        scene.settings.integrator = integrator;
        const std::vector<std::string> warnings = render_here(scene, 1).warnings;
        return std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
            return warning.find("the camera is within a medium") != std::string::npos;
        });
    };
    CHECK(told("<camera z='1.9'/>", "lightTracing"));
    CHECK(told("<camera z='1.9' projection='equirectangular'/>", "lightTracing"));
    CHECK(!told("<camera z='2.1'/>", "lightTracing"));
    CHECK(!told("<camera z='1.9'/>", "bidirectional"));
    CHECK(!told("<camera z='1.9'/>", "ratioTracking"));
    // Between two balls, and within what does not scatter.
    const auto told_of = [](const std::string& body) {
        Scene scene =
            parse(body + "<lights><point y='1'/></lights><rayPerPixelCount>1</rayPerPixelCount><width>8</width>"
                         "<height>8</height><camera/><integrator>lightTracing</integrator>");
        const std::vector<std::string> warnings = render_here(scene, 1).warnings;
        return std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
            return warning.find("the camera is within a medium") != std::string::npos;
        });
    };
    const auto balls = [](double x) {
        return fmt::format("<volumes><volume><sphere x='{0}' radius='1'/></volume><volume><sphere x='-{0}' radius='1'/>"
                           "</volume></volumes>",
                           x);
    };
    CHECK(!told_of(balls(8.0)));
    CHECK(told_of(balls(0.5)));
    CHECK(!told_of("<box width='4' height='4' depth='4'/><sigma_a>1</sigma_a><sigma_s>0</sigma_s><surfaces><sphere "
                   "z='-1.5' radius='0.3'/></surfaces>"));
}

TEST_CASE("particles are seen by every camera through every filter", "[gpu][particles]") {
    const PointLight point{{1.2, 1.9, 1.5}, {12.0, 9.0, 6.0}};
    const Scene usual = before_smoke({surface_of(left_ball, MaterialKind::diffuse)}, {point});
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
    Scene scene = small_picture(medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 2.0, 1.0, 0.5), 2.5, {});
    scene.background = {1.0, 2.0, 0.5};
    scene.surfaces = {surface_of(BallSurface{{0.0, 0.0, 0.0}, 0.7}, MaterialKind::conductor, 0.5)};
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
            Surface ceiling = surface_of(square(half), MaterialKind::diffuse);
            ceiling.material.color = Rgb(0.0);
            Scene scene = before_smoke({}, {lamp});
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
    Scene scene = before_smoke({}, lamps); // about its medium
    scene.background = Rgb(0.0);
    const Film open = render_here(scene, 1).film;
    scene.surfaces.emplace_back().shape = BallSurface{center, 1e4};
    scene.surfaces.back().material.color = Rgb(0.0);
    for (const char* integrator : {"ratioTracking", "lightTracing"})
        CHECK_AGREEMENT(agree(render_here(by(scene, integrator), 2).film, open, integrator));
}

// So far away that rounding knows nothing of the side from which it is seen.
TEST_CASE("a distant lamp is shared out by particles and paths", "[gpu][particles][long]") {
    Scene scene = small_picture(medium(Sphere{{0.0, 0.0, 0.0}, 1.5}, 1.5, 0.9), 4.0,
                                {SphereLight{{600.0, 700.0, 400.0}, 1e-4, Rgb(1e13)}});
    scene.background = Rgb(0.0);
    scene.settings.spp = 1024;
    CHECK_AGREEMENT(
        agree(render_here(by(scene, "bidirectional"), 1).film, render_here(by(scene, "ratioTracking"), 2).film, "far"));
}
