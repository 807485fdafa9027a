// What particles leave in pixels: sums whose error is known, in units that hold both little and much, and bits that do
// not hang on how they are worked on.
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

#include "camera_view.h"
#include "session.h"
#include "shared/constants.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/surface_scenes.h"
#include "support/test_device.h"

using namespace vkvol;

// A particle is in several pixels, or in one of those that count it. Of 48 pictures, the variance of their means over
// the mean of what they say it is: a chi-square of 47 degrees over 47, beyond 0.40 or 1.96 once in 10^4 each (Wilson
// and Hilferty).
TEST_CASE("pixels of particles are parts of a sum whose error is known", "[gpu][particles]") {
    Scene lamp = by(small_picture(medium(Box{glm::dvec3(0.0), glm::dvec3(2.0)}, 10.0, 0.9), 4.0,
                                  {PointLight{{0.0, 0.0, 0.0}, Rgb(9.0)}}),
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
    Scene scene = by(small_picture(medium(Box{glm::dvec3(0.0), glm::dvec3(2.0)}, 10.0, 0.9), 4.0,
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

// Splats are numbers of so many digits, and what paths from the camera bring are splats as well.
TEST_CASE("what is seen may be far brighter than what particles bring", "[gpu][particles]") {
    Scene scene = small_picture(medium(Sphere{glm::dvec3(0.0), 1000.0}, 1e-6, 1.0), 100.0,
                                {PointLight{{0.0, 0.0, 0.0}, Rgb(0.01)}});
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
    Scene scene = small_picture(medium(Sphere{{0.0, 0.0, 0.0}, 1.0}, 0.5, 1.0, 0.99999), 1.0, {});
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

TEST_CASE("negative estimates are splats too", "[gpu][particles][long]") {
    Scene scene = small_picture(smoke(), 4.0, {PointLight{{1.2, 1.9, 1.5}, {12.0, 9.0, 6.0}}});
    scene.settings.march.shadow_step = 0.7;
    const Film reference = render_reference(scene, 2);
    scene = by(scene, "lightTracing");
    scene.settings.choices.transmittance = TRANSMITTANCE_TELESCOPING;
    CHECK_AGREEMENT(agree(render_here(scene, 1).film, reference, "telescoping"));
}

TEST_CASE("particles give the same bits however they are worked on", "[gpu][particles]") {
    Scene scene = small_picture(smoke(), 5.5, {SphereLight{{1.6, 1.6, 1.2}, 0.4, {9.0, 7.0, 5.0}}});
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
    Scene scene = before_smoke({surface_of(BallSurface{{0.0, 0.0, 0.0}, 20.0}, MaterialKind::diffuse)},
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
