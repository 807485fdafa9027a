// The part of SceneReader that reads the phase function.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "nearest_name.h"
#include "scene_reader.h"

namespace vkvol {

namespace {

struct PhaseKind {
    std::string name;
    std::vector<std::string> attributes;
    bool has_g = true;
};

// As PhaseFunction.
const std::vector<PhaseKind> phase_kinds = {{"henyeyGreenstein", {}},
                                            {"rayleigh", {"depolarization"}, false},
                                            {"doubleHenyeyGreenstein", {"second", "share"}},
                                            {"draine", {"alpha"}},
                                            {"droplets", {"diameter"}, false},
                                            {"table", {"file", "baseDir"}, false},
                                            {"fournierForand", {"index", "backscatter"}, false}};

constexpr Limits asymmetry{-1, 1, false, false, "a number between -1 and 1, both excluded"};
constexpr double sharpest = 0.99999; // single precision still has 1 - g to a hundredth

std::string too_sharp(const std::string& name, double g) {
    return fmt::format("{} {} is too near 1 for single precision; expected at most {} in magnitude", name, g, sharpest);
}

const PhaseKind& kind_of(const XmlElement& phase) {
    if (!phase.exists())
        return phase_kinds.front();
    const std::string text = phase.text();
    const auto found =
        std::find_if(phase_kinds.begin(), phase_kinds.end(), [&](const PhaseKind& kind) { return kind.name == text; });
    if (found != phase_kinds.end())
        return *found;
    std::vector<std::string> names;
    for (const PhaseKind& kind : phase_kinds)
        names.push_back(kind.name);
    phase.fail_text(fmt::format("unknown phase function '{}'{}", text, name_hint(text, names)));
}

} // namespace

void SceneReader::read_phase(Volume& volume) const {
    const XmlElement phase = one("phase");
    const PhaseKind& kind = kind_of(phase);
    phase.allow(kind.attributes, true);
    volume.phase = static_cast<PhaseFunction>(&kind - phase_kinds.data());
    const XmlElement g = one({"heyneygreenstein_g", "heynegreenstein_g"});
    g.allow({}, true);
    volume.g = g.number(volume.g, asymmetry);
    if (std::abs(volume.g) > sharpest)
        g.fail_text(too_sharp(fmt::format("<{}>", g.name()), volume.g));
    if (!kind.has_g && volume.g != 0.0) {
        g.warn(fmt::format("<{}> is without effect: phase {} has an asymmetry of its own", g.name(), kind.name));
        volume.g = 0.0;
    }
    PhaseDetails& details = volume.phase_details;
    if (volume.phase == PhaseFunction::double_henyey_greenstein) {
        details.g2 = phase.attribute_number("second", details.g2, asymmetry);
        if (std::abs(details.g2) > sharpest)
            phase.fail_attribute("second", too_sharp("<phase> second:", details.g2));
        details.share = phase.attribute_number("share", details.share, {0, 1, true, true, "a number from 0 to 1"});
    }
    details.alpha = phase.attribute_number("alpha", details.alpha, {0, 250, true, true, "a number from 0 to 250"});
    details.diameter = phase.attribute_number("diameter", details.diameter,
                                              {0.01, 50, true, true, "a diameter from 0.01 to 50 micrometres"});
    details.depolarization = phase.attribute_number("depolarization", details.depolarization,
                                                    {0.0, 6.0 / 7.0, true, true, "a number from 0 to 6/7"});
    details.index = phase.attribute_number("index", details.index,
                                           {1.001, 1.6, true, true, "an index of refraction from 1.001 to 1.6"});
    details.backscatter = phase.attribute_number("backscatter", details.backscatter,
                                                 {0.0001, 0.49, true, true, "a part from 0.0001 to 0.49"});
    if (volume.phase == PhaseFunction::table) {
        if (!phase.has("file"))
            phase.fail("<phase> table names no file; write e.g. file=\"droplets.txt\"");
        details.file = file_path(phase, phase.attribute("file"));
    }
}

} // namespace vkvol
