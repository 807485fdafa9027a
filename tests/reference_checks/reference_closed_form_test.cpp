// The scalar reference against closed forms.
#include <catch2/catch.hpp>

#include "tests/reference/test_media.h"

using namespace reference;

TEST_CASE("homogeneous free flights are exponential", "[cpu][reference]") {
    const Medium medium = load(box({2, 2, 1e9}, 0.5, 1.5));
    Rng rng = stream(13);
    Mean distance;
    for (int i = 0; i < 100000; ++i)
        distance.add(*fly(medium, FREE_FLIGHT_ANALYTIC, {{0, 0, 0}, {0, 0, 1}}, rng.next().exponential(0), 0.0,
                          vkvol::Rgb(1.0), {}, rng)
                          .t);
    const double z = distance.z(0.5); // the mean free path, 1 / sigma_t
    CHECK(std::abs(z) < 4.0);
}

TEST_CASE("the transmittance of slabs and spheres is exponential", "[cpu][reference]") {
    Rng rng = stream(0);
    for (const double tau : {1e-9, 1e-6, 1.0, 10.0, 80.0, 87.0, 88.0, 104.0, 1e4}) { // row 1
        const Medium slab = load(box({1e3, 1e3, 2.0}, 0.5 * tau, 0.0));
        CHECK(analytic_transmittance(slab, {{0, 0, 5}, {0, 0, -1}}).x == Approx(std::exp(-tau)).epsilon(1e-12));
        const glm::dvec3 oblique(0.6, 0.0, -0.8);
        CHECK(analytic_transmittance(slab, {{0, 0, 5}, oblique}).x == Approx(std::exp(-tau / 0.8)).epsilon(1e-10));
    }
    vkvol::Volume ball = volume(0.7, 0.0);
    ball.shape = vkvol::Sphere{{0, 0, 0}, 2.0};
    const Medium medium = load(ball);
    for (int i = 0; i < 100; ++i) { // row 20: from the centre
        const Draw a = rng.next();
        const Ray ray{{0, 0, 0}, hg_sample(0.0, {0, 0, 1}, a.x(), a.y())};
        CHECK(analytic_transmittance(medium, ray).x == Approx(std::exp(-1.4)).epsilon(1e-12));
    }
}

TEST_CASE("absorption and emission", "[cpu][reference]") {
    for (const double tau : {0.01, 1.0, 30.0}) { // row 2: Le (1 - exp(-tau)) + B exp(-tau)
        vkvol::Volume v = box({10, 10, 1}, tau, 0.0);
        v.Le = {5.0, 0.0, 0.0};
        vkvol::Scene scene = pixel_scene(v, 10.0);
        scene.background = {2.0, 0.0, 0.0};
        const double expected = 5.0 * -std::expm1(-tau) + 2.0 * std::exp(-tau);
        const Ray ray{{0, 0, 10}, {0, 0, -1}};
        CHECK(unscattered_quadrature(load(v), scene.background, ray).x == Approx(expected).epsilon(1e-12));
        const Mean L = sample_pixel(load_world(scene), 40000, 19);
        if (tau == 30.0) {
            CHECK(L.mean() == 5.0); // a path gets through with probability 1e-13
        } else {
            const double z = L.z(expected);
            CHECK(std::abs(z) < 4.0);
        }
    }
}

TEST_CASE("the white furnace is exact per sample", "[cpu][reference]") {
    const double g = GENERATE(-0.5, 0.0, 0.85); // row 4
    vkvol::Volume v = volume(0.0, 1.5, g);
    vkvol::Scene scene = pixel_scene(v, 40.0);
    scene.background = vkvol::Rgb(0.75);
    scene.camera.position = {3.0, 7.0, 40.0};
    World world = make_world(scene, with_grid(random_grid(), v));
    vkvol::Volume ball = v;
    ball.shape = vkvol::Sphere{{3, 7, 5}, 3.0};
    for (int i = 0; i < 2000; ++i)
        REQUIRE(trace_path(world, 0, 0, i, 23) == vkvol::Rgb(0.75));
    world = make_world(scene, load(ball));
    for (int i = 0; i < 2000; ++i)
        REQUIRE(trace_path(world, 0, 0, i, 23) == vkvol::Rgb(0.75));

    // Row 5: with a limit the background is lost exactly where the limit was met.
    world.scene.settings.max_depth = 0;
    const Mean L = sample_pixel(world, 40000, 29);
    const double z = L.z(0.75 * std::exp(-1.5 * 6.0));
    CHECK(std::abs(z) < 4.0);
}

TEST_CASE("single scattering in a slab", "[cpu][reference]") {
    const double tau = GENERATE(1e-6, 0.3, 4.0); // rows 3 and 8
    const double g = GENERATE(0.0, 0.6);
    CAPTURE(tau, g);
    const vkvol::Volume v = box({1e5, 1e5, 1.0}, 0.3 * tau, 0.7 * tau, g);
    const glm::dvec3 away = glm::normalize(glm::dvec3(0.3, -0.4, 0.7));
    const bool below = GENERATE(false, true); // the light
    const double mu0 = away.z;
    const vkvol::DirectionalLight light{below ? -away : away, vkvol::Rgb(10.0)};
    const double p = hg_eval(g, glm::dot(light.direction, glm::dvec3(0, 0, -1)));
    const double expected = 10.0 * (below ? slab_single_transmission(0.7, p, tau, mu0, 1.0)
                                          : slab_single_reflection(0.7, p, tau, mu0, 1.0));
    const Ray ray{{0, 0, 10}, {0, 0, -1}};
    CHECK(single_scattering_quadrature(load(v), light, ray).x == Approx(expected).epsilon(1e-6));
    if (tau < 1e-3) {
        CHECK(expected == Approx(10.0 * 0.7 * p * tau).epsilon(1e-4));
        return;
    }
    vkvol::Scene scene = pixel_scene(v, 10.0);
    scene.lights = {light};
    scene.settings.max_depth = 1;
    const double z = sample_pixel(load_world(scene), 40000, 31).z(expected);
    CHECK(std::abs(z) < 4.0);
}

TEST_CASE("single scattering in a grid", "[cpu][reference]") {
    const vkvol::Volume v = volume(0.2, 0.6, 0.4);
    vkvol::Scene scene = pixel_scene(v, 20.0);
    const glm::dvec3 middle = skewed * glm::dvec3(3, 7, 5);
    scene.camera.position = {middle.x, middle.y, 20.0};
    scene.lights = {vkvol::DirectionalLight{glm::normalize(glm::dvec3(1, 2, -0.5)), vkvol::Rgb(3.0)},
                    vkvol::DirectionalLight{glm::normalize(glm::dvec3(-1, 0.3, 1)), vkvol::Rgb(4.0)}};
    scene.settings.max_depth = 1;
    const World world = make_world(scene, with_grid(random_grid(skewed), v));
    const Ray ray{world.scene.camera.position, {0, 0, -1}};
    double expected = 0.0, coarse = 0.0;
    for (const auto& light : world.scene.lights) {
        expected += single_scattering_quadrature(*world.medium, light, ray, 16).x;
        coarse += single_scattering_quadrature(*world.medium, light, ray, 8).x;
    }
    CHECK(coarse == Approx(expected).epsilon(1e-5));
    const double z = sample_pixel(world, 100000, 37).z(expected);
    CHECK(std::abs(z) < 4.0);
}

TEST_CASE("a semi-infinite medium", "[cpu][reference][long]") {
    // Row 7, Chandrasekhar. The medium is a cube of 2000 mean free paths, seen along the normal of a face.
    struct Case {
        double albedo, plane_albedo, reflection;
    };
    const Case c =
        GENERATE(Case{0.5, 0.115226, 0.031148}, Case{0.9, 0.414947, 0.122572}, Case{0.99, 0.752721, 0.240863});
    CHECK(plane_albedo(c.albedo) == Approx(c.plane_albedo).epsilon(1e-4));
    CHECK(normal_reflection(c.albedo) == Approx(c.reflection).epsilon(1e-4));

    vkvol::Scene scene = pixel_scene(box(glm::dvec3(2000.0), 1.0 - c.albedo, c.albedo), 1001.0);
    scene.background = vkvol::Rgb(1.0); // by reciprocity the light of a white sky that comes back is the plane albedo
    const double z_albedo = sample_pixel(load_world(scene), 60000, 41).z(plane_albedo(c.albedo));
    CHECK(std::abs(z_albedo) < 4.0);

    scene.background = vkvol::Rgb(0.0);
    scene.lights = {vkvol::DirectionalLight{{0, 0, 1}, vkvol::Rgb(1.0)}};
    const double z_reflection = sample_pixel(load_world(scene), 60000, 43).z(normal_reflection(c.albedo));
    CHECK(std::abs(z_reflection) < 4.0);
}

TEST_CASE("a conservative slab under Lambertian light", "[cpu][reference]") {
    // Row 6. Nothing is lost, so that reflection is the rest; the published values are known to their own error.
    struct Case {
        double tau, transmission, error;
    };
    const Case c =
        GENERATE(Case{1, 0.552, 0.002}, Case{5, 0.212, 0.002}, Case{10, 0.118, 0.001}, Case{20, 0.062, 0.001});
    const Medium medium = load(box({1e6, 1e6, c.tau}, 0.0, 1.0));
    Rng rng = stream(47);
    Mean transmitted;
    for (int i = 0; i < 40000; ++i) {
        const Draw first = rng.next();
        const double mu = std::sqrt(1.0 - first.x());
        Ray ray{{0, 0, 0.5 * c.tau}, {std::sqrt(1.0 - mu * mu), 0.0, -mu}};
        double flight = first.exponential(1);
        while (const auto t = fly(medium, FREE_FLIGHT_ANALYTIC, ray, flight, 0.0, vkvol::Rgb(1.0), {}, rng).t) {
            const Draw draw = rng.next();
            ray = {ray.at(*t), hg_sample(0.0, ray.direction, draw.y(), draw.z())};
            flight = draw.exponential(0);
        }
        transmitted.add(ray.direction.z < 0.0 ? 1.0 : 0.0);
    }
    CHECK(std::abs(transmitted.mean() - c.transmission) < c.error + 4.0 * transmitted.standard_error());
    if (c.tau >= 10.0)
        CHECK(transmitted.mean() ==
              Approx(diffuse_transmission_asymptote(c.tau)).margin(4.0 * transmitted.standard_error()));
}

TEST_CASE("a constant grid scatters like a homogeneous box", "[cpu][reference]") {
    // Row 32. Filtered by the nearest voxel, a constant grid of 8^3 voxels of edge 0.5 is a cube of edge 4.
    const auto preset = GENERATE("deltaTracking", "ratioTracking");
    const int cell = GENERATE(as<int>{}, one_cell, 3);
    vkvol::Volume v = box(glm::dvec3(4.0), 0.1, 0.9, 0.5);
    v.unit = vkvol::CoefficientUnit::world;
    v.Le = vkvol::Rgb(0.2);
    vkvol::Scene scene = pixel_scene(v, 10.0);
    scene.background = vkvol::Rgb(0.3);
    scene.lights = {vkvol::DirectionalLight{glm::normalize(glm::dvec3(1, 1, 1)), vkvol::Rgb(2.0)}};
    scene.settings.integrator = preset;
    World world = load_world(scene);
    const Mean homogeneous = sample_pixel(world, 60000, 53);
    Grid grid = make_grid(
        {0, 0, 0}, {7, 7, 7}, [](auto) { return 1.0; }, glm::dmat3(0.5), glm::dvec3(-1.75));
    build_majorants(grid, cell);
    world = make_world(scene, with_grid(std::move(grid), v, vkvol::Filter::nearest));
    const Mean heterogeneous = sample_pixel(world, 60000, 59);
    const double z = (homogeneous.mean() - heterogeneous.mean()) /
                     std::hypot(homogeneous.standard_error(), heterogeneous.standard_error());
    CHECK(std::abs(z) < 4.0);
}

TEST_CASE("a film does not depend on threads and merges by samples", "[cpu][reference]") {
    vkvol::Scene scene = pixel_scene(box(glm::dvec3(4.0), 0.1, 0.9), 10.0);
    scene.picture = {8, 6, 0.0, 0.0, 8.0, 6.0};
    scene.camera.fov = 40.0;
    scene.background = {1.0, 2.0, 3.0};
    const vkvol::Film all = render(scene, {0, 8, 0, 6}, 64, 61, 1);
    const vkvol::Film part = render(scene, {2, 7, 1, 5}, 64, 61, 3);
    const vkvol::Film a = render(scene, {0, 8, 0, 6}, 16, 61, 2);
    const vkvol::Film b = render(scene, {0, 8, 0, 6}, 48, 61, 2, 16);
    for (int y = 1; y < 5; ++y)
        for (int x = 2; x < 7; ++x)
            CHECK(part.mean[(y - 1) * 5 + (x - 2)] == all.mean[y * 8 + x]);
    for (std::size_t i = 0; i < all.pixel_count(); ++i) {
        CHECK(0.25f * a.mean[i].y + 0.75f * b.mean[i].y == Approx(all.mean[i].y));
        CHECK(all.samples[i] == 64);
    }
    scene.settings.integrator = "somethingElse";
    CHECK_THROWS(render(scene, {0, 8, 0, 6}, 1, 0, 1));
}
