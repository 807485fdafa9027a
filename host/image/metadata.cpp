#include "metadata.h"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <sstream>

#include "error.h"
#include "number_text.h"
#include "one_line.h"

namespace vkvol {

std::string text_of(const Metadata& metadata, const std::string& key) {
    const auto found = metadata.find(key);
    if (found == metadata.end())
        return "";
    return std::visit([](const auto& value) { return fmt::format("{}", value); }, found->second);
}

std::optional<std::uint64_t> count_of(const Metadata& metadata, const std::string& key, const std::string& image) {
    if (!metadata.count(key))
        return std::nullopt;
    const std::string text = text_of(metadata, key);
    std::uint64_t count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error != std::errc() || end != text.data() + text.size())
        throw InputError(one_line(fmt::format("{}: {} is '{}'; expected a whole number", image, key, text)));
    return count;
}

namespace {
constexpr const char* premultiplied_key = "vkvol/premultiplied";
constexpr const char* passes_key = "vkvol/passes";
constexpr const char* correlated_key = "vkvol/correlated";
constexpr const char* sum_variance_key = "vkvol/sumVariance"; // red, green, blue
} // namespace

void record_facts(const Film& film, Metadata& metadata) {
    metadata.erase(correlated_key);
    metadata.erase(sum_variance_key);
    metadata.erase(premultiplied_key);
    metadata.erase(passes_key);
    if (film.passes > 0)
        metadata[passes_key] = std::to_string(film.passes);
    if (film.is_premultiplied)
        metadata[premultiplied_key] = 1;
    if (film.is_correlated)
        metadata[correlated_key] = 1;
    if (const auto& v = film.sum_variance; film.is_correlated && v)
        metadata[sum_variance_key] = fmt::format("{} {} {}", v->x, v->y, v->z);
}

void read_facts(const Metadata& metadata, Film& film) {
    film.is_premultiplied = text_of(metadata, premultiplied_key) == "1";
    film.is_correlated = text_of(metadata, correlated_key) == "1";
    const NumberText passes = read_number_text(text_of(metadata, passes_key));
    film.passes =
        passes.is_number && passes.value >= 1.0 && passes.value < 1e9 ? static_cast<std::uint32_t>(passes.value) : 0;
    film.sum_variance.reset();
    std::istringstream text(text_of(metadata, sum_variance_key));
    glm::dvec3 v;
    const auto is_variance = [](double x) { return x >= 0.0 && std::isfinite(x); };
    if (film.is_correlated && text >> v.x >> v.y >> v.z && is_variance(v.x) && is_variance(v.y) && is_variance(v.z))
        film.sum_variance = v;
}

} // namespace vkvol
