// What estimators have in common, a row each: host and kernels ask for traits, never for the order of ids.
#ifndef SHARED_ESTIMATORS_H
#define SHARED_ESTIMATORS_H
#include "shared/constants.h"

#define TRAIT_NULL 1     // collisions of the majorant, some of them null
#define TRAIT_CELLS 2    // goes from majorant cell to majorant cell
#define TRAIT_VOXELS 4   // goes from voxel to voxel
#define TRAIT_MARCH 8    // takes the density to be constant along steps
#define TRAIT_SETS 16    // of several sets of samples in such steps
#define TRAIT_CONTROL 32 // knows a control density
#define TRAIT_BOUND 64   // is biased where the density is above its majorant
#define TRAIT_GREY 128   // all channels have one extinction

#define FREE_FLIGHT_TRAITS(id)                                                                                         \
    ((id) == FREE_FLIGHT_REGULAR         ? TRAIT_VOXELS                                                                \
     : (id) == FREE_FLIGHT_MARCH         ? TRAIT_MARCH                                                                 \
     : (id) == FREE_FLIGHT_ADAPTIVE      ? TRAIT_MARCH | TRAIT_CELLS                                                   \
     : (id) == FREE_FLIGHT_DELTA         ? TRAIT_NULL | TRAIT_CELLS | TRAIT_BOUND | TRAIT_GREY                         \
     : (id) == FREE_FLIGHT_WEIGHTED      ? TRAIT_NULL | TRAIT_CELLS | TRAIT_GREY                                       \
     : (id) == FREE_FLIGHT_DECOMPOSITION ? TRAIT_NULL | TRAIT_CELLS | TRAIT_BOUND | TRAIT_GREY | TRAIT_CONTROL         \
     : (id) == FREE_FLIGHT_SPECTRAL      ? TRAIT_NULL | TRAIT_CELLS                                                    \
                                         : 0) // analytic

#define TRANSMITTANCE_TRAITS(id)                                                                                       \
    ((id) == TRANSMITTANCE_REGULAR       ? TRAIT_VOXELS                                                                \
     : (id) == TRANSMITTANCE_DELTA       ? TRAIT_NULL | TRAIT_CELLS | TRAIT_BOUND                                      \
     : (id) == TRANSMITTANCE_RATIO       ? TRAIT_NULL | TRAIT_CELLS                                                    \
     : (id) == TRANSMITTANCE_RESIDUAL    ? TRAIT_NULL | TRAIT_CELLS | TRAIT_CONTROL                                    \
     : (id) == TRANSMITTANCE_MARCH       ? TRAIT_MARCH                                                                 \
     : (id) == TRANSMITTANCE_TELESCOPING ? TRAIT_MARCH | TRAIT_SETS                                                    \
     : (id) == TRANSMITTANCE_JACKKNIFE   ? TRAIT_MARCH | TRAIT_SETS                                                    \
                                         : 0) // analytic

#endif
