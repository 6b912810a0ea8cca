/* The competitor: Duffing, lie2, with the closed form of ΔJ, Λ, MSE and max |ΔJ|, in C with MPFR.
   Usage: duffing_lie2_mpfr STEPS BITS H DELTA Q P; prints seconds of the loop and the results.

   With f = H_q = q (1 + δq²), g = H_qq = 1 + 3δq², w = (h/2) f, G = (h²/2) g and s = p − w:
   q' = q + h s, p' = s − w − p G, and ΔJ = h³ (3δ p q + h g²/4) = 3δh³ p q + G². That is 9
   multiplications and squarings, and 2 more for the observables. mpfr_fma and mpfr_fmma were
   slower (at 113 and 170 bits) or no faster (240) than a product and a sum. */
#include "mpfr_loop.h"

int main(int argc, char **argv) {
    if (argc != 7 || atol(argv[1]) < 1) return 2;
    const long steps = atol(argv[1]);
    begin(argv[2]);
    mpfr_t h, d, q, p, h_half, h2_half, w_q2, g_q2, pq_factor, q2, g, w, s, t, dj;
    read_number(h, argv[3]);
    read_number(d, argv[4]);
    read_number(q, argv[5]);
    read_number(p, argv[6]);
    mpfr_inits(h_half, h2_half, w_q2, g_q2, pq_factor, q2, g, w, s, t, dj, NULL);

    mpfr_div_2ui(h_half, h, 1, NEAR);
    mpfr_mul(w_q2, h_half, d, NEAR);                 /* hδ/2 */
    mpfr_mul(h2_half, h, h_half, NEAR);
    mpfr_mul(g_q2, h2_half, d, NEAR);
    mpfr_mul_ui(g_q2, g_q2, 3, NEAR);                /* 3h²δ/2 */
    mpfr_mul(pq_factor, g_q2, h, NEAR);
    mpfr_mul_2ui(pq_factor, pq_factor, 1, NEAR);     /* 3h³δ */

    const double begun = now();
    for (long k = 0; k < steps; k++) {
        mpfr_sqr(q2, q, NEAR);
        mpfr_mul(g, g_q2, q2, NEAR);
        mpfr_add(g, g, h2_half, NEAR);
        mpfr_mul(w, w_q2, q2, NEAR);
        mpfr_add(w, w, h_half, NEAR);
        mpfr_mul(w, w, q, NEAR);
        mpfr_mul(t, p, q, NEAR);
        mpfr_mul(t, t, pq_factor, NEAR);
        mpfr_sqr(dj, g, NEAR);
        mpfr_add(dj, dj, t, NEAR);
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
