// What other programs call things that scene files here have by another name.
#pragma once

#include <string>

namespace vkvol {

// How an element, or an attribute of one, which may have text, is said here; empty if nothing is known of it.
std::string said_here(const std::string& element);
std::string said_here(const std::string& element, const std::string& attribute, bool has_text);

} // namespace vkvol
