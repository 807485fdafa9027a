// What the tests of `vkvol view` ask its page for.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace vkvol {

struct Address {
    std::string root, key;
    int port = 0;
};

// As the command prints it.
Address parts(const std::string& address);

// The state, and behind it the pixels.
std::pair<nlohmann::json, std::string> frame_of(const std::string& body);

} // namespace vkvol
