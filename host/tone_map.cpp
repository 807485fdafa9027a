#include "tone_map.h"

#include <algorithm>
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

// Narkowicz, "ACES Filmic Tone Mapping Curve", 2016.
Vec3 aces(const Vec3& v) {
    return (v * (2.51 * v + 0.03)) / (v * (2.43 * v + 0.59) + 0.14);
}

// Sobotka's AgX, base look: inset into the working space, log2 encoding between -12.47393 and 4.026069 stops around 1,
// Wrensch's sixth-order polynomial for the sigmoid (2023), outset. The result is display-encoded already.
Vec3 agx(const Vec3& v) {
    static const glm::dmat3 inset = from_rows({0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                                              {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                                              {0.0423756549057051, 0.0784336, 0.879142973793104});
    static const glm::dmat3 outset = glm::inverse(inset);
    constexpr double min_stop = -12.47393;
    constexpr double max_stop = 4.026069;
    const Vec3 working = glm::max(inset * v, Vec3(1e-10));
    const Vec3 x = (glm::clamp(glm::log2(working), min_stop, max_stop) - min_stop) / (max_stop - min_stop);
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

Vec3 display_value(const Vec3& radiance, ToneCurve curve, double white) {
    switch (curve) {
    case ToneCurve::aces:
        return srgb_encode(clamped(aces(radiance)));
    case ToneCurve::agx:
        return clamped(agx(radiance));
    case ToneCurve::reinhard:
        return white > 0.0 ? clamped(reinhard(radiance, white)) : Vec3(0.0);
    case ToneCurve::srgb:
        break;
    }
    return srgb_encode(clamped(radiance));
}

// Not finite: black. Negative radiance cannot come from a render, but from a file it can.
Vec3 exposed(const glm::vec3& mean, double gain) {
    const Vec3 v = Vec3(mean) * gain;
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
        return Vec3(0.0);
    return glm::max(v, Vec3(0.0));
}

} // namespace

std::vector<std::uint8_t> tone_map(const Film& film, const ToneMapping& mapping) {
    const double gain = std::exp2(mapping.exposure);
    double white = 0.0;
    for (const glm::vec3& mean : film.mean) {
        const Vec3 v = exposed(mean, gain);
        white = std::max({white, v.x, v.y, v.z});
    }
    // The original cut to bytes (1e-6: but white, computed as 1 - 1 ulp, is white); the other curves round to the
    // nearest.
    const double rounding = mapping.curve == ToneCurve::reinhard ? 1e-6 : 0.5;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(film.mean.size() * 3);
    for (const glm::vec3& mean : film.mean) {
        const Vec3 v = display_value(exposed(mean, gain), mapping.curve, white);
        for (int channel = 0; channel < 3; ++channel)
            bytes.push_back(static_cast<std::uint8_t>(255.0 * v[channel] + rounding));
    }
    return bytes;
}

} // namespace vkvol
