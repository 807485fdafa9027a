// Homogeneous: known at once. `distance` within the medium.
Spectrum analytic_transmittance(VolumeParams v, float distance) {
    return exp(-v.sigma_t * distance * to_spectrum(v.sigma_ratio));
}
