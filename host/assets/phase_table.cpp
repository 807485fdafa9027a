#include "phase_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <numbers>

#include "error.h"
#include "one_line.h"

namespace vkvol {

namespace {

using std::numbers::pi;

constexpr std::size_t most_lines = 65536;
constexpr std::size_t longest_line = 4096;
constexpr double largest_value = 1e30;
constexpr int moment_angles = 16384; // at which a series is evaluated: 0.011 degrees apart

// The file's numbers, a row a line that has some, all of as many.
struct Rows {
    std::vector<double> numbers;
    std::vector<int> lines; // where each row was
    std::size_t width = 0;
};

[[noreturn]] void fail(const std::filesystem::path& file, int line, const std::string& message) {
    throw InputError(fmt::format("{}:{}: {}", file.string(), line, message));
}

void read_row(const std::filesystem::path& file, int number, std::string line, Rows& rows) {
    line.erase(std::find(line.begin(), line.end(), '#'), line.end());
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ',' || c == ';' || c == '\t' || c == '\r'; }, ' ');
    const char *at = line.data(), *end = at + line.size();
    std::size_t width = 0;
    while ((at = std::find_if(at, end, [](char c) { return c != ' '; })) != end) {
        const char* word_end = std::find(at, end, ' ');
        double value = 0.0;
        const auto [read, error] = std::from_chars(at + (*at == '+' ? 1 : 0), word_end, value);
        if (error != std::errc() || read != word_end || !(std::abs(value) <= largest_value))
            fail(file, number,
                 fmt::format("'{}' is no number; lines are \"angle value\", or one Legendre moment each",
                             one_line(std::string(at, std::min(word_end, at + 40)))));
        rows.numbers.push_back(value);
        ++width;
        at = word_end;
    }
    if (width == 0)
        return;
    if (rows.width == 0)
        rows.width = width;
    if (width != rows.width || width > 2)
        fail(file, number,
             fmt::format("has {} numbers; every line has two, an angle and a value, or every line one, a "
                         "Legendre moment",
                         width));
    rows.lines.push_back(number);
    if (rows.lines.size() > most_lines)
        fail(file, number, fmt::format("more than {} lines; thin it out", most_lines));
}

Rows read_rows(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!stream || std::filesystem::is_directory(file))
        throw InputError(
            fmt::format("{}: cannot be read; <phase> names a text file of angles and values", file.string()));
    Rows rows;
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        if (line.size() > longest_line)
            fail(file, number, "a very long line; is this the text file that was meant?");
        read_row(file, number, line, rows);
    }
    if (rows.lines.size() < 2)
        throw InputError(
            fmt::format("{}: holds {} lines with numbers; at least two are needed", file.string(), rows.lines.size()));
    return rows;
}

PhaseTable from_angles(const std::filesystem::path& file, const Rows& rows) {
    std::vector<double> angles, values;
    for (std::size_t i = 0; i < rows.lines.size(); ++i) {
        const double angle = rows.numbers[2 * i], value = rows.numbers[2 * i + 1];
        if (angle < 0.0 || angle > 180.0 || (i > 0 && angle <= rows.numbers[2 * i - 2]))
            fail(file, rows.lines[i], fmt::format("angle {:g}; angles go from 0 to 180 degrees, and rise", angle));
        if (value < 0.0)
            fail(file, rows.lines[i], fmt::format("value {:g}; values are 0 or more", value));
        angles.push_back(angle / 180.0 * pi);
        values.push_back(value);
    }
    if (rows.numbers[0] != 0.0 || angles.back() != pi)
        throw InputError(fmt::format("{}: goes from {:g} to {:g} degrees; values are needed at 0 and at 180, too",
                                     file.string(), rows.numbers[0], angles.back() / pi * 180.0));
    if (*std::max_element(values.begin(), values.end()) == 0.0)
        throw InputError(fmt::format("{}: every value is 0; a phase function scatters somewhere", file.string()));
    return {make_phase_nodes(angles, values), {}};
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

// A series that ends too soon swings about what it is to be, below 0 as well.
PhaseTable from_moments(const std::filesystem::path& file, const Rows& rows) {
    const std::vector<double>& moments = rows.numbers;
    if (std::abs(moments[0] - 1.0) > 1e-3)
        fail(file, rows.lines[0], fmt::format("the first moment is {:g}; it is the mean of 1, and so 1", moments[0]));
    for (std::size_t i = 0; i < moments.size(); ++i)
        if (std::abs(moments[i]) > 1.001)
            fail(file, rows.lines[i],
                 fmt::format("moment {:g}; means of Legendre's polynomials are from -1 to 1 (without "
                             "the factor 2 l + 1)",
                             moments[i]));
    std::vector<double> angles, values;
    double below = 0.0, above = 0.0;
    for (int i = 0; i <= moment_angles; ++i) {
        angles.push_back(pi * i / moment_angles);
        const double value = series(moments, std::cos(angles.back()));
        (value < 0.0 ? below : above) += std::abs(value) * std::sin(angles.back());
        values.push_back(std::max(value, 0.0));
    }
    if (below > 0.05 * above)
        throw InputError(
            fmt::format("{}: the series of its {} moments is negative over {:.0f} percent of what it is in "
                        "all; give more moments, or angles and values",
                        file.string(), moments.size(), 100.0 * below / above));
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
    const Rows rows = read_rows(file);
    PhaseTable table = rows.width == 2 ? from_angles(file, rows) : from_moments(file, rows);
    if (!(table.nodes.back().share > 0.0f)) // all of it between angles that are one in single precision
        throw InputError(fmt::format("{}: scatters nowhere; give values above 0 at more angles", file.string()));
    return table;
}

} // namespace vkvol
