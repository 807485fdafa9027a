// Which curve and exposure a picture gets: what the command line says, and where it says nothing, what suits it.
#pragma once

#include <optional>
#include <string>

#include "film.h"
#include "tone_map.h"

namespace vkvol {

// What was asked for.
struct ToneRequest {
    std::optional<ToneCurve> curve;
    std::optional<double> exposure;  // stops
    bool automatic_exposure = false; // in place of a number: that of suitable_exposure()

    bool operator==(const ToneRequest&) const = default;
};

// What the picture gets.
struct Tone {
    ToneMapping mapping;
    bool for_glow = false;   // nobody chose the curve: it suits what glows
    std::size_t clipped = 0; // pixels, of
    std::size_t pixels = 0;
};

const char* name_of(ToneCurve curve);
std::optional<ToneCurve> find_tone_curve(const std::string& name);

// Metadata: stops, as text, by which a camera's settings raise radiance; those that are asked for come on top.
inline constexpr const char* camera_exposure_key = "vkvol/cameraExposure";

// Stops; 0 without such settings.
double camera_exposure(const Metadata& metadata);

// Whether the medium glows, and what was asked for, so that the image can be developed again as it was.
void record_tone(const ToneRequest& request, bool glows, Metadata& metadata);
// What was asked for in addition; the rest is as it was.
void record_tone(const ToneRequest& request, Metadata& metadata);

// Whether these say that this was asked for.
bool has_recorded(const ToneRequest& request, const Metadata& metadata);

// What is not asked for is as the image's metadata say; else the exposure is that of the camera's settings, or 0, and
// the curve is agx for what glows, since it keeps the colours of fire, which srgb cuts to yellow and white, and srgb
// for all else.
Tone choose_tone(const ToneRequest& request, const Film& film, const Metadata& metadata);

// What is worth telling of it: "tone curve agx since it glows, exposure -1, 12 % of the pixels clip". Empty for the
// usual.
std::string tone_text(const Tone& tone);

} // namespace vkvol
