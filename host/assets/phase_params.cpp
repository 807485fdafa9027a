#include "phase_params.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace vkvol {

namespace {

// A mixture of Henyey and Greenstein's phase function and a share of Draine's.
struct Mixture {
    double g, g2, alpha, share;
};

// Jendersie and d'Eon's fit to Mie's theory of droplets of water in visible light, by their diameter in micrometres
// ("An Approximate Mie Scattering Function for Fog and Cloud Rendering", 2023, equations 7 to 22).
Mixture fit_to_droplets(double d) {
    const double l = std::log(d);
    if (d <= 0.1)
        return {13.8 * d * d, 1.1456 * d * std::sin(9.29044 * d), 250.0, 0.252977 - 312.983 * std::pow(d, 4.3)};
    if (d < 1.5) {
        const double inner = std::cos((l - 0.238604) * (l + 1.00667) / (0.507522 - 0.15677 * l));
        return {0.862 - 0.143 * l * l, 0.379685 * std::cos(1.19692 * inner + 1.37932 * l + 0.0625835) + 0.344213, 250.0,
                0.146209 * std::cos(3.38707 * l + 2.11193) + 0.316072 + 0.0778917 * l};
    }
    if (d < 5.0) {
        const double ll = std::log(l);
        return {0.0604931 * ll + 0.940256, 0.500411 - 0.081287 / (-2.0 * l + std::tan(l) + 1.27551),
                7.30354 * l + 6.31675, 0.026914 * (l - std::cos(5.68947 * (ll - 0.0292149))) + 0.376475};
    }
    return {std::exp(-0.0990567 / (d - 1.67154)), std::exp(-2.20679 / (d + 3.91029) - 0.428934),
            std::exp(3.62489 - 8.29288 / (d + 5.52825)), std::exp(-0.599085 / (d - 0.641583) - 0.665888)};
}

// The part that is not even of Rayleigh's phase function, 3 / (4 (1 + 2 c)) (1 + 3 c + (1 - c) mu^2) / 4 pi with
// c = d / (2 - d) (Bucholtz, "Rayleigh-scattering calculations for the terrestrial atmosphere", 1995, equation 12).
double directed_share(double depolarization) {
    const double c = depolarization / (2.0 - depolarization);
    return (1.0 - c) / (1.0 + 2.0 * c);
}

double henyey_greenstein(double g, double mu) {
    return (1.0 - g * g) / (4.0 * std::numbers::pi * std::pow(1.0 + g * g - 2.0 * g * mu, 1.5));
}

double draine(double g, double alpha, double mu) {
    return henyey_greenstein(g, mu) * (1.0 + alpha * mu * mu) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
}

double draine_mean_cosine(double g, double alpha) {
    return g * (1.0 + alpha * (3.0 + 2.0 * g * g) / 5.0) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
}

double table_value(std::span<const shared::PhaseNode> nodes, double mu) {
    const float x = static_cast<float>(1.0 - mu);
    const auto after = std::ranges::upper_bound(nodes.begin() + 1, nodes.end() - 1, x, {}, &shared::PhaseNode::x);
    const shared::PhaseNode &a = *std::prev(after), &b = *after;
    return std::lerp(a.value, b.value, std::clamp((x - a.x) / (b.x - a.x), 0.0f, 1.0f));
}

// Mean cosine of densities that are linear between nodes: 2 pi times the integral of (1 - x) value.
double table_mean_cosine(std::span<const shared::PhaseNode> nodes) {
    double mean = 0.0;
    for (std::size_t i = 1; i < nodes.size(); ++i) {
        const double a = nodes[i - 1].x, b = nodes[i].x;
        const double middle = 0.5 * (nodes[i - 1].value + nodes[i].value);
        mean += (b - a) / 6.0 *
                ((1.0 - a) * nodes[i - 1].value + 4.0 * (1.0 - 0.5 * (a + b)) * middle + (1.0 - b) * nodes[i].value);
    }
    return 2.0 * std::numbers::pi * mean;
}

} // namespace

shared::PhaseParams phase_params(const Volume& volume, std::span<const shared::PhaseNode> nodes) {
    const PhaseDetails& details = volume.phase_details;
    Mixture mixture{volume.g, details.g2, details.alpha, details.share};
    if (volume.phase == PhaseFunction::droplets)
        mixture = fit_to_droplets(details.diameter);
    if (volume.phase == PhaseFunction::rayleigh)
        mixture.share = directed_share(details.depolarization);
    shared::PhaseParams params{};
    params.g = static_cast<float>(mixture.g);
    params.g2 = static_cast<float>(mixture.g2);
    params.share = static_cast<float>(mixture.share);
    params.alpha = static_cast<float>(mixture.alpha);
    params.nodes = static_cast<std::uint32_t>(nodes.size());
    return params;
}

std::uint32_t phase_iterations(const Volume& volume, std::span<const shared::PhaseNode> nodes) {
    // A flight's next direction, and looks for light from where it collides, tentatively too, and from along it. These
    // draw one, toward a lamp or, of what is scattered once, a sun or map, and evaluate three times for each, and twice
    // for what comes of it. Lanes of a group are at different ones of them in one turn.
    constexpr std::uint32_t drawn = 1 + 2 + 2 + 1, evaluated = 1 + 8 + 8 + 4, newton_steps = 10;
    if (volume.phase == PhaseFunction::draine || volume.phase == PhaseFunction::droplets)
        return drawn * (newton_steps + 1);
    if (!nodes.empty())
        return (drawn + evaluated) * static_cast<std::uint32_t>(std::bit_width(nodes.size()) + 1);
    return 0;
}

double phase_value(const Volume& volume, std::span<const shared::PhaseNode> nodes, double mu) {
    const shared::PhaseParams p = phase_params(volume, nodes);
    switch (volume.phase) {
    case PhaseFunction::rayleigh: // whose mean of mu^2 is 1/3
        return std::lerp(1.0, 0.75 * (1.0 + mu * mu), double(p.share)) / (4.0 * std::numbers::pi);
    case PhaseFunction::double_henyey_greenstein:
        return std::lerp(henyey_greenstein(p.g, mu), henyey_greenstein(p.g2, mu), double(p.share));
    case PhaseFunction::draine:
        return draine(p.g, p.alpha, mu);
    case PhaseFunction::droplets:
        return std::lerp(henyey_greenstein(p.g, mu), draine(p.g2, p.alpha, mu), double(p.share));
    case PhaseFunction::table:
    case PhaseFunction::fournier_forand:
        return table_value(nodes, mu);
    case PhaseFunction::henyey_greenstein:
        break;
    }
    return henyey_greenstein(p.g, mu);
}

double phase_peak(const Volume& volume, std::span<const shared::PhaseNode> nodes) {
    const auto henyey_greenstein_peak = [](double g) {
        return (1.0 + std::abs(g)) / (4.0 * std::numbers::pi * (1.0 - std::abs(g)) * (1.0 - std::abs(g)));
    };
    const shared::PhaseParams params = phase_params(volume, nodes);
    switch (volume.phase) {
    case PhaseFunction::rayleigh:
        return 1.5 / (4.0 * std::numbers::pi);
    case PhaseFunction::double_henyey_greenstein:
        return std::max(henyey_greenstein_peak(params.g), henyey_greenstein_peak(params.g2));
    case PhaseFunction::draine: // at most three times that of Henyey and Greenstein's with the same g
        return 3.0 * henyey_greenstein_peak(params.g);
    case PhaseFunction::droplets:
        return std::max(henyey_greenstein_peak(params.g), 3.0 * henyey_greenstein_peak(params.g2));
    case PhaseFunction::table:
    case PhaseFunction::fournier_forand: {
        float peak = 0.0f;
        for (const shared::PhaseNode& node : nodes)
            peak = std::max(peak, node.value);
        return peak;
    }
    case PhaseFunction::henyey_greenstein:
        break;
    }
    return henyey_greenstein_peak(params.g);
}

double mean_cosine(const Volume& volume, std::span<const shared::PhaseNode> nodes) {
    const PhaseDetails& details = volume.phase_details;
    switch (volume.phase) {
    case PhaseFunction::rayleigh:
        return 0.0;
    case PhaseFunction::double_henyey_greenstein:
        return std::lerp(volume.g, details.g2, details.share);
    case PhaseFunction::draine:
        return draine_mean_cosine(volume.g, details.alpha);
    case PhaseFunction::droplets: {
        const Mixture fit = fit_to_droplets(details.diameter);
        return std::lerp(fit.g, draine_mean_cosine(fit.g2, fit.alpha), fit.share);
    }
    case PhaseFunction::table:
    case PhaseFunction::fournier_forand:
        return table_mean_cosine(nodes);
    case PhaseFunction::henyey_greenstein:
        break;
    }
    return volume.g;
}

} // namespace vkvol
