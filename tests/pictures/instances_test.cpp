// The same grid in many media: that it is read and uploaded once, and that pictures do not tell; and small media in
// wide ones, over which cells have two sizes.
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "error.h"
#include "frame_params.h"
#include "loaded_medium.h"
#include "overlap_words.h"
#include "scene_hash.h"
#include "support/agreement.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "tests/reference/camera.h"
#include "tests/reference/medium.h"
#include "upload_layout.h"

using namespace vkvol;
using Catch::Contains;

namespace {

Scene lit_scene(std::vector<Volume> volumes, double width, double distance) {
    Scene scene = scene_of(volumes.front(), width, 16, distance, glm::dvec3(0.0), {10.0, 25.0, -5.0});
    scene.volumes = std::move(volumes);
    scene.background = {0.1, 0.2, 0.4};
    scene.lights = {sunlight({1.0, 0.9, 0.8})};
    scene.settings.spp = 128;
    return scene;
}

glm::dmat4 placed(glm::dvec3 to, double angle, glm::dvec3 scale) {
    return glm::translate(glm::dmat4(1.0), to) *
           glm::rotate(glm::dmat4(1.0), angle, glm::normalize(glm::dvec3(1, 2, 3))) *
           glm::scale(glm::dmat4(1.0), scale);
}

Volume instance(const GridFile& file, const glm::dmat4& transform, double sigma_t = 1.5) {
    Volume volume = medium(file, sigma_t, 0.9, 0.2);
    volume.transform = transform;
    return volume;
}

// Turned, mirrored, flattened, of other densities, and in one another.
std::vector<Volume> cluster(const GridFile& file) {
    std::vector<Volume> volumes;
    volumes.push_back(instance(file, placed({0.0, 0.0, 0.0}, 0.0, glm::dvec3(0.3))));
    volumes.push_back(instance(file, placed({1.6, 0.9, -0.5}, 1.1, {0.3, -0.2, 0.3}), 2.5));
    volumes.push_back(instance(file, placed({-1.5, -0.8, 0.9}, 2.3, {-0.25, 0.3, 0.2}), 0.8));
    volumes.push_back(instance(file, placed({0.7, -1.1, 0.2}, -0.7, glm::dvec3(0.2)), 3.0));
    volumes[1].g = -0.3;
    volumes[2].phase = PhaseFunction::rayleigh;
    return volumes;
}

std::vector<Volume> field(const GridFile& file, int edge) {
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    std::vector<Volume> volumes;
    for (int i = 0; i < edge * edge * edge; ++i) {
        const glm::dvec3 place(i % edge, i / edge % edge, i / edge / edge);
        const glm::dvec3 aside(part(engine), part(engine), part(engine));
        volumes.push_back(instance(file, placed(10.0 * place + aside, 3.0 * part(engine), glm::dvec3(0.8))));
    }
    return volumes;
}

// A small cloud amid haze a hundred times as wide. `haze`: its sigma_t.
Scene cloud_in_haze(double haze = 0.03) {
    const GridFile file = write_grids({cloud_grid()});
    std::vector<Volume> volumes{instance(file, placed({0.0, 0.0, 0.0}, 0.4, glm::dvec3(0.05)), 20.0),
                                instance(file, placed({0.35, 0.1, 0.05}, 1.4, glm::dvec3(0.04)), 30.0)};
    volumes.push_back(medium(Box{{3.0, -2.0, 1.0}, {30.0, 26.0, 34.0}}, haze, 0.8, 0.5));
    volumes.back().transform = placed({0.0, 0.0, 0.0}, 0.3, glm::dvec3(1.0));
    Scene scene = lit_scene(volumes, 0.9, 2.0);
    scene.settings.majorant_cell = 4;
    return scene;
}

} // namespace

TEST_CASE("instances of a grid equal the reference's copies", "[gpu][image][several]") {
    const GridFile file = write_grids({cloud_grid()});
    Scene scene = lit_scene(cluster(file), 5.0, 12.0);
    CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_reference(scene, 2), "cluster"));
    scene.settings.integrator = "cachedRatioTracking";
    CHECK_AGREEMENT(agree(render_here(scene, 3).film, render_reference(scene, 4), "cached"));
    // Beside a grid of another kind they have no grid in common.
    scene.volumes.push_back(
        instance(write_grids({cloud_grid(Storage::fp8)}), placed({0.2, 0.6, 0.6}, 0.5, glm::dvec3(0.2))));
    CHECK_AGREEMENT(agree(render_here(scene, 5).film, render_reference(scene, 6), "two grids"));
}

TEST_CASE("a file and its copy give the same bits as the file twice, but take twice its memory",
          "[gpu][image][several][long]") {
    const GridFile file = write_grids({cloud_grid()}), copy = write_grids({cloud_grid()});
    REQUIRE(file.path != copy.path);
    Scene once = lit_scene(cluster(file), 5.0, 12.0);
    once.settings.spp = 16;
    once.settings.majorant_cell = 8; // else as suits the first that has the grid
    Scene twice = once;
    twice.volumes[1].shape = copy;
    twice.volumes[2].shape = copy;
    const RenderResult shared = render_here(once, 1), apart = render_here(twice, 1);
    CHECK(shared.film.mean == apart.film.mean);
    CHECK(shared.media.media == 4);
    CHECK(shared.media.grids == 4);
    CHECK(shared.media.distinct_grids == 1);
    CHECK(apart.media.distinct_grids == 2);
    CHECK(apart.media.grid_bytes == 2 * shared.media.grid_bytes);
    CHECK(apart.device_bytes >= shared.device_bytes + shared.media.grid_bytes);
}

TEST_CASE("a thousand instances are read, bounded and uploaded once", "[cpu][several]") {
    GridRecipe heat = cloud_grid();
    heat.name = "temperature";
    heat.value = [](glm::ivec3 i) { return 1.5f * cloud_noise(i + 40); };
    const GridFile file = write_grids({cloud_grid(), heat});
    Scene scene = lit_scene(field(file, 10), 100.0, 400.0);
    for (Volume& volume : scene.volumes) {
        volume.temperature.model = TemperatureEmission::Model::blackbody;
        volume.temperature.color = Rgb(1.0);
        volume.temperature.scale = 900.0;
    }
    const Method method = choose_method(scene);
    const Assets assets = load_assets(scene, method);
    REQUIRE(assets.media.size() == 1000);
    const LoadedMedium& first = assets.media.front();
    for (const LoadedMedium& medium : assets.media) {
        CHECK(medium.field->bytes.data() == first.field->bytes.data());
        CHECK(medium.field->leaf_table.data() == first.field->leaf_table.data());
        CHECK(medium.majorants == first.majorants);
        CHECK(medium.temperature->bytes.data() == first.temperature->bytes.data());
        CHECK(medium.blackbody.data() == first.blackbody.data());
    }
    const UploadLayout layout(assets.media);
    CHECK(layout.grids().size() == 2);
    CHECK(layout.leaf_tables().size() == 2);
    CHECK(layout.blackbodies().size() == 1);
    CHECK(layout.grids()[0].data() == first.field->bytes.data());
    CHECK(layout.place_of(*first.temperature).first_word == first.field->bytes.size() / 4);
    const Superposition& whole = *assets.superposition;
    CHECK(whole.most_overlaps < 30);
    std::vector<bool> listed(1000, false);
    for (std::size_t i = whole.entries() + 1; i < whole.overlaps.size(); ++i)
        listed[whole.overlaps[i]] = true;
    CHECK(std::count(listed.begin(), listed.end(), true) == 1000);
    const auto rows = make_media(scene, assets.media, method, render_origin(scene, assets.media, &whole));
    const OverlapWords words = overlap_words(rows, assets.media, whole);
    CHECK(words.places.bricks == 1001 * 16); // a row each, and one of the grid
    CHECK(words.grid.first_word == 0);
}

TEST_CASE("a grid used twice within a medium is there once", "[cpu][several]") {
    Scene scene = lit_scene({instance(write_grids({cloud_grid()}), glm::dmat4(1.0))}, 11.0, 20.0);
    scene.volumes.front().temperature.color = Rgb(1.0);
    scene.volumes.front().temperature.grid = "density";
    const Assets assets = load_assets(scene, choose_method(scene));
    CHECK(grids_of(assets.media.front()).size() == 2);
    CHECK(distinct_grids(assets.media).size() == 1);
    CHECK(UploadLayout(assets.media).grids().size() == 1);
}

TEST_CASE("small media in wide ones have cells of their own, which bound the sum of all", "[cpu][several]") {
    const Scene scene = cloud_in_haze();
    const Assets assets = load_assets(scene, choose_method(scene));
    const Superposition& whole = *assets.superposition;
    REQUIRE(whole.bits > 0);
    REQUIRE(!whole.brick_bounds.empty());
    CHECK(whole.edge <= 4.0 * 0.3 * 0.05); // as the clouds have them by themselves
    std::vector<reference::Medium> media;
    for (const Volume& volume : scene.volumes)
        media.push_back(reference::load(volume));
    const std::vector<float> walked = walked_bounds(whole);
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> part(0.0, 1.0);
    std::size_t coarse = 0, fine = 0, met = 0;
    for (int n = 0; n < 40000; ++n) {
        const glm::dvec3 u(part(engine), part(engine), part(engine));
        const glm::dvec3 near = (glm::mix(glm::dvec3(-0.5), glm::dvec3(0.7), u) - whole.origin) / whole.edge;
        const glm::dvec3 p = n % 2 == 0 ? glm::mix(whole.low(), whole.high(), u) : near;
        const std::size_t entry = whole.entry_of(glm::ivec3(glm::floor(p)) - whole.cells.origin);
        const auto list = whole.list(entry);
        const reference::Ray ray{whole.origin + whole.edge * p, {0.0, 0.0, 1.0}};
        double sum = 0.0;
        for (std::uint32_t k = 0; k < media.size(); ++k) {
            const auto parts = support(media[k], ray);
            const bool inside = !parts.empty() && parts.front().t0 == 0.0;
            const double sigma_t = inside ? media[k].largest() * reference::DensityAlong(media[k], ray)(0.0) : 0.0;
            sum += sigma_t;
            met += sigma_t > 0.0;
            if (sigma_t > 0.0)
                CHECK(std::find(list.begin(), list.end(), k) != list.end());
        }
        CHECK(sum <= whole.bound(entry));
        CHECK((sum == 0.0 || walked[entry] == whole.bound(entry)));
        (entry < whole.cells.bounds.size() ? coarse : fine) += 1;
    }
    CHECK(coarse > 10000);
    CHECK(fine > 10000);
    CHECK(met > 10000);
}

TEST_CASE("volumes are where single precision tells their parts apart", "[cpu][several]") {
    const auto loads = [](const Volume& first, const Volume& second) {
        Scene scene = scene_of(first, 10.0, 8);
        scene.volumes.push_back(second);
        load_assets(scene, choose_method(scene));
    };
    const Volume flat = medium(Box{{0.0, 0.0, 0.0}, {1e5, 1.0, 1e5}}, 1e-4, 0.5);
    CHECK_NOTHROW(loads(flat, medium(Box{{0.0, 1.0, 0.0}, {1e5, 1.0, 1e5}}, 1e-4, 0.5)));
    // Voxels of 0.3, of which a quarter is 2^-24 of 1.26e6.
    const Volume cloud = medium(write_grid(cloud_grid()), 1.0, 0.8);
    Volume other = cloud;
    other.transform = glm::translate(glm::dmat4(1.0), {1e6, 0.0, 0.0});
    CHECK_NOTHROW(loads(cloud, other));
    other.transform = glm::translate(glm::dmat4(1.0), {5e6, 0.0, 0.0});
    CHECK_THROWS_WITH(loads(cloud, other), Contains("move the volumes together"));
}

TEST_CASE("reaches of cells in bricks end where anything is", "[cpu][several]") {
    Scene scene = cloud_in_haze();
    scene.volumes.pop_back();
    scene.volumes.push_back(medium(Sphere{{14.0, 13.0, -15.0}, 3.0}, 0.5, 0.5));
    const Assets assets = load_assets(scene, choose_method(scene));
    const Superposition& whole = *assets.superposition;
    REQUIRE(whole.bits > 0);
    REQUIRE(whole.cells.leaps);
    const std::vector<float> walked = walked_bounds(whole);
    std::mt19937 engine(3);
    std::size_t leaps = 0;
    for (std::size_t i = 0; i < whole.bricks.size(); ++i) {
        if (whole.bricks[i] == 0)
            continue;
        const int z = int(i) % whole.cells.dims.z, y = int(i) / whole.cells.dims.z % whole.cells.dims.y;
        const glm::ivec3 coarse(int(i) / whole.cells.dims.z / whole.cells.dims.y, y, z);
        for (int n = 0; n < 50; ++n) {
            const auto any = [&] { return int(engine() >> (32 - whole.bits)); };
            const glm::ivec3 cell = (coarse << whole.bits) + glm::ivec3(any(), any(), any());
            const std::size_t entry = whole.entry_of(cell);
            if (whole.bound(entry) > 0.0f)
                continue;
            const int reach = int(-walked[entry]);
            leaps += reach > 0;
            for (int x = -reach; x <= reach; ++x)
                for (int dy = -reach; dy <= reach; ++dy)
                    for (int dz = -reach; dz <= reach; ++dz) {
                        const glm::ivec3 other = cell + glm::ivec3(x, dy, dz);
                        if (other == glm::clamp(other, glm::ivec3(0), whole.dims() - 1) &&
                            whole.bound(whole.entry_of(other)) > 0.0f)
                            FAIL("a reach has matter in it");
                    }
        }
    }
    CHECK(leaps > 100);
}

TEST_CASE("small clouds in a wide haze equal the reference", "[gpu][image][several]") {
    Scene scene = cloud_in_haze();
    CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_reference(scene, 2), "haze"));
    // So thick that walks often collide in its large cells: which have to end where smaller ones begin.
    CHECK_AGREEMENT(agree(render_here(cloud_in_haze(1.0), 9).film, render_reference(cloud_in_haze(1.0), 10), "thick"));
    scene.settings.integrator = "cachedRatioTracking";
    CHECK_AGREEMENT(agree(render_here(scene, 3).film, render_reference(scene, 4), "cached"));
    scene.settings.integrator = "ratioNEE"; // a shadow ray from every null collision
    scene.settings.spp = 64;
    CHECK_AGREEMENT(agree(render_here(scene, 5).film, render_reference(scene, 6), "every tentative collision"));
    scene.volumes.pop_back(); // empty space between the clouds and a ball
    scene.volumes.push_back(medium(Sphere{{14.0, 13.0, -15.0}, 3.0}, 0.5, 0.5));
    scene.settings.integrator = "";
    CHECK_AGREEMENT(agree(render_here(scene, 7).film, render_reference(scene, 8), "far apart"));
}

// Seen upward along all axes, through haze of hardly any matter, whose coarse cells are entered amid their sides. A
// walk that took them to end as far from there as they are long would pass over the first cells of bricks: there the
// solid has its faces, a tenth of a unit beyond the coarse cells'.
TEST_CASE("coarse cells end where bricks begin, wherever they are entered", "[gpu][image][several]") {
    GridRecipe solid = cloud_grid();
    solid.value = [](glm::ivec3) { return 1.0f; };
    std::vector<Volume> volumes{instance(write_grid(solid), placed({-0.33, -0.51, -0.42}, 0.0, glm::dvec3(0.3)), 1.0)};
    volumes.push_back(medium(Box{{0.0, 0.0, 0.0}, {60.0, 60.0, 60.0}}, 1e-3, 0.0));
    Scene scene = scene_of(volumes.front(), 4.0, 16, 20.0, glm::dvec3(0.0), {35.0, 225.0, 0.0});
    scene.volumes = volumes;
    scene.background = Rgb(1.0);
    scene.settings.spp = 128;
    scene.settings.majorant_cell = 4;
    const glm::dvec3 along = reference::camera_ray(scene.camera, scene.picture, 8.0, 8.0).direction;
    REQUIRE(glm::all(glm::greaterThan(along, glm::dvec3(0.5))));
    const Assets assets = load_assets(scene, choose_method(scene));
    const double coarse = assets.superposition->edge * assets.superposition->cells.cell;
    REQUIRE(assets.superposition->bits > 0);
    REQUIRE(std::abs(coarse - 0.9375) < 1e-6); // two of them to the solid's faces, but for the tenth
    CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_reference(scene, 2), "from below"));
}

TEST_CASE("volumes of another shape leave what is of another kind of density", "[cpu][xml][several]") {
    const std::string noise = "<volume name='a'><sphere/><noise/><sigma_s>2</sigma_s></volume>";
    const std::string layers = "<volume name='a'><box/><layers scaleHeight='1'/></volume>";
    const std::string map = "<volume name='a'><densityField>c.nvdb</densityField><densityMap gain='2'/></volume>";
    const std::string transfer = "<volume name='a'><densityField>c.nvdb</densityField><sigma_s>2</sigma_s></volume>";
    const Scene grid = parse_volumes(noise + "<volume like='a'><densityField>c.nvdb</densityField></volume>");
    CHECK_FALSE(grid.volumes.at(1).noise);
    CHECK(grid.volumes.at(1).sigma_s == Rgb(2.0));
    CHECK(parse_volumes(noise + "<volume like='a'><box/></volume>").volumes.at(1).noise);
    CHECK_FALSE(parse_volumes(layers + "<volume like='a'><sphere/></volume>").volumes.at(1).layers);
    CHECK_FALSE(parse_volumes(map + "<volume like='a'><sphere/></volume>").volumes.at(1).map.exists());
    CHECK(parse_volumes(transfer +
                        "<volume like='a'><transferFunction><point value='1' sigma_t='3'/></transferFunction>"
                        "</volume>")
              .volumes.at(1)
              .sigma_s == Rgb(1.0));
    CHECK_THROWS_AS(parse_volumes(map + "<volume like='a'><sphere/><densityMap gain='3'/></volume>"), InputError);
}

TEST_CASE("of what excludes each other the nearer counts", "[cpu][xml][several]") {
    const auto like = [](const std::string& first, const std::string& second) {
        return parse_volumes("<volume name='a'>" + first + "</volume><volume like='a'>" + second + "</volume>")
            .volumes.at(1);
    };
    const std::string grid = "<densityField>c.nvdb</densityField>", map = "<densityMap gain='2'/>",
                      transfer = "<transferFunction><point value='1' sigma_t='3'/></transferFunction>",
                      layers = "<layers scaleHeight='1'/>";
    CHECK(like(grid + map, transfer).map.is_transfer);
    CHECK_FALSE(like(grid + transfer, map).map.is_transfer);
    CHECK(like(grid + transfer, map).map.exists());
    CHECK_THROWS_AS(like(grid, map + transfer), InputError);
    CHECK(like("<box/><noise/>", layers).layers);
    CHECK_FALSE(like("<box/><noise/>", layers).noise);
    CHECK(like("<box/>" + layers, "<noise/>").noise);
    CHECK_FALSE(like("<box/>" + layers, "<noise/>").layers);
    CHECK_THROWS_AS(like("<box/>", "<noise/>" + layers), InputError);
    // A grid without a file would be of none.
    for (const char* nameless : {"<densityField grid='d'/>", "<densityField velocity='v'/>"}) {
        CHECK_THROWS_WITH(like(grid, nameless), Contains("names a grid and no file"));
        CHECK_THROWS_WITH(like("<sphere/>" + std::string(nameless), ""), Contains("names a grid and no file"));
    }
}

TEST_CASE("volumes that are like another", "[cpu][xml][several]") {
    const std::string cloud = R"(<volume name="a"><sphere radius="2"/><noise/><sigma_s>3</sigma_s>
        <transform><scale y="2"/></transform></volume>)";
    const Scene scene = parse_volumes(R"(<volume name="c" like="b"><sigma_s>5</sigma_s>
        <transform><translate x="1"/></transform></volume>)" +
                                      cloud + R"(
        <volume name="b" like="a"><phase>rayleigh</phase><transform><rotate z="1" angle="90"/></transform></volume>
        <volume like="a"/><volume like="a"><box/></volume>)");
    REQUIRE(scene.volumes.size() == 5);
    const Volume &c = scene.volumes[0], &a = scene.volumes[1], &b = scene.volumes[2];
    for (const Volume* volume : {&a, &b, &c}) {
        CHECK(std::get<Sphere>(volume->shape).radius == 2.0);
        CHECK(volume->noise);
    }
    CHECK(a.sigma_s == Rgb(3.0));
    CHECK(b.sigma_s == Rgb(3.0));
    CHECK(c.sigma_s == Rgb(5.0));
    CHECK(a.phase == PhaseFunction::henyey_greenstein);
    CHECK(c.phase == PhaseFunction::rayleigh);
    // Stretched, then turned to -x, then moved.
    CHECK(glm::distance(glm::dvec3(c.transform * glm::dvec4(0, 1, 0, 1)), glm::dvec3(-1.0, 0.0, 0.0)) < 1e-12);
    CHECK(scene.volumes[3].transform == a.transform);
    CHECK(std::holds_alternative<Box>(scene.volumes[4].shape));
    CHECK(scene.volumes[4].sigma_s == Rgb(3.0));
    CHECK(scene_hash(parse_volumes(cloud + "<volume like='a'><transform><translate x='1'/></transform></volume>")) ==
          scene_hash(parse_volumes(cloud + R"(<volume><sphere radius="2"/><noise/><sigma_s>3</sigma_s>
              <transform><scale y="2"/><translate x="1"/></transform></volume>)")));
    // What is read for several is warned of once.
    CHECK(parse_volumes("<volume name='a'><sphere/><albedo grid='Cd'/></volume><volume like='a'/><volume like='a'/>")
              .warnings.size() == 1);

    const std::pair<const char*, const char*> bad[] = {
        {"<volume name='cloud'><sphere/></volume><volume like='clod'/>",
         "no volume is named 'clod'; did you mean cloud?"},
        {"<volume><sphere/></volume><volume like='sea'/>", "no volume is named 'sea'"},
        {"<volume like=''><sphere/></volume>", "no volume is named ''"},
        {"<volume name='a' like='a'><sphere/></volume>", "in the end like this one itself"},
        {"<volume name='a' like='b'/><volume name='b' like='c'/><volume name='c' like='a'><sphere/></volume>",
         "in the end like this one itself"},
        {"<volume name='a'><sphere/></volume><volume name='a'><box/></volume><volume like='a'/>",
         "two volumes are named"},
        {"<volume name='a'/><volume like='a'/>", "no shape"},
        {"<volume name='a'><sphere/><transform><scale value='1e-5'/></transform></volume>"
         "<volume like='a'><transform><scale value='1e-5'/></transform></volume>",
         "leaves nothing"},
    };
    for (const auto& [text, message] : bad) {
        INFO(text);
        CHECK_THROWS_WITH(parse_volumes(text), Contains(message));
    }
    std::string chain = "<volume name='0'><sphere/></volume>";
    for (int i = 1; i <= 70; ++i)
        chain += fmt::format("<volume name='{}' like='{}'/>", i, i - 1);
    CHECK_THROWS_WITH(parse_volumes(chain), Contains("more than 64 volumes"));
    std::string many = "<volume name='0'><sphere/></volume>";
    for (int i = 1; i < 10000; ++i)
        many += fmt::format("<volume like='0'><transform><translate x='{}'/></transform></volume>", i);
    CHECK(parse_volumes(many).volumes.size() == 10000);
}
