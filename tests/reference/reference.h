// The scalar reference: volumetric path tracing written from the equations, in double precision and plain loops, to
// check the renderer by. It is kept as simple as it can be; it shares with the renderer the scene structs, the film
// and the specification of the random numbers, and no code.
//
// Radiative transfer: sigma_t(x) = (sigma_a + sigma_s) density_scale density(x), albedo = sigma_s / (sigma_a +
// sigma_s),
//   (omega . grad) L = -sigma_t L + sigma_a Le + sigma_s int p(omega', omega) L(omega') d omega'
#pragma once

#include "camera.h"
#include "cells.h"
#include "closed_forms.h"
#include "free_flight.h"
#include "medium.h"
#include "path.h"
#include "phase.h"
#include "quadrature.h"
#include "reference_method.h"
#include "render.h"
#include "rng.h"
#include "transmittance.h"
