// What lights are read from: maps of the sky, and tables of phase functions.
#include <OpenImageIO/imageio.h>
#include <array>
#include <cmath>

#include "mutate.h"
#include "phase_table.h"
#include "sky_map.h"
#include "target.h"

namespace vkvol::fuzz {

namespace {

// PNG has sums of its own, by which what is damaged is refused without being read.
constexpr std::array<const char*, 2> formats = {"exr", "hdr"};

std::string format_of(const std::string& bytes, Random& random) {
    if (bytes.starts_with("\x76\x2f\x31\x01"))
        return "exr";
    if (bytes.starts_with("#?"))
        return "hdr";
    return random.pick(formats);
}

void write_map(const std::filesystem::path& file, int width, int height, int channels) {
    OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::FLOAT);
    std::vector<float> values(std::size_t(width) * std::size_t(height) * std::size_t(channels));
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = 0.25f + 0.5f * float(i % 7);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(file.string());
    if (!output || !output->open(file.string(), spec) || !output->write_image(OIIO::TypeDesc::FLOAT, values.data()))
        throw std::runtime_error(file.string() + ": cannot be made");
    output->close();
}

class SkyTarget : public Target {
public:
    SkyTarget() : Target("sky", ".map", 512, 1040) {}

    void prepare(const std::filesystem::path& directory) override {
        OIIO::attribute("threads", 1);
        OIIO::attribute("exr_threads", 1);
        directory_ = directory;
        for (const char* format : formats)
            for (const auto& [width, height, channels] :
                 {std::tuple(16, 8, 3), std::tuple(8, 8, 3), std::tuple(5, 1, 1)}) {
                const bool is_whole = format == std::string("hdr") && channels == 1; // which has three alone
                const std::filesystem::path file = directory / (std::string("map.") + format);
                write_map(file, width, height, is_whole ? 3 : channels);
                corpus_.push_back(read_file(file));
            }
    }

    std::string make(Random& random) override {
        std::string file = random.pick(corpus_);
        if (random.one_in(2)) // the header
            put_interesting(std::as_writable_bytes(std::span(file)),
                            random.below(std::min<std::size_t>(file.size(), 400) - 8), random);
        else
            mutate_bytes(file, random, random.pick(corpus_));
        return file;
    }

    void use(const std::string& input, Random& random) override {
        SkyLight light;
        light.file = directory_ / ("input." + format_of(input, random));
        light.mapping = random.one_in(2) ? SkyMapping::equal_area : SkyMapping::equirectangular;
        light.mirror = random.one_in(4);
        write_file(light.file, input);
        const SkyMap sky = load_sky(light);
        const std::size_t texels = std::size_t(sky.width) * sky.height;
        expect(texels > 0 && sky.texels.size() == texels && sky.alias.size() == texels + sky.height,
               "a map has other sizes than it says");
        bool shines = false;
        for (const glm::vec4& texel : sky.texels) {
            for (int c = 0; c < 4; ++c)
                expect(std::isfinite(texel[c]) && texel[c] >= 0.0f, "a map has texels that are negative or not finite");
            expect(texel.w > 0.0f || texel.x + texel.y + texel.z == 0.0f, "light is never drawn");
            shines = shines || texel.w > 0.0f;
        }
        expect(shines && std::isfinite(sky.unevenness) && sky.unevenness > 0.999, "a map without light is taken");
        for (std::size_t i = 0; i < sky.alias.size(); ++i)
            expect(sky.alias[i].other < (i < sky.height ? sky.height : sky.width), "a choice leads out of its table");
    }

private:
    std::filesystem::path directory_;
    std::vector<std::string> corpus_;
};

constexpr const char* numbers[] = {
    "0", "180", "90", "1",    "-1",  "1e300", "1e-300", "nan",   "inf", "0.5",
    "#", ",",   ";",  "1e38", "360", "0x10",  "1,5",    "\"a\"", "",    "179.9999999999"};

class PhaseTarget : public Target {
public:
    PhaseTarget() : Target("phase", ".txt", 256, 2000) {}

    void prepare(const std::filesystem::path& directory) override {
        file_ = directory / "phase.txt";
        std::string moments;
        for (int l = 0; l < 40; ++l)
            moments += std::to_string(std::pow(0.6, l)) + "\n";
        corpus_ = {"0 5\n30 1\n90 .2\n180 .4\n", "# angle, value\n0, 1e4\n0.01, 100\n1, 1\n180, 0.1\n", moments,
                   "1\n0.5\n", read_file(source_directory() / "scenes/gallery/fogbow.txt")};
    }

    std::string make(Random& random) override {
        std::string text = random.pick(corpus_);
        for (std::size_t i = 1 + random.below(4); i > 0; --i)
            if (random.one_in(3))
                mutate_bytes(text, random, random.pick(corpus_));
            else if (random.one_in(3))
                shuffle_lines(text, random);
            else
                replace_token(text, random, numbers);
        return text;
    }

    void use(const std::string& input, Random&) override {
        write_file(file_, input);
        const PhaseTable table = load_phase_table(file_);
        expect(table.nodes.size() >= 2 && table.nodes.front().x == 0.0f && table.nodes.back().x == 2.0f,
               "a phase function is not of all directions");
        for (std::size_t i = 0; i < table.nodes.size(); ++i) {
            const shared::PhaseNode& node = table.nodes[i];
            expect(std::isfinite(node.value) && node.value >= 0.0f, "a phase function is negative or not finite");
            expect(node.share >= 0.0f && node.share <= 1.0f, "shares leave [0, 1]");
            expect(i == 0 || (node.x > table.nodes[i - 1].x && node.share >= table.nodes[i - 1].share),
                   "nodes do not rise");
        }
    }

private:
    std::filesystem::path file_;
    std::vector<std::string> corpus_;
};

} // namespace

Target& sky_target() {
    static SkyTarget target;
    return target;
}

Target& phase_target() {
    static PhaseTarget target;
    return target;
}

} // namespace vkvol::fuzz
