// Debiased ray marching (Misso et al., "Unbiased and Consistent Rendering Using Biased Estimators", 2022). Marches with
// 2, 4, 8 ... times as many steps form a sequence T_0, T_1, ... that tends to T; T_0 + (T_{j+1} - T_j) / P(j) with a
// random j has the mean T. All samples of a march have one random offset, and the coarser marches use a random one of
// every two (or 2^(j+1)) of the finest one's samples, so that each by itself is such a march as well.
// P(j) = (1 - q) q^j with q = 2^-1.5: between 1/2, which the expected cost needs (2^j steps), and what the variance
// needs: 1/16 where the density is continuous, 1/4 with nearest lookup. May be negative, or above 1.
//
// At the highest levels two sums of 10^6 terms differ by less than they are rounded, and 1 / P(j) is 10^7: hence the
// difference is itself a sum, of the samples with alternating signs.
const float TELESCOPING_LOG_Q = -1.0397207708399179; // log(2^-1.5)

float telescoping_probability(uint level) {
    return (1.0 - exp(TELESCOPING_LOG_Q)) * exp(TELESCOPING_LOG_Q * float(level));
}

void begin_telescoping(vec4 u, float select, inout Walk w) {
    w.level = uint(log(1.0 - u.y) / TELESCOPING_LOG_Q); // at most 16, since u has 24 bits
    w.residue = uint(select * float(2u << w.level));
    w.offset = u.z;
    w.base = 0.0;
}

void refine_march(inout Walk w) {
    w.dt /= float(2u << w.level);
}

uint telescoping_transmittance(MediumParams v, inout Walk w, inout Tally tally) {
    if (march_is_over(w))
        return EVENT_LEFT;
    float sampled = w.dt * march_density(v, (float(w.index) + w.offset) * w.dt, vec3(0.5), 0.0, w, tally);
    uint every = 2u << w.level;
    w.depth += sampled;
    w.partial += ((w.index ^ w.residue) & 1u) == 0u ? -sampled : sampled;
    w.base += ((w.index ^ w.residue) & (every - 1u)) == 0u ? float(every) * sampled : 0.0;
    w.index += 1u;
    w.t = float(w.index) * w.dt;
    return EVENT_MOVING;
}

Spectrum end_telescoping(MediumParams v, Walk w) {
    Spectrum sigma_t = v.sigma_t * to_spectrum(v.sigma_ratio);
    Spectrum of_lesser = exp(-sigma_t * min(w.depth, w.depth - w.partial));
    Spectrum size = of_lesser * one_minus_exp(sigma_t * abs(w.partial));
    Spectrum difference = w.partial > 0.0 ? -size : size;
    return exp(-sigma_t * w.base) + difference / telescoping_probability(w.level);
}
