// The files a bench leaves: JSON, CSV, and each estimator's last picture.
#pragma once

#include "bench.h"

namespace vkvol {

// Where the pictures go, NAME.bench, and one of them.
std::filesystem::path picture_folder(const BenchRequest& request);
std::filesystem::path bench_picture(const BenchRequest& request, const std::string& integrator);

// Writes NAME.bench.json, NAME.bench.csv and NAME.bench/INTEGRATOR.exr; the keys are documented in the README. A
// picture that cannot be written is missing in the JSON, with a warning; for the other two RenderError is thrown.
void write_bench(const BenchRequest& request, const Device& device, const BenchResult& result);

} // namespace vkvol
