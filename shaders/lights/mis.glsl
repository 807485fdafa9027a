// Light that looks find and flights meet, too: they share it by weights that add up to 1 for every direction. Multiple importance
// sampling (Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering", 1995).
#ifndef MIS_GLSL
#define MIS_GLSL
#include "lib/specialization.glsl"

// Weight of a direction that was drawn with density `own`, and that the other technique draws with `other`. By quotients, since the
// densities of small lights overflow when squared.
float mis_weight(float own, float other) {
    float r = other / own;
    return own > 0.0 ? 1.0 / (1.0 + (MIS == MIS_POWER ? r * r : r)) : 0.0;
}
float weight_of_look(float pdf, float phase_pdf) {
    return MIS == MIS_LIGHT || SCATTERING == SCATTERING_SINGLE ? 1.0 : MIS == MIS_PHASE ? 0.0 : mis_weight(pdf, phase_pdf);
}
float weight_of_flight(float phase_pdf, float pdf) {
    return MIS == MIS_PHASE || NEE == NEE_NONE ? 1.0 : MIS == MIS_LIGHT ? 0.0 : mis_weight(phase_pdf, pdf);
}

#endif
