#include "kernel_text.h"

#include <array>
#include <fmt/format.h>

#include "integrators.h"

namespace vkvol {

namespace {

// `s` of the media that they have in common.
std::string several_text(const Specialization& s, const Assets& assets) {
    const Superposition& whole = *assets.superposition;
    const double coarse = whole.edge * (1 << whole.bits);
    return fmt::format("{} media in cells of {:.3g} world units{}, at most {} of them in one{}", assets.media.size(),
                       coarse, whole.bits > 0 ? fmt::format(", or {:.3g} where small media are", whole.edge) : "",
                       whole.most_overlaps, s[SPEC_LEAPS] ? ", empty ones leapt" : "");
}

} // namespace

std::string kernel_text(const Specialization& s, const Assets& assets, bool chromatic) {
    constexpr std::array shapes = {"no medium", "sphere", "box", "mesh"};
    constexpr std::array types = {"float", "Fp4", "Fp8", "Fp16", "FpN"};
    constexpr std::array filters = {"nearest", "trilinear", "stochastic"};
    constexpr std::array scatterings = {", no scattering", ", single scattering", ""};
    const bool glows_in_color = s[SPEC_TEMPERATURE_TYPE] == GRID_COLOR;
    const std::array emissions = {"", ", uniform emission",
                                  glows_in_color ? ", emission by a grid of colours" : ", emission by temperature",
                                  ", black-body emission"};
    const auto choice = [&](const char* axis, int id) { return find_axis(axis).names[std::size_t(id)]; };
    if (s[SPEC_SHAPE] == SHAPE_NONE)
        return shapes[SHAPE_NONE];
    std::string text = shapes[s[SPEC_SHAPE]];
    if (assets.superposition)
        text = several_text(s, assets);
    else if (s[SPEC_FIELD] == FIELD_GRID)
        text = fmt::format("grid {}, {} filter, majorant cells of {} voxels{}", types[s[SPEC_GRID_TYPE]],
                           filters[s[SPEC_FILTER]], assets.media.front().majorants->cell,
                           s[SPEC_LEAPS] ? ", empty ones leapt" : "");
    else
        text = (s[SPEC_FIELD] == FIELD_NOISE    ? "noise in a "
                : s[SPEC_FIELD] == FIELD_LAYERS ? "layers in a "
                                                : "homogeneous ") +
               (s[SPEC_UNBOUNDED] != 0 ? "medium everywhere" : text);
    if (s[SPEC_MAP] != MAP_NONE)
        text += s[SPEC_MAP] >= MAP_ALBEDO ? ", transfer function" : ", mapped values";
    text += fmt::format("{}, {} flight", chromatic ? ", chromatic" : "", choice("flight", s[SPEC_FREE_FLIGHT]));
    text += s[SPEC_FIRST_FLIGHT] == FIRST_FLIGHT_SPLIT ? ", the first split" : "";
    text += scatterings[s[SPEC_SCATTERING]];
    if (s[SPEC_NEE] != NEE_NONE)
        text += fmt::format(", light at {} by {} transmittance",
                            s[SPEC_NEE] == NEE_COLLISIONS ? "collisions"
                            : s[SPEC_NEE] == NEE_CACHED   ? "collisions, from a cache corrected"
                                                          : "tentative collisions",
                            choice("transmittance", s[SPEC_TRANSMITTANCE]));
    if (s[SPEC_DISTANCE] == DISTANCE_MIXED)
        text += ", and looks from along flights";
    if (s[SPEC_PERIODIC] != 0)
        text += ", in a domain that repeats";
    if (s[SPEC_ALBEDO] == ALBEDO_GRID)
        text += ", albedo by a grid";
    text += s[SPEC_EMISSION] == EACH ? ", emission" : emissions[s[SPEC_EMISSION]];
    return text + (s[SPEC_EMISSION_AT] == EMISSION_AT_STEPS ? " along flights" : "");
}

} // namespace vkvol
