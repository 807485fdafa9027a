// Pictures on a terminal, read back from what is written to it.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <map>
#include <regex>

#include "terminal_picture.h"

using namespace vkvol;

namespace {

using Bytes = std::vector<std::uint8_t>;

// A ramp: red across, green down, blue neither.
Bytes ramp(int width, int height) {
    Bytes rgb;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            rgb.push_back(static_cast<std::uint8_t>(255 * x / (width - 1)));
            rgb.push_back(static_cast<std::uint8_t>(255 * y / (height - 1)));
            rgb.push_back(100);
        }
    return rgb;
}

Bytes from_base64(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    Bytes bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=')
            break;
        bits = bits << 6u | std::uint32_t(digits.find(c));
        count += 6;
        if (count >= 8)
            bytes.push_back(static_cast<std::uint8_t>(bits >> (count -= 8) & 255u));
    }
    return bytes;
}

// In percent, row by row; -1 where nothing is drawn.
std::vector<glm::dvec3> picture_of_sixels(const std::string& text, int width, int height) {
    const std::size_t begin = text.find("\033P"), end = text.find("\033\\", begin);
    REQUIRE(begin != std::string::npos);
    REQUIRE(end != std::string::npos);
    std::size_t at = text.find('q', begin) + 1;
    const auto number = [&] {
        int value = 0;
        while (at < end && std::isdigit(static_cast<unsigned char>(text[at])))
            value = 10 * value + (text[at++] - '0');
        return value;
    };
    std::map<int, glm::dvec3> palette;
    std::vector<glm::dvec3> picture(std::size_t(width) * height, glm::dvec3(-1.0));
    int color = 0, x = 0, top = 0;
    while (at < end) {
        const char c = text[at++];
        if (c == '"') {
            std::vector<int> raster = {number()};
            while (text[at] == ';') {
                ++at;
                raster.push_back(number());
            }
            CHECK(raster == std::vector<int>{1, 1, width, height});
        } else if (c == '#') {
            color = number();
            if (text[at] == ';') {
                glm::dvec3 rgb_percent;
                ++at;
                CHECK(number() == 2);
                for (int k = 0; k < 3; ++k) {
                    ++at;
                    rgb_percent[k] = number();
                }
                palette[color] = rgb_percent;
            }
        } else if (c == '$' || c == '-') {
            x = 0;
            top += c == '-' ? 6 : 0;
        } else {
            const int run = c == '!' ? number() : 1;
            const int bits = (c == '!' ? text[at++] : c) - '?';
            for (int k = 0; k < run; ++k, ++x)
                for (int y = 0; y < 6; ++y)
                    if (bits >> y & 1) {
                        REQUIRE(x < width);
                        REQUIRE(top + y < height);
                        picture[std::size_t(top + y) * width + x] = palette.at(color);
                    }
        }
    }
    return picture;
}

} // namespace

TEST_CASE("pictures fit a terminal and keep their shape", "[cpu][live]") {
    for (const auto& [width, height] : {std::pair(640, 360), {100, 1000}, {1000, 100}, {1, 1}, {40, 40}})
        for (const TerminalSize& terminal :
             {TerminalSize{80, 24, 0, 0}, {200, 50, 2000, 1200}, {10, 3, 0, 0}, {1, 1, 0, 0}}) {
            CAPTURE(width, height, terminal.columns, terminal.rows);
            const CellSize cells = fitting_cells(width, height, terminal);
            CHECK(cells.columns >= 1);
            CHECK(cells.columns <= terminal.columns);
            CHECK(cells.rows >= 1);
            CHECK(cells.rows <= std::max(terminal.rows - 2, 1));
            const double cell = terminal.width > 0 ? 1200.0 / 50 / (2000.0 / 200) : 2.0; // its height over its width
            // To the rounding of either edge.
            const double rows = cells.columns * double(height) / width / cell;
            CHECK(std::abs(rows - cells.rows) <= 0.5 + double(height) / width / cell + (rows < 1.0 ? 1.0 : 0.0));
        }
}

TEST_CASE("half blocks have the picture's colours", "[cpu][live]") {
    const int width = 64, height = 32;
    const std::string text = drawn(TerminalGraphics::blocks, ramp(width, height), width, height, {16, 20, 0, 0});
    const CellSize cells = fitting_cells(width, height, {16, 20, 0, 0});
    REQUIRE(cells.columns == 16);
    REQUIRE(cells.rows == 4);
    const std::regex block("\033\\[38;2;(\\d+);(\\d+);(\\d+);48;2;(\\d+);(\\d+);(\\d+)m\u2580");
    int index = 0;
    for (std::sregex_iterator found(text.begin(), text.end(), block), end; found != end; ++found, ++index)
        for (int half = 0; half < 2; ++half) {
            const int column = index % 16, row = 2 * (index / 16) + half;
            const auto number = [&](int c) { return std::stoi((*found)[std::size_t(1 + 3 * half + c)]); };
            CHECK(std::abs(number(0) - 255.0 * (4 * column + 1.5) / 63) <= 1.5); // the middle of 4 x 4 pixels
            CHECK(std::abs(number(1) - 255.0 * (4 * row + 1.5) / 31) <= 1.5);
            CHECK(number(2) == 100);
        }
    CHECK(index == 64);
    CHECK(std::count(text.begin(), text.end(), '\n') == 4);
    CHECK(text.find("m\u2580\033[0m\n") != std::string::npos); // nothing erases what is in the last column
}

TEST_CASE("kitty gets the pixels as they are", "[cpu][live]") {
    const int width = 60, height = 40;
    const Bytes rgb = ramp(width, height);
    const std::string text = drawn(TerminalGraphics::kitty, rgb, width, height, {80, 24, 0, 0});
    CHECK(text.find("s=60,v=40") != std::string::npos);
    const std::regex part("\033_G([^;]*);([^\033]*)\033\\\\");
    std::string data;
    int parts = 0;
    for (std::sregex_iterator found(text.begin(), text.end(), part), end; found != end; ++found, ++parts) {
        const std::string keys = (*found)[1], chunk = (*found)[2];
        CHECK(chunk.size() <= 4096);
        data += chunk;
        const bool is_last = data.size() == (rgb.size() + 2) / 3 * 4;
        CHECK(keys.ends_with(is_last ? "m=0" : "m=1"));
    }
    CHECK(parts == 3);
    CHECK(from_base64(data) == rgb);
}

TEST_CASE("sixels have the picture's colours on average", "[cpu][live]") {
    const int width = 64, height = 32;
    const Bytes rgb = ramp(width, height);
    const std::vector<glm::dvec3> picture =
        picture_of_sixels(drawn(TerminalGraphics::sixel, rgb, width, height, {80, 24, 0, 0}), width, height);
    // Over blocks of 4 x 4 pixels, as the dither is: of an even colour its 16 thresholds leave a sixteenth of a step of
    // 20 %, and no more comes of a ramp than its own range to either side of the block's middle, 1.5 pixels.
    for (int row = 0; row < height; row += 4)
        for (int column = 0; column < width; column += 4) {
            glm::dvec3 sum(0.0), wanted(0.0);
            for (int i = 0; i < 16; ++i) {
                const std::size_t pixel = std::size_t(row + i / 4) * width + column + i % 4;
                REQUIRE(picture[pixel].x >= 0.0);
                sum += picture[pixel] / 16.0;
                wanted += glm::dvec3(rgb[3 * pixel], rgb[3 * pixel + 1], rgb[3 * pixel + 2]) / 2.55 / 16.0;
            }
            CAPTURE(row, column, sum.x, wanted.x, sum.y, wanted.y, sum.z, wanted.z);
            CHECK(std::abs(sum.x - wanted.x) < 1.25 + 1.5 * 100 / 63);
            CHECK(std::abs(sum.y - wanted.y) < 1.25 + 1.5 * 100 / 31);
            CHECK(std::abs(sum.z - wanted.z) <= 1.25);
        }
}

TEST_CASE("sixels are no larger than their cells", "[cpu][live]") {
    const int width = 1920, height = 1080;
    const TerminalSize terminal{80, 24, 640, 384};
    const std::string text = drawn(TerminalGraphics::sixel, ramp(width, height), width, height, terminal);
    const CellSize cells = fitting_cells(width, height, terminal);
    std::smatch size;
    REQUIRE(std::regex_search(text, size, std::regex("\"1;1;(\\d+);(\\d+)")));
    CHECK(std::stoi(size[1]) <= cells.columns * 8);
    CHECK(std::stoi(size[2]) <= cells.rows * 16);
}

TEST_CASE("terminals are known by their environment", "[cpu][live]") {
    unsetenv("TMUX");
    unsetenv("STY");
    const auto with = [](const char* term, const char* window, const char* program) {
        setenv("TERM", term, 1);
        window ? setenv("KITTY_WINDOW_ID", window, 1) : unsetenv("KITTY_WINDOW_ID");
        program ? setenv("TERM_PROGRAM", program, 1) : unsetenv("TERM_PROGRAM");
        return terminal_graphics();
    };
    CHECK(with("xterm-256color", nullptr, nullptr) == TerminalGraphics::blocks);
    CHECK(with("xterm-kitty", nullptr, nullptr) == TerminalGraphics::kitty);
    CHECK(with("xterm-256color", "1", nullptr) == TerminalGraphics::kitty);
    CHECK(with("xterm-256color", nullptr, "WezTerm") == TerminalGraphics::kitty);
    CHECK(with("foot", nullptr, nullptr) == TerminalGraphics::sixel);
    // Of a multiplexer within kitty.
    CHECK(with("tmux-256color", "1", nullptr) == TerminalGraphics::blocks);
    setenv("TMUX", "/tmp/tmux-0/default,1,0", 1);
    CHECK(with("xterm-kitty", "1", nullptr) == TerminalGraphics::blocks);
    unsetenv("TMUX");
}
