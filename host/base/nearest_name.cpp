#include "nearest_name.h"

#include <algorithm>
#include <cctype>

namespace vkvol {

namespace {

char lower(char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

} // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), current(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        previous[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        current[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t substitution = previous[j - 1] + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
            current[j] = std::min({previous[j] + 1, current[j - 1] + 1, substitution});
            const bool swapped =
                i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
            if (swapped)
                current[j] = std::min(current[j], before[j - 2] + 1);
        }
        std::swap(before, previous);
        std::swap(previous, current);
    }
    return previous[b.size()];
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& known) {
    // Names longer than any known one by far are not misspellings; the cut also bounds the work on garbage.
    if (name.size() > 64)
        return "";
    // All names of one letter are as near to each other: one that it begins is meant.
    if (name.size() == 1) {
        const auto begun = std::find_if(known.begin(), known.end(), [&](const std::string& candidate) {
            return !candidate.empty() && lower(candidate[0]) == lower(name[0]);
        });
        return begun == known.end() ? "" : *begun;
    }
    std::string best;
    std::size_t best_distance = std::max<std::size_t>(1, name.size() / 3) + 1;
    for (const std::string& candidate : known) {
        const std::size_t distance = edit_distance(name, candidate);
        // Where two are equally near, the one that begins with the name is meant.
        const bool completed = candidate.starts_with(name) && !best.starts_with(name);
        if (distance < best_distance || (distance == best_distance && !best.empty() && completed)) {
            best_distance = distance;
            best = candidate;
        }
    }
    return best;
}

std::string name_hint(std::string_view name, const std::vector<std::string>& known) {
    const std::string nearest = nearest_name(name, known);
    if (!nearest.empty())
        return "; did you mean " + nearest + "?";
    if (known.empty())
        return "";
    std::string list = "; known are ";
    for (std::size_t i = 0; i < known.size(); ++i)
        list += (i == 0 ? "" : ", ") + known[i];
    return list;
}

} // namespace vkvol
