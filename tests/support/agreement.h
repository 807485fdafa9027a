// Scenes in which many estimators can be compared, what the estimators are, and the comparison of all with all.
#pragma once

#include <string>
#include <vector>

#include "film.h"
#include "scene.h"

namespace vkvol {

struct NamedScene {
    std::string name;
    Scene scene; // its samples per pixel suit a table; a test may take fewer
};

// A homogeneous slab, spheres with g = +-0.8, a thin and a thick cloud, a spike, a chromatic cloud, fire, noise in a
// mesh, several media in one another, a cloud by a transfer function, and an atmosphere. Small pictures.
std::vector<NamedScene> agreement_scenes();

// Choices along all axes, named as on the command line.
struct Combination {
    std::string name;
    AxisChoices choices;
};

// All that this scene allows and that are unbiased in it, each once: a choice that would be replaced by another is left
// out.
std::vector<Combination> unbiased_combinations(const Scene& scene);

struct Estimate {
    std::string name;
    Film film;
};

// Every pair, per channel: image means by a t-test, pixels by a z-test; of three and more, see known_variances.
struct PairwiseAgreement {
    std::size_t pairs = 0, tests = 0;
    double mean_z = 0.0, pixel_z = 0.0; // the largest
    std::string mean_pair, pixel_pair;  // and whose they are
};
PairwiseAgreement compare_all(const std::vector<Estimate>& estimates);

// One row of a table: what was compared, by the means of pictures and by pixels, which may be of fewer estimates. The
// two are those of one comparison unless told otherwise.
struct AgreementRow {
    std::string what;
    PairwiseAgreement means, pixels;
};

// Prints `about` and the rows under `heading`, each with its largest z and the limits by which all together fail by
// chance with probability alpha, half of it for means, half for pixels; and checks them.
void check_rows(const std::string& about, const std::string& heading, const std::vector<AgreementRow>& rows,
                double alpha);

// Two-sided limit of |z| if `tests` tests together are to fail by chance with probability alpha (Sidak).
double z_limit(double alpha, double tests);

} // namespace vkvol
