// A medium as boxes that are bounded each by itself: what cells over several media are filled from.
#pragma once

#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "loaded_medium.h"

namespace vkvol {

// Boxes of one size, in the medium's space. Where there is none, there is no matter.
struct Pieces {
    struct Piece {
        glm::dvec3 middle;
        double bound; // of the density there, scaled as the scene asks
    };
    glm::dvec3 half{0.0};
    std::vector<Piece> parts;
};

// Whether it has any.
bool has_matter(const Volume& volume, const LoadedMedium& loaded);

// World units: as large as the cells that the medium has by itself, or would have.
double usual_cell(const Volume& volume, const LoadedMedium& loaded);

// Those of each grid or shape, however many media have it, are made once.
class PieceStore {
public:
    explicit PieceStore(double majorant_scale) : scale_(majorant_scale) {}

    double scale() const { return scale_; }

    // As fine as there are, or as suits who wants to know about places of this size [world units] and no smaller ones.
    // Until the next call of it.
    const Pieces& of(const Volume& volume, const LoadedMedium& loaded, double finest);

private:
    const Pieces& of_grid(const LoadedMedium& loaded, int level);
    const Pieces& of_mesh(const InsideLattice& inside, double bound, int level);
    const Pieces& of_shape(bool is_ball, double bound, int level);

    double scale_;
    // By level: from one to the next their edges are twice as long.
    std::map<const MajorantGrid*, std::vector<std::pair<std::shared_ptr<const MajorantGrid>, Pieces>>> grids_;
    std::map<std::tuple<const InsideLattice*, double, int>, Pieces> meshes_;
    std::map<std::tuple<bool, double, int>, Pieces> shapes_;
};

} // namespace vkvol
