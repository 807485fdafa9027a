// The scalar reference: grids, their majorants, their files, and integrals through them.
#include <catch2/catch.hpp>
#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/IO.h>

#include <unistd.h>

#include "tests/reference/test_media.h"

using namespace reference;

TEST_CASE("a trilinear grid reaches one voxel beyond its active box", "[cpu][reference]") {
    // Row 18: a constant N^3 grid, ray along an axis: tau = sigma v N h.
    const Grid constant = make_grid(
        {0, 0, 0}, {4, 4, 4}, [](auto) { return 2.0; }, glm::dmat3(0.5));
    for (const auto unit : {vkvol::CoefficientUnit::voxel, vkvol::CoefficientUnit::world}) {
        vkvol::Volume v = volume(0.3, 0.4);
        v.unit = unit;
        const Medium medium = with_grid(constant, v);
        const double per_world = unit == vkvol::CoefficientUnit::world ? 0.7 : 0.7 / 0.5;
        CHECK(optical_depth(medium, {{1, 1, -50}, {0, 0, 1}}, 0, infinity) == Approx(per_world * 2.0 * 5 * 0.5));
        CHECK(optical_depth(medium, {{-50, 1, 1}, {1, 0, 0}}, 0, infinity) == Approx(per_world * 2.0 * 5 * 0.5));
        CHECK(optical_depth(medium, {{-50, 1, 2.25}, {1, 0, 0}}, 0, infinity) == Approx(per_world * 2.0 * 5 * 0.25));
    }
    // Row 14: a single voxel v has the area of a hat, v h; as a nearest-filtered box the same.
    const Grid spike = make_grid({7, 7, 7}, {7, 7, 7}, [](auto) { return 3.0; });
    for (const auto filter : {vkvol::Filter::trilinear, vkvol::Filter::nearest}) {
        const Medium medium = with_grid(spike, volume(0.5, 0.0), filter);
        CHECK(optical_depth(medium, {{7, 7, 0}, {0, 0, 1}}, 0, infinity) == Approx(0.5 * 3.0));
    }
    // Rows 13 and 17.
    CHECK(make_grid({0, 0, 0}, {-1, -1, -1}, [](auto) { return 1.0; }).empty());
    const Medium none = with_grid(Grid{}, volume(1, 1));
    CHECK(transmittance_quadrature(none, {{0, 0, 0}, {0, 0, 1}}, 0, infinity) == 1.0);
    for (const double bad : {-1.0, double(NAN), infinity, -infinity})
        CHECK(make_grid({0, 0, 0}, {0, 0, 0}, [=](auto) { return bad; }).voxel({0, 0, 0}) == 0.0);
}

TEST_CASE("majorants bound the interpolated density", "[cpu][reference]") {
    Grid grid = random_grid();
    const int cell = GENERATE(as<int>{}, one_cell, 1, 3, 8);
    build_majorants(grid, cell);
    Rng rng = stream(7);
    const glm::dvec3 lower(grid.lower), extent(grid.size - 1);
    for (int i = 0; i < 300; ++i) {
        const Draw a = rng.next();
        const Ray ray{lower + extent * glm::dvec3(a.x(), a.y(), a.z()), hg_sample(0.0, {0, 0, 1}, a.w(), a.tap().z)};
        const Interval inside = grid.support(ray);
        MajorantWalk walk(grid, ray, inside);
        MajorantSegment segment;
        double t = inside.t0;
        while (walk.next(segment)) {
            REQUIRE(segment.t0 == t);
            t = segment.t1;
            for (int k = 0; k < 5; ++k) {
                const glm::dvec3 p = ray.at(segment.t0 + (segment.t1 - segment.t0) * (k + 0.5) / 5.0);
                REQUIRE(grid.trilinear(p) <= segment.majorant + 1e-12);
                REQUIRE(grid.nearest(p) <= segment.majorant);
            }
        }
        REQUIRE(t == Approx(inside.t1).epsilon(1e-12));
    }
}

TEST_CASE("the quadrature equals a fine Riemann sum under any affine transform", "[cpu][reference]") {
    const glm::dvec3 translation(100.0, -20.0, 3.0);
    const auto filter = GENERATE(vkvol::Filter::trilinear, vkvol::Filter::nearest);
    const Medium medium = with_grid(random_grid(skewed, translation), volume(0.4, 0.8), filter);
    const glm::dvec3 middle = skewed * glm::dvec3(3, 7, 5) + translation;
    const double world_sigma_t = 1.2 / std::cbrt(std::abs(glm::determinant(skewed)));
    Rng rng = stream(9);
    for (int i = 0; i < 10; ++i) {
        const Draw a = rng.next();
        const glm::dvec3 d = hg_sample(0.0, {0, 0, 1}, a.x(), a.y());
        const Ray ray{middle - 20.0 * d + a.z(), d};
        double sum = 0.0;
        constexpr int n = 400000;
        for (int k = 0; k < n; ++k) // world distance: 40 units
            sum += medium.density(medium.grid()->to_index(ray.at(40.0 * (k + 0.5) / n))) * 40.0 / n;
        const double epsilon = filter == vkvol::Filter::nearest ? 1e-3 : 1e-7;
        CHECK(optical_depth(medium, ray, 0.0, infinity) == Approx(world_sigma_t * sum).epsilon(epsilon));
    }
}

TEST_CASE("grids are read from .nvdb files", "[cpu][reference]") {
    const auto folder = std::filesystem::temp_directory_path() / ("reference_test_" + std::to_string(::getpid()));
    std::filesystem::create_directory(folder);
    const auto path = folder / "random.nvdb";
    const Grid expected = random_grid();

    const auto round_trip = [&]<typename Build>(Build, double tolerance, nanovdb::io::Codec codec) {
        nanovdb::GridBuilder<float, Build> builder(0.0f);
        auto accessor = builder.getAccessor();
        for (int k = 0; k <= 10; ++k)
            for (int j = 2; j <= 12; ++j)
                for (int i = -3; i <= 9; ++i)
                    accessor.setValue(nanovdb::Coord(i, j, k), static_cast<float>(expected.voxel({i, j, k})));
        const auto handle = builder.getHandle(0.25, nanovdb::Vec3d(1, 2, 3), "density",
                                              nanovdb::AbsDiff(static_cast<float>(tolerance)));
        nanovdb::io::writeGrid(path.string(), handle, codec);

        vkvol::Volume v = volume(1, 1);
        v.shape = vkvol::GridFile{path, "density"};
        const Medium medium = load(v);
        const Grid& grid = *medium.grid();
        CHECK(grid.lower == expected.lower);
        CHECK(grid.size == expected.size);
        CHECK(grid.voxel_length() == Approx(0.25));
        CHECK(medium.sigma_t.x == Approx(8.0));
        CHECK(glm::distance(grid.translation, glm::dvec3(1, 2, 3)) < 1e-12);
        double worst = 0.0;
        for (std::size_t i = 0; i < grid.values.size(); ++i)
            vkvol::worsen(worst, std::abs(double(grid.values[i]) - expected.values[i]));
        CHECK(worst <= tolerance);
    };
    using nanovdb::io::Codec;
    round_trip(float{}, 0.0, Codec::ZIP); // the values lie in [0, 2]: a quantum is 2 / (2^bits - 1)
    round_trip(nanovdb::Fp16{}, 2.0 / 65535, Codec::BLOSC);
    round_trip(nanovdb::Fp8{}, 2.0 / 255, Codec::NONE);
    round_trip(nanovdb::Fp4{}, 2.0 / 15, Codec::NONE);
    round_trip(nanovdb::FpN{}, 0.01, Codec::NONE);

    CHECK_THROWS(load_grid(path, "temperature"));
    CHECK_THROWS(load_grid(folder / "missing.nvdb", "density"));
    CHECK_THROWS(load_grid(folder / "field.vdb", "density"));
    std::filesystem::remove_all(folder);
}
