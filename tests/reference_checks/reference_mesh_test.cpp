// The scalar reference: what closed meshes enclose.
#include <catch2/catch.hpp>

#include <fstream>
#include <sstream>
#include <string>
#include <unistd.h>

#include "tests/reference/test_media.h"

using namespace reference;

namespace {

// Appends an axis-parallel box of quads, seen counterclockwise from without unless `inverted`.
void add_box(std::string& obj, int& vertices, const glm::dvec3& low, const glm::dvec3& high, bool inverted = false) {
    std::ostringstream out;
    for (int i = 0; i < 8; ++i)
        out << "v " << (i & 1 ? high.x : low.x) << ' ' << (i & 2 ? high.y : low.y) << ' ' << (i & 4 ? high.z : low.z)
            << '\n';
    const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& face : faces) {
        out << 'f';
        for (int k = 0; k < 4; ++k)
            out << ' ' << vertices + 1 + face[inverted ? 3 - k : k];
        out << '\n';
    }
    obj += out.str();
    vertices += 8;
}

class ObjFile {
public:
    explicit ObjFile(const std::string& text, const std::string& mtl = "")
        : folder_(std::filesystem::temp_directory_path() / ("reference_mesh_" + std::to_string(::getpid()))) {
        std::filesystem::create_directory(folder_);
        std::ofstream(path()) << text;
        std::ofstream(folder_ / "body.mtl") << mtl;
    }
    ~ObjFile() { std::filesystem::remove_all(folder_); }
    std::filesystem::path path() const { return folder_ / "body.obj"; }

private:
    std::filesystem::path folder_;
};

Ray random_ray(Rng& rng) {
    const Draw a = rng.next();
    return {glm::dvec3(a.x(), a.y(), a.z()) * 8.0 - 4.0, hg_sample(0.0, {0, 0, 1}, a.w(), a.select())};
}

double length(const std::vector<Interval>& intervals) {
    double sum = 0.0;
    for (const Interval& interval : intervals)
        sum += interval.length();
    return sum;
}

} // namespace

TEST_CASE("a mesh of a cube is a box", "[cpu][reference]") {
    const bool inverted = GENERATE(false, true); // turned inside out, and back by the reader
    std::string obj;
    int vertices = 0;
    add_box(obj, vertices, {-1, -1.5, -2}, {1, 1.5, 2}, inverted);
    const ObjFile file(obj);
    const Mesh mesh = load_mesh({{file.path()}});
    CHECK(mesh.triangles.size() == 12);
    CHECK_FALSE(mesh.diffuse);
    const vkvol::Box cube{{0, 0, 0}, {2, 3, 4}};
    Rng rng = stream(61);
    const auto compare = [&](const Ray& ray) {
        const Interval expected = intersect(cube, ray);
        const std::vector<Interval> inside = intersect(mesh, ray);
        REQUIRE(inside.size() == (expected.empty() ? 0u : 1u));
        if (!inside.empty()) {
            REQUIRE(inside[0].t0 == Approx(expected.t0).margin(1e-10));
            REQUIRE(inside[0].t1 == Approx(expected.t1).margin(1e-10));
        }
    };
    for (int i = 0; i < 5000; ++i)
        compare(random_ray(rng));
    // Through the diagonals of the faces, and from corner to corner.
    compare({{0, 0, 9}, {0, 0, -1}});
    compare({{9, 0, 0}, {-1, 0, 0}});
    compare({{0, 0.75, 9}, {0, 0, -1}});
    compare({{-2, -3, -4}, glm::normalize(glm::dvec3(2, 3, 4))});
}

TEST_CASE("bodies in one mesh unite, and inward surfaces cut cavities", "[cpu][reference]") {
    struct Case {
        glm::dvec3 low, high; // of the second box
        bool inverted;
    };
    const Case c = GENERATE(Case{{1.5, -0.5, -1}, {2.5, 1, 1}, false},        // apart
                            Case{{0.5, -0.5, -0.5}, {2, 2, 2}, false},        // overlapping
                            Case{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, true}); // a cavity
    std::string obj;
    int vertices = 0;
    const glm::dvec3 one(1.0);
    add_box(obj, vertices, -one, one);
    add_box(obj, vertices, c.low, c.high, c.inverted);
    const ObjFile file(obj);
    const Mesh mesh = load_mesh({{file.path()}});
    Rng rng = stream(67);
    for (int i = 0; i < 5000; ++i) {
        const Ray ray = random_ray(rng);
        const Interval a = intersect(-one, one, ray), b = intersect(c.low, c.high, ray), common = clip(a, b);
        const double expected = c.inverted ? a.length() - b.length()
                                           : a.length() + b.length() - (a.empty() || b.empty() ? 0.0 : common.length());
        const std::vector<Interval> inside = intersect(mesh, ray);
        REQUIRE(length(inside) == Approx(expected).margin(1e-9));
        for (std::size_t k = 1; k < inside.size(); ++k)
            REQUIRE(inside[k - 1].t1 <= inside[k].t0);
    }
    CHECK(intersect(mesh, {{-9, 0, 0.1}, {1, 0, 0}}).size() == (c.low.x == 0.5 ? 1u : 2u));
}

TEST_CASE("flights and transmittance go on behind a gap", "[cpu][reference]") {
    std::string obj;
    int vertices = 0;
    add_box(obj, vertices, {-1, -1, -1}, {1, 1, 1});
    add_box(obj, vertices, {-1, -1, 2}, {1, 1, 4});
    const ObjFile file(obj);
    vkvol::Volume v = volume(0.1, 0.2);
    v.shape = vkvol::MeshFiles{{file.path()}};
    if (GENERATE(false, true))
        v.noise = vkvol::Noise{};
    const Medium medium = load(v);
    const Ray ray{{0.1, 0.2, 9}, {0, 0, -1}};
    const vkvol::Rgb T = chromatic_transmittance(medium, ray);
    const vkvol::March march = resolve_march({}, medium);
    Rng rng = stream(71);
    for (const int estimator :
         {TRANSMITTANCE_DELTA, TRANSMITTANCE_RATIO, TRANSMITTANCE_RESIDUAL, TRANSMITTANCE_TELESCOPING}) {
        RgbMean mean;
        for (int i = 0; i < 10000; ++i)
            mean.add(estimate_transmittance(medium, estimator, ray, march, rng));
        CHECK(mean.z(T) < 4.0);
    }
    Mean escaped;
    for (int i = 0; i < 20000; ++i) {
        const Draw draw = rng.next();
        const int kind = medium.homogeneous() ? FREE_FLIGHT_ANALYTIC : FREE_FLIGHT_DELTA;
        escaped.add(fly(medium, kind, ray, draw.exponential(2), 0.0, vkvol::Rgb(1.0), march, rng).t ? 0.0 : 1.0);
    }
    const double z = escaped.z(T.x);
    CHECK(std::abs(z) < 4.0);
}

TEST_CASE("density sampling shows the first material's colour", "[cpu][reference]") {
    std::string obj = "mtllib body.mtl\nusemtl glow\n";
    int vertices = 0;
    add_box(obj, vertices, {-1, -1, -1}, {1, 1, 1});
    const ObjFile file(obj, "newmtl glow\nKd 0.25 0.5 1\n");
    vkvol::Volume v = volume(0.4, 0.3);
    v.shape = vkvol::MeshFiles{{file.path()}};
    vkvol::Scene scene = pixel_scene(v, 10.0);
    scene.background = vkvol::Rgb(2.0);
    scene.settings.integrator = "densitySampling";
    const vkvol::Rgb L = trace_path(load_world(scene), 0, 0, 0, 1);
    const double T = std::exp(-0.4 * 2.0);
    for (int i = 0; i < 3; ++i)
        CHECK(L[i] == Approx((1.0 - T) * std::ldexp(0.25, i) + 2.0 * T).epsilon(1e-6));
}
