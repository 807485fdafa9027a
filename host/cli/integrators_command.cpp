#include "integrators_command.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "error.h"
#include "integrators.h"
#include "messages.h"

namespace vkvol {

namespace {

// The preset's choice along an axis; emission is at collisions in all of them.
std::string choice_name(const Integrator& integrator, const std::string& axis) {
    const int id = axis == "scattering"      ? integrator.scattering
                   : axis == "flight"        ? integrator.free_flight
                   : axis == "transmittance" ? integrator.transmittance
                   : axis == "nee"           ? integrator.nee
                   : axis == "paths"         ? integrator.paths
                                             : 0;
    return find_axis(axis).names.at(static_cast<std::size_t>(id));
}

void print_table() {
    const auto row = [](const auto&... cells) {
        tell(stdout, "{:<30} {:<11} {:<14} {:<14} {:<11} {:<9} {}\n", cells...);
    };
    row("integrator", "scattering", "flight", "transmittance", "nee", "estimate", "from");
    for (const Integrator& integrator : integrators()) {
        const bool biased = *integrator.biased != '\0';
        row(integrator.name, choice_name(integrator, "scattering"), choice_name(integrator, "flight"),
            choice_name(integrator, "transmittance"), choice_name(integrator, "nee"), biased ? "biased" : "unbiased",
            integrator.source);
        tell(stdout, "    {}\n", integrator.summary);
        if (biased)
            tell(stdout, "    biased: {}\n", integrator.biased);
        tell(stdout, "    parameters: {}\n", integrator.parameters);
    }
    tell(stdout, "\nEach choice can be changed, here as in the scene: --integrator ratioTracking:flight=weighted, or\n"
                 "<integrator flight=\"weighted\">ratioTracking</integrator>. The choices are:\n");
    for (const Axis& axis : axes())
        tell(stdout, "    {:<14} {}\n", axis.name, fmt::join(axis.names, ", "));
    tell(stdout,
         "At constant density, and where the extinction differs between the channels, what fits replaces these;\n"
         "scenes/README.md has the rules.\n");
}

void print_json() {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Integrator& integrator : integrators()) {
        nlohmann::ordered_json entry = {{"name", integrator.name}};
        for (const Axis& axis : axes())
            entry[axis.name] = choice_name(integrator, axis.name);
        entry["biased"] = integrator.biased;
        entry["parameters"] = integrator.parameters;
        entry["summary"] = integrator.summary;
        entry["source"] = integrator.source;
        list.push_back(entry);
    }
    put(stdout, list.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

} // namespace

int run_integrators(bool json) {
    json ? print_json() : print_table();
    return exit_done;
}

} // namespace vkvol
