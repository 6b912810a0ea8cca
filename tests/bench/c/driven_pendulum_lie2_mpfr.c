/* The competitor: H = p^2/2 - g(t) cos q with g = 1 + cos(2t)/2, lie2, with the closed form of ΔJ, Λ,
   MSE and max |ΔJ|, in C with MPFR.
   Usage: driven_pendulum_lie2_mpfr STEPS BITS H Q P; prints seconds of the loop and the results.

   With D = ∂_t + X: q' = q + h p - (h²/2) g sin q and p' = p - h g sin q - (h²/2)(g' sin q + g p cos q).
   With G = (h²/2) g cos q, w = (h/2) g sin q and v = (h²/2) g' sin q, s = p - w: q' = q + h s and
   p' = s - w - v - p G; ΔJ = G² - h² p w + h³ g' cos q/2. Next to sin and cos of q and of 2t that is 13
   multiplications and squarings, and 2 more for the observables. t is k h, rounded once. */
#include "mpfr_loop.h"

int main(int argc, char **argv) {
    if (argc != 6 || atol(argv[1]) < 1) return 2;
    const long steps = atol(argv[1]);
    begin(argv[2]);
    mpfr_t h, q, p, h2, half, angle, g, dg, sn, cs, big, w, v, s, t, dj;
    read_number(h, argv[3]);
    read_number(q, argv[4]);
    read_number(p, argv[5]);
    mpfr_inits(h2, half, angle, g, dg, sn, cs, big, w, v, s, t, dj, NULL);

    mpfr_sqr(h2, h, NEAR);
    mpfr_div_2ui(half, h2, 1, NEAR);

    const double begun = now();
    for (long k = 0; k < steps; k++) {
        mpfr_mul_ui(angle, h, 2 * (unsigned long)k, NEAR);
        mpfr_sin_cos(dg, g, angle, NEAR);
        mpfr_div_2ui(g, g, 1, NEAR);
        mpfr_add_ui(g, g, 1, NEAR);
        mpfr_neg(dg, dg, NEAR);
        mpfr_sin_cos(sn, cs, q, NEAR);
        mpfr_mul(w, g, sn, NEAR);
        mpfr_mul(w, w, h, NEAR);
        mpfr_div_2ui(w, w, 1, NEAR);
        mpfr_mul(big, g, cs, NEAR);
        mpfr_mul(big, big, half, NEAR);
        mpfr_mul(dg, dg, half, NEAR);
        mpfr_mul(v, dg, sn, NEAR);
        mpfr_sqr(dj, big, NEAR);
        mpfr_mul(t, p, w, NEAR);
        mpfr_mul(t, t, h2, NEAR);
        mpfr_sub(dj, dj, t, NEAR);
        mpfr_mul(t, dg, cs, NEAR);
        mpfr_mul(t, t, h, NEAR);
        mpfr_add(dj, dj, t, NEAR);
        observe(dj);
        mpfr_sub(s, p, w, NEAR);
        mpfr_mul(t, p, big, NEAR);
        mpfr_sub(p, s, w, NEAR);
        mpfr_sub(p, p, v, NEAR);
        mpfr_sub(p, p, t, NEAR);
        mpfr_mul(s, s, h, NEAR);
        mpfr_add(q, q, s, NEAR);
    }
    return finish(now() - begun, steps, q, p);
}
