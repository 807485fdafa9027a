// The bench command: error against time of the integrators that suit a scene.
#pragma once

#include <string>
#include <vector>

#include "bench_estimators.h"
#include "bench_reference.h"
#include "bench_statistics.h"
#include "session.h"

namespace vkvol {

// What an estimator's renders came to.
struct Measurement {
    Estimator estimator;
    std::vector<BenchRun> runs;
    std::vector<RenderResult> results; // of the same runs, their films left out
    Film last;                         // of the last run
    // Seconds of a render before them: these found files in memory and kernels compiled.
    double load_seconds = 0.0, upload_seconds = 0.0, pipeline_seconds = 0.0;
};

struct BenchResult {
    std::vector<Measurement> measurements;
    Reference reference;
    double load_before = 0.0, load_after = 0.0; // of the machine, in processes that run
    bool interrupted = false;
};

// Distinct for every number below 2^32, whatever the bench's own seed.
std::uint32_t seed_of_run(std::uint32_t seed, std::uint32_t number);

// Returns the exit code; throws InputError, DeviceError or RenderError.
int run_bench(const BenchRequest& request);

} // namespace vkvol
