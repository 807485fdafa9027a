// Runs the tests; fails as well if the validation layer had anything to say about any of them.
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "support/test_device.h"

int main(int argc, char** argv) {
    const int failures = Catch::Session().run(argc, argv);
    const std::vector<std::string> messages = vkvol::test_device_messages();
    for (const std::string& message : messages)
        Catch::cerr() << "validation layer: " << message << '\n';
    vkvol::close_test_device();
    return failures != 0 ? failures : !messages.empty();
}
