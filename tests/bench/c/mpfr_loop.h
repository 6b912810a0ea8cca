/* What the loops with MPFR share: reading the arguments, what is observed at each step, and
   printing. All numbers have BITS bits and every operation rounds to nearest. */
#include <stdio.h> /* before mpfr.h, which only then declares mpfr_out_str */
#include <stdlib.h>
#include <time.h>
#include <mpfr.h>

#define NEAR MPFR_RNDN

static mpfr_t lambda, mse, top, term;

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The precision, and the observables at zero. */
static void begin(const char *bits) {
    const long precision = atol(bits);
    if (precision < 2 || precision > 100000) exit(2);
    mpfr_set_default_prec(precision);
    mpfr_inits(lambda, mse, top, term, NULL);
    mpfr_set_zero(lambda, 1);
    mpfr_set_zero(mse, 1);
    mpfr_set_zero(top, 1);
}

static void read_number(mpfr_t x, const char *text) {
    mpfr_init(x);
    if (mpfr_set_str(x, text, 10, NEAR) != 0) exit(2);
}

/* Λ ← Λ + (ΔJ + Λ ΔJ), the sum of ΔJ², and max |ΔJ|. */
static inline void observe(const mpfr_t dj) {
    mpfr_mul(term, lambda, dj, NEAR);
    mpfr_add(term, term, dj, NEAR);
    mpfr_add(lambda, lambda, term, NEAR);
    mpfr_sqr(term, dj, NEAR);
    mpfr_add(mse, mse, term, NEAR);
    if (mpfr_cmpabs(dj, top) > 0) mpfr_abs(top, dj, NEAR);
}

/* Seconds, Λ, MSE, max |ΔJ|, q, p, with the digits that give each number back. */
static int finish(double seconds, long steps, const mpfr_t q, const mpfr_t p) {
    mpfr_div_si(mse, mse, steps, NEAR);
    mpfr_srcptr found[] = {lambda, mse, top, q, p};
    printf("%.9f", seconds);
    for (int k = 0; k < 5; k++) {
        putchar(' ');
        mpfr_out_str(stdout, 10, 0, found[k], NEAR);
    }
    putchar('\n');
    return 0;
}
