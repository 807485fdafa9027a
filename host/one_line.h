// Text from files, made fit for messages.
#pragma once

#include <string>

namespace vkvol {

// One line of sane length, whatever the file holds.
std::string one_line(std::string message);

} // namespace vkvol
