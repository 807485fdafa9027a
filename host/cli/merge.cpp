#include "merge.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include <map>

#include "error.h"
#include "file_uses.h"
#include "image_io.h"
#include "merge_metadata.h"
#include "messages.h"
#include "metadata.h"
#include "one_line.h"
#include "render_summary.h"
#include "sample_ranges.h"
#include "tone_choice.h"

namespace vkvol {

namespace {

bool disjoint(const Crop& a, const Crop& b) {
    return a.x1 <= b.x0 || b.x1 <= a.x0 || a.y1 <= b.y0 || b.y1 <= a.y0;
}

[[noreturn]] void refuse(const MergeInput& a, const MergeInput& b, const std::string& why) {
    throw InputError(one_line(fmt::format("{} and {} do not belong together: {}", a.name, b.name, why)));
}

void check_pair(const MergeInput& a, const MergeInput& b) {
    if (a.film.picture_width != b.film.picture_width || a.film.picture_height != b.film.picture_height)
        refuse(a, b,
               fmt::format("the pictures are {}x{} and {}x{}", a.film.picture_width, a.film.picture_height,
                           b.film.picture_width, b.film.picture_height));
    for (const char* key : {"vkvol/sceneHash", "vkvol/integrator", "vkvol/layersOf"})
        if (text_of(a.metadata, key) != text_of(b.metadata, key))
            refuse(a, b, fmt::format("{} is '{}' and '{}'", key, text_of(a.metadata, key), text_of(b.metadata, key)));
    if (layer_list(a.film) != layer_list(b.film))
        refuse(a, b, fmt::format("their layers are '{}' and '{}'", layer_list(a.film), layer_list(b.film)));
    if (a.film.crop == b.film.crop) {
        const std::string shared =
            shared_samples(sample_ranges_of(a.metadata, a.name), sample_ranges_of(b.metadata, b.name));
        if (!shared.empty())
            refuse(a, b,
                   fmt::format("they hold the same samples; give each run its own --sample-offset or --seed ({})",
                               shared));
    } else if (!disjoint(a.film.crop, b.film.crop)) {
        refuse(a, b, "their windows overlap without being equal; render equal or disjoint --crop windows");
    }
}

void check_input(const MergeInput& input) {
    if (input.film.layer("noisy"))
        throw InputError(
            fmt::format("{}: is denoised, and knows no variance; merge noisy images, and denoise the sum", input.name));
    const std::vector<std::uint32_t>& samples = input.film.samples;
    if (std::all_of(samples.begin(), samples.end(), [](std::uint32_t n) { return n == 0; }))
        throw InputError(
            fmt::format("{}: does not say how many samples its pixels have, or their variance; merge needs "
                        "images written by vkvol",
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

// Where a film's pixel lies in the window.
std::size_t place_in(const Crop& window, const Film& film, std::size_t i) {
    const std::size_t x = i % std::size_t(film.width()) + std::size_t(film.crop.x0 - window.x0);
    const std::size_t y = i / std::size_t(film.width()) + std::size_t(film.crop.y0 - window.y0);
    return y * std::size_t(window.x1 - window.x0) + x;
}

// Adds the film's means, or those of a layer, to the moments.
void add_means(const Film& film, const std::vector<glm::vec3>& mean, const std::vector<glm::vec3>& variance,
               const Crop& window, std::vector<Moments>& moments) {
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const double n = film.samples[i];
        // variance = squares / (n (n - 1))
        moments[place_in(window, film, i)].add(film.samples[i], mean[i], glm::dvec3(variance[i]) * n * (n - 1));
    }
}

void take_means(const std::vector<Moments>& moments, std::vector<glm::vec3>& mean, std::vector<glm::vec3>& variance) {
    for (const Moments& pixel : moments) {
        const double n = double(pixel.n);
        mean.push_back(pixel.n > 0 ? glm::vec3(pixel.sum / n) : glm::vec3(0.0f));
        variance.push_back(pixel.n > 1 ? glm::vec3(pixel.squares / (n * (n - 1))) : glm::vec3(0.0f));
    }
}

// Whether all know of this layer how sure it is.
bool knows_variance(const std::vector<MergeInput>& inputs, std::size_t which) {
    return std::none_of(inputs.begin(), inputs.end(),
                        [which](const MergeInput& input) { return input.film.layers[which].variance.empty(); });
}

// Merges means over collisions: weighted by how many there were. The variance is that of a quotient of sums over all
// samples, n / (n - 1) sum (w (d - mean))^2 / (sum w)^2: each part has told the sum about its own mean; how far the
// parts lie apart counts by the sum of the squares of weights, which coverage's variance knows.
FilmLayer merge_collisions(const std::vector<MergeInput>& inputs, std::size_t which, const Crop& window) {
    const std::size_t pixels = std::size_t(window.x1 - window.x0) * std::size_t(window.y1 - window.y0);
    std::vector<double> weights(pixels, 0.0), samples(pixels, 0.0);
    std::vector<glm::dvec3> sums(pixels, glm::dvec3(0.0)), squares(pixels, glm::dvec3(0.0));
    const FilmLayer& first = inputs.front().film.layers[which];
    const bool is_sure = knows_variance(inputs, which);
    for (const MergeInput& input : inputs) {
        const FilmLayer& layer = input.film.layers[which];
        const FilmLayer* coverage = input.film.layer("coverage");
        for (std::size_t i = 0; i < input.film.pixel_count(); ++i) {
            const double n = input.film.samples[i], weight = coverage ? coverage->mean[i].x * n : 0.0;
            const std::size_t at = place_in(window, input.film, i);
            weights[at] += weight;
            samples[at] += n;
            sums[at] += weight * glm::dvec3(layer.mean[i]);
            if (!layer.variance.empty() && n > 0.0)
                squares[at] += (n - 1.0) / n * weight * weight * glm::dvec3(layer.variance[i]);
        }
    }
    FilmLayer merged{first.name, {}, {}};
    for (std::size_t i = 0; i < pixels; ++i)
        merged.mean.emplace_back(weights[i] > 0.0 ? sums[i] / weights[i] : glm::dvec3(0.0));
    for (const MergeInput& input : inputs) {
        const FilmLayer& layer = input.film.layers[which];
        const FilmLayer* coverage = input.film.layer("coverage");
        for (std::size_t i = 0; coverage && i < input.film.pixel_count(); ++i) {
            const std::size_t at = place_in(window, input.film, i);
            const glm::dvec3 apart = glm::dvec3(layer.mean[i]) - glm::dvec3(merged.mean[at]);
            const double n = input.film.samples[i], w = coverage->mean[i].x;
            const double scatter =
                coverage->variance.empty() ? w * (1.0 - w) : double(coverage->variance[i].x) * (n - 1.0);
            squares[at] += n * (scatter + w * w) * apart * apart;
        }
    }
    for (std::size_t i = 0; i < pixels; ++i) {
        const double weight = weights[i], n = samples[i];
        if (is_sure)
            merged.variance.emplace_back(weight > 0.0 && n > 1.0 ? n / (n - 1.0) * squares[i] / (weight * weight)
                                                                 : glm::dvec3(0.0));
    }
    return merged;
}

FilmLayer merge_layer(const std::vector<MergeInput>& inputs, std::size_t which, const Crop& window) {
    const FilmLayer& first = inputs.front().film.layers[which];
    if (first.is_of_collisions())
        return merge_collisions(inputs, which, window);
    std::vector<Moments> moments(std::size_t(window.x1 - window.x0) * std::size_t(window.y1 - window.y0));
    for (const MergeInput& input : inputs) {
        const FilmLayer& layer = input.film.layers[which];
        const std::vector<glm::vec3> none(layer.variance.empty() ? layer.mean.size() : 0, glm::vec3(0.0f));
        add_means(input.film, layer.mean, layer.variance.empty() ? none : layer.variance, window, moments);
    }
    FilmLayer merged{first.name, {}, {}};
    take_means(moments, merged.mean, merged.variance);
    if (!knows_variance(inputs, which))
        merged.variance.clear();
    return merged;
}

// Of pictures whose variances are known from passes: as many as all have.
std::uint32_t passes_of(const std::vector<MergeInput>& inputs) {
    std::uint32_t passes = 0;
    for (const MergeInput& input : inputs)
        passes += input.film.passes;
    return passes;
}

Film film_of(const std::vector<Moments>& moments, const Film& like, const Crop& window) {
    Film film;
    film.is_premultiplied = like.is_premultiplied;
    film.is_correlated = like.is_correlated;
    film.picture_width = like.picture_width;
    film.picture_height = like.picture_height;
    film.crop = window;
    take_means(moments, film.mean, film.variance);
    for (const Moments& pixel : moments)
        film.samples.push_back(
            static_cast<std::uint32_t>(std::min<std::uint64_t>(pixel.n, std::numeric_limits<std::uint32_t>::max())));
    return film;
}

// Variance of the sum: the means of one window's samples count by their number; windows add up.
std::optional<glm::dvec3> merged_sum_variance(const std::vector<MergeInput>& inputs) {
    struct Window {
        glm::dvec3 weighted{0.0};
        double samples = 0.0;
    };
    std::map<std::array<int, 4>, Window> windows;
    for (const MergeInput& input : inputs) {
        if (!input.film.sum_variance)
            return std::nullopt;
        const Crop& crop = input.film.crop;
        Window& window = windows[{crop.x0, crop.x1, crop.y0, crop.y1}];
        const double n = *std::max_element(input.film.samples.begin(), input.film.samples.end()); // elsewhere are holes
        window.weighted += n * n * *input.film.sum_variance;
        window.samples += n;
    }
    glm::dvec3 sum(0.0);
    for (const auto& [crop, window] : windows)
        if (window.samples > 0.0)
            sum += window.weighted / (window.samples * window.samples);
    return sum;
}

// Whether an image without ranges holds samples of another of its window, nobody knows.
void warn_of_unknown_ranges(const std::vector<MergeInput>& inputs, std::vector<std::string>& warnings) {
    for (const MergeInput& input : inputs) {
        const bool is_alone = std::none_of(inputs.begin(), inputs.end(), [&input](const MergeInput& other) {
            return &other != &input && other.film.crop == input.film.crop;
        });
        if (!is_alone && !sample_ranges_of(input.metadata, input.name).complete)
            warnings.push_back(fmt::format("{}: does not say which samples it holds: whether other images hold the "
                                           "same ones cannot be checked",
                                           input.name));
    }
}

void warn_of_holes(const Film& film, std::vector<std::string>& warnings) {
    const auto holes = std::count(film.samples.begin(), film.samples.end(), 0u);
    if (holes > 0)
        warnings.push_back(fmt::format("{} of {} pixels have no samples in any image, and are black; render the rest "
                                       "of the window",
                                       holes, film.pixel_count()));
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
        add_means(input.film, input.film.mean, input.film.variance, window, moments);
    MergeResult result;
    result.film = film_of(moments, inputs.front().film, window);
    result.film.passes = passes_of(inputs);
    if (result.film.is_correlated)
        result.film.sum_variance = merged_sum_variance(inputs);
    for (std::size_t i = 0; i < inputs.front().film.layers.size(); ++i)
        result.film.layers.push_back(merge_layer(inputs, i, window));
    result.metadata = merged_metadata(inputs, result.film);
    warn_of_unknown_ranges(inputs, result.warnings);
    warn_of_holes(result.film, result.warnings);
    return result;
}

namespace {

void print_warnings(const MergeResult& result) {
    for (const std::string& warning : result.warnings)
        tell(stderr, "vkvol: warning: {}\n", warning);
}

// Before any work is done.
void check_files(const MergeOptions& options) {
    FileUses uses;
    for (const std::filesystem::path& input : options.inputs)
        uses.reads("an image to be merged", input);
    for (const std::filesystem::path& output : options.outputs) {
        check_writable(output);
        uses.writes("the merged picture", output, "-o");
    }
    uses.check();
}

void print_summary(const MergeOptions& options, const MergeResult& result) {
    std::string outputs;
    for (const std::filesystem::path& output : options.outputs)
        outputs += (outputs.empty() ? "" : ", ") + output.string();
    tell(stream_for_words(options.outputs, {}), "{}: {} images, up to {} samples per pixel\n", outputs,
         options.inputs.size(), *std::max_element(result.film.samples.begin(), result.film.samples.end()));
}

} // namespace

int run_merge(const MergeOptions& options) {
    check_files(options);
    std::vector<MergeInput> inputs;
    for (const std::filesystem::path& path : options.inputs) {
        MergeInput input;
        input.name = path.string();
        input.film = read_exr(path, &input.metadata);
        inputs.push_back(std::move(input));
    }
    MergeResult result = merge_films(inputs);
    record_tone(options.tone, result.metadata);
    if (!options.quiet)
        print_warnings(result);
    write_images(options.outputs, result.film, result.metadata, choose_tone({}, result.film, result.metadata).mapping);
    if (!options.quiet)
        print_summary(options, result);
    return exit_done;
}

} // namespace vkvol
