// .obj files with the .mtl beside them, and .ply files.
#include <array>

#include "corpus.h"
#include "mutate.h"
#include "scene_words.h"
#include "target.h"
#include "use_scene.h"

namespace vkvol::fuzz {

namespace {

constexpr const char* mesh_words[] = {"v",
                                      "f",
                                      "vt",
                                      "vn",
                                      "vw",
                                      "g",
                                      "o",
                                      "s",
                                      "l",
                                      "p",
                                      "t",
                                      "usemtl",
                                      "mtllib",
                                      "newmtl",
                                      "Kd",
                                      "Ka",
                                      "map_Kd",
                                      "d",
                                      "Tr",
                                      "Ns",
                                      "-clamp",
                                      "-bm",
                                      "1//1",
                                      "1/1/1",
                                      "-1//-1",
                                      "-9",
                                      "9",
                                      "0",
                                      "1/",
                                      "//",
                                      "2147483648",
                                      "-2147483648",
                                      "99999999999",
                                      "\\",
                                      "#",
                                      "ball.mtl",
                                      "ball.obj",
                                      ".",
                                      "/",
                                      "/dev/zero",
                                      "none.mtl",
                                      "\n",
                                      "\r",
                                      "\t",
                                      "\x0c",
                                      "f 1 2 3\n",
                                      "v 1 2\n",
                                      "f\n",
                                      "f 1 2\n",
                                      "usemtl\n",
                                      "mtllib\n",
                                      "newmtl\n",
                                      "Kd\n",
                                      "element",
                                      "property",
                                      "list",
                                      "vertex",
                                      "face",
                                      "uchar",
                                      "double",
                                      "float",
                                      "end_header\n",
                                      "format ascii 1.0\n",
                                      "format binary_big_endian 1.0\n",
                                      "vertex_index",
                                      "element face 4000000000\n"};

// Separates the mesh from its materials in an input.
const std::string separator = "\n%materials\n";

class MeshTarget : public Target {
public:
    MeshTarget() : Target("mesh", ".obj", 64, 1000) {}

    void prepare(const std::filesystem::path& directory) override {
        directory_ = directory;
        corpus_ = make_objs();
        const std::vector<std::string> plys = make_plys();
        corpus_.insert(corpus_.end(), plys.begin(), plys.end());
    }

    std::string make(Random& random) override {
        std::string obj = random.pick(corpus_), mtl = ball_mtl;
        damage(obj, random);
        if (random.one_in(3))
            damage(mtl, random);
        return obj + separator + mtl;
    }

    void use(const std::string& input, Random& random) override {
        const std::size_t at = input.rfind(separator);
        const std::filesystem::path file = directory_ / (input.starts_with("ply") ? "ball.ply" : "ball.obj");
        write_file(file, input.substr(0, at));
        write_file(directory_ / "ball.mtl", input.substr(at + separator.size()));
        Scene scene;
        scene.volumes.emplace_back();
        scene.volumes.front().shape = MeshFiles{{file}};
        if (random.one_in(2))
            scene.settings.integrator = "densitySampling";
        if (random.one_in(2)) // among other media
            scene.volumes.emplace_back().shape = Sphere{};
        use_scene(scene);
    }

private:
    void damage(std::string& text, Random& random) const {
        for (std::uint64_t n = random.below(4); n > 0; --n)
            switch (random.below(6)) {
            case 0:
                replace_token(text, random, mesh_words);
                break;
            case 1:
                replace_token(text, random, edge_values);
                break;
            case 2:
                shuffle_lines(text, random);
                break;
            case 3:
                text.insert(random.below(text.size() + 1), random.pick(mesh_words));
                break;
            case 4: { // one long line
                std::string many;
                for (std::uint64_t i = 1 + random.below(random.one_in(10) ? 20000 : 100); i > 0; --i)
                    many += random.one_in(2) ? " 1" : " 2";
                text.insert(text.find('\n', random.below(text.size() + 1)) % (text.size() + 1), many);
                break;
            }
            default:
                mutate_bytes(text, random, random.pick(corpus_));
            }
    }

    std::filesystem::path directory_;
    std::vector<std::string> corpus_;
};

} // namespace

Target& mesh_target() {
    static MeshTarget target;
    return target;
}

} // namespace vkvol::fuzz
