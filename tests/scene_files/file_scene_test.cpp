// `vkvol cloud.nvdb`: what is chosen for a density file, and what is left beside its picture.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "error.h"
#include "file_scene.h"
#include "image_io.h"
#include "scene_beside.h"
#include "scene_xml.h"
#include "support/shell.h"
#include "support/test_grids.h"
#include "test_paths.h"

using namespace vkvol;
using Catch::Contains;

namespace {

std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

// An empty folder to work in, with some of the tests' fields.
class Folder {
public:
    Folder() {
        std::filesystem::create_directories(path_ / "fields & $more");
        copy("sphere.nvdb", "cloud.nvdb");
        copy("glow.nvdb", "fire.NVDB");
        copy("empty.nvdb", "nothing.nvdb");
        copy("sphere.nvdb", "fields & $more/a.nvdb");
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    Run vkvol(const std::string& arguments) const {
        const char* device = std::getenv("VKVOL_TEST_DEVICE");
        return run(fmt::format("cd '{}' && '{}' {}{}", path_.string(), VKVOL_BINARY, arguments,
                               device ? fmt::format(" --device '{}'", device) : ""));
    }
    std::filesystem::path file(const char* name) const { return path_ / name; }
    bool has(const char* name) const { return std::filesystem::exists(path_ / name); }

private:
    void copy(const char* field, const char* name) const {
        std::filesystem::copy_file(std::filesystem::path(VKVOL_TEST_FIELDS) / field, path_ / name);
    }
    std::filesystem::path path_ = std::filesystem::temp_directory_path() / fmt::format("vkvol-file-{}", getpid());
};

bool same_pixels(const std::filesystem::path& a, const std::filesystem::path& b) {
    const Film one = read_exr(a), other = read_exr(b);
    return one.mean == other.mean && one.samples == other.samples;
}

// A cube of 20^3 voxels.
DensityField cube(double voxel, float density) {
    GridRecipe recipe;
    recipe.first = glm::ivec3(-10);
    recipe.last = glm::ivec3(9);
    recipe.value = [density](glm::ivec3) { return density; };
    recipe.linear = glm::dmat3(voxel);
    return make_density_field(make_grid_bytes(recipe), "cube");
}

SuitableMedium suit_cube(double voxel, float density) {
    Camera camera;
    camera.position = {-0.5 * voxel, -0.5 * voxel, 4000.0 * voxel};
    camera.fov = 0.5;
    return suit_medium(cube(voxel, density), nullptr, camera, file_picture());
}

} // namespace

// Rays half a degree apart at most cross the cube from face to face, and the depth of each is density times edge, less
// than 4e-5 longer for its slope.
TEST_CASE("coefficients give a cube of any density and size the same optical depth", "[cpu][method]") {
    for (const double voxel : {1e-3, 1.0, 1e4})
        for (const float density : {1e-5f, 1.0f, 50.0f}) {
            const SuitableMedium medium = suit_cube(voxel, density);
            CAPTURE(voxel, density);
            CHECK(medium.sigma_t * double(density) * 20.0 * voxel == Approx(medium.depth).epsilon(1e-4));
            CHECK_FALSE(medium.kelvin);
        }
}

TEST_CASE("numbers of a temperature grid are kelvin, or are stretched to kelvin", "[cpu][method]") {
    CHECK(read_kelvin(1516.0)->scale == 1.0);
    CHECK(read_kelvin(1516.0)->offset == 0.0);
    CHECK(read_kelvin(1516.0)->hottest == 1516.0);
    for (const double highest : {0.01, 1.0, 2.99, 100.0}) {
        const Kelvin kelvin = *read_kelvin(highest);
        CHECK(kelvin.scale * highest + kelvin.offset == Approx(kelvin.hottest));
        CHECK(kelvin.hottest > 1500.0);
        CHECK(kelvin.hottest < 3000.0);
    }
    CHECK_FALSE(read_kelvin(310.0)); // warm air
    CHECK_FALSE(read_kelvin(0.0));
}

TEST_CASE("a scene for a file names what it found in it, and shows all of it", "[cpu][method]") {
    const Folder folder;
    const FileSceneOptions options{file_picture(), 8, "ratioTracking:flight=weighted", Up::z};
    const std::filesystem::path file = folder.file("fire.NVDB");
    const FileScene made = make_file_scene(file, folder.file("."), options);
    const Scene scene = parse_scene(made.xml, folder.file("fire.xml"));
    CHECK(scene.warnings.empty());
    const Volume& volume = scene.volumes.front();
    CHECK(std::filesystem::equivalent(std::get<GridFile>(volume.shape).path, file));
    CHECK(volume.unit == CoefficientUnit::world);
    CHECK(volume.temperature.model == TemperatureEmission::Model::blackbody);
    CHECK(volume.temperature.color.x > 0.0);
    CHECK(scene.settings.integrator == "ratioTracking");
    CHECK(scene.settings.choices.free_flight.has_value());
    CHECK(scene.settings.spp == 8);
    CHECK_THAT(made.assumed, Contains("\"temperature\" glows") && Contains("z up"));
    // z up: the camera's right is level.
    CHECK(std::abs(camera_rotation(scene.camera)[0].z) < 1e-12);
    CHECK(camera_rotation(scene.camera)[1].z > 0.9);
}

TEST_CASE("is a scene beside a picture still as it was made?", "[cpu][method]") {
    const std::string scene = marked("<options>\n</options>\n");
    CHECK(is_untouched(scene));
    CHECK_FALSE(is_untouched(scene + " "));
    CHECK_FALSE(is_untouched("<options>\n</options>\n"));
    CHECK_FALSE(is_untouched(""));
    std::string changed = scene;
    changed[changed.size() - 3] = 'S';
    CHECK_FALSE(is_untouched(changed));
    CHECK_NOTHROW(parse_scene(scene, "s.xml"));
}

TEST_CASE("a density file is rendered, and the scene beside its picture gives the same bits", "[gpu][command][long]") {
    const Folder folder;
    const Run run = folder.vkvol("cloud.nvdb --spp 2 --width 64");
    CAPTURE(run.text);
    REQUIRE(run.code == exit_done);
    CHECK_THAT(run.text, Contains("cloud.nvdb: \"density\", optical depth") && Contains("scene: cloud.xml"));
    REQUIRE(folder.has("cloud.png"));
    REQUIRE(folder.vkvol("cloud.xml -o again.exr").code == exit_done);
    CHECK(same_pixels(folder.file("cloud.exr"), folder.file("again.exr")));
    const Film film = read_exr(folder.file("cloud.exr"));
    CHECK(film.width() == 64);
    CHECK(film.height() == 48);
    CHECK(film.mean[std::size_t(24 * 64 + 32)] != film.mean[0]); // a cloud in the middle, sky in the corner
    CHECK(film.mean[0] == film.mean[63]);

    REQUIRE(folder.vkvol("'fields & $more/a.nvdb' --spp 1 --width 32 --integrator ratioNEE -o b.exr").code ==
            exit_done);
    REQUIRE(folder.vkvol("b.xml -o c.exr").code == exit_done);
    CHECK(same_pixels(folder.file("b.exr"), folder.file("c.exr")));
}

TEST_CASE("a made scene finds its file through links, and is framed as it says", "[gpu][command][long]") {
    const Folder folder;
    std::filesystem::create_directories(folder.file("real/deep"));
    std::filesystem::create_directory_symlink("real/deep", folder.file("link"));
    REQUIRE(folder.vkvol("cloud.nvdb --spp 1 --width 16 -q -o link/x.exr").code == exit_done);
    REQUIRE(folder.vkvol("link/x.xml -q -o again.exr").code == exit_done);
    CHECK(same_pixels(folder.file("link/x.exr"), folder.file("again.exr")));
    REQUIRE(folder.vkvol("cloud.nvdb --spp 1 --width 16 -q --frame -o f.exr").code == exit_done);
    REQUIRE(folder.vkvol("f.xml -q -o again.exr").code == exit_done);
    CHECK(same_pixels(folder.file("f.exr"), folder.file("again.exr")));
    const Run dry = folder.vkvol("cloud.nvdb --report cloud.xml --dry-run");
    CHECK(dry.code == exit_bad_input);
    CHECK_THAT(dry.text, Contains("cloud.xml"));
    CHECK_THAT(folder.vkvol("cloud.nvdb --dry-run").text, Contains("scene that would be written: cloud.xml"));
    CHECK_FALSE(std::filesystem::exists(folder.file("cloud.xml")));
}

TEST_CASE("init writes a scene to start from, and over nothing", "[gpu][command][long]") {
    const Folder folder;
    CHECK_THAT(folder.vkvol("init").text, Contains("scene.xml: vkvol scene.xml renders it"));
    const std::string first = text_of(folder.file("scene.xml"));
    // Others' readers of XML want no two hyphens within a comment.
    for (std::size_t at = first.find("<!--"); at != first.npos; at = first.find("<!--", at + 4))
        CHECK(first.compare(first.find("--", at + 4), 3, "-->") == 0);
    REQUIRE(folder.vkvol("scene.xml --width 32 --spp 1 -q").code == exit_done);
    CHECK(folder.has("scene.png"));
    const Run again = folder.vkvol("init");
    CHECK(again.code == exit_bad_input);
    CHECK_THAT(again.text, Contains("scene.xml: is there already"));
    CHECK(folder.vkvol("init -o nowhere/scene.xml").code == exit_bad_input);
    CHECK(text_of(folder.file("scene.xml")) == first);

    REQUIRE(folder.vkvol("init 'fields & $more/a.nvdb' -q").text.empty());
    REQUIRE(folder.vkvol("a.xml -q --width 32 --spp 1").code == exit_done);
    REQUIRE(folder.vkvol("'fields & $more/a.nvdb' -q --width 32 --spp 1 -o b.exr").code == exit_done);
    CHECK(same_pixels(folder.file("a.exr"), folder.file("b.exr")));
    CHECK_THAT(folder.vkvol("init cloud.pbrt").text, Contains("vkvol convert"));
    CHECK_THAT(folder.vkvol("init cloud.nvdb -o cloud.exr").text, Contains("expected .xml"));
    CHECK_THAT(folder.vkvol("init none.nvdb").text, Contains("none.nvdb"));
}

TEST_CASE("a scene that init writes to a stream finds its grid wherever it comes to be", "[gpu][command]") {
    const Folder folder;
    std::filesystem::create_directories(folder.file("elsewhere"));
    REQUIRE(folder.vkvol("init cloud.nvdb -q -o /dev/stdout > elsewhere/a.xml").code == exit_done);
    CHECK(folder.vkvol("elsewhere/a.xml -q --width 16 --spp 1 -o a.exr").code == exit_done);
}

TEST_CASE("a scene that its user has changed is never overwritten", "[gpu][command][long]") {
    const Folder folder;
    const std::string render = "cloud.nvdb --spp 1 --width 16 -q";
    REQUIRE(folder.vkvol(render).code == exit_done);
    REQUIRE(folder.vkvol("cloud.nvdb --spp 1 --width 20 -q").code == exit_done); // ours still: replaced
    CHECK_THAT(text_of(folder.file("cloud.xml")), Contains("<width>20</width>"));
    std::ofstream(folder.file("cloud.xml"), std::ios::app) << "<!-- mine -->\n";
    const std::string mine = text_of(folder.file("cloud.xml"));
    REQUIRE(folder.vkvol(render).code == exit_done);
    REQUIRE(folder.vkvol(render).code == exit_done);
    CHECK(text_of(folder.file("cloud.xml")) == mine);
    CHECK(folder.has("cloud-2.xml"));
    CHECK_FALSE(folder.has("cloud-3.xml"));
}

TEST_CASE("what makes no sense with a density file is an error", "[gpu][command]") {
    const Folder folder;
    const auto error = [&](const std::string& arguments) {
        const Run run = folder.vkvol(arguments);
        CHECK(run.code == exit_bad_input);
        return run.text;
    };
    CHECK_THAT(error("cloud.nvdb -D a=1"), Contains("-D and -f: "));
    CHECK_THAT(error("cloud.nvdb -f 1..2"), Contains("-D and -f: "));
    CHECK_THAT(error("cloud.nvdb --grid fire.NVDB"), Contains("--grid: "));
    CHECK_THAT(error("cloud.nvdb --up x"), Contains("--up"));
    CHECK_THAT(error("bench cloud.nvdb"), Contains("expected a scene file"));
    const std::string nothing = error("nothing.nvdb");
    CHECK_THAT(nothing, Contains("nothing.nvdb: holds no density to render: \"density\" is empty"));
    CHECK(std::count(nothing.begin(), nothing.end(), '\n') == 1);
    CHECK_FALSE(folder.has("nothing.xml"));
    const Run trace = folder.vkvol("cloud.nvdb --pixel 320,240 --sample 0 --trace");
    CHECK(trace.code == exit_done);
    CHECK_FALSE(folder.has("cloud.xml"));
}

TEST_CASE("--frame moves a camera that looks past the medium", "[gpu][command]") {
    const Folder folder;
    std::ofstream(folder.file("past.xml"))
        << "<options><sphere x='5'/><sigma_a>9</sigma_a><camera x='-500' z='40' fov='20'/><width>32</width>"
           "<height>24</height><backgroundColor r='1' g='1' b='1'/></options>";
    REQUIRE(folder.vkvol("past.xml -q").code == exit_done);
    CHECK(read_exr(folder.file("past.exr")).mean[std::size_t(12 * 32 + 16)].x == 1.0f);
    REQUIRE(folder.vkvol("past.xml -q --frame --spp 16").code == exit_done);
    const Film film = read_exr(folder.file("past.exr"));
    CHECK(film.mean[std::size_t(12 * 32 + 16)].x < 0.5f);
    CHECK(film.mean.front().x == 1.0f);
    CHECK_THAT(folder.vkvol("past.xml --frame --up z").text, Contains("--up: "));
    std::ofstream(folder.file("none.xml")) << "<options/>";
    CHECK_THAT(folder.vkvol("none.xml --frame").text, Contains("no medium to frame"));
}

TEST_CASE("info prints a view to paste into a scene, and JSON", "[cpu][command]") {
    const Folder folder;
    const Run text = folder.vkvol("info fire.NVDB");
    REQUIRE(text.code == exit_done);
    const std::size_t at = text.text.find("  <camera lookAt=");
    REQUIRE(at != std::string::npos);
    const std::string elements = text.text.substr(at);
    const Scene scene =
        parse_scene("<options><densityField>fire.NVDB</densityField>" + elements + "</options>", folder.file("s.xml"));
    CHECK(scene.warnings.empty());
    CHECK(scene.camera.fov < 90.0);

    const auto json = nlohmann::json::parse(folder.vkvol("info --json fire.NVDB").text);
    REQUIRE(json["grids"].size() == 2);
    CHECK(json["grids"][0]["name"] == "density");
    CHECK(json["grids"][0]["usable"] == true);
    CHECK(json["grids"][0]["activeVoxels"] == 4096);
    CHECK(json["view"]["emission"]["grid"] == "temperature");
    CHECK(json["view"]["sigma_s"].get<double>() == Approx(scene.volumes.front().sigma_s.x).epsilon(1e-3));
    const auto empty = nlohmann::json::parse(folder.vkvol("info nothing.nvdb --json").text);
    CHECK(empty["grids"][0]["empty"] == true);
    CHECK(empty["view"].is_null());
    CHECK_THAT(folder.vkvol("info nothing.nvdb").text, Contains("nothing to render"));
}
