// Command lines: the program's own words in any order, with ordinary and absurd values.
#include <algorithm>
#include <cmath>

#include "mutate.h"
#include "option_values.h"
#include "options.h"
#include "requested_scene.h"
#include "scene_words.h"
#include "target.h"

namespace vkvol::fuzz {

namespace {

constexpr const char* options_words[] = {"render",
                                         "devices",
                                         "info",
                                         "integrators",
                                         "compare",
                                         "merge",
                                         "develop",
                                         "bench",
                                         "measure",
                                         "view",
                                         "init",
                                         "convert",
                                         "demo",
                                         "scene.xml",
                                         "a.exr",
                                         "b.exr",
                                         "cloud.nvdb",
                                         "-o",
                                         "--output",
                                         "--width",
                                         "--height",
                                         "--crop",
                                         "--tonemap",
                                         "--exposure",
                                         "--spp",
                                         "--time",
                                         "--noise",
                                         "--seed",
                                         "--sample-offset",
                                         "--alpha",
                                         "--aov",
                                         "--checkpoint",
                                         "--frame",
                                         "--pixel",
                                         "--preview",
                                         "--resume",
                                         "--sample",
                                         "--schedule",
                                         "--tev",
                                         "--trace",
                                         "--up",
                                         "--integrator",
                                         "--grid",
                                         "-D",
                                         "--define",
                                         "--device",
                                         "--robust",
                                         "--validate",
                                         "--no-cache",
                                         "--report",
                                         "--progress",
                                         "-q",
                                         "--quiet",
                                         "--strict",
                                         "--version",
                                         "--help",
                                         "-h",
                                         "--json",
                                         "--significance",
                                         "--max-relmse",
                                         "-f",
                                         "--frames",
                                         "--dry-run",
                                         "--spp=4",
                                         "--time=5m",
                                         "--noise=1%",
                                         "--crop=0,1,0,1",
                                         "-ofile.png",
                                         "-Dkey=value",
                                         "--",
                                         "-",
                                         "--unknown",
                                         "-z",
                                         "--widht",
                                         "rendr"};

constexpr const char* values[] = {"4",
                                  "100",
                                  "16",
                                  "0",
                                  "5m",
                                  "30s",
                                  "2h",
                                  "1e308h",
                                  "1e-320s",
                                  "0.5,1,0.,1.",
                                  "0,100,0,50",
                                  "0,0,0,0",
                                  "1e300,2,3,4",
                                  "nan,1,2,3",
                                  "0.1,0.2,0.3,0.4,0.5",
                                  ",,,",
                                  "srgb",
                                  "aces",
                                  "agx",
                                  "reinhard",
                                  "auto",
                                  "json",
                                  "cpu",
                                  "key=value",
                                  "key",
                                  "=",
                                  "k=",
                                  "ratioTracking",
                                  "ratioTracking:flight=weighted",
                                  "ratioTracking:flight",
                                  "ratioTracking::",
                                  ":",
                                  "deltaTracking:nee=none:nee=none",
                                  "1..8",
                                  "8..1x3",
                                  "1,5..9,7",
                                  "0..99999999",
                                  "1..2x0",
                                  "F=3",
                                  "out.####.exr",
                                  "out.exr",
                                  "out.png"};

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

void check_render(const RenderOptions& render, Random& random) {
    expect(!render.scene.empty() && !render.outputs.empty(), "a render without a scene or without an output");
    if (render.noise_goal)
        expect(*render.noise_goal > 0.0 && *render.noise_goal < 1.0, "a goal of noise is out of range");
    if (render.time_limit)
        expect(std::isfinite(*render.time_limit) && *render.time_limit > 0.0, "a time limit is not finite");
    const std::uint64_t spp = render.spp.value_or(1);
    expect(spp >= 1 && spp + render.sample_offset < (1ull << 32), "sample numbers do not fit 32 bits");
    if (render.time_limit && !render.spp)
        expect(render.sample_offset < 2147483647u, "time alone decides, but no sample is left to take");
    Picture picture;
    picture.width = static_cast<int>(1 + random.below(65536));
    picture.height = static_cast<int>(1 + random.below(200));
    const Crop crop = resolve_crop(render.crop, picture);
    expect(crop.x0 >= 0 && crop.x0 < crop.x1 && crop.x1 <= picture.width && crop.y0 >= 0 && crop.y0 < crop.y1 &&
               crop.y1 <= picture.height,
           "a crop leaves the picture");
}

class OptionsTarget : public Target {
public:
    OptionsTarget() : Target("options", ".txt", 16, 100) {}

    void prepare(const std::filesystem::path&) override {}

    // One argument a line.
    std::string make(Random& random) override {
        std::string text;
        for (std::uint64_t n = random.below(12); n > 0; --n) {
            std::string word = random.one_in(3) ? random.pick(values) : random.pick(options_words);
            if (random.one_in(10))
                word = random.pick(edge_values);
            if (random.one_in(30))
                word.append("=").append(random.pick(values));
            text += word;
            text += '\n';
        }
        if (random.one_in(5) && !text.empty())
            mutate_bytes(text, random, text);
        if (random.one_in(200))
            text.append(random.below(100000), random.one_in(2) ? '-' : 'x').append("\n");
        return text;
    }

    void use(const std::string& input, Random& random) override {
        const std::vector<std::string> arguments = split(input);
        std::vector<const char*> argv = {"vkvol"};
        for (const std::string& argument : arguments)
            argv.push_back(argument.c_str());
        const Options options = parse_options(static_cast<int>(argv.size()), argv.data());
        if (options.command == Command::render)
            check_render(options.render, random);
        if (options.command == Command::print)
            expect(!options.text.empty(), "nothing to print");
    }
};

} // namespace

Target& options_target() {
    static OptionsTarget target;
    return target;
}

} // namespace vkvol::fuzz
