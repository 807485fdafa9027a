// What a bench measures: integrators that estimate one and the same picture, and those that could tell it what that
// picture is.
#pragma once

#include <string>
#include <vector>

#include "bench_request.h"
#include "method.h"

namespace vkvol {

struct Estimator {
    std::string integrator; // name and explicit choices
    Scene scene;
    Method method;
    bool is_default = false;       // what `vkvol scene.xml` renders by, or would if that were unbiased
    std::string stands_for;        // the biased one that the scene names, of the default in its place
    std::vector<std::string> same; // other integrators that come to the same kernel in this scene
};

// Those asked for, or the unbiased presets that estimate what the default does, the default first. What comes to one
// and the same kernel is listed once. Throws InputError, also if those asked for estimate different pictures.
std::vector<Estimator> find_estimators(const BenchRequest& request);

// Hash of the exact picture that the estimator is after: of biased ones, the hash that an unbiased estimator of the
// same light has. Throws InputError if there is none.
std::string expected_hash(const Estimator& estimator);

// Unbiased estimators of the same picture that are none of `measured`: presets, or else what differs from the first of
// them in one choice of flight or transmittance. If there is none of that kind either, the first unbiased one measured.
std::vector<Estimator> reference_candidates(const std::vector<Estimator>& measured);

} // namespace vkvol
