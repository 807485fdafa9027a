// Scene files: built as their schema allows, or taken from scenes/, then damaged as elements, as words and as bytes.
#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <regex>
#include <span>
#include <string_view>

#include "corpus.h"
#include "mutate.h"
#include "scene_schema.h"
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

std::string value_of(const std::string& name, const ValueKind& kind, Source& random) {
    if (random.at_edge())
        return random.pick(edge_values);
    if (!kind.words.empty() && !(kind.is_number && random.one_in(2)))
        return random.pick(kind.words);
    const auto* texts = std::find_if(std::begin(ordinary_texts), std::end(ordinary_texts),
                                     [&](const Texts& texts) { return texts.name == name; });
    if (texts != std::end(ordinary_texts))
        return one_of(texts->alternatives, random);
    std::string value;
    for (std::uint64_t n = kind.least + random.below(kind.most - kind.least + 1); n > 0; --n) {
        const auto highest = static_cast<std::uint64_t>(std::clamp(kind.high, 1.0, 200.0));
        value +=
            (value.empty() ? "" : " ") + (kind.is_whole ? std::to_string(random.below(highest) + 1) : number(random));
    }
    return value;
}

// Of elements that exclude each other a scene, or a volume, mostly has one.
constexpr std::string_view exclusive[][6] = {
    {"densityField", "densityField", "sphere", "box", "everywhere", "models"},
    {"camera", "camera", "camera", "irradiance", "fluence", "absorption"},
    {"heyneygreenstein_g", "heynegreenstein_g", "phase", "phase", "phase", "phase"},
};

class SceneMaker {
public:
    SceneMaker(const SceneSchema& schema, Source& random) : schema_(schema), random_(random) {}

    std::string scene() { return element(schema_.root(), 0, ""); }

    // Any, in one line or several, as at the place of another.
    std::string part() {
        const ChildKind* at = &schema_.root();
        do
            at = &random_.pick(at->kind->children);
        while (!at->kind->children.empty() && !random_.one_in(3));
        return element(*at, 1, "");
    }

private:
    // `ascending`: the value of its first attribute, if not empty.
    std::string element(const ChildKind& child, int depth, const std::string& ascending) {
        const std::string indent(2 * static_cast<std::size_t>(depth), ' ');
        std::string xml = indent + "<" + child.name;
        const std::uint64_t rarity = random_.pick(rarities);
        for (const AttributeKind& attribute : child.kind->attributes) {
            const bool is_first = &attribute == child.kind->attributes.data() && !ascending.empty();
            if (attribute.is_required || is_first || random_.one_in(rarity))
                xml += fmt::format(" {}=\"{}\"", attribute.name,
                                   is_first ? ascending : value_of(attribute.name, attribute.value, random_));
        }
        const std::string inner = children(*child.kind, depth);
        const std::string text = child.kind->text ? value_of(child.name, *child.kind->text, random_) : "";
        if (inner.empty() && text.empty())
            return xml + "/>\n";
        return xml + ">" + text + (inner.empty() ? "" : "\n" + inner + indent) + "</" + child.name + ">\n";
    }

    std::string children(const ElementKind& kind, int depth) {
        std::vector<std::string_view> chosen;
        for (const auto& names : exclusive)
            chosen.push_back(random_.pick(names));
        std::string xml;
        for (const ChildKind& child : kind.children) {
            const bool may_be = child.repeats || random_.one_in(40) || !is_excluded(child.name, chosen);
            const std::uint64_t rarity = is_among(child.name, chosen) && depth < 2 ? 2 : 5;
            double value = 0.0; // of points of maps, and heights of layers, which ascend
            for (std::uint64_t n = child.repeats ? random_.below(4) : random_.one_in(rarity); n > 0 && may_be; --n) {
                value += random_.one_in(4) ? 0.0 : 0.1 * static_cast<double>(1 + random_.below(5));
                const bool ascends = kind.children.size() == 1 && !child.kind->attributes.empty() &&
                                     child.kind->attributes.front().is_required && !random_.one_in(20);
                xml += element(child, depth + 1, ascends ? fmt::format("{}", value) : "");
            }
        }
        return xml;
    }

    static bool is_among(std::string_view name, const std::vector<std::string_view>& names) {
        return std::find(names.begin(), names.end(), name) != names.end();
    }
    static bool is_excluded(std::string_view name, const std::vector<std::string_view>& chosen) {
        const auto has = [&](const auto& names) {
            return std::find(std::begin(names), std::end(names), name) != std::end(names);
        };
        return std::any_of(std::begin(exclusive), std::end(exclusive), has) && !is_among(name, chosen);
    }

    static constexpr std::uint64_t rarities[] = {1, 2, 4, 12};
    const SceneSchema& schema_;
    Source& random_;
};

// Between < and >, or an element on its line.
void damage_elements(std::string& xml, const SceneSchema& schema, Source& random) {
    switch (random.below(6)) {
    case 0: {
        const std::string added = SceneMaker(schema, random).part();
        const std::size_t line = xml.find('\n', random.below(xml.size()));
        xml.insert(line == std::string::npos ? xml.size() : line + 1, added);
        break;
    }
    case 1: { // deep nesting
        const std::string name = random.pick(schema.names());
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
        piece += random.pick(schema.names());
        const std::uint64_t times = 1 + random.below(random.one_in(20) ? 10000 : 100);
        std::string many;
        for (std::uint64_t i = 0; i < times; ++i)
            many += piece;
        xml.insert(random.below(xml.size()), many);
        break;
    }
    case 3:
        replace_token(xml, random, schema.names());
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
        schema_.emplace(scenes / "vkvol.xsd");
        for (const std::filesystem::path& folder : {scenes, scenes / "thesis"})
            for (const auto& entry : std::filesystem::directory_iterator(folder))
                if (entry.path().extension() == ".xml")
                    files_.push_back(entry.path());
        std::sort(files_.begin(), files_.end()); // directories have no order of their own
        for (const std::filesystem::path& file : files_)
            corpus_.push_back(read_file(file));
        make_named_files();
    }

    std::string make(Random& seeded) override {
        Source random(seeded);
        std::string xml = random.one_in(3) ? random.pick(corpus_) : SceneMaker(*schema_, random).scene();
        if (random.one_in(3))
            for (std::uint64_t n = 1 + random.below(4); n > 0 && !xml.empty(); --n)
                replace_token(xml, random, random.one_in(4) ? std::span<const char* const>(edge_values) : words_);
        if (random.one_in(6) && !xml.empty())
            damage_elements(xml, *schema_, random);
        if (random.one_in(6))
            mutate_bytes(xml, random, random.pick(corpus_));
        return xml;
    }

    void use(const std::string& input, Random& seeded) override {
        Source random(seeded);
        Defines defines;
        if (random.one_in(50) || input.find("$a") != std::string::npos)
            defines["a"] = number(random);
        if (input.find("$long") != std::string::npos)
            defines["long"] = std::string(random.below(100000), 'x');
        SceneOverrides overrides;
        if (random.one_in(10))
            overrides.integrator = integrator(random);
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
    // What the corpus names, so that it is read further than to there.
    void make_named_files() {
        const std::regex name(R"re(baseDir="([^"$]*)">([^<$]*[.](nvdb|obj))<)re");
        for (const std::string& xml : corpus_)
            for (std::sregex_iterator match(xml.begin(), xml.end(), name), end; match != end; ++match) {
                std::string folder = (*match)[1];
                std::replace(folder.begin(), folder.end(), '\\', '/');
                const std::filesystem::path file = directory_ / folder / (*match)[2].str();
                std::filesystem::create_directories(file.parent_path());
                std::filesystem::copy_file(directory_ / ((*match)[3] == "obj" ? "ball.obj" : "fire.nvdb"), file,
                                           std::filesystem::copy_options::skip_existing);
            }
        for (const char* value : edge_values)
            if (std::string_view(value).find_first_of("<>&$\"'\x01") == std::string_view::npos)
                words_.push_back(value);
    }

    // A name, and mostly one of its axes.
    std::string integrator(Source& random) {
        const std::vector<ChildKind>& all = schema_->root().kind->children;
        const ElementKind& kind = *std::find_if(all.begin(), all.end(), [](const ChildKind& child) {
                                       return child.name == "integrator";
                                   })->kind;
        const AttributeKind& axis = random.pick(kind.attributes);
        return value_of("integrator", *kind.text, random) +
               (random.one_in(2) ? ":" + axis.name + "=" + value_of(axis.name, axis.value, random) : "");
    }

    std::filesystem::path directory_;
    std::optional<SceneSchema> schema_;
    std::vector<std::filesystem::path> files_;
    std::vector<std::string> corpus_;
    std::vector<const char*> words_; // edge values that leave XML well formed
};

} // namespace

Target& scene_target() {
    static SceneTarget target;
    return target;
}

} // namespace vkvol::fuzz
