#include "spectral_bands.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <sstream>

#include "error.h"
#include "input_file.h"
#include "number_table.h"

namespace vkvol {

namespace {

constexpr std::size_t most_bands = 10'000;

std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> words_of(const std::string& line) {
    std::vector<std::string> words;
    std::istringstream text(line + ",");
    for (std::string word; std::getline(text, word, ',');)
        words.push_back(trimmed(word));
    return words;
}

double weight_of(const std::filesystem::path& file, int line, const std::string& text) {
    constexpr double most = 1e12; // whose square, times a variance, single precision holds
    double weight = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), weight);
    if (error != std::errc() || end != text.data() + text.size() ||
        !(weight == 0.0 || (std::abs(weight) >= 1.0 / most && std::abs(weight) <= most)))
        fail_line(file, line,
                  fmt::format("the weight is '{}'; expected a number, 0 or between {:g} and {:g} without its sign: of "
                              "others choose another unit",
                              text, 1.0 / most, most));
    return weight;
}

void check_heading(const std::filesystem::path& file, int line, const std::vector<std::string>& names) {
    if (std::count(names.begin(), names.end(), "weight") != 1)
        fail_line(file, line,
                  "the first line has the names of the columns, of which one is weight; e.g. weight,sigma,sun");
    for (const std::string& name : names)
        if (name.empty() || std::count(names.begin(), names.end(), name) > 1)
            fail_line(file, line, fmt::format("a column is called '{}'; give each a name of its own", name));
}

} // namespace

std::vector<SpectralBand> read_bands(const std::filesystem::path& file) {
    std::istringstream text(
        read_input_text(file, 1u << 24, "--bands names a text file, weight,key,... in its first line"));
    std::vector<std::string> names;
    std::vector<SpectralBand> bands;
    int line = 0;
    for (std::string whole; std::getline(text, whole);) {
        ++line;
        const std::string said = trimmed(whole.substr(0, whole.find('#')));
        if (said.empty())
            continue;
        const std::vector<std::string> words = words_of(said);
        if (names.empty()) {
            check_heading(file, line, words);
            names = words;
            continue;
        }
        if (words.size() != names.size())
            fail_line(file, line,
                      fmt::format("{} values under {} names; give one for each", words.size(), names.size()));
        SpectralBand band;
        for (std::size_t i = 0; i < names.size(); ++i)
            if (names[i] == "weight")
                band.weight = weight_of(file, line, words[i]);
            else if (words[i].empty()) // which the scene would take for its default
                fail_line(file, line, fmt::format("{} has no value; give one", names[i]));
            else
                band.values[names[i]] = words[i];
        bands.push_back(std::move(band));
        if (bands.size() > most_bands)
            fail_line(file, line, fmt::format("more than {} bands", most_bands));
    }
    if (bands.empty())
        throw InputError(
            fmt::format("{}: has no bands; write a line of values for each, below their names", file.string()));
    return bands;
}

void add_band(const Film& film, double weight, Film& sum) {
    const auto w = static_cast<float>(weight);
    if (sum.mean.empty()) {
        sum = film;
        std::fill(sum.mean.begin(), sum.mean.end(), glm::vec3(0.0f));
        std::fill(sum.variance.begin(), sum.variance.end(), glm::vec3(0.0f));
        sum.sum_variance = glm::dvec3(0.0);
    }
    if (sum.pixel_count() != film.pixel_count())
        throw InputError(another_size);
    if (sum.places != film.places)
        throw InputError("bands whose sensors are at other places are no sum; leave their column out of the table of "
                         "bands, and sweep it with -D");
    const std::optional<glm::dvec3> of_band = variance_of_sum(film);
    if (sum.sum_variance && of_band)
        *sum.sum_variance += weight * weight * *of_band;
    else
        sum.sum_variance.reset();
    sum.is_correlated = sum.is_correlated || film.is_correlated;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        sum.mean[i] += w * film.mean[i];
        sum.variance[i] += w * w * film.variance[i];
        sum.samples[i] = std::min(sum.samples[i], film.samples[i]); // a single one has no error, nor has the sum then
    }
}

} // namespace vkvol
