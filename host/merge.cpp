#include "merge.h"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <limits>

#include "error.h"
#include "image_io.h"
#include "one_line.h"

namespace vkvol {

namespace {

bool same_window(const Crop& a, const Crop& b) {
    return a.x0 == b.x0 && a.x1 == b.x1 && a.y0 == b.y0 && a.y1 == b.y1;
}

bool disjoint(const Crop& a, const Crop& b) {
    return a.x1 <= b.x0 || b.x1 <= a.x0 || a.y1 <= b.y0 || b.y1 <= a.y0;
}

std::string text_of(const Metadata& metadata, const std::string& key) {
    const auto found = metadata.find(key);
    if (found == metadata.end())
        return "";
    return std::visit([](const auto& value) { return fmt::format("{}", value); }, found->second);
}

int int_of(const Metadata& metadata, const std::string& key) {
    const auto found = metadata.find(key);
    const int* value = found == metadata.end() ? nullptr : std::get_if<int>(&found->second);
    return value ? *value : 0;
}

[[noreturn]] void refuse(const MergeInput& a, const MergeInput& b, const std::string& why) {
    throw InputError(one_line(fmt::format("{} and {} do not belong together: {}", a.name, b.name, why)));
}

// The same seed and overlapping sample ranges: the same random numbers, counted twice.
bool shares_samples(const Metadata& a, const Metadata& b) {
    if (!a.count("vkvol/seed") || text_of(a, "vkvol/seed") != text_of(b, "vkvol/seed"))
        return false;
    const std::int64_t begin_a = int_of(a, "vkvol/sampleOffset");
    const std::int64_t begin_b = int_of(b, "vkvol/sampleOffset");
    const std::int64_t end_a = begin_a + int_of(a, "samplesPerPixel");
    const std::int64_t end_b = begin_b + int_of(b, "samplesPerPixel");
    return begin_a < end_b && begin_b < end_a;
}

void check_pair(const MergeInput& a, const MergeInput& b) {
    if (a.film.picture_width != b.film.picture_width || a.film.picture_height != b.film.picture_height)
        refuse(a, b,
               fmt::format("the pictures are {}x{} and {}x{}", a.film.picture_width, a.film.picture_height,
                           b.film.picture_width, b.film.picture_height));
    for (const char* key : {"vkvol/sceneHash", "vkvol/integrator"})
        if (text_of(a.metadata, key) != text_of(b.metadata, key))
            refuse(a, b, fmt::format("{} is '{}' and '{}'", key, text_of(a.metadata, key), text_of(b.metadata, key)));
    if (same_window(a.film.crop, b.film.crop)) {
        if (shares_samples(a.metadata, b.metadata))
            refuse(a, b,
                   "they hold the same samples (seed and sample range); give each run its own --sample-offset or "
                   "--seed");
    } else if (!disjoint(a.film.crop, b.film.crop)) {
        refuse(a, b, "their windows overlap without being equal; render equal or disjoint --crop windows");
    }
}

void check_input(const MergeInput& input) {
    const std::vector<std::uint32_t>& samples = input.film.samples;
    if (std::all_of(samples.begin(), samples.end(), [](std::uint32_t n) { return n == 0; }))
        throw InputError(fmt::format("{}: does not say how many samples its pixels have; merge needs images written by "
                                     "vkvol",
                                     input.name));
}

// n samples with this mean and sum of squares per channel.
struct Moments {
    std::uint64_t n = 0;
    glm::dvec3 sum{0.0};
    glm::dvec3 squares{0.0}; // sum of squares about the mean of the pixel

    // Chan, Golub and LeVeque's pairwise update: no cancellation, unlike raw second moments.
    void add(std::uint64_t n2, const glm::dvec3& mean2, const glm::dvec3& squares2) {
        if (n2 == 0)
            return;
        const glm::dvec3 delta = n > 0 ? mean2 - sum / double(n) : glm::dvec3(0.0);
        squares += squares2 + delta * delta * (double(n) * double(n2) / double(n + n2));
        sum += mean2 * double(n2);
        n += n2;
    }
};

Crop bounding_window(const std::vector<MergeInput>& inputs) {
    Crop window = inputs.front().film.crop;
    for (const MergeInput& input : inputs) {
        const Crop& crop = input.film.crop;
        window = {std::min(window.x0, crop.x0), std::max(window.x1, crop.x1), std::min(window.y0, crop.y0),
                  std::max(window.y1, crop.y1)};
    }
    return window;
}

// Specks far apart in a huge picture would need all the memory for the black between them.
void check_coverage(const std::vector<MergeInput>& inputs, const Crop& window) {
    constexpr std::uint64_t any = 1 << 24, sparsest = 64; // pixels of any window, and per pixel that is there
    std::uint64_t pixels = 0;
    for (const MergeInput& input : inputs)
        pixels += input.film.pixel_count();
    const std::uint64_t width = std::uint64_t(window.x1 - window.x0), height = std::uint64_t(window.y1 - window.y0);
    if (width * height > any && width * height / sparsest > pixels)
        throw InputError(fmt::format("the images hold {} pixels of a window of {}x{}; merge what lies side by side, or "
                                     "render the rest of the picture",
                                     pixels, width, height));
}

void add_film(const Film& film, const Crop& window, std::vector<Moments>& moments) {
    const std::size_t row_length = std::size_t(window.x1 - window.x0);
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const std::size_t x = i % std::size_t(film.width()) + std::size_t(film.crop.x0 - window.x0);
        const std::size_t y = i / std::size_t(film.width()) + std::size_t(film.crop.y0 - window.y0);
        const double n = film.samples[i];
        // variance = squares / (n (n - 1))
        moments[y * row_length + x].add(film.samples[i], film.mean[i], glm::dvec3(film.variance[i]) * n * (n - 1));
    }
}

Film film_of(const std::vector<Moments>& moments, const Film& like, const Crop& window) {
    Film film;
    film.picture_width = like.picture_width;
    film.picture_height = like.picture_height;
    film.crop = window;
    for (const Moments& pixel : moments) {
        const double n = double(pixel.n);
        film.mean.push_back(pixel.n > 0 ? glm::vec3(pixel.sum / n) : glm::vec3(0.0f));
        film.variance.push_back(pixel.n > 1 ? glm::vec3(pixel.squares / (n * (n - 1))) : glm::vec3(0.0f));
        film.samples.push_back(
            static_cast<std::uint32_t>(std::min<std::uint64_t>(pixel.n, std::numeric_limits<std::uint32_t>::max())));
    }
    return film;
}

// The union of the sample ranges where it is one range, so that a merged image can be merged again and an overlap
// still be found. Different seeds have no common range: the merged image then has no seed, and is trusted.
void merge_ranges(const std::vector<MergeInput>& inputs, Metadata& metadata) {
    bool same_seed = true;
    std::vector<std::pair<std::int64_t, std::int64_t>> ranges;
    for (const MergeInput& input : inputs) {
        same_seed = same_seed && input.metadata.count("vkvol/seed") &&
                    text_of(input.metadata, "vkvol/seed") == text_of(metadata, "vkvol/seed");
        const std::int64_t begin = int_of(input.metadata, "vkvol/sampleOffset");
        ranges.emplace_back(begin, begin + int_of(input.metadata, "samplesPerPixel"));
    }
    std::sort(ranges.begin(), ranges.end());
    std::int64_t end = ranges.front().second;
    for (const auto& [next_begin, next_end] : ranges) {
        same_seed = same_seed && next_begin <= end;
        end = std::max(end, next_end);
    }
    if (same_seed && end - ranges.front().first == int_of(metadata, "samplesPerPixel")) {
        metadata["vkvol/sampleOffset"] = static_cast<int>(ranges.front().first);
    } else {
        metadata.erase("vkvol/seed");
        metadata.erase("vkvol/sampleOffset");
    }
}

Metadata merged_metadata(const std::vector<MergeInput>& inputs, const Film& film) {
    Metadata metadata;
    // What all images agree on stays.
    for (const auto& [key, value] : inputs.front().metadata)
        if (std::all_of(inputs.begin(), inputs.end(), [&key = key, &value = value](const MergeInput& input) {
                const auto found = input.metadata.find(key);
                return found != input.metadata.end() && found->second == value;
            }))
            metadata[key] = value;
    const auto largest = std::max_element(film.samples.begin(), film.samples.end());
    metadata["samplesPerPixel"] = static_cast<int>(std::min<std::uint32_t>(*largest, 2147483647u));
    merge_ranges(inputs, metadata);
    float seconds = 0.0f;
    bool timed = true;
    for (const MergeInput& input : inputs) {
        const auto found = input.metadata.find("renderTimeSeconds");
        const float* value = found == input.metadata.end() ? nullptr : std::get_if<float>(&found->second);
        timed = timed && value;
        seconds += value ? *value : 0.0f;
    }
    if (timed)
        metadata["renderTimeSeconds"] = seconds;
    metadata["vkvol/mergedFrom"] = static_cast<int>(inputs.size());
    return metadata;
}

} // namespace

MergeResult merge_films(const std::vector<MergeInput>& inputs) {
    if (inputs.empty())
        throw InputError("nothing to merge; name at least one image");
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        check_input(inputs[i]);
        for (std::size_t j = 0; j < i; ++j)
            check_pair(inputs[j], inputs[i]);
    }
    const Crop window = bounding_window(inputs);
    check_coverage(inputs, window);
    std::vector<Moments> moments(std::size_t(window.x1 - window.x0) * std::size_t(window.y1 - window.y0));
    for (const MergeInput& input : inputs)
        add_film(input.film, window, moments);
    MergeResult result;
    result.film = film_of(moments, inputs.front().film, window);
    result.metadata = merged_metadata(inputs, result.film);
    return result;
}

int run_merge(const MergeOptions& options) {
    for (const std::filesystem::path& output : options.outputs)
        check_writable(output);
    std::vector<MergeInput> inputs;
    for (const std::filesystem::path& path : options.inputs) {
        MergeInput input;
        input.name = path.string();
        input.film = read_exr(path, &input.metadata);
        inputs.push_back(std::move(input));
    }
    const MergeResult result = merge_films(inputs);
    for (const std::filesystem::path& output : options.outputs)
        write_image(output, result.film, result.metadata, options.tone_mapping);
    if (!options.quiet)
        fmt::print("{}: {} images, up to {} samples per pixel\n", options.outputs.front().string(), inputs.size(),
                   *std::max_element(result.film.samples.begin(), result.film.samples.end()));
    return exit_done;
}

} // namespace vkvol
