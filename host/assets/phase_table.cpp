#include "phase_table.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "error.h"
#include "fournier_forand.h"
#include "number_table.h"

namespace vkvol {

namespace {

using std::numbers::pi;

constexpr int moment_angles = 16384; // at which a series is evaluated: 0.011 degrees apart

NumberTable read_rows(const std::filesystem::path& file) {
    const NumberTable rows = read_number_table(file, {"<phase> names a text file of angles and values",
                                                      "lines are \"angle value\", or one Legendre moment each", 1, 2});
    if (rows.rows() < 2)
        throw InputError(
            fmt::format("{}: holds {} lines with numbers; at least two are needed", file.string(), rows.rows()));
    return rows;
}

// 0, 1, 2 ..., and the first is 1: moments that stand beside their indices, it may be.
bool look_like_moments(const NumberTable& rows) {
    for (std::size_t i = 0; i < rows.lines.size(); ++i)
        if (rows.numbers[2 * i] != double(i) || std::abs(rows.numbers[2 * i + 1]) > 1.0)
            return false;
    return rows.numbers[1] == 1.0;
}

PhaseTable from_angles(const std::filesystem::path& file, const NumberTable& rows) {
    std::vector<double> angles, values;
    for (std::size_t i = 0; i < rows.lines.size(); ++i) {
        const double angle = rows.numbers[2 * i], value = rows.numbers[2 * i + 1];
        if (angle < 0.0 || angle > 180.0 || (i > 0 && angle <= rows.numbers[2 * i - 2]))
            fail_line(file, rows.lines[i], fmt::format("angle {:g}; angles go from 0 to 180 degrees, and rise", angle));
        if (value < 0.0)
            fail_line(file, rows.lines[i], fmt::format("value {:g}; values are 0 or more", value));
        angles.push_back(angle / 180.0 * pi);
        values.push_back(value);
    }
    if (rows.numbers[0] != 0.0 || angles.back() != pi)
        throw InputError(
            fmt::format("{}: goes from {:g} to {:g} degrees; values are needed at 0 and at 180, too{}", file.string(),
                        rows.numbers[0], angles.back() / pi * 180.0,
                        look_like_moments(rows) ? "; if these are Legendre moments, leave out their indices" : ""));
    if (*std::max_element(values.begin(), values.end()) == 0.0)
        throw InputError(fmt::format("{}: every value is 0; a phase function scatters somewhere", file.string()));
    PhaseTable table{make_phase_nodes(angles, values), {}};
    if (look_like_moments(rows))
        table.warnings.push_back(fmt::format("{}: is read as values at 0, 1, 2 ... degrees; if these are Legendre "
                                             "moments, leave out their indices",
                                             file.string()));
    return table;
}

// Sum of (2 l + 1) moment_l P_l(mu), by the recurrence of Legendre's polynomials.
double series(const std::vector<double>& moments, double mu) {
    double before = 1.0, now = mu, sum = moments[0] + 3.0 * moments[1] * mu;
    for (std::size_t l = 2; l < moments.size(); ++l) {
        const double next = ((2.0 * l - 1.0) * mu * now - (l - 1.0) * before) / l;
        before = now;
        now = next;
        sum += (2.0 * l + 1.0) * moments[l] * now;
    }
    return sum;
}

// Even, and towards 0, where many moments may have a peak narrower than that, closer and closer together.
std::vector<double> angles_of_series(std::size_t moments) {
    constexpr double nearest = 1e-7, evenly_from = 0.01;
    constexpr int close = 2048;
    std::vector<double> angles{0.0};
    if (moments > 1024)
        for (int i = 0; i < close; ++i)
            angles.push_back(nearest * std::pow(evenly_from / nearest, double(i) / close));
    for (int i = 1; i <= moment_angles; ++i)
        if (const double angle = pi * i / moment_angles; angle > angles.back())
            angles.push_back(angle);
    return angles;
}

// A series that ends too soon swings about what it is to be, below 0 as well.
PhaseTable from_moments(const std::filesystem::path& file, const NumberTable& rows) {
    const std::vector<double>& moments = rows.numbers;
    if (std::abs(moments[0] - 1.0) > 1e-3)
        fail_line(file, rows.lines[0],
                  fmt::format("the first moment is {:g}; it is the mean of 1, and so 1", moments[0]));
    for (std::size_t i = 0; i < moments.size(); ++i)
        if (std::abs(moments[i]) > 1.001)
            fail_line(file, rows.lines[i],
                      fmt::format("moment {:g}; means of Legendre's polynomials are from -1 to 1 (without "
                                  "the factor 2 l + 1)",
                                  moments[i]));
    const std::vector<double> angles = angles_of_series(moments.size());
    std::vector<double> values;
    double below = 0.0, above = 0.0;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        values.push_back(series(moments, std::cos(angles[i])));
        if (i > 0) {
            const double part = 0.25 * (values[i - 1] + values[i]) * (std::cos(angles[i - 1]) - std::cos(angles[i]));
            (part < 0.0 ? below : above) += std::abs(part);
        }
    }
    for (double& value : values)
        value = std::max(value, 0.0);
    if (below > 0.05 * above)
        throw InputError(
            fmt::format("{}: the series of its {} moments is negative over {:.0f} percent of what it is in "
                        "all; give more moments, or angles and values",
                        file.string(), moments.size(), 100.0 * below / above));
    if (std::abs(above - below - 1.0) > 0.01)
        throw InputError(
            fmt::format("{}: the series of its {} moments has a peak too narrow to be drawn from (between "
                        "angles it comes to {:.3f} of what it should); give angles and values, or take the "
                        "light that goes straight on out of the extinction",
                        file.string(), moments.size(), above - below));
    PhaseTable table{make_phase_nodes(angles, values), {}};
    if (below > 1e-6 * above)
        table.warnings.push_back(fmt::format("{}: the series of its {} moments is negative at some angles, over {:.2g} "
                                             "percent of all light, and counts as 0 there",
                                             file.string(), moments.size(), 100.0 * below / above));
    return table;
}

} // namespace

std::vector<shared::PhaseNode> make_phase_nodes(std::span<const double> angles, std::span<const double> values) {
    std::vector<shared::PhaseNode> nodes;
    std::vector<double> kept;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        // Towards 180 degrees single precision has nodes 0.03 degrees apart: of those that fall together the last
        // stays.
        const double sine = std::sin(0.5 * angles[i]);
        const auto x = i + 1 < angles.size() ? static_cast<float>(2.0 * sine * sine) : 2.0f;
        if (!nodes.empty() && x <= nodes.back().x) {
            kept.back() = values[i];
            continue;
        }
        nodes.push_back({x, 0.0f, 0.0f});
        kept.push_back(values[i]);
    }
    std::vector<double> shares{0.0};
    for (std::size_t i = 1; i < nodes.size(); ++i)
        shares.push_back(shares.back() + pi * (kept[i - 1] + kept[i]) * (double(nodes[i].x) - nodes[i - 1].x));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        nodes[i].value = static_cast<float>(kept[i] / shares.back());
        nodes[i].share = static_cast<float>(shares[i] / shares.back());
    }
    return nodes;
}

PhaseTable load_phase_table(const std::filesystem::path& file) {
    const NumberTable rows = read_rows(file);
    PhaseTable table = rows.width == 2 ? from_angles(file, rows) : from_moments(file, rows);
    if (!(table.nodes.back().share > 0.0f)) // all of it between angles that are one in single precision
        throw InputError(fmt::format("{}: scatters nowhere; give values above 0 at more angles", file.string()));
    return table;
}

PhaseTable phase_table(const Volume& volume) {
    const PhaseDetails& details = volume.phase_details;
    if (volume.phase == PhaseFunction::table)
        return load_phase_table(details.file);
    if (volume.phase == PhaseFunction::fournier_forand)
        return {fournier_forand_nodes(details.index, details.backscatter), {}};
    return {};
}

} // namespace vkvol
