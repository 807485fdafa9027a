#include "test_device.h"

#include <cstdlib>
#include <memory>

namespace vkvol {

namespace {
std::unique_ptr<Device> device;
}

Device& test_device() {
    if (!device) {
        const char* choice = std::getenv("VKVOL_TEST_DEVICE");
        device = std::make_unique<Device>(DeviceOptions{choice ? choice : "auto", true, true});
    }
    return *device;
}

std::vector<std::string> test_device_messages() {
    return device ? device->validation_messages() : std::vector<std::string>{};
}

void close_test_device() {
    device.reset();
}

} // namespace vkvol
