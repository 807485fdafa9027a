// A render that is stopped and goes on from its checkpoint ends with the bits of one that never stopped, and no file
// that is not a whole checkpoint of the same render is taken for one.
#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <new>
#include <unistd.h>

#include "checkpoint.h"
#include "error.h"
#include "program.h"
#include "support/images.h"
#include "support/scenes.h"
#include "support/surface_scenes.h"
#include "support/test_device.h"
#include "support/thorough.h"

using namespace vkvol;

namespace {

std::filesystem::path temporary(const char* name) {
    return std::filesystem::temp_directory_path() / fmt::format("{}-{}", name, getpid());
}

RenderResult render_part(const Scene& scene, const RenderJob& job) {
    RenderJob part = job;
    part.crop = {0, scene.picture.width, 0, scene.picture.height};
    part.seed = 5;
    return render(test_device(), scene, part);
}

RenderCounts with_no_place(RenderCounts counts) {
    counts.room = 0; // what lanes could have done depends on when they came to rest
    return counts;
}

bool equal(const RenderCounts& a, const RenderCounts& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

// The last checkpoint of a scene's render.
Checkpoint checkpoint_of(const Scene& scene) {
    std::optional<Checkpoint> last;
    RenderJob job;
    job.checkpoint_seconds = 0.0;
    job.checkpoint = [&](const Checkpoint& checkpoint) { last = checkpoint; };
    render_part(scene, job);
    REQUIRE(last);
    return *last;
}

void check_not_continued(const Checkpoint& last, const Scene& other) {
    RenderJob rest;
    rest.resume = &last;
    CHECK_THROWS_WITH(render_part(other, rest), Catch::Contains("--resume: the checkpoint is of"));
}

} // namespace

TEST_CASE("a render resumed from any of its checkpoints has the same bits", "[gpu][checkpoint]") {
    const std::size_t band_rows = GENERATE(0u, 10u); // the film in one buffer, or in several
    const Schedule schedule = GENERATE(Schedule::fused, Schedule::staged);
    const Schedule resumed_by = GENERATE(Schedule::fused, Schedule::staged);
    if ((band_rows > 0) != (resumed_by == Schedule::staged) && !thorough())
        return; // each goes on from what either has kept, of one film or of bands
    Scene scene = sunlit_cloud(32, 9);
    if (band_rows > 0) {
        scene.volumes.push_back(medium(Sphere{{0.0, 0.0, 0.0}, 3.0}, 0.5, 0.5));
        scene.surfaces = {surface_of(BallSurface{{1.0, -1.5, 2.0}, 1.0}, MaterialKind::dielectric, 0.3),
                          surface_of(PlaneSurface{{0.0, -2.5, 0.0}, {0.0, 1.0, 0.0}}, MaterialKind::diffuse)};
    }
    RenderJob job;
    job.plan.schedule = schedule;
    job.plan.slots = 64;           // few, so that every checkpoint finds pixels left
    job.plan.submit_seconds = 0.0; // a round each, however fast the device
    job.plan.most_film_bytes = band_rows * 32 * sizeof(shared::FilmPixel);
    const RenderResult whole = render_part(scene, job);

    std::vector<Checkpoint> checkpoints;
    job.checkpoint = [&](const Checkpoint& checkpoint) { checkpoints.push_back(checkpoint); };
    job.checkpoint_seconds = 0.0;                               // after every submit
    CHECK(same_bits(render_part(scene, job).film, whole.film)); // keeping them changes nothing
    REQUIRE(checkpoints.size() > 4);
    std::size_t amid_bands = 0;
    // Odd: checkpoints between bands and amid them may come in turn.
    const std::size_t every = (checkpoints.size() / 8) | 1u;
    for (std::size_t i = 0; i < checkpoints.size(); i += every) {
        amid_bands += checkpoints[i].pixels.has_value();
        const auto file = temporary("vkvol-checkpoint-test");
        save_checkpoint(file, checkpoints[i]);
        const Checkpoint loaded = load_checkpoint(file);
        std::filesystem::remove(file);
        RenderJob rest = job;
        rest.checkpoint = nullptr;
        rest.resume = &loaded;
        rest.plan.slots = 512;
        rest.plan.schedule = resumed_by;
        const RenderResult resumed = render_part(scene, rest);
        CHECK((same_bits(resumed.film, whole.film) || !test_device().is_cpu()));
        const bool alike = schedule == Schedule::fused && resumed_by == schedule; // their batches end alike
        CHECK((equal(with_no_place(resumed.counts), with_no_place(whole.counts)) || !alike));
    }
    CHECK(amid_bands > 0);
}

TEST_CASE("an interrupted render keeps a checkpoint of all that is in the picture", "[gpu][checkpoint]") {
    const Scene scene = sunlit_cloud(32, 9);
    RenderJob job;
    job.plan.schedule = GENERATE(Schedule::fused, Schedule::staged);
    job.plan.slots = 64;
    job.plan.submit_seconds = 0.0; // a round each, however fast the device
    const RenderResult whole = render_part(scene, job);
    int asked = 0;
    std::optional<Checkpoint> last;
    job.interrupted = [&] { return ++asked > 7; };
    job.checkpoint_seconds = 1e9;
    job.checkpoint = [&](const Checkpoint& checkpoint) { last = checkpoint; };
    const RenderResult begun = render_part(scene, job);
    REQUIRE(begun.interrupted);
    REQUIRE(last);
    RenderJob rest;
    rest.plan.schedule = job.plan.schedule;
    rest.resume = &*last;
    CHECK(same_bits(render_part(scene, rest).film, whole.film));
    CHECK_FALSE(same_bits(begun.film, whole.film));
    // More samples may be asked for than at first, but not fewer than there are.
    RenderJob longer;
    longer.plan.schedule = job.plan.schedule;
    CHECK(same_bits(render_part(sunlit_cloud(32, 12), rest).film, render_part(sunlit_cloud(32, 12), longer).film));
    last->done = 10;
    CHECK_THROWS_WITH(render_part(scene, rest), Catch::Contains("--spp"));
}

TEST_CASE("a checkpoint that there is no memory for is left out, and told of once", "[gpu][checkpoint]") {
    const Scene scene = sunlit_cloud(32, 9);
    RenderJob job;
    job.plan.submit_seconds = 0.0;
    const RenderResult whole = render_part(scene, job);
    int asked = 0;
    job.checkpoint_seconds = 0.0;
    job.checkpoint = [&](const Checkpoint&) {
        ++asked;
        throw std::bad_alloc();
    };
    const RenderResult result = render_part(scene, job);
    CHECK(asked > 1);
    CHECK(same_bits(result.film, whole.film));
    REQUIRE(result.warnings.size() == 1);
    CHECK_THAT(result.warnings[0], Catch::Contains("a checkpoint was left out"));
}

TEST_CASE("a checkpoint is continued by its own render alone", "[gpu][checkpoint]") {
    Scene other = sunlit_cloud(32, 4);
    const Checkpoint last = checkpoint_of(other);
    SECTION("of the scene") {
        other.volumes.front().g = 0.4;
    }
    SECTION("of the integrator") {
        other.settings.integrator = "weightedTracking";
    }
    SECTION("of the density field") {
        GridRecipe recipe = cloud_grid();
        recipe.value = [](glm::ivec3 voxel) { return cloud_noise(voxel + 1); };
        other.volumes.front().shape = write_grid(recipe);
    }
    SECTION("of a single voxel, far below its majorant") {
        static glm::ivec3 faint;
        for (faint = {0, 0, -19}; cloud_noise(faint) == 0.0f || cloud_noise(faint) > 0.2f;)
            REQUIRE(++faint.z <= 10);
        GridRecipe recipe = cloud_grid();
        recipe.value = [](glm::ivec3 voxel) { return (voxel == faint ? 0.5f : 1.0f) * cloud_noise(voxel); };
        other.volumes.front().shape = write_grid(recipe);
    }
    SECTION("of one of several media") {
        other.volumes.push_back(medium(Sphere{{0.0, 0.0, 0.0}, 3.0}, 0.5, 0.5));
    }
    check_not_continued(last, other);
}

TEST_CASE("a checkpoint is continued by what is in its scene alone", "[gpu][checkpoint]") {
    Scene other = sunlit_cloud(32, 4);
    Checkpoint last;
    SECTION("of a lamp among others") {
        other.lights.push_back(SphereLight{{3.0, 4.0, 5.0}, 1.0, Rgb(2.0)});
        last = checkpoint_of(other);
        other.lights.back() = SphereLight{{3.0, 4.0, 5.0}, 1.0, Rgb(2.0, 2.0, 2.1)};
    }
    SECTION("of the grid of albedos") {
        GridRecipe albedo = cloud_grid();
        albedo.name = "Cd";
        albedo.value = [](glm::ivec3 voxel) { return 0.5f + 0.5f * cloud_noise(voxel); };
        other.volumes.front().shape = write_grids({cloud_grid(), albedo});
        other.volumes.front().albedo_grid = "Cd";
        last = checkpoint_of(other);
        albedo.value = [](glm::ivec3 voxel) { return 0.5f + 0.5f * cloud_noise(voxel + 1); };
        other.volumes.front().shape = write_grids({cloud_grid(), albedo});
    }
    SECTION("of what a map's points emit") {
        other.volumes.front().map.is_transfer = true;
        other.volumes.front().map.points = {{0.0, 0.0}, {1.0, 1.0, Rgb(0.5), Rgb(1.0)}};
        last = checkpoint_of(other);
        other.volumes.front().map.points.back().emission = Rgb(5.0);
    }
    SECTION("of what one of several media is") {
        other.volumes.push_back(medium(Sphere{{0.0, 0.0, 0.0}, 3.0}, 0.5, 0.5));
        last = checkpoint_of(other);
        other.volumes.back().g = 0.1;
    }
    check_not_continued(last, other);
}

TEST_CASE("a checkpoint is continued where it was made, from where it ended", "[gpu][checkpoint]") {
    const Scene scene = sunlit_cloud(32, 4);
    Checkpoint last = checkpoint_of(scene);
    RenderJob rest;
    rest.resume = &last;
    SECTION("of the samples' range") {
        rest.sample_offset = 1;
    }
    SECTION("of the program") {
        CHECK_THAT(last.identity.program, Catch::Contains("kernels " + kernels_digest()));
        CHECK(kernels_digest().size() == 16);
        last.identity.program += "x";
    }
    SECTION("of the device") {
        last.identity.device += "x";
    }
    CHECK_THROWS_WITH(render_part(scene, rest), Catch::Contains("--resume: the checkpoint is of"));
}

TEST_CASE("damaged checkpoints are refused", "[cpu][checkpoint]") {
    Checkpoint checkpoint;
    checkpoint.identity = {"kernel", "program", "device", {3, 2}};
    checkpoint.done = 7;
    checkpoint.pixels = {1, 2, 3};
    checkpoint.film.resize(20);
    checkpoint.film[3].sum.y = 0.1f;
    checkpoint.counts.lookups = 1ull << 40;
    checkpoint.non_finite = {{4, 5, 6}};
    checkpoint.seconds = 1.5;
    checkpoint.schedule = Schedule::staged;
    const auto file = temporary("vkvol-damaged-checkpoint");
    save_checkpoint(file, checkpoint);
    const Checkpoint same = load_checkpoint(file);
    CHECK(same.identity == checkpoint.identity);
    CHECK((same.done == 7 && same.batch == 0 && same.band == 0));
    CHECK(same.pixels == checkpoint.pixels);
    CHECK((same.film.size() == 20 && same.film[3].sum.y == 0.1f));
    CHECK(same.counts.lookups == 1ull << 40);
    CHECK((same.non_finite.size() == 1 && same.non_finite[0].sample == 6));
    CHECK(same.seconds == 1.5);
    CHECK(same.schedule == Schedule::staged);

    std::ifstream stream(file, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    const auto refused = [&](const std::string& damaged) {
        std::ofstream(file, std::ios::binary) << damaged;
        CHECK_THROWS_AS(load_checkpoint(file), InputError);
    };
    for (const std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{12}, bytes.size() / 2, bytes.size() - 1})
        refused(bytes.substr(0, size));
    for (std::size_t i = 0; i < bytes.size(); i += 13) {
        std::string damaged = bytes;
        damaged[i] = static_cast<char>(damaged[i] ^ 1);
        refused(damaged);
    }
    std::filesystem::remove(file);
    CHECK_THROWS_AS(load_checkpoint(file), InputError);
}

TEST_CASE("checkpoints of other versions are told from other files", "[cpu][checkpoint]") {
    const auto file = temporary("vkvol-old-checkpoint");
    std::ofstream(file, std::ios::binary) << "vkvolch5" << std::string(100, '\0');
    CHECK(is_checkpoint(file));
    CHECK_THROWS_WITH(load_checkpoint(file), Catch::Contains("another version of vkvol wrote it"));
    std::filesystem::remove(file);
}
