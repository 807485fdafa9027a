// Delta tracking (Woodcock et al. 1965): a tentative collision is real with probability sigma_t / sigma_maj.
// Unbiased as long as sigma_maj bounds sigma_t; where it does not, the excess is lost: biased, and counted.
uint delta_flight(Collision c) {
    return c.u * c.sigma_maj < c.sigma_t ? EVENT_COLLIDED : EVENT_TOUCHED;
}
