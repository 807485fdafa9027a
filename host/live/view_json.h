// What goes between the page of a viewer and this program, as JSON.
#pragma once

#include <cstdint>
#include <string>

#include "shown_layer.h"
#include "view_board.h"

namespace vkvol {

// Throws InputError for what is no wish, in one line. What is left out is as the scene has it; places of lights are
// those of the scene's.
ViewWish wish_of(const std::string& json);

// What the page shows beside the picture. `shot` may be null: nothing is rendered yet.
std::string state_json(const Shot* shot, const ShownLayer& shown, const ViewWish& wish, std::uint64_t wish_number,
                       const std::string& message);

} // namespace vkvol
