#include "bench_reference.h"

#include <algorithm>
#include <fmt/format.h>

#include "bench_render.h"
#include "bench_statistics.h"
#include "cache_directory.h"
#include "error.h"
#include "file_uses.h"
#include "image_io.h"
#include "interrupt.h"
#include "messages.h"
#include "metadata.h"
#include "program.h"
#include "report.h"
#include "scene_hash.h"
#include "version.h"

namespace vkvol {

namespace {

template <typename T> T value_of(const Metadata& metadata, const char* key, T otherwise) {
    const auto found = metadata.find(key);
    const T* value = found == metadata.end() ? nullptr : std::get_if<T>(&found->second);
    return value ? *value : otherwise;
}

std::uint32_t least_samples(const Film& film) {
    return film.samples.empty() ? 0 : *std::min_element(film.samples.begin(), film.samples.end());
}

void describe(Reference& reference, const Metadata& metadata) {
    const Film& film = reference.film;
    reference.integrator = text_of(metadata, "vkvol/integrator");
    reference.seconds = value_of(metadata, "renderTimeSeconds", 0.0f);
    reference.samples = least_samples(film);
    const bool has_variance = std::any_of(film.variance.begin(), film.variance.end(),
                                          [](const glm::vec3& v) { return v != glm::vec3(0.0f); });
    if (has_variance || reference.samples > 1)
        reference.relmse = relative_variance(film, film);
    reference.offset_error = reference_offset_error(film);
}

bool shows_all_of(const Film& film, const Picture& picture) {
    return film.picture_width == picture.width && film.picture_height == picture.height && film.crop.x0 == 0 &&
           film.crop.y0 == 0 && film.width() == picture.width && film.height() == picture.height;
}

std::filesystem::path cache_file(const Estimator& estimator, std::uint32_t seed) {
    const std::filesystem::path directory = cache_directory();
    if (directory.empty())
        return directory;
    std::string name = estimator.integrator;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ':' || c == '='; }, '-');
    const Picture& picture = estimator.scene.picture;
    return directory / fmt::format("reference-{}-{}-{}-{}x{}.exr", scene_hash(estimator.scene), name, seed,
                                   picture.width, picture.height);
}

std::optional<Reference> read_cached(const Estimator& candidate, const ReferenceWish& wish) {
    Reference reference;
    const std::filesystem::path file = cache_file(candidate, wish.seed);
    FileUses uses;
    uses.reads_files_of(candidate.scene);
    if (file.empty() || !uses.is_newer_than_inputs(file))
        return std::nullopt;
    Metadata metadata;
    try {
        reference.film = read_exr(file, &metadata);
    } catch (const InputError&) {
        return std::nullopt; // damaged
    }
    describe(reference, metadata);
    reference.file = file.string();
    reference.cached = true;
    const bool same =
        shows_all_of(reference.film, candidate.scene.picture) &&
        text_of(metadata, "vkvol/sceneHash") == scene_hash(candidate.scene) &&
        reference.integrator == candidate.integrator && text_of(metadata, "vkvol/seed") == std::to_string(wish.seed) &&
        text_of(metadata, "vkvol/version") == version && text_of(metadata, "vkvol/kernels") == kernels_digest();
    const bool enough = reference.seconds >= 0.9 * wish.seconds;
    return same && reference.samples > 1 && enough ? std::optional(std::move(reference)) : std::nullopt;
}

// By some samples of each, which the reference itself does not have: of those it would have the luckiest. One that
// cannot be rendered after all is left out.
const Estimator& most_efficient(const BenchRequest& request, const std::vector<Estimator>& candidates,
                                Workshop& workshop, const ReferenceWish& wish) {
    constexpr std::uint32_t samples = 8;
    const Estimator* best = &candidates.front();
    std::optional<double> least;
    for (const Estimator& candidate : candidates) {
        if (candidates.size() == 1 || interrupted())
            break;
        try {
            const RenderResult result =
                render_whole(request, candidate, workshop, samples, ~wish.seed, 0.1 * wish.seconds);
            const double cost = relative_variance(result.film, result.film) * result.render_seconds;
            if (result.samples == samples && (!least || cost < *least)) {
                least = cost;
                best = &candidate;
            }
        } catch (const std::runtime_error&) { // input, or memory
        }
    }
    return *best;
}

// A failure to keep it costs time the next time, no more.
void keep(Reference& reference, const std::filesystem::path& file, const Metadata& metadata) {
    if (file.empty())
        return;
    try {
        std::filesystem::create_directories(file.parent_path());
        write_exr(file, reference.film, metadata, "XDG_CACHE_HOME");
        reference.file = file.string();
    } catch (const std::exception& error) {
        tell(stderr, "vkvol: warning: {}: the reference is not kept\n", error.what());
    }
}

Reference render_reference(const BenchRequest& request, const Estimator& estimator, Workshop& workshop,
                           const ReferenceWish& wish) {
    constexpr std::uint32_t any = 1u << 30;
    RenderResult result = render_whole(request, estimator, workshop, any, wish.seed, wish.seconds);
    RenderRequest as = request.render;
    as.seed = wish.seed;
    const Metadata metadata = make_metadata(as, estimator.scene, workshop.device(as.device), result);
    Reference reference;
    reference.film = std::move(result.film);
    describe(reference, metadata);
    reference.interrupted = result.interrupted;
    if (reference.interrupted)
        return reference;
    if (reference.samples < 2)
        throw InputError(fmt::format("{:.3g} s do not suffice for a reference of two samples per pixel; raise --time, "
                                     "lower --width, or give a --reference",
                                     wish.seconds));
    if (const std::uint64_t lost = result.counts.step_caps + result.counts.abandoned + result.counts.non_finite)
        tell(stderr,
             "vkvol: warning: the reference lacks the light of {} paths that were not followed to their end; it is "
             "not kept\n",
             lost);
    else if (!request.render.no_cache)
        keep(reference, cache_file(estimator, wish.seed), metadata);
    return reference;
}

} // namespace

Reference read_reference(const std::filesystem::path& file, const std::vector<Estimator>& measured) {
    Reference reference;
    Metadata metadata;
    reference.film = read_exr(file, &metadata);
    const Picture& picture = measured.front().scene.picture;
    if (!shows_all_of(reference.film, picture))
        throw InputError(fmt::format("{}: shows {}x{} pixels of a picture of {}x{}, but {}x{} are measured; render the "
                                     "reference in that size, or give --width and --height",
                                     file.string(), reference.film.width(), reference.film.height(),
                                     reference.film.picture_width, reference.film.picture_height, picture.width,
                                     picture.height));
    const std::string hash = text_of(metadata, "vkvol/sceneHash");
    if (!hash.empty() && hash != expected_hash(measured.front()))
        throw InputError(fmt::format("{}: is no unbiased render of this scene (scene hash {}, not {}); render it anew, "
                                     "by an unbiased integrator that sees the same light",
                                     file.string(), hash, expected_hash(measured.front())));
    describe(reference, metadata);
    if (const auto most = std::max_element(reference.film.samples.begin(), reference.film.samples.end()); *most == 1)
        throw InputError(fmt::format("{}: one sample per pixel tells no variance, and makes no reference; render more",
                                     file.string()));
    const auto is_exact = [](const glm::vec3& v) { return v == glm::vec3(0.0f); };
    const std::vector<glm::vec3>& variance = reference.film.variance;
    if (const std::string biased = text_of(metadata, "vkvol/biased");
        !biased.empty() && std::all_of(variance.begin(), variance.end(), is_exact)) // as of denoised ones
        throw InputError(fmt::format("{}: does not know its variance, and is biased: {}; a render as it was makes a "
                                     "reference",
                                     file.string(), biased));
    reference.file = file.string();
    reference.cached = true;
    return reference;
}

std::optional<Reference> find_reference(const BenchRequest& request, const std::vector<Estimator>& measured,
                                        const ReferenceWish& wish) {
    if (request.render.no_cache)
        return std::nullopt;
    for (const Estimator& candidate : reference_candidates(measured))
        if (std::optional<Reference> cached = read_cached(candidate, wish))
            return cached;
    return std::nullopt;
}

Reference make_reference(const BenchRequest& request, const std::vector<Estimator>& measured, Workshop& workshop,
                         const ReferenceWish& wish) {
    const std::vector<Estimator> candidates = reference_candidates(measured);
    const Estimator& best = most_efficient(request, candidates, workshop, wish);
    if (!request.quiet)
        tell(stderr, "vkvol: reference by {}, {:.3g} s\n", best.integrator, wish.seconds);
    return render_reference(request, best, workshop, wish);
}

} // namespace vkvol
