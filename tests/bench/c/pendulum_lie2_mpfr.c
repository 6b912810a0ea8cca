/* The competitor: pendulum, lie2, with the closed form of ΔJ, Λ, MSE and max |ΔJ|, in C with MPFR.
   Usage: pendulum_lie2_mpfr STEPS BITS H Q P; prints seconds of the loop and the results.

   With w = (h/2) sin q, G = (h²/2) cos q and s = p − w: q' = q + h s, p' = s − w − p G, and
   ΔJ = h³ (h cos²q/4 − p sin q/2) = G² − h² p w. Next to sin and cos in one call that is 7
   multiplications and squarings, and 2 more for the observables. */
#include "mpfr_loop.h"

int main(int argc, char **argv) {
    if (argc != 6 || atol(argv[1]) < 1) return 2;
    const long steps = atol(argv[1]);
    begin(argv[2]);
    mpfr_t h, q, p, h_half, h2, h2_half, g, w, s, t, dj;
    read_number(h, argv[3]);
    read_number(q, argv[4]);
    read_number(p, argv[5]);
    mpfr_inits(h_half, h2, h2_half, g, w, s, t, dj, NULL);

    mpfr_div_2ui(h_half, h, 1, NEAR);
    mpfr_sqr(h2, h, NEAR);
    mpfr_div_2ui(h2_half, h2, 1, NEAR);

    const double begun = now();
    for (long k = 0; k < steps; k++) {
        mpfr_sin_cos(w, g, q, NEAR);
        mpfr_mul(w, w, h_half, NEAR);
        mpfr_mul(g, g, h2_half, NEAR);
        mpfr_mul(t, p, w, NEAR);
        mpfr_mul(t, t, h2, NEAR);
        mpfr_sqr(dj, g, NEAR);
        mpfr_sub(dj, dj, t, NEAR);
        observe(dj);
        mpfr_sub(s, p, w, NEAR);
        mpfr_mul(t, p, g, NEAR);
        mpfr_sub(p, s, w, NEAR);
        mpfr_sub(p, p, t, NEAR);
        mpfr_mul(s, s, h, NEAR);
        mpfr_add(q, q, s, NEAR);
    }
    return finish(now() - begun, steps, q, p);
}
