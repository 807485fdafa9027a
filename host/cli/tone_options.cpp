#include "tone_options.h"

#include <charconv>
#include <fmt/format.h>

#include "nearest_name.h"
#include "option_values.h"

namespace vkvol {

void ToneTexts::add(CLI::App& app, const char* usual_curve, const char* usual_exposure) {
    app.add_option("--tonemap", curve, "Curve for PNG: srgb, aces, agx, or reinhard (the original's)")
        ->option_text(fmt::format("CURVE [{}]", usual_curve))
        ->group("Picture");
    app.add_option("--exposure", exposure,
                   "Brightness of PNG in stops: 1 doubles, -1 halves; or auto: 99 % of what is not black "
                   "stays below nine tenths of white")
        ->option_text(fmt::format("EV|auto [{}]", usual_exposure))
        ->group("Picture");
}

ToneRequest ToneTexts::request() const {
    constexpr double most = 100.0;
    ToneRequest request;
    if (!curve.empty()) {
        request.curve = find_tone_curve(curve);
        if (!request.curve)
            fail_command_line(fmt::format("--tonemap: unknown value '{}'{}", curve,
                                          name_hint(curve, {"srgb", "aces", "agx", "reinhard"})));
    }
    if (exposure == "auto") {
        request.automatic_exposure = true;
    } else if (!exposure.empty()) {
        double stops = 0.0;
        const std::size_t sign = exposure.size() > 1 && exposure[0] == '+' && exposure[1] != '-' ? 1 : 0;
        const auto [end, error] = std::from_chars(exposure.data() + sign, exposure.data() + exposure.size(), stops);
        if (error != std::errc() || end != exposure.data() + exposure.size() || !(stops >= -most && stops <= most))
            fail_command_line(
                fmt::format("--exposure: '{}' is neither a number from {:g} to {:g} nor auto", exposure, -most, most));
        request.exposure = stops;
    }
    return request;
}

} // namespace vkvol
