// Scenes of pbrt-v4: from scenes/pbrt, damaged as directives, as words and as bytes.
#include <algorithm>
#include <fmt/format.h>

#include "corpus.h"
#include "mutate.h"
#include "scene_words.h"
#include "scene_xml.h"
#include "target.h"
#include "use_scene.h"

namespace vkvol::fuzz {

namespace {

constexpr const char* pbrt_words[] = {"[",
                                      "]",
                                      "\"",
                                      "#",
                                      "true",
                                      "false",
                                      "\"rgb L\"",
                                      "\"float radius\"",
                                      "\"sphere\"",
                                      "\"disk\"",
                                      "\"plymesh\"",
                                      "\"trianglemesh\"",
                                      "\"bilinearmesh\"",
                                      "\"interface\"",
                                      "\"homogeneous\"",
                                      "\"nanovdb\"",
                                      "\"dielectric\"",
                                      "\"conductor\"",
                                      "\"infinite\"",
                                      "\"spot\"",
                                      "\"distant\"",
                                      "\"blackbody L\"",
                                      "\"spectrum L\"",
                                      "\"texture reflectance\"",
                                      "\"metal-Au-eta\"",
                                      "\"none.ply\"",
                                      "\"ball.ply\"",
                                      "\"spherical\"",
                                      "\"orthographic\"",
                                      "\"checkerboard\"",
                                      "\"texture tex1\"",
                                      "\"float illuminance\""};
constexpr const char* directives[] = {
    "AttributeBegin",
    "AttributeEnd",
    "WorldBegin",
    "ReverseOrientation",
    "Identity",
    "ObjectBegin \"o\"",
    "ObjectEnd",
    "ObjectInstance \"o\"",
    "Include \"scene.pbrt\"",
    "Scale -1 1 1",
    "Scale 1 2 3",
    "Translate 1e30 0 0",
    "LookAt 0 0 0 1 1 1 0 1 0",
    "Shape \"sphere\"",
    "Material \"interface\"",
    "MediumInterface \"fog\" \"\"",
    "Attribute \"shape\" \"float radius\" 2",
    "TransformBegin",
    "TransformTimes",
    "TransformEnd",
    "CoordSysTransform \"camera\"",
    "ActiveTransform EndTime",
    "Camera \"perspective\"",
    "AreaLightSource \"diffuse\"",
    "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]",
    "LightSource \"infinite\" \"string filename\" \"sky.hdr\" \"float illuminance\" 3",
    "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [ 1 0 0 ] \"float uscale\" 4",
    "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"t\"",
    "Material \"diffuse\" \"texture reflectance\" \"t\""};

class PbrtTarget : public Target {
public:
    PbrtTarget() : Target("pbrt", ".pbrt", 256, 400) {}

    void prepare(const std::filesystem::path& directory) override {
        directory_ = directory;
        write_scene_files(directory);
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(source_directory() / "scenes" / "pbrt")) {
            if (entry.path().extension() == ".pbrt")
                files.push_back(entry.path());
            else if (entry.is_regular_file())
                std::filesystem::copy_file(entry.path(), directory / entry.path().filename(),
                                           std::filesystem::copy_options::overwrite_existing);
        }
        std::sort(files.begin(), files.end()); // directories have no order of their own
        for (const std::filesystem::path& file : files)
            corpus_.push_back(read_file(file));
    }

    std::string make(Random& random) override {
        std::string text = random.pick(corpus_);
        for (std::uint64_t n = random.below(6); n > 0 && !text.empty(); --n)
            switch (random.below(6)) {
            case 0:
                replace_token(text, random, edge_values);
                break;
            case 1:
                replace_token(text, random, pbrt_words);
                break;
            case 2: {
                const std::size_t line = text.find('\n', random.below(text.size()));
                text.insert(line == std::string::npos ? text.size() : line,
                            fmt::format("\n{}", random.pick(directives)));
                break;
            }
            case 3:
                shuffle_lines(text, random);
                break;
            case 4:
                mutate_bytes(text, random, random.pick(corpus_));
                break;
            default:
                replace_token(text, random, ordinary_numbers);
            }
        return text;
    }

    void use(const std::string& input, Random&) override {
        const std::filesystem::path file = directory_ / "scene.pbrt";
        PbrtTranslationOptions coarse; // a cloud as fine as usual takes seconds
        coarse.most_cloud_voxels = 4096;
        const PbrtTranslation translation = translate_pbrt(read_pbrt(input, file), coarse);
        for (const std::string& note : translation.notes)
            expect(note.size() <= 4000 && note.find('\n') == std::string::npos, "a note is not one short line");
        const Scene scene = parse_scene(translation, file);
        use_scene(scene);
    }

private:
    std::filesystem::path directory_;
    std::vector<std::string> corpus_;
};

} // namespace

Target& pbrt_target() {
    static PbrtTarget target;
    return target;
}

} // namespace vkvol::fuzz
