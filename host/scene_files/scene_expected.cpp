// The part of SceneReader that reads what the mean of the picture must be, in scenes that are tests.
#include <fmt/format.h>

#include "scene_reader.h"

namespace vkvol {

namespace {
constexpr Limits expected_radiance{0.0, no_limit, true, true, "a number >= 0", false};
}

std::optional<Expected> SceneReader::expected() const {
    const XmlElement element = one("expected");
    element.allow({"mean", "bias", "exact"});
    if (!element.exists())
        return std::nullopt;
    if (!element.has("mean"))
        element.fail("<expected> lacks mean; write the picture's mean radiance, e.g. mean=\"0.5 1 1.5\"");
    return Expected{channels(element, "mean", expected_radiance, Rgb(0.0)),
                    channels(element, "bias", expected_radiance, Rgb(0.0)), element.attribute_boolean("exact", false)};
}

// One number for all channels, or one for each.
Rgb SceneReader::channels(const XmlElement& element, const char* attribute, const Limits& limits,
                          const Rgb& fallback) const {
    if (!element.has(attribute))
        return fallback;
    const std::vector<double> numbers = element.attribute_numbers(attribute, limits);
    if (numbers.size() == 1)
        return Rgb(numbers[0]);
    if (numbers.size() != 3)
        element.fail_attribute(attribute,
                               fmt::format("<{}> {}: {} numbers; expected one, or three for red, green, blue",
                                           element.name(), attribute, numbers.size()));
    return {numbers[0], numbers[1], numbers[2]};
}

} // namespace vkvol
