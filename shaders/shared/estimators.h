// What estimators have in common, a row each: host and kernels ask for traits, never for the order of ids.
#ifndef SHARED_ESTIMATORS_H
#define SHARED_ESTIMATORS_H
#include "shared/constants.h"

#define TRAIT_NULL 1             // collisions of the majorant, some of them null
#define TRAIT_CELLS 2            // goes from majorant cell to majorant cell
#define TRAIT_VOXELS 4           // goes from voxel to voxel
#define TRAIT_MARCH 8            // takes the density to be constant along steps
#define TRAIT_SETS 16            // of several sets of samples in such steps
#define TRAIT_CONTROL 32         // knows a control density
#define TRAIT_BOUND 64           // is biased where the density is above its majorant
#define TRAIT_GREY 128           // all channels have one extinction
#define TRAIT_CLOSED 256         // a closed form, of constant densities alone
#define TRAIT_EQUAL_STEPS 512    // a flight's march in steps of one length
#define TRAIT_OPTICAL_STEPS 1024 // in steps of one optical depth
#define TRAIT_INEXACT 2048       // takes the density of one point for that of a whole step
#define TRAIT_JITTERED 4096      // that point is a random one, where the scene says so

#define FREE_FLIGHT_TRAITS(id)                                                                                         \
    ((id) == FREE_FLIGHT_REGULAR         ? TRAIT_VOXELS                                                                \
     : (id) == FREE_FLIGHT_MARCH         ? TRAIT_MARCH | TRAIT_INEXACT | TRAIT_JITTERED | TRAIT_EQUAL_STEPS            \
     : (id) == FREE_FLIGHT_ADAPTIVE      ? TRAIT_MARCH | TRAIT_INEXACT | TRAIT_JITTERED | TRAIT_OPTICAL_STEPS |        \
                                               TRAIT_CELLS                                                             \
     : (id) == FREE_FLIGHT_DELTA         ? TRAIT_NULL | TRAIT_CELLS | TRAIT_BOUND | TRAIT_GREY                         \
     : (id) == FREE_FLIGHT_WEIGHTED      ? TRAIT_NULL | TRAIT_CELLS | TRAIT_GREY                                       \
     : (id) == FREE_FLIGHT_DECOMPOSITION ? TRAIT_NULL | TRAIT_CELLS | TRAIT_BOUND | TRAIT_GREY | TRAIT_CONTROL         \
     : (id) == FREE_FLIGHT_SPECTRAL      ? TRAIT_NULL | TRAIT_CELLS                                                    \
                                         : TRAIT_CLOSED) // analytic

#define TRANSMITTANCE_TRAITS(id)                                                                                       \
    ((id) == TRANSMITTANCE_REGULAR       ? TRAIT_VOXELS                                                                \
     : (id) == TRANSMITTANCE_DELTA       ? TRAIT_NULL | TRAIT_CELLS | TRAIT_BOUND                                      \
     : (id) == TRANSMITTANCE_RATIO       ? TRAIT_NULL | TRAIT_CELLS                                                    \
     : (id) == TRANSMITTANCE_RESIDUAL    ? TRAIT_NULL | TRAIT_CELLS | TRAIT_CONTROL                                    \
     : (id) == TRANSMITTANCE_MARCH       ? TRAIT_MARCH | TRAIT_INEXACT | TRAIT_JITTERED                                \
     : (id) == TRANSMITTANCE_TELESCOPING ? TRAIT_MARCH | TRAIT_SETS                                                    \
     : (id) == TRANSMITTANCE_JACKKNIFE   ? TRAIT_MARCH | TRAIT_INEXACT | TRAIT_SETS                                    \
                                         : TRAIT_CLOSED) // analytic

#endif
