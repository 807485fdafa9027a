// Tests in processes of their own.
#pragma once

#include <string>
#include <vector>

namespace vkvol {

// Runs each test that `arguments` name by this program, alone: some drivers keep whatever they compiled until their
// process ends, and SwiftShader comes to 20 GiB of that in one group. Returns how many failed.
int run_apart(const std::string& program, const std::vector<std::string>& arguments);

} // namespace vkvol
