// A picture on a terminal: as coloured half blocks, which any does that has 24 bits of colour, or in pixels where it
// knows the graphics of kitty or sixels.
#pragma once

#include <cstdio>
#include <optional>
#include <string>

#include "live_picture.h"

namespace vkvol {

enum class TerminalGraphics { blocks, sixel, kitty };

// What the terminal of this process's environment knows.
TerminalGraphics terminal_graphics();

struct TerminalSize {
    int columns = 80, rows = 24;
    int width = 0, height = 0; // pixels; 0: not known
};

// How many cells a picture fills so that it fits with room for two lines of text: columns, rows.
struct CellSize {
    int columns = 0, rows = 0;
};
CellSize fitting_cells(int width, int height, const TerminalSize& terminal);

// The bytes that draw it, from the cursor on; after them the cursor is in the line below. `rgb`: three bytes a pixel,
// `width` x `height`, rows top to bottom.
std::string drawn(TerminalGraphics graphics, const std::vector<std::uint8_t>& rgb, int width, int height,
                  const TerminalSize& terminal);

class TerminalPicture : public LivePicture {
public:
    // Throws InputError if `out` is no terminal. Without `graphics`: as the environment says.
    TerminalPicture(std::optional<TerminalGraphics> graphics, std::FILE* out = stderr);

    // Over the one before, if nothing else was printed since.
    void show(const Film& film, const ToneMapping& mapping) override;

private:
    TerminalGraphics graphics_;
    std::FILE* out_;
    int rows_ = 0; // of the one before
};

} // namespace vkvol
