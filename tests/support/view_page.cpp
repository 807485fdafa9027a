#include "support/view_page.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>

namespace vkvol {

Address parts(const std::string& address) {
    Address result;
    result.root = address.substr(0, address.find("/?"));
    result.key = address.substr(address.find("key=") + 4);
    while (!result.key.empty() && result.key.back() == '\n')
        result.key.pop_back();
    result.port = std::stoi(result.root.substr(result.root.rfind(':') + 1));
    return result;
}

std::pair<nlohmann::json, std::string> frame_of(const std::string& body) {
    REQUIRE(body.size() > 4);
    std::uint32_t length = 0;
    std::memcpy(&length, body.data(), 4);
    return {nlohmann::json::parse(body.substr(4, length)), body.substr(4 + length)};
}

} // namespace vkvol
