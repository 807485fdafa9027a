#include "tone_map.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vkvol {

namespace {

using Vec3 = glm::dvec3;

// Rows as published; glm matrices are built from columns.
glm::dmat3 from_rows(const Vec3& a, const Vec3& b, const Vec3& c) {
    return glm::transpose(glm::dmat3(a, b, c));
}

Vec3 clamped(const Vec3& v) {
    return glm::clamp(v, 0.0, 1.0);
}

// IEC 61966-2-1.
double srgb_encode(double v) {
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
}

Vec3 srgb_encode(const Vec3& v) {
    return {srgb_encode(v.x), srgb_encode(v.y), srgb_encode(v.z)};
}

// 255 srgb_encode(v), to the nearest, for v in [0, 1], without its powers: where each byte begins is found once.
// Pictures that are watched while they are rendered are turned into bytes again and again.
class SrgbBytes {
public:
    SrgbBytes() {
        for (int byte = 1; byte < 256; ++byte) {
            double below = 0.0, above = 1.0;
            while (true) {
                const double middle = 0.5 * (below + above);
                if (middle <= below || middle >= above)
                    break;
                (encoded(middle) >= byte ? above : below) = middle;
            }
            begins_[std::size_t(byte)] = above;
        }
        for (int i = 0; i <= buckets; ++i)
            first_[std::size_t(i)] = static_cast<std::uint8_t>(encoded(double(i) / buckets));
    }
    std::uint8_t operator()(double v) const {
        std::uint8_t byte = first_[static_cast<std::size_t>(v * buckets)];
        while (byte < 255 && v >= begins_[std::size_t(byte) + 1])
            ++byte;
        return byte;
    }

private:
    static constexpr int buckets = 4096; // hardly ever two bytes begin in one
    static int encoded(double v) { return static_cast<int>(255.0 * srgb_encode(v) + 0.5); }
    std::array<double, 256> begins_{};
    std::array<std::uint8_t, buckets + 1> first_{};
};

// Narkowicz, "ACES Filmic Tone Mapping Curve", 2016.
Vec3 aces(const Vec3& v) {
    return (v * (2.51 * v + 0.03)) / (v * (2.43 * v + 0.59) + 0.14);
}

// AgX encodes the logarithm of what lies between these, in stops around 1.
constexpr double agx_min_stop = -12.47393;
constexpr double agx_max_stop = 4.026069;

const glm::dmat3& agx_inset() {
    static const glm::dmat3 inset = from_rows({0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                                              {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                                              {0.0423756549057051, 0.0784336, 0.879142973793104});
    return inset;
}

Vec3 agx_stops(const Vec3& v) {
    return glm::log2(glm::max(agx_inset() * v, Vec3(1e-10)));
}

// Sobotka's AgX, base look: inset into the working space, log2 encoding, Wrensch's sixth-order polynomial for the
// sigmoid (2023), outset. The result is display-encoded already.
Vec3 agx(const Vec3& v) {
    static const glm::dmat3 outset = glm::inverse(agx_inset());
    const Vec3 x =
        (glm::clamp(agx_stops(v), agx_min_stop, agx_max_stop) - agx_min_stop) / (agx_max_stop - agx_min_stop);
    const Vec3 x2 = x * x;
    const Vec3 x4 = x2 * x2;
    const Vec3 sigmoid =
        15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
    return outset * sigmoid;
}

// Extended Reinhard per channel; `white` maps to 1.
Vec3 reinhard(const Vec3& v, double white) {
    return v * (1.0 + v / (white * white)) / (1.0 + v);
}

// The value that srgb_encode is given, for the curves that it follows.
Vec3 linear_value(const Vec3& radiance, ToneCurve curve) {
    return clamped(curve == ToneCurve::aces ? aces(radiance) : radiance);
}

Vec3 display_value(const Vec3& radiance, ToneCurve curve, double white) {
    switch (curve) {
    case ToneCurve::agx:
        return clamped(agx(radiance));
    case ToneCurve::reinhard:
        return white > 0.0 ? clamped(reinhard(radiance, white)) : Vec3(0.0);
    case ToneCurve::aces:
    case ToneCurve::srgb:
        break;
    }
    return srgb_encode(linear_value(radiance, curve));
}

// Beyond what the curve tells apart. Reinhard's, which ends at the brightest value, has nothing beyond.
bool clips(const Vec3& radiance, ToneCurve curve) {
    constexpr double rounding = 1e-6; // a white of 1 is white, and no loss
    switch (curve) {
    case ToneCurve::aces:
        return glm::any(glm::greaterThan(aces(radiance), Vec3(1.0 + rounding)));
    case ToneCurve::agx:
        return glm::any(glm::greaterThan(agx_stops(radiance), Vec3(agx_max_stop + rounding)));
    case ToneCurve::reinhard:
        return false;
    case ToneCurve::srgb:
        break;
    }
    return glm::any(glm::greaterThan(radiance, Vec3(1.0 + rounding)));
}

// Not finite: black. Negative radiance cannot come from a render, but from a file it can.
Vec3 exposed(const glm::vec3& mean, double gain) {
    const Vec3 v = Vec3(mean) * gain;
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
        return Vec3(0.0);
    return glm::max(v, Vec3(0.0));
}

double brightest_channel(const Vec3& v) {
    return std::max({v.x, v.y, v.z});
}

// The original cut to bytes (1e-6: but white, computed as 1 - 1 ulp, is white); the other curves round to the nearest.
double rounding_of(ToneCurve curve) {
    return curve == ToneCurve::reinhard ? 1e-6 : 0.5;
}

// Reinhard's: the brightest channel.
double white_of(std::span<const glm::vec3> radiance, double gain) {
    double white = 0.0;
    for (const glm::vec3& mean : radiance)
        white = std::max(white, brightest_channel(exposed(mean, gain)));
    return white;
}

// Those of each pixel go where `bytes` says, `each` from pixel to pixel. `whole`: has the white, where the curve asks.
void write_colors(std::span<const glm::vec3> radiance, const ToneMapping& mapping, std::span<const glm::vec3> whole,
                  std::uint8_t* bytes, std::size_t each) {
    static const SrgbBytes srgb_bytes;
    const double gain = std::exp2(mapping.exposure), rounding = rounding_of(mapping.curve);
    if (mapping.curve == ToneCurve::srgb || mapping.curve == ToneCurve::aces) {
        for (const glm::vec3& mean : radiance) {
            const Vec3 linear = linear_value(exposed(mean, gain), mapping.curve);
            for (int channel = 0; channel < 3; ++channel)
                bytes[channel] = srgb_bytes(linear[channel]);
            bytes += each;
        }
        return;
    }
    const double white = mapping.curve == ToneCurve::reinhard ? white_of(whole, gain) : 0.0;
    for (const glm::vec3& mean : radiance) {
        const Vec3 v = display_value(exposed(mean, gain), mapping.curve, white);
        for (int channel = 0; channel < 3; ++channel)
            bytes[channel] = static_cast<std::uint8_t>(255.0 * v[channel] + rounding);
        bytes += each;
    }
}

} // namespace

std::vector<std::uint8_t> tone_map(const Film& film, const ToneMapping& mapping) {
    std::vector<std::uint8_t> bytes(film.mean.size() * 3);
    write_colors(film.mean, mapping, film.mean, bytes.data(), 3);
    return bytes;
}

std::vector<std::uint8_t> tone_map_opaque(std::span<const glm::vec3> radiance, const ToneMapping& mapping,
                                          std::span<const glm::vec3> whole) {
    std::vector<std::uint8_t> bytes(radiance.size() * 4, 255);
    write_colors(radiance, mapping, whole, bytes.data(), 4);
    return bytes;
}

std::vector<std::uint8_t> tone_map(const Film& film, const ToneMapping& mapping, const FilmLayer& alpha) {
    const double gain = std::exp2(mapping.exposure), rounding = rounding_of(mapping.curve);
    const auto alpha_of = [&](std::size_t i) { return std::clamp(double(alpha.mean[i].x), 0.0, 1.0); };
    const auto color_of = [&](std::size_t i) { return exposed(film.mean[i], gain) / alpha_of(i); };
    double white = 0.0;
    for (std::size_t i = 0; i < film.mean.size() && mapping.curve == ToneCurve::reinhard; ++i)
        white = alpha_of(i) > 0.0 ? std::max(white, brightest_channel(color_of(i))) : white;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(film.mean.size() * 4);
    for (std::size_t i = 0; i < film.mean.size(); ++i) {
        const double a = alpha_of(i);
        const Vec3 v = a > 0.0 ? display_value(color_of(i), mapping.curve, white) : Vec3(0.0);
        for (int channel = 0; channel < 3; ++channel)
            bytes.push_back(static_cast<std::uint8_t>(255.0 * v[channel] + rounding));
        bytes.push_back(static_cast<std::uint8_t>(255.0 * a + 0.5));
    }
    return bytes;
}

std::size_t clipped_pixels(const Film& film, const ToneMapping& mapping) {
    const double gain = std::exp2(mapping.exposure);
    return std::size_t(std::count_if(film.mean.begin(), film.mean.end(),
                                     [&](const glm::vec3& mean) { return clips(exposed(mean, gain), mapping.curve); }));
}

double faintest_radiance(const ToneMapping& mapping) {
    double low = -200.0, high = 200.0; // stops
    while (high - low > 1e-3) {
        const double middle = 0.5 * (low + high), radiance = std::exp2(middle + mapping.exposure);
        const double value = display_value(Vec3(radiance), mapping.curve, 1e100).x;
        (255.0 * value + rounding_of(mapping.curve) < 1.0 ? low : high) = middle;
    }
    return std::exp2(high);
}

double suitable_exposure(const Film& film, ToneCurve curve) {
    std::vector<double> values;
    for (const glm::vec3& mean : film.mean)
        if (const double value = brightest_channel(exposed(mean, 1.0)); value > 0.0)
            values.push_back(value);
    if (values.empty())
        return 0.0;
    const double white = *std::max_element(values.begin(), values.end());
    const auto bright = values.begin() + std::ptrdiff_t(0.99 * double(values.size() - 1));
    std::nth_element(values.begin(), bright, values.end());
    constexpr double most = 100.0; // stops, as on the command line
    double low = -most, high = most;
    while (high - low > 1e-3) {
        const double middle = 0.5 * (low + high), gain = std::exp2(middle);
        (display_value(Vec3(*bright * gain), curve, white * gain).x < 0.9 ? low : high) = middle;
    }
    // Where the curve makes its own white, of a picture of nearly one value, no exposure helps.
    return low == -most || high == most ? 0.0 : std::floor(100.0 * low) / 100.0;
}

} // namespace vkvol
