#include "compare_notes.h"

#include <fmt/format.h>

#include "error.h"
#include "metadata.h"
#include "one_line.h"
#include "sample_ranges.h"

namespace vkvol {

namespace {

std::string note_of_scenes(const Metadata& a, const Metadata& b) {
    const std::string hash_a = text_of(a, "vkvol/sceneHash"), hash_b = text_of(b, "vkvol/sceneHash");
    if (hash_a.empty() || hash_b.empty() || hash_a == hash_b)
        return "";
    return fmt::format("the images are of different scenes, or integrators that differ in bias made them "
                       "(vkvol/sceneHash is '{}' and '{}')",
                       hash_a, hash_b);
}

// With common random numbers the difference has less noise than the statistics expect, or more.
std::string note_of_samples(const CompareOptions& options, const Metadata& a, const Metadata& b) try {
    const std::string shared =
        shared_samples(sample_ranges_of(a, options.a.string()), sample_ranges_of(b, options.b.string()));
    if (shared.empty())
        return "";
    return fmt::format("the images share samples, and the statistics take them for independent: give one another "
                       "--seed ({})",
                       shared);
} catch (const InputError& error) { // the pixels can be compared all the same
    return error.what();
}

// A mean that is not exact differs by more than noise does, however many samples there are.
std::string note_of_bias(const std::filesystem::path& image, const Metadata& metadata) {
    const std::string why = text_of(metadata, "vkvol/biased");
    return why.empty() ? "" : fmt::format("{} is biased: {}", image.string(), why);
}

} // namespace

std::vector<std::string> comparison_notes(const CompareOptions& options, const Metadata& a, const Metadata& b) {
    std::vector<std::string> notes;
    for (const std::string& note :
         {note_of_scenes(a, b), note_of_samples(options, a, b), note_of_bias(options.a, a), note_of_bias(options.b, b)})
        if (!note.empty())
            notes.push_back(one_line(note));
    return notes;
}

} // namespace vkvol
