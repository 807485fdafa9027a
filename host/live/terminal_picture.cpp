#include "terminal_picture.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fmt/format.h>
#include <iterator>
#include <string_view>
#include <sys/ioctl.h>
#include <unistd.h>

#include "error.h"
#include "messages.h"

namespace vkvol {

namespace {

using Bytes = std::vector<std::uint8_t>;

std::string environment(const char* name) {
    const char* const value = std::getenv(name);
    return value ? value : "";
}

TerminalSize size_of(std::FILE* out) {
    winsize size{};
    TerminalSize found;
    if (ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0)
        found = {size.ws_col, size.ws_row, size.ws_xpixel, size.ws_ypixel};
    return found;
}

// Each pixel the mean of those that it covers; larger than it was it becomes squares.
Bytes resized(const Bytes& rgb, int width, int height, int to_width, int to_height) {
    Bytes result;
    result.reserve(std::size_t(to_width) * to_height * 3);
    for (int y = 0; y < to_height; ++y)
        for (int x = 0; x < to_width; ++x) {
            const auto range = [](int i, int from, int to) {
                const int begin = static_cast<int>(std::int64_t{i} * from / to);
                return std::pair(begin, std::max(static_cast<int>(std::int64_t{i + 1} * from / to), begin + 1));
            };
            const auto [x0, x1] = range(x, width, to_width);
            const auto [y0, y1] = range(y, height, to_height);
            std::array<std::uint64_t, 3> sum{};
            for (int v = y0; v < y1; ++v)
                for (int u = x0; u < x1; ++u)
                    for (int c = 0; c < 3; ++c)
                        sum[c] += rgb[3 * (std::size_t(v) * width + u) + c];
            const auto count = static_cast<std::uint64_t>(x1 - x0) * static_cast<std::uint64_t>(y1 - y0);
            for (const std::uint64_t s : sum)
                result.push_back(static_cast<std::uint8_t>((s + count / 2) / count));
        }
    return result;
}

// An upper half block a cell: its own colour above, the background's below.
std::string as_blocks(const Bytes& rgb, const CellSize& cells) {
    std::string text;
    for (int row = 0; row < cells.rows; ++row) {
        text += "\033[K"; // not after the row: a cursor that waits in the last column would take that with it
        for (int column = 0; column < cells.columns; ++column) {
            const std::uint8_t* const above = &rgb[3 * (std::size_t(2 * row) * cells.columns + column)];
            const std::uint8_t* const below = above + 3 * std::size_t(cells.columns);
            fmt::format_to(std::back_inserter(text), "\033[38;2;{};{};{};48;2;{};{};{}m\u2580", above[0], above[1],
                           above[2], below[0], below[1], below[2]);
        }
        text += "\033[0m\n";
    }
    return text;
}

std::string base64(const Bytes& bytes) {
    constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto byte = [&](std::size_t k) { return i + k < bytes.size() ? std::uint32_t{bytes[i + k]} : 0u; };
        const std::uint32_t word = byte(0) << 16u | byte(1) << 8u | byte(2);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63u];
    }
    return text;
}

// Pixels as they are, which the terminal makes fit: number 1 always, so that each takes the place of the one before.
std::string as_kitty(const Bytes& rgb, int width, int height, const CellSize& cells) {
    constexpr std::size_t chunk = 4096; // the protocol's largest
    const std::string data = base64(rgb);
    std::string text;
    for (std::size_t at = 0; at < data.size(); at += chunk) {
        const int more = at + chunk < data.size() ? 1 : 0;
        const std::string keys = at == 0 ? fmt::format("a=T,f=24,i=1,p=1,q=2,C=1,s={},v={},c={},r={},m={}", width,
                                                       height, cells.columns, cells.rows, more)
                                         : fmt::format("q=2,m={}", more);
        text += fmt::format("\033_G{};{}\033\\", keys, data.substr(at, chunk));
    }
    return text;
}

// Six levels a channel, ordered dither (Bayer's matrix of 4 x 4) between them: 216 colours, as many as terminals have
// at least. Bands of six rows, of each colour in a band which of the six.
std::string as_sixels(const Bytes& rgb, int width, int height) {
    constexpr int levels = 6, colors = levels * levels * levels;
    constexpr int bayer[16] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
    std::string text = fmt::format("\033P0;1q\"1;1;{};{}", width, height);
    for (int i = 0; i < colors; ++i)
        text += fmt::format("#{};2;{};{};{}", i, i / 36 * 20, i / 6 % 6 * 20, i % 6 * 20);
    const auto color_at = [&](int x, int y) {
        const int threshold = bayer[4 * (y % 4) + x % 4];
        int index = 0;
        for (int c = 0; c < 3; ++c) // 255 = 5 steps of 51
            index = index * levels + (rgb[3 * (std::size_t(y) * width + x) + c] * 16 + threshold * 51) / (16 * 51);
        return index;
    };
    std::vector<int> band(std::size_t(width) * 6);
    for (int top = 0; top < height; top += 6) {
        const int rows = std::min(6, height - top);
        std::array<bool, colors> used{};
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < width; ++x)
                used[band[std::size_t(y) * width + x] = color_at(x, top + y)] = true;
        for (int color = 0; color < colors; ++color) {
            if (!used[color])
                continue;
            text += fmt::format("#{}", color);
            for (int x = 0, run = 0; x < width; x += run) {
                const auto sixel = [&](int at) {
                    int bits = 0;
                    for (int y = 0; y < rows; ++y)
                        bits |= int{band[std::size_t(y) * width + at] == color} << y;
                    return static_cast<char>('?' + bits);
                };
                const char here = sixel(x);
                for (run = 1; x + run < width && sixel(x + run) == here;)
                    ++run;
                text += run > 3 ? fmt::format("!{}{}", run, here) : std::string(std::size_t(run), here);
            }
            text += '$';
        }
        text += '-';
    }
    return text + "\033\\";
}

} // namespace

TerminalGraphics terminal_graphics() {
    const std::string term = environment("TERM"), program = environment("TERM_PROGRAM");
    const auto names = [](const std::string& text, const char* name) { return text.find(name) != std::string::npos; };
    // Multiplexers hand on the environment that they were started in, and no graphics.
    if (!environment("TMUX").empty() || !environment("STY").empty() || term.starts_with("tmux") ||
        term.starts_with("screen"))
        return TerminalGraphics::blocks;
    if (!environment("KITTY_WINDOW_ID").empty() || names(term, "kitty") || names(term, "ghostty") ||
        program == "WezTerm")
        return TerminalGraphics::kitty;
    if (names(term, "sixel") || names(term, "foot") || names(term, "mlterm"))
        return TerminalGraphics::sixel;
    return TerminalGraphics::blocks;
}

CellSize fitting_cells(int width, int height, const TerminalSize& terminal) {
    // A cell is twice as high as wide, where nobody knows better.
    const double cell = terminal.width > 0 && terminal.height > 0
                            ? double(terminal.height) / terminal.rows / (double(terminal.width) / terminal.columns)
                            : 2.0;
    const double columns = std::max(terminal.columns, 1), rows = std::max(terminal.rows - 2, 1);
    const double by_rows = rows * cell * width / height;
    const double across = std::min(columns, by_rows);
    return {std::max(static_cast<int>(across), 1),
            std::clamp(static_cast<int>(across * height / width / cell + 0.5), 1, static_cast<int>(rows))};
}

std::string drawn(TerminalGraphics graphics, const Bytes& rgb, int width, int height, const TerminalSize& terminal) {
    const CellSize cells = fitting_cells(width, height, terminal);
    if (graphics == TerminalGraphics::blocks)
        return as_blocks(resized(rgb, width, height, cells.columns, 2 * cells.rows), cells);
    // No more pixels than the cells have; where their size is not known, of 10 by 20.
    const bool is_known = terminal.width > 0 && terminal.height > 0;
    const int across =
        std::min(width, cells.columns * (is_known ? std::max(terminal.width / terminal.columns, 1) : 10));
    const int most = cells.rows * (is_known ? std::max(terminal.height / terminal.rows, 1) : 20);
    const int down = std::clamp(static_cast<int>(std::int64_t{across} * height / width), 1, most);
    const Bytes smaller = resized(rgb, width, height, across, down);
    const std::string pixels =
        graphics == TerminalGraphics::kitty ? as_kitty(smaller, across, down, cells) : as_sixels(smaller, across, down);
    // Where the cursor is afterwards is for each terminal to say, unless it is put back.
    return fmt::format("\0337{}\0338\033[{}B\r", pixels, cells.rows);
}

TerminalPicture::TerminalPicture(std::optional<TerminalGraphics> graphics, std::FILE* out)
    : graphics_(graphics.value_or(terminal_graphics())), out_(out) {
    if (!isatty(fileno(out)))
        throw InputError("--preview: standard error is no terminal that could show a picture; render without it");
}

void TerminalPicture::show(const Film& film, const ToneMapping& mapping) {
    const TerminalSize terminal = size_of(out_);
    const int rows = fitting_cells(film.width(), film.height(), terminal).rows;
    std::string text = rows_ == 0 ? std::string(std::size_t(rows), '\n') : ""; // the place for it
    text += fmt::format("\033[{}A\r", rows_ == 0 ? rows : rows_);
    text += drawn(graphics_, tone_map(film, mapping), film.width(), film.height(), terminal);
    rows_ = rows;
    put(out_, text);
    std::fflush(out_);
}

} // namespace vkvol
