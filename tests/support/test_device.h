// The device that all tests share.
#pragma once

#include "device.h"

namespace vkvol {

// Opened at first use, with the validation layer and robust buffer access. The environment variable VKVOL_TEST_DEVICE
// chooses it, in the words of --device.
Device& test_device();

// What the validation layer has said so far; empty if no test has opened the device.
std::vector<std::string> test_device_messages();

// Before main returns: later a driver's own static objects may be gone.
void close_test_device();

} // namespace vkvol
