// Scene files: built from the vocabulary, or taken from scenes/, then damaged as elements, as words and as bytes.
#include <algorithm>
#include <fmt/format.h>
#include <string_view>
#include <utility>

#include "corpus.h"
#include "mutate.h"
#include "scene_words.h"
#include "scene_xml.h"
#include "target.h"
#include "use_scene.h"

namespace vkvol::fuzz {

namespace {

// Most values are ordinary, or no scene would be read to its end.
struct Source : Random {
    explicit Source(Random& random) : Random(random.next()), rate(pick(rates)) {}
    bool at_edge() { return rate > 0 && one_in(rate); }

    static constexpr std::uint64_t rates[] = {0, 0, 60, 20};
    std::uint64_t rate; // one in how many values; 0: none
};

std::string number(Source& random) {
    return random.at_edge() ? random.pick(edge_values) : random.pick(ordinary_numbers);
}

std::string one_of(std::string_view alternatives, Random& random) {
    const auto count = 1 + std::count(alternatives.begin(), alternatives.end(), '|');
    for (std::uint64_t skip = random.below(static_cast<std::uint64_t>(count)); skip > 0; --skip)
        alternatives.remove_prefix(alternatives.find('|') + 1);
    return std::string(alternatives.substr(0, alternatives.find('|')));
}

std::string attribute_value(std::string_view name, Source& random) {
    if (random.at_edge())
        return random.pick(edge_values);
    if (name == "unit")
        return one_of("voxel|world|world", random);
    if (name == "model")
        return one_of("color|blackbody", random);
    if (name == "brightness")
        return one_of("planck|peak", random);
    if (name == "grid")
        return one_of("density|temperature|density|colour|other", random);
    if (name == "baseDir")
        return one_of(".|./|", random);
    if (name == "file")
        return one_of("phase.txt|ball.obj|none.txt|.", random);
    if (name == "jitter" || name == "mirror")
        return one_of("true|false", random);
    if (name == "scattering")
        return one_of("none|single|multiple", random);
    if (name == "flight")
        return one_of("analytic|regular|march|adaptive|delta|weighted|decomposition|spectral", random);
    if (name == "transmittance")
        return one_of("analytic|regular|delta|ratio|residual|march|telescoping|jackknife", random);
    if (name == "nee")
        return one_of("none|collisions|tentative", random);
    if (name == "emission")
        return one_of("collisions|steps", random);
    if (name == "mis")
        return one_of("balance|power|light|phase", random);
    if (name == "mapping")
        return one_of("equirectangular|equalArea", random);
    if (name == "distance")
        return one_of("flights|mixed", random);
    if (name == "up" && random.one_in(2))
        return one_of("x|y|z", random);
    if (name == "lookAt" || name == "up")
        return one_of("0 0 0|1 2 3|0 0", random);
    if (name == "values")
        return one_of("1 0 0 0 0 1 0 0 0 0 1 0|1 2 3 4 0 2 0 1 1 0 3 2 0 0 0 1|1 0 0", random);
    if (name == "albedo" || (name == "emission" && random.one_in(2)))
        return one_of("0.5|0.9 0.5 0.2|1|0 1", random);
    if (name == "kelvin")
        return one_of("|2000|6500", random);
    if (name == "material")
        return one_of("diffuse|mirror|conductor|dielectric|coated|thinDielectric", random);
    if (name == "normals")
        return one_of("file|flat|smooth", random);
    if (name == "metal")
        return one_of("gold|copper|silver|aluminium|tin", random);
    if (name == "sides")
        return one_of("1|2", random);
    if (name == "eta" || name == "k")
        return one_of("1.5|0.2 0.9 1.1|1 2", random);
    if (name == "octaves" || name == "cell")
        return std::to_string(1 + random.below(16));
    if (name == "lacunarity" || name == "reference")
        return one_of("2|1|100|640", random);
    return number(random);
}

const Words& words_of(std::string_view name) {
    return *std::find_if(std::begin(grammar), std::end(grammar),
                         [&](const Words& words) { return words.element == name; });
}

std::string element(const Words& words, Source& random) {
    std::string xml = fmt::format("  <{}", words.element);
    const bool all = random.one_in(2) || std::string_view(words.element).starts_with("sigma");
    for (const char* name : words.attributes)
        if (name && (all ? !(std::string_view(name) == "unit" && random.one_in(2)) : random.one_in(3)))
            xml += fmt::format(" {}=\"{}\"", name, attribute_value(name, random));
    const std::string_view kind = words.text;
    if (kind.empty())
        return xml + "/>\n";
    const std::string text = random.at_edge() ? random.pick(edge_values)
                             : kind == "n"    ? number(random)
                             : kind == "i"    ? std::to_string(1 + random.below(200))
                                              : one_of(kind, random);
    return xml + fmt::format(">{}</{}>\n", text, words.element);
}

// A map of a grid's values by points, most of which ascend.
std::string map_by_points(Source& random) {
    const bool transfer = random.one_in(2);
    const char* name = transfer ? "transferFunction" : "densityMap";
    std::string xml = fmt::format("  <{}>\n", name);
    double value = 0.0;
    for (std::uint64_t points = random.below(6); points > 0; --points) {
        std::string point = element(point_grammar[transfer], random);
        if (const std::size_t at = point.find("value=\""); at != std::string::npos && !random.one_in(20)) {
            value += random.one_in(4) ? 0.0 : 0.1 * static_cast<double>(random.below(5));
            const std::size_t begin = at + 7;
            point.replace(begin, point.find('"', begin) - begin, fmt::format("{}", value));
        }
        xml += point;
    }
    return xml + fmt::format("  </{}>\n", name);
}

// A volume with some of the elements that a medium has.
std::string volume(Source& random) {
    const char* names[] = {"a", "b", "c", ""};
    std::string xml = "  <volume";
    for (const char* attribute : {"name", "like"})
        if (random.one_in(3))
            xml += fmt::format(" {}=\"{}\"", attribute, names[random.below(4)]);
    xml += ">\n";
    if (!random.one_in(4))
        xml += element(grammar[random.below(4)], random);
    for (const char* name :
         {"noise", "layers", "sigma_a", "sigma_s", "phase", "medium", "emission", "albedo", "densityMap"})
        if (random.one_in(3))
            xml += element(words_of(name), random);
    if (random.one_in(4))
        xml += map_by_points(random);
    if (random.one_in(2)) {
        xml += "  <transform>\n";
        for (std::uint64_t steps = random.below(4); steps > 0; --steps)
            xml += element(random.pick(step_grammar), random);
        xml += "  </transform>\n";
    }
    return xml + "  </volume>\n";
}

// With what it holds between its tags.
std::string surface(Source& random) {
    const Words& words = random.pick(surface_grammar);
    std::string xml = element(words, random);
    xml.replace(xml.rfind("/>"), 2, ">");
    if (random.one_in(3))
        xml += element(random.pick(shine_grammar), random);
    if (std::string_view(words.element) == "mesh" && random.one_in(2))
        for (const Words& part : part_grammar)
            if (!random.one_in(5))
                xml += element(part, random);
    if (random.one_in(3)) {
        xml += "  <transform>\n";
        for (std::uint64_t steps = random.below(3); steps > 0; --steps)
            xml += element(random.pick(step_grammar), random);
        xml += "  </transform>\n";
    }
    return xml + fmt::format("  </{}>\n", words.element);
}

std::string build(Source& random) {
    std::string xml = "<options>\n";
    if (random.one_in(3)) {
        xml += "  <volumes>\n";
        for (std::uint64_t volumes = random.below(4); volumes > 0; --volumes)
            xml += volume(random);
        xml += "  </volumes>\n";
    }
    switch (random.below(5)) { // one medium, mostly
    case 0:
        xml += element(grammar[0], random);
        break;
    case 1:
        xml += "  <models><model>ball.obj</model></models>\n";
        break;
    default:
        xml += element(grammar[1 + random.below(3)], random);
    }
    bool both_sigmas[2] = {false, false};
    for (std::size_t i = 4; i < std::size(grammar); ++i) {
        const std::string_view name = grammar[i].element;
        if (!random.one_in(4) || ((name == "noise" || name == "layers") && !random.one_in(3)))
            continue;
        if (name.starts_with("sigma") && std::exchange(both_sigmas[name.back() == 's'], true))
            continue;
        xml += element(grammar[i], random);
    }
    if (random.one_in(6))
        xml += map_by_points(random);
    if (random.one_in(4)) {
        xml += "  <surfaces>\n";
        for (std::uint64_t surfaces = random.below(4); surfaces > 0; --surfaces)
            xml += surface(random);
        xml += "  </surfaces>\n";
    }
    if (random.one_in(3)) {
        xml += "  <lights>\n";
        for (std::uint64_t lights = random.below(4); lights > 0; --lights)
            xml += element(random.pick(light_grammar), random);
        xml += "  </lights>\n";
    }
    return xml + "</options>\n";
}

// Between < and >, or an element on its line.
void damage_elements(std::string& xml, Source& random) {
    switch (random.below(6)) {
    case 0: {
        const std::string added = element(random.one_in(4) ? random.pick(light_grammar) : random.pick(grammar), random);
        const std::size_t line = xml.find('\n', random.below(xml.size()));
        xml.insert(line == std::string::npos ? xml.size() : line + 1, added);
        break;
    }
    case 1: { // deep nesting
        const std::string name = random.pick(element_names);
        const std::uint64_t depth = 1 + random.below(random.one_in(20) ? 20000 : 20);
        std::string open, close;
        for (std::uint64_t i = 0; i < depth; ++i) {
            open += "<" + name + ">";
            if (!random.one_in(5000))
                close += "</" + name + ">";
        }
        const std::size_t line = xml.find('\n', random.below(xml.size()));
        xml.insert(line == std::string::npos ? xml.size() : line + 1, open + close);
        break;
    }
    case 2: { // something very long
        std::string piece = random.pick(edge_values);
        piece += random.pick(element_names);
        const std::uint64_t times = 1 + random.below(random.one_in(20) ? 10000 : 100);
        std::string many;
        for (std::uint64_t i = 0; i < times; ++i)
            many += piece;
        xml.insert(random.below(xml.size()), many);
        break;
    }
    case 3:
        replace_token(xml, random, element_names);
        break;
    default:
        shuffle_lines(xml, random);
    }
}

class SceneTarget : public Target {
public:
    // OpenImageIO reads maps of the sky, as in image_target.cpp.
    SceneTarget() : Target("scene", ".xml", 256, 0) {}

    void prepare(const std::filesystem::path& directory) override {
        directory_ = directory;
        write_scene_files(directory);
        const std::filesystem::path scenes = source_directory() / "scenes";
        for (const std::filesystem::path& folder : {scenes, scenes / "thesis"})
            for (const auto& entry : std::filesystem::directory_iterator(folder))
                if (entry.path().extension() == ".xml")
                    files_.push_back(entry.path());
        std::sort(files_.begin(), files_.end()); // directories have no order of their own
        for (const std::filesystem::path& file : files_)
            corpus_.push_back(read_file(file));
    }

    std::string make(Random& seeded) override {
        Source random(seeded);
        std::string xml = random.one_in(3) ? random.pick(corpus_) : build(random);
        if (random.one_in(3))
            for (std::uint64_t n = 1 + random.below(4); n > 0 && !xml.empty(); --n)
                replace_token(xml, random, edge_values);
        if (random.one_in(6) && !xml.empty())
            damage_elements(xml, random);
        if (random.one_in(6))
            mutate_bytes(xml, random, random.pick(corpus_));
        return xml;
    }

    void use(const std::string& input, Random& seeded) override {
        Source random(seeded);
        Defines defines;
        if (random.one_in(8) || input.find("$a") != std::string::npos)
            defines["a"] = number(random);
        if (input.find("$long") != std::string::npos)
            defines["long"] = std::string(random.below(100000), 'x');
        SceneOverrides overrides;
        if (random.one_in(10))
            overrides.integrator = one_of(words_of("integrator").text, random) +
                                   (random.one_in(2) ? ":flight=" + attribute_value("flight", random) : "");
        if (random.one_in(20))
            overrides.grid = directory_ / "cloud.nvdb";
        Scene scene = parse_scene(input, directory_ / "scene.xml", defines, overrides);
        for (const std::string& warning : scene.warnings)
            expect(warning.size() <= 4000 && warning.find('\n') == std::string::npos,
                   "a warning is not one short line");
        if (random.one_in(4))
            resize_picture(scene.picture, static_cast<int>(1 + random.below(65536)), std::nullopt);
        use_scene(scene);
    }

private:
    std::filesystem::path directory_;
    std::vector<std::filesystem::path> files_;
    std::vector<std::string> corpus_;
};

} // namespace

Target& scene_target() {
    static SceneTarget target;
    return target;
}

} // namespace vkvol::fuzz
