// Decomposition tracking (Kutz et al. 2017): the medium is a control part, whose collisions need no lookup, and the
// rest. One number decides both: u sigma_maj below the control's extinction is a collision with the control part (then
// sigma_t was not looked up, see next_collision), and u sigma_maj < sigma_t one with the rest. Hence the very paths of
// delta tracking, with fewer lookups.
uint decomposition_flight(Collision c) {
    return c.u * c.sigma_maj < c.sigma_t ? EVENT_COLLIDED : EVENT_TOUCHED;
}

// What of the throughput meets matter there, in the mean sigma_t / sigma_maj: all of it in the control part, whose
// sigma_t is not known, and a share of it in the rest.
float decomposition_share(Collision c) {
    return c.u * c.sigma_maj < c.sigma_c ? 1.0 : (c.sigma_t - c.sigma_c) / (c.sigma_maj - c.sigma_c);
}
