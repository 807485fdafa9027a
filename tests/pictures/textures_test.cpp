// Images on surfaces: by closed form, against the reference on every shape, and as files have them.
#include <catch2/catch.hpp>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

#include "error.h"
#include "image_io.h"
#include "picture_codec.h"
#include "radiance_map.h"
#include "scene_hash.h"
#include "support/images.h"
#include "support/scene_text.h"
#include "support/scenes.h"
#include "support/test_directory.h"
#include "surface_mesh.h"

using namespace vkvol;
using Catch::Contains;

namespace {

// Colours without any order.
std::shared_ptr<const Texture> motley(int width, int height) {
    Texture image{width, height, {}, false};
    for (int i = 0; i < width * height; ++i)
        image.colors.emplace_back(float(i * 37 % 101) / 100.0f, float(i * 53 % 97) / 96.0f, float(i * 71 % 89) / 88.0f);
    return std::make_shared<const Texture>(image);
}

std::shared_ptr<const Texture> board(const glm::vec3& own, const glm::vec3& other) {
    return std::make_shared<const Texture>(Texture{2, 2, {other, own, own, other}, true});
}

Surface textured(SurfaceShape shape, const std::shared_ptr<const Texture>& image, glm::dvec2 repeat = glm::dvec2(1.0)) {
    Surface surface;
    surface.shape = std::move(shape);
    surface.material.color = Rgb(1.0);
    surface.material.image = image;
    surface.material.repeat = repeat;
    return surface;
}

glm::dmat3 turned_axes(const glm::dvec3& z) {
    const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(0.3, 1.0, 0.2), z));
    return {x, glm::cross(z, x), z};
}

// Two triangles that lean on each other, and do not agree about where on the image they are.
TriangleSurface tent() {
    return {{{-1.2, -1.0, 0.0}, {0.0, -1.0, 0.8}, {0.0, 1.0, 0.8}, {1.2, -1.0, 0.0}},
            {{0, 1, 2}, {1, 3, 2}},
            {},
            {{{0.1, 0.0}, {1.3, 0.2}, {0.4, -0.9}}, {{0.0, 0.0}, {0.5, 0.1}, {0.2, 2.0}}}};
}

std::vector<Surface> all_shapes() {
    TriangleSurface round = tent();
    const glm::vec3 left = glm::normalize(glm::vec3(-0.8f, 0.0f, 1.0f)),
                    right = glm::normalize(glm::vec3(0.8f, 0.0f, 1.0f)), ridge(0.0f, 0.0f, 1.0f);
    round.normals = {{left, ridge, ridge}, {ridge, right, ridge}};
    for (glm::dvec3& vertex : round.vertices)
        vertex += glm::dvec3(1.8, 1.4, -0.5);
    TriangleSurface flat = tent();
    for (glm::dvec3& vertex : flat.vertices)
        vertex += glm::dvec3(-1.8, 1.4, -0.5);
    std::vector<Surface> all = {
        textured(PlaneSurface{{0.3, -1.4, 0.0}, {0.0, 1.0, 0.0}}, motley(3, 2), {0.4, 0.7}),
        textured(BallSurface{{-1.6, -0.6, 0.6}, 0.8}, motley(7, 5)),
        textured(DiskSurface{{0.1, 0.0, -1.0}, glm::normalize(glm::dvec3(0.2, 0.3, 1.0)), 0.9}, motley(4, 4),
                 {1.5, 1.0}),
        textured(RectangleSurface{{1.6, -0.6, 0.4}, {0.7, 0.2, 0.0}, {-0.2, 0.7, 0.0}}, motley(5, 4), {1.0, 2.0}),
        textured(flat, motley(6, 3)),
        textured(round, motley(6, 3))};
    all[0].axes = glm::dmat3({1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0});
    all[1].axes = turned_axes(glm::normalize(glm::dvec3(0.5, 0.4, 1.0)));
    all[2].axes = turned_axes(std::get<DiskSurface>(all[2].shape).normal);
    all[1].material.kind = MaterialKind::coated;
    all[3].material.kind = MaterialKind::mirror;
    all[4].material.color = {0.9, 0.6, 0.3};
    all.push_back(textured(RectangleSurface{{0.2, 1.9, -0.4}, {0.9, 0.0, 0.3}, {-0.06, 0.4, 0.18}},
                           board({0.9, 0.2, 0.1}, {0.1, 0.3, 0.8}), {1.7, 0.6}));
    return all;
}

// Without a medium, in an even sky.
Scene bare(int pixels, int spp) {
    Scene scene =
        scene_of(medium(Sphere{{0.0, 0.0, 0.0}, 1.0}, 0.0, 0.0), 5.5, pixels, 9.0, glm::dvec3(0.0), {-8.0, 12.0, 0.0});
    scene.volumes.clear();
    scene.background = Rgb(1.0);
    scene.settings.spp = spp;
    return scene;
}

// Right is x, upwards -z.
Camera above(double height) {
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.view_height = height;
    camera.position = {0.0, 5.0, 0.0};
    camera.pitch = -90.0;
    return camera;
}

} // namespace

// In an even sky what is flat and matte is as bright as it is coloured. Over a texel its own colour has the mean weight
// 3/4, and those beside it 1/8 each.
TEST_CASE("a texel is seen where it lies, and its neighbours beside it", "[gpu][image][surfaces]") {
    constexpr int n = 8;
    const int times = GENERATE(1, 2);
    const auto image = motley(n / times, n / times);
    Scene scene = bare(n, 1024);
    scene.camera = above(2.0);
    scene.surfaces = {
        textured(RectangleSurface{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}}, image, glm::dvec2(times))};
    std::vector<Rgb> expected;
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            Rgb sum(0.0);
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) {
                    const int i = (row + y + n) % image->height, k = (column + x + n) % image->width;
                    sum += (x == 0 ? 0.75 : 0.125) * (y == 0 ? 0.75 : 0.125) *
                           Rgb(image->colors[std::size_t(i * image->width + k)]);
                }
            expected.push_back(sum);
        }
    CHECK_AGREEMENT(agree_with_means(render_here(scene, 1).film, expected, "texels"));
}

// Whole pixels of one colour, the one on the lower left its own.
TEST_CASE("a board is of two colours, with edges", "[gpu][image][surfaces]") {
    constexpr int n = 8;
    Scene scene = bare(n, 256);
    scene.camera = above(2.0);
    scene.surfaces = parse("<surfaces><rectangle width=\"2\" height=\"2\" lookAt=\"0 5 0\" up=\"0 0 -1\" r=\".75\" "
                           "g=\".5\" b=\"0\" checker=\"0.125 0.25 1\" repeat=\"2 1\"/></surfaces>")
                         .surfaces;
    std::vector<Rgb> expected;
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column)
            expected.push_back((column / 2 + row / 4) % 2 == 1 ? Rgb(0.75, 0.5, 0.0) : Rgb(0.125, 0.25, 1.0));
    CHECK_AGREEMENT(agree_with_means(render_here(scene, 1).film, expected, "squares"));
}

TEST_CASE("textures on every shape equal the reference", "[gpu][image][surfaces]") {
    Scene scene = bare(20, 256);
    scene.surfaces = all_shapes();
    scene.lights = {SunLight{glm::normalize(glm::dvec3(0.5, 1.0, 1.2)), {2.0, 1.5, 1.0}, 10.0}};
    scene.background = {0.4, 0.5, 0.7};
    CHECK_AGREEMENT(agree(render_here(scene, 1).film, render_reference(scene, 2), "textures"));
    // Beside a map of the sky, in whose buffer they are.
    RadianceMap map{4, 2, {}, 0};
    for (int i = 0; i < 8; ++i)
        map.texels.emplace_back(0.2f + 0.1f * float(i), 0.5f, 0.9f - 0.1f * float(i));
    scene.lights.push_back(write_sky(map));
    CHECK_AGREEMENT(agree(render_here(scene, 3).film, render_reference(scene, 4), "textures under a sky"));
}

TEST_CASE("maps cover their display window, and are not multiplied by alpha", "[cpu][xml][surfaces]") {
    const TestDirectory directory;
    // The upper half of a picture.
    Film film;
    film.crop = {0, 4, 0, 2};
    film.picture_width = film.picture_height = 4;
    film.mean.assign(8, glm::vec3(0.5f, 0.25f, 1.0f));
    film.variance.assign(8, glm::vec3(0.0f));
    film.samples.assign(8, 1);
    write_exr(directory.path / "half.exr", film, {});
    const RadianceMap half = read_radiance_map(directory.path / "half.exr");
    REQUIRE((half.width == 4 && half.height == 4));
    CHECK(half.texels[7] == glm::vec3(0.5f, 0.25f, 1.0f));
    CHECK(half.texels[8] == glm::vec3(0.0f));
    // White, of alpha 1/2.
    const std::uint8_t pixels[] = {255, 255, 255, 128};
    PictureHeader header;
    header.width = header.height = header.full_width = header.full_height = 1;
    header.channels = {"R", "G", "B", "A"};
    struct TextSink : PictureSink {
        std::string bytes;
        bool write(const void* data, std::size_t size, std::int64_t at) override {
            bytes.resize(std::max(bytes.size(), std::size_t(at) + size));
            std::memcpy(bytes.data() + at, data, size);
            return true;
        }
    } sink;
    REQUIRE(picture_codec().write(PictureFormat::png, header, pixels, sink).empty());
    CHECK(read_radiance_map(directory.write("leaf.png", sink.bytes)).texels[0] == glm::vec3(1.0f));
}

TEST_CASE("places on textures are those of the file", "[cpu][mesh][surfaces]") {
    const TestDirectory directory;
    RadianceMap map{2, 2, {{0.0f, 0.5f, 1.0f}, {0.1f, 0.2f, 0.3f}, {1.0f, 1.0f, 1.0f}, {0.0f, 0.0f, 0.0f}}, 0};
    Surface surface;
    surface.material.texture = write_sky(map).file;
    const auto loaded = [&](const std::filesystem::path& file) {
        Scene scene;
        surface.shape = MeshSurface{file};
        scene.surfaces = {surface, surface};
        return with_surface_files(scene).surfaces;
    };
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const auto all = loaded(directory.write("a.obj", corners + "vt 0.1 0.2\nvt 0.3 0.4\nvt 2 -1\nf 1/1 2/-2 3/3\n"));
    CHECK(all[0].material.image->colors == map.texels);
    CHECK(all[0].material.image == all[1].material.image);
    CHECK(std::get<TriangleSurface>(all[0].shape).places ==
          std::vector<glm::mat3x2>{{{0.1f, 0.2f}, {0.3f, 0.4f}, {2.0f, -1.0f}}});
    surface.transform[0][0] = -1.0; // a mirror: corners change places
    CHECK(std::get<TriangleSurface>(
              loaded(directory.write("a.obj", corners + "vt 0.1 0.2\nvt 0.3 0.4\nvt 2 -1\nf 1/1 2/2 3/3\n"))[0].shape)
              .places[0][1] == glm::vec2(2.0f, -1.0f));
    surface.transform = glm::dmat4(1.0);
    for (const char* names : {"s t", "u v", "texture_u texture_v"}) {
        const std::string text(names);
        const std::size_t space = text.find(' ');
        const auto ply = loaded(directory.write(
            "a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                     "property float " +
                         text.substr(0, space) + "\nproperty float " + text.substr(space + 1) +
                         "\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                         "0 0 0 0.5 0.25\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n"));
        CHECK(std::get<TriangleSurface>(ply[0].shape).places ==
              std::vector<glm::mat3x2>{{{0.5f, 0.25f}, {1.0f, 0.0f}, {0.0f, 1.0f}}});
    }
    CHECK_THROWS_WITH(loaded(directory.write("b.obj", corners + "f 1 2 3\n")), Contains("b.obj") && Contains("UVs"));
    map.texels[3].y = 1.5f;
    surface.material.texture = write_sky(map).file;
    Scene bright;
    surface.shape = MeshSurface{directory.write("a.obj", corners + "vt 0 0\nf 1/1 2/1 3/1\n")};
    bright.surfaces = {surface};
    bright = with_surface_files(bright);
    CHECK(bright.surfaces[0].material.image->colors[3] == glm::vec3(map.texels[3].x, 1.0f, map.texels[3].z));
    REQUIRE(bright.warnings.size() == 1);
    CHECK_THAT(bright.warnings[0], Contains("column 1, row 1") && Contains("they count as 1"));
    surface.material.texture = directory.path / "none.png";
    CHECK_THROWS_AS(loaded(directory.write("a.obj", corners + "vt 0 0\nf 1/1 2/1 3/1\n")), InputError);
}

TEST_CASE("textures are read", "[xml][surfaces]") {
    const Scene scene = parse("<surfaces><rectangle lookAt=\"0 0 1\" texture=\"wood.png\" repeat=\"2 3\"/>"
                              "<disk lookAt=\"0 0 1\" up=\"1 0 0\" texture=\"a.exr\" r=\".5\" g=\".4\" b=\".3\"/>"
                              "<sphere><transform><rotate y=\"1\" angle=\"90\"/></transform></sphere>"
                              "<box texture=\"wood.png\"/></surfaces>");
    const auto& all = scene.surfaces;
    CHECK(all[0].material.texture.filename() == "wood.png");
    CHECK(all[0].material.repeat == glm::dvec2(2.0, 3.0));
    CHECK(all[0].material.color == Rgb(1.0));
    CHECK(all[1].material.color == Rgb(0.5, 0.4, 0.3));
    CHECK(glm::distance(all[1].axes[1], glm::dvec3(1.0, 0.0, 0.0)) < 1e-12);
    CHECK(glm::distance(glm::cross(all[1].axes[0], all[1].axes[1]), all[1].axes[2]) < 1e-12);
    CHECK(glm::distance(all[2].axes[2], glm::dvec3(1.0, 0.0, 0.0)) < 1e-12);
    // Each face of a box shows the image upright, and not mirrored, to who stands before it.
    const auto& box = std::get<TriangleSurface>(all[3].shape);
    for (std::size_t i = 0; i < box.triangles.size(); ++i) {
        const glm::dmat3 corners(box.vertices[box.triangles[i].x], box.vertices[box.triangles[i].y],
                                 box.vertices[box.triangles[i].z]);
        const glm::dmat3x2 places(box.places[i]);
        const glm::dvec3 front = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const glm::dvec2 u = places[1] - places[0], v = places[2] - places[0];
        CHECK(u.x * v.y - u.y * v.x == Approx(1.0)); // half of the image, turned as the face is
        CHECK(glm::length(front) == Approx(1.0));
        for (int k = 0; k < 3; ++k)
            if (std::abs(front.y) < 0.5)
                CHECK(places[k].y == Approx(corners[k].y + 0.5));
    }
}

TEST_CASE("textures are refused by name", "[xml][surfaces]") {
    const auto refused = [](const std::string& surface) { return error_of("<surfaces>" + surface + "</surfaces>"); };
    CHECK_THAT(refused("<sphere repeat=\"2\"/>"), Contains("repeat") && Contains("texture"));
    CHECK_THAT(refused("<sphere texture=\"a.png\" repeat=\"1 2 3\"/>"), Contains("3 numbers"));
    CHECK_THAT(refused("<sphere texture=\"a.png\" repeat=\"0\"/>"), Contains("above 0"));
    CHECK_THAT(refused("<sphere texture=\"\"/>"), Contains("names no file"));
    CHECK_THAT(refused("<sphere texture=\"a.png\" material=\"dielectric\"/>"), Contains("texture"));
    CHECK_THAT(refused("<sphere checker=\".1\" material=\"thinDielectric\"/>"), Contains("checker"));
    CHECK_THAT(refused("<sphere checker=\".1 .2\"/>"), Contains("2 numbers"));
    CHECK_THAT(refused("<sphere checker=\"1.1\"/>"), Contains("checker") && Contains("0 to 1"));
    CHECK_THAT(refused("<sphere checker=\".1\" texture=\"a.png\"/>"), Contains("leave that or checker out"));
    CHECK_THAT(refused("<sphere material=\"conductor\" eta=\"1 1 1\"/>"), Contains("has eta without k"));
    CHECK_THAT(refused("<sphere material=\"conductor\" eta=\"1 1 1\" k=\"1 1 1\" metal=\"gold\"/>"), Contains("metal"));
}

TEST_CASE("a mirror takes a rectangle's texture along", "[xml][surfaces]") {
    const std::string mirrored = "lookAt=\"0 0 1\"{}><transform><scale x=\"-1\"/></transform></rectangle></surfaces>";
    const auto shape_of = [&](const char* texture) {
        return parse("<surfaces><rectangle " + fmt::format(fmt::runtime(mirrored), texture)).surfaces.at(0).shape;
    };
    CHECK(std::holds_alternative<RectangleSurface>(shape_of("")));
    const SurfaceShape turned = shape_of(" checker=\".1\"");
    REQUIRE(std::holds_alternative<TriangleSurface>(turned));
    const auto& mesh = std::get<TriangleSurface>(turned);
    for (std::size_t t = 0; t < 2; ++t)
        for (int k = 0; k < 3; ++k) { // a unit wide, its right on the left
            const glm::dvec3 at = mesh.vertices[mesh.triangles[t][k]];
            CHECK(mesh.places[t][k].x == Approx(0.5 - at.x));
            CHECK(mesh.places[t][k].y == Approx(0.5 + at.y));
        }
}

TEST_CASE("what textures show is in the hash", "[xml][surfaces]") {
    const auto hash_of = [](const char* colors) {
        return scene_hash(parse(fmt::format("<surfaces><sphere {}/></surfaces>", colors)));
    };
    CHECK(hash_of("checker=\".1\"") == hash_of("r=\".5\" g=\".5\" b=\".5\" checker=\".1 .1 .1\""));
    CHECK(hash_of("checker=\".1\"") != hash_of("checker=\".2\""));
    CHECK(hash_of("checker=\".1\"") != hash_of("multiplier=\".2\" checker=\".1\""));
    CHECK(hash_of("checker=\".1\"") != hash_of("repeat=\"5 1\" checker=\".1\""));
    // Files count by what is in them.
    const TestDirectory directory;
    const auto hash_of_file = [&](const char* folder, const char* text) {
        std::filesystem::create_directories(directory.path / folder);
        const std::filesystem::path file = directory.path / folder / "a.png";
        std::ofstream(file) << text;
        return hash_of(fmt::format("texture=\"{}\"", file.string()).c_str());
    };
    CHECK(hash_of_file("first", "same size") == hash_of_file("second", "same size"));
    CHECK(hash_of_file("first", "same size") != hash_of_file("third", "also nine"));
    const auto hash_of_places = [](const char* checker, const char* places) {
        return scene_hash(parse(fmt::format("<surfaces><mesh {}><vertices>0 0 0 1 0 0 0 1 0</vertices><triangles>0 1 2"
                                            "</triangles><places>{}</places></mesh></surfaces>",
                                            checker, places)));
    };
    CHECK(hash_of_places("checker=\".1\"", "0 0 1 0 0 1") != hash_of_places("checker=\".1\"", "0 0 2 0 0 1"));
    CHECK(hash_of_places("", "0 0 1 0 0 1") == hash_of_places("", "0 0 2 0 0 1")); // the same picture
}
