#include "pbrt_spectra.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "blackbody.h"

namespace vkvol {

namespace {

constexpr double first_nm = 380.0, last_nm = 780.0, step_nm = 1.0;

// Relative power of the CIE's standard illuminant D65, every 20 nm from 380 on.
constexpr std::array d65 = {49.9755, 82.7549, 93.4318, 104.865, 117.812, 115.923, 109.354,
                            104.790, 104.405, 100.000, 95.7880, 90.0062, 87.6987, 83.6992,
                            80.2146, 78.2842, 71.6091, 61.6040, 75.0870, 46.4182, 63.3828};

double daylight(double nm) {
    const double at = std::clamp((nm - first_nm) / 20.0, 0.0, double(d65.size() - 1));
    const std::size_t i = std::min(static_cast<std::size_t>(at), d65.size() - 2);
    return std::lerp(d65[i], d65[i + 1], at - double(i));
}

double value_at(const Spectrum& spectrum, double nm) {
    const auto after = std::lower_bound(spectrum.begin(), spectrum.end(), nm,
                                        [](const auto& sample, double at) { return sample.first < at; });
    if (after == spectrum.end())
        return 0.0;
    if (after->first == nm)
        return after->second;
    if (after == spectrum.begin())
        return 0.0;
    const auto& [low, value] = *std::prev(after);
    return std::lerp(value, after->second, (nm - low) / (after->first - low));
}

// Tristimulus values of `power`.
template <class Power> glm::dvec3 xyz_of(const Power& power) {
    glm::dvec3 sum(0.0);
    for (double nm = first_nm; nm <= last_nm; nm += step_nm)
        sum += power(nm) * observer(nm);
    return sum;
}

// Primaries and white of a space of colours, by their chromaticities (x, y).
glm::dmat3 to_xyz(const glm::dvec2& r, const glm::dvec2& g, const glm::dvec2& b, const glm::dvec2& w) {
    const auto column = [](const glm::dvec2& c) { return glm::dvec3(c.x, c.y, 1.0 - c.x - c.y) / c.y; };
    const glm::dmat3 primaries(column(r), column(g), column(b));
    const glm::dvec3 shares = glm::inverse(primaries) * column(w);
    return {primaries[0] * shares.x, primaries[1] * shares.y, primaries[2] * shares.z};
}

constexpr glm::dvec2 d65_white{0.3127, 0.3290};

glm::dmat3 rec709() {
    return to_xyz({0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, d65_white);
}

glm::dvec3 rec709_of(const glm::dvec3& xyz) {
    return glm::max(glm::inverse(rec709()) * xyz, glm::dvec3(0.0));
}

// White of luminance 1 with this chromaticity (x, y).
glm::dvec3 white(double x, double y) {
    return rec709_of({x / y, 1.0, (1.0 - x - y) / y});
}

// Chromaticities for the observer of 1931 of the spectra that pbrt has by these names: its D50 is bluer than CIE's, the
// fluorescent lamps are those of CIE 15:2004, and D60 is ACES' white.
struct NamedWhite {
    const char* name;
    double x, y;
};
constexpr NamedWhite illuminants[] = {
    {"stdillum-D50", 0.33681, 0.35798}, {"stdillum-F1", 0.31310, 0.33727},  {"stdillum-F2", 0.37208, 0.37529},
    {"stdillum-F3", 0.40910, 0.39430},  {"stdillum-F4", 0.44018, 0.40329},  {"stdillum-F5", 0.31379, 0.34531},
    {"stdillum-F6", 0.37790, 0.38835},  {"stdillum-F7", 0.31292, 0.32933},  {"stdillum-F8", 0.34588, 0.35875},
    {"stdillum-F9", 0.37417, 0.37281},  {"stdillum-F10", 0.34609, 0.35896}, {"stdillum-F11", 0.38052, 0.37713},
    {"stdillum-F12", 0.43695, 0.40441}, {"illum-acesD60", 0.32168, 0.33767}};

struct NamedShare {
    const char* name;
    glm::dvec3 value;
};

// Indices of metals as in scene files (Johnson and Christy 1972; Rakic 1995), brass by Querry (1985); of glasses from
// Schott's data sheets, at 588 nm; pbrt's F5, F10 and F11 are of SF5, SF10 and SF11. Oxides at 630, 532 and 465 nm.
const NamedShare shares[] = {{"metal-Ag-eta", {0.155, 0.117, 0.138}},   {"metal-Ag-k", {4.828, 3.122, 2.147}},
                             {"metal-Al-eta", {1.657, 0.880, 0.521}},   {"metal-Al-k", {9.224, 6.270, 4.837}},
                             {"metal-Au-eta", {0.143, 0.375, 1.442}},   {"metal-Au-k", {3.983, 2.386, 1.603}},
                             {"metal-Cu-eta", {0.200, 0.924, 1.102}},   {"metal-Cu-k", {3.912, 2.452, 2.142}},
                             {"metal-CuZn-eta", {0.444, 0.527, 1.094}}, {"metal-CuZn-k", {3.695, 2.765, 1.829}},
                             {"metal-MgO-eta", {1.735, 1.742, 1.750}},  {"metal-MgO-k", glm::dvec3(0.0)},
                             {"metal-TiO2-eta", {2.875, 2.969, 3.118}}, {"metal-TiO2-k", glm::dvec3(0.0)},
                             {"glass-F5", glm::dvec3(1.6727)},          {"glass-F10", glm::dvec3(1.7283)},
                             {"glass-F11", glm::dvec3(1.7847)},         {"glass-BK7", glm::dvec3(1.5168)},
                             {"glass-BAF10", glm::dvec3(1.6700)},       {"glass-FK51A", glm::dvec3(1.4866)},
                             {"glass-LASF9", glm::dvec3(1.8503)},       {"glass-SF5", glm::dvec3(1.6727)},
                             {"glass-SF10", glm::dvec3(1.7283)},        {"glass-SF11", glm::dvec3(1.7847)}};

} // namespace

std::optional<glm::dmat3> to_rec709(const std::string& space) {
    const glm::dmat3 from_xyz = glm::inverse(rec709());
    if (space == "srgb")
        return glm::dmat3(1.0);
    if (space == "dci-p3")
        return from_xyz * to_xyz({0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}, d65_white);
    if (space == "rec2020")
        return from_xyz * to_xyz({0.708, 0.292}, {0.17, 0.797}, {0.131, 0.046}, d65_white);
    if (space == "aces2065-1") // whites are made the same, channel by channel
        return from_xyz * to_xyz({0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.077}, d65_white);
    return std::nullopt;
}

glm::dvec3 white_of_space(const std::string& space) {
    return space == "aces2065-1" ? *named_light("illum-acesD60") : glm::dvec3(1.0);
}

glm::dvec3 color_of_share(const Spectrum& spectrum) {
    const glm::dmat3 from_xyz = glm::inverse(rec709());
    const glm::dvec3 seen = from_xyz * xyz_of([&](double nm) { return value_at(spectrum, nm) * daylight(nm); });
    return glm::max(seen / (from_xyz * xyz_of(daylight)), glm::dvec3(0.0));
}

glm::dvec3 color_of_light(const Spectrum& spectrum) {
    const glm::dvec3 xyz = xyz_of([&](double nm) { return value_at(spectrum, nm); });
    return xyz.y > 0.0 ? rec709_of(xyz / xyz.y) : glm::dvec3(0.0);
}

std::optional<glm::dvec3> named_share(const std::string& name) {
    for (const NamedShare& share : shares)
        if (name == share.name)
            return share.value;
    return std::nullopt;
}

std::optional<glm::dvec3> named_light(const std::string& name) {
    if (name == "stdillum-D65")
        return glm::dvec3(1.0);
    if (name == "stdillum-A")
        return blackbody_rgb(2856.0, 2856.0);
    for (const NamedWhite& illuminant : illuminants)
        if (name == illuminant.name)
            return white(illuminant.x, illuminant.y);
    return std::nullopt;
}

} // namespace vkvol
