#include "tone_choice.h"

#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "metadata.h"

namespace vkvol {

namespace {

constexpr std::array<std::pair<ToneCurve, const char*>, 4> names = {
    {{ToneCurve::srgb, "srgb"}, {ToneCurve::aces, "aces"}, {ToneCurve::agx, "agx"}, {ToneCurve::reinhard, "reinhard"}}};

constexpr const char* glow_key = "vkvol/glows";
constexpr const char* curve_key = "vkvol/tonemap";
constexpr const char* exposure_key = "vkvol/exposure"; // as text: a float would round it
constexpr const char* automatic = "auto";

std::optional<double> stops_in(const Metadata& metadata, const char* key) {
    const std::string text = text_of(metadata, key);
    double exposure = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), exposure);
    const bool good = error == std::errc() && end == text.data() + text.size() && std::abs(exposure) <= 100.0;
    return good ? std::optional(exposure) : std::nullopt;
}

// What a file's metadata asks for. The file may be anyone's: what cannot be read says nothing.
ToneRequest recorded(const Metadata& metadata) {
    ToneRequest request;
    request.curve = find_tone_curve(text_of(metadata, curve_key));
    request.exposure = stops_in(metadata, exposure_key);
    request.automatic_exposure = text_of(metadata, exposure_key) == automatic;
    return request;
}

bool says_exposure(const ToneRequest& request) {
    return request.exposure || request.automatic_exposure;
}

} // namespace

const char* name_of(ToneCurve curve) {
    for (const auto& [known, name] : names)
        if (known == curve)
            return name;
    return "";
}

std::optional<ToneCurve> find_tone_curve(const std::string& name) {
    for (const auto& [curve, known] : names)
        if (known == name)
            return curve;
    return std::nullopt;
}

void record_tone(const ToneRequest& request, bool glows, Metadata& metadata) {
    metadata[glow_key] = glows ? 1 : 0;
    record_tone(request, metadata);
}

void record_tone(const ToneRequest& request, Metadata& metadata) {
    if (request.curve)
        metadata[curve_key] = std::string(name_of(*request.curve));
    if (says_exposure(request))
        metadata[exposure_key] =
            request.automatic_exposure ? std::string(automatic) : fmt::format("{}", *request.exposure);
}

bool has_recorded(const ToneRequest& request, const Metadata& metadata) {
    return recorded(metadata) == request;
}

double camera_exposure(const Metadata& metadata) {
    return stops_in(metadata, camera_exposure_key).value_or(0.0);
}

Tone choose_tone(const ToneRequest& request, const Film& film, const Metadata& metadata) {
    const ToneRequest before = recorded(metadata);
    const ToneRequest& exposing = says_exposure(request) ? request : before;
    Tone tone;
    if (request.curve || before.curve) {
        tone.mapping.curve = request.curve ? *request.curve : *before.curve;
    } else {
        tone.for_glow = text_of(metadata, glow_key) == "1";
        tone.mapping.curve = tone.for_glow ? ToneCurve::agx : ToneCurve::srgb;
    }
    const double camera = camera_exposure(metadata);
    tone.mapping.exposure = exposing.automatic_exposure ? suitable_exposure(film, tone.mapping.curve)
                                                        : camera + exposing.exposure.value_or(0.0);
    tone.clipped = clipped_pixels(film, tone.mapping);
    tone.pixels = film.pixel_count();
    return tone;
}

std::string tone_text(const Tone& tone) {
    constexpr double many = 0.01; // what is less is a highlight or two
    std::string text;
    const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
    if (tone.for_glow)
        add(fmt::format("tone curve {} since it glows", name_of(tone.mapping.curve)));
    else if (tone.mapping.curve != ToneCurve::srgb)
        add(fmt::format("tone curve {}", name_of(tone.mapping.curve)));
    if (tone.mapping.exposure != 0.0)
        add(fmt::format("exposure {:g}", tone.mapping.exposure));
    const double part = tone.pixels > 0 ? double(tone.clipped) / double(tone.pixels) : 0.0;
    if (part >= many)
        add(fmt::format("{:.0f} % of the pixels clip", 100.0 * part));
    return text;
}

} // namespace vkvol
