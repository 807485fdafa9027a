// Runs the tests; fails as well if the validation layer had anything to say about any of them.
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#include <cstdlib>

#include "software_lanes.h"
#include "support/test_device.h"

// By eight lanes, for which drivers that write out what each lane does have half as much to compile; VKVOL_ALL_LANES=1:
// by as many as the program takes.
int main(int argc, char** argv) {
    if (std::getenv("VKVOL_ALL_LANES"))
        vkvol::take_all_lanes();
    const int failures = Catch::Session().run(argc, argv);
    const std::vector<std::string> messages = vkvol::test_device_messages();
    for (const std::string& message : messages)
        Catch::cerr() << "validation layer: " << message << '\n';
    vkvol::close_test_device();
    return failures != 0 ? failures : !messages.empty();
}
