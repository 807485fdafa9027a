// The picture that a bench measures against: given, found in the user's cache directory, or rendered.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "bench_estimators.h"
#include "film.h"

namespace vkvol {

class Workshop;

struct Reference {
    Film film;
    std::string file; // empty: kept nowhere
    std::string integrator;
    std::uint32_t samples = 0; // least of any pixel; 0 unknown
    double seconds = 0.0;      // 0 unknown
    bool cached = false;
    bool interrupted = false;
    std::optional<double> relmse; // its own, expected by its variance
    double offset_error = 0.0;    // see reference_offset_error
};

struct ReferenceWish {
    double seconds = 0.0; // of rendering
    std::uint32_t seed = 0;
};

// Reads the image given by --reference. Throws InputError if it shows anything else than the estimators do.
Reference read_reference(const std::filesystem::path& file, const std::vector<Estimator>& measured);

// From the cache, if a file there holds the same picture by one of the candidates, rendered for as long as wished for.
// A damaged file is as good as none.
std::optional<Reference> find_reference(const BenchRequest& request, const std::vector<Estimator>& measured,
                                        const ReferenceWish& wish);

// Rendered by the candidate with the least expected error per second, and kept in the cache.
Reference make_reference(const BenchRequest& request, const std::vector<Estimator>& measured, Workshop& workshop,
                         const ReferenceWish& wish);

} // namespace vkvol
