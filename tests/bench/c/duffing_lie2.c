/* The competitor: Duffing, lie2, with the closed form of ΔJ, Λ, MSE and max |ΔJ|, in plain C.
   Usage: duffing_lie2 STEPS H DELTA Q P; prints seconds of the loop and the results. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(int argc, char **argv) {
    if (argc != 6) return 2;
    const long steps = atol(argv[1]);
    const double h = atof(argv[2]), d = atof(argv[3]);
    double q = atof(argv[4]), p = atof(argv[5]);
    double lambda = 0, mse = 0, top = 0;
    const double begun = now();
    for (long k = 0; k < steps; k++) {
        const double q2 = q * q;
        const double g = 1 + 3 * d * q2;            /* H_qq */
        const double f = q * (1 + d * q2);          /* H_q */
        const double dj = h * h * h * (3 * d * p * q + h * g * g / 4);
        const double size = fabs(dj);
        lambda += dj + lambda * dj;
        mse += dj * dj;
        if (size > top) top = size;
        const double p_next = p - h * (f + h / 2 * p * g);
        q = q + h * (p - h / 2 * f);
        p = p_next;
    }
    const double seconds = now() - begun;
    printf("%.9f %.17g %.17g %.17g %.17g %.17g\n", seconds, lambda, mse / (double)steps, top, q, p);
    return 0;
}
