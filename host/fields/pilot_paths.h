// A few paths followed on the host before a render, to learn where its time will go.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "majorant_grid.h"

namespace vkvol {

// What the pilot knows of a scene; index space, where voxel centres are integers.
struct PilotScene {
    glm::dvec3 eye{0.0};
    std::optional<glm::dvec3> light; // direction towards it, if every collision sends a shadow ray
    double sigma_t = 0.0;            // extinction at density 1 per voxel
    double albedo = 0.0;
    double g = 0.0;
    bool leaps = true; // its walks can pass empty cells together
    ValueMap map = {}; // of the grid's values to densities
};

// A flight or a shadow ray.
struct PilotSegment {
    glm::dvec3 origin, direction; // unit
    double length;                // voxels, within the grid's box
    bool collides = false;        // at its end; else it leaves the box
};

// Paths by delta tracking over `cells`, from the eye towards random points of the grid's box. The same ones every time.
std::vector<PilotSegment> pilot_paths(const DensityField& field, const MajorantGrid& cells, const PilotScene& scene);

// Steps that null-collision tracking is expected to take along one: the majorant's optical depth, which is the number
// of look-ups, plus the cells it crosses, empty ones together if the walk leaps. A look-up and a cell take about the
// same time.
std::vector<double> pilot_steps(const std::vector<PilotSegment>& segments, const MajorantGrid& cells, double sigma_t);

// With how many steps in a turn segments of these steps take the least time, 2 to 4: what else there is to a turn costs
// as much as two steps, and a lane whose segment ends waits for the turn's end.
std::uint32_t best_steps_per_turn(const std::vector<double>& segment_steps);

} // namespace vkvol
