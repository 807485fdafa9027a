// --tonemap and --exposure, which mean the same wherever 8-bit pictures are written.
#pragma once

#include <string>

#include "option_groups.h"
#include "tone_choice.h"

namespace vkvol {

struct ToneTexts {
    std::string curve, exposure;

    // `usual`: what holds where nothing is asked for.
    void add(CLI::App& app, const char* usual_curve, const char* usual_exposure);
    // Throws InputError.
    ToneRequest request() const;
};

} // namespace vkvol
