#include "aovs.h"

#include <algorithm>
#include <sstream>

namespace vkvol {

const std::vector<std::string>& layer_names() {
    static const std::vector<std::string> names = {"background", "emission",      "direct", "indirect",
                                                   "groups",     "media",         "depth",  "position",
                                                   "albedo",     "transmittance", "alpha",  "normal"};
    return names;
}

std::optional<unsigned> parse_layers(const std::string& text, std::string& wrong) {
    std::string spaced = text;
    std::replace(spaced.begin(), spaced.end(), ',', ' ');
    std::istringstream words(spaced);
    unsigned set = 0;
    for (std::string word; words >> word;) {
        const auto found = std::find(layer_names().begin(), layer_names().end(), word);
        if (found == layer_names().end()) {
            wrong = word;
            return std::nullopt;
        }
        set |= 1u << unsigned(found - layer_names().begin());
    }
    return set;
}

} // namespace vkvol
