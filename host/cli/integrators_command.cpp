#include "integrators_command.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>

#include "error.h"
#include "integrators.h"
#include "messages.h"

namespace vkvol {

namespace {

// The preset's choice along an axis; none: it is made for each scene.
std::optional<int> choice_of(const Integrator& integrator, const std::string& axis) {
    return axis == "scattering"      ? std::optional(integrator.scattering)
           : axis == "flight"        ? std::optional(integrator.free_flight)
           : axis == "transmittance" ? std::optional(integrator.transmittance)
           : axis == "nee"           ? std::optional(integrator.nee)
           : axis == "paths"         ? std::optional(integrator.paths)
                                     : std::nullopt;
}

std::string choice_name(const Integrator& integrator, const std::string& axis) {
    const std::optional<int> id = choice_of(integrator, axis);
    return id ? find_axis(axis).names.at(static_cast<std::size_t>(*id)) : "by scene";
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
         "emission, mis, distance and firstFlight suit the scene unless they are asked for: looks share light with\n"
         "flights by the balance heuristic, but for skies that are nearly even, which are left to flights; looks from\n"
         "along flights are for lamps in even fog; and first flights are split where media are thin.\n"
         "At constant density, and where the extinction differs between the channels, what fits replaces these;\n"
         "scenes/README.md has the rules.\n");
}

void print_json() {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Integrator& integrator : integrators()) {
        nlohmann::ordered_json entry = {{"name", integrator.name}};
        for (const Axis& axis : axes())
            if (choice_of(integrator, axis.name))
                entry[axis.name] = choice_name(integrator, axis.name);
            else
                entry[axis.name] = nullptr; // made for each scene
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
