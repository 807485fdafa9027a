// Text from files, made fit for messages.
#pragma once

#include <string>

namespace vkvol {

// One line of sane length, whatever the file holds: white space becomes a space, other control characters \\xNN.
std::string one_line(std::string message);

} // namespace vkvol
