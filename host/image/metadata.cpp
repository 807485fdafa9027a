#include "metadata.h"

#include <charconv>
#include <fmt/format.h>

#include "error.h"
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

} // namespace vkvol
