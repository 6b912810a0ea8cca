/* Long runs of lie2, in long double or -DREAL=double, beside the exact solution by Taylor series of order 24.

   long_runs SYSTEM DELTA TIME Q P PERIOD REACH_Q REACH_P [STEP_SIZE...]

   Without step sizes: q and p of the exact solution at TIME. Else:
   One line for each step size h, N = floor(TIME/h): N, MSE, max |dJ|, Lambda, the largest error over
   the last period, the error at the end. Errors are in parts of the reach, the greater of q's and
   p's. Steps of at most 0.03.                                                                     */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <tgmath.h>

#ifndef REAL
#define REAL long double
#endif
typedef REAL real;

enum { ORDER = 24, CLOSE = 128, SAMPLES = 600 };

static int pendulum;
static real delta;

typedef struct { real sum, lost; } total; /* Kahan's compensated sum */

static inline void add(total *t, real x)
{
    real more = x - t->lost, after = t->sum + more;
    t->lost = (after - t->sum) - more;
    t->sum = after;
}

/* -- the exact solution ---------------------------------------------------------------------- */

typedef struct { real q, p, time; } state;

/* The coefficients of q'' = -q - delta q^3 or -sin q, by Cauchy products, summed at dt. */
static void advance(state *z, real dt)
{
    real q[ORDER + 1], p[ORDER + 1], one[ORDER + 1], two[ORDER + 1];
    q[0] = z->q, p[0] = z->p;
    if (pendulum) one[0] = sin(q[0]), two[0] = cos(q[0]);
    for (int n = 0; n < ORDER; n++) {
        real force = 0, s = 0, c = 0;
        if (pendulum) {
            for (int k = 1; k <= n; k++) s += k * q[k] * two[n - k], c -= k * q[k] * one[n - k];
            if (n) one[n] = s / n, two[n] = c / n;
            force = one[n];
        } else {
            for (int k = 0; k <= n; k++) s += q[k] * q[n - k];
            one[n] = s;
            for (int k = 0; k <= n; k++) force += one[k] * q[n - k];
            force = q[n] + delta * force;
        }
        q[n + 1] = p[n] / (n + 1), p[n + 1] = -force / (n + 1);
    }
    z->q = q[ORDER], z->p = p[ORDER];
    for (int n = ORDER - 1; n >= 0; n--) z->q = z->q * dt + q[n], z->p = z->p * dt + p[n];
}

static void follow(state *z, real until)
{
    int parts = (int)((until - z->time) * 6) + 1;
    real dt = (until - z->time) / parts;
    for (int k = 0; k < parts; k++) advance(z, dt);
    z->time = until;
}

/* -- the run --------------------------------------------------------------------------------- */

typedef struct {
    real q, p, sin_q, cos_q, largest;
    total squares, lambda;
} run;

/* `steps` steps; the determinant of each less 1 is added up. */
static void steps_of(run *r, real h, long steps)
{
    const real a2 = 1.0L / 2, a3 = 1.0L / 6, a4 = 1.0L / 12, a5 = 1.0L / 20, a6 = 1.0L / 30;
    const real a7 = 1.0L / 42, a8 = 1.0L / 56, half = h / 2, quarter = h / 4, cube = h * h * h;
    run at = *r;
    for (long k = 0; k < steps; k++) {
        real q = at.q, p = at.p, dq, dp, dj;
        if (pendulum) {
            if (k % CLOSE == 0) at.sin_q = sin(q), at.cos_q = cos(q);
            real s = at.sin_q, c = at.cos_q;
            dq = h * (p - half * s), dp = -h * (s + half * p * c);
            dj = cube * (quarter * c * c - p * s / 2);
            /* sin and cos of q + dq by those of dq */
            real x = dq * dq;
            real sine = dq * (1 - x * a3 * (1 - x * a5 * (1 - x * a7)));
            real less = x * a2 * (1 - x * a4 * (1 - x * a6 * (1 - x * a8)));
            at.sin_q = s + (c * sine - s * less), at.cos_q = c - (s * sine + c * less);
        } else {
            real bend = delta * q * q, stiff = 1 + 3 * bend, force = q * (1 + bend);
            dq = h * (p - half * force), dp = -h * (force + half * p * stiff);
            dj = cube * (3 * delta * p * q + quarter * stiff * stiff);
        }
        add(&at.squares, dj * dj);
        add(&at.lambda, dj * (1 + at.lambda.sum));
        if (fabs(dj) > at.largest) at.largest = fabs(dj);
        at.q = q + dq, at.p = p + dp;
    }
    *r = at;
}

int main(int count, char **words)
{
    if (count < 9) return 2;
    pendulum = !strcmp(words[1], "pendulum"), delta = strtold(words[2], NULL);
    real numbers[6];
    for (int i = 0; i < 6; i++) numbers[i] = strtold(words[3 + i], NULL);
    real time = numbers[0], period = numbers[3], reach_q = numbers[4], reach_p = numbers[5];
    state start = {numbers[1], numbers[2], 0}, near_end = start;
    if (count == 9) {
        follow(&near_end, time);
        printf("%.17Lg %.17Lg\n", (long double)near_end.q, (long double)near_end.p);
    }
    if (time > period + 1) follow(&near_end, time - period - 1);
    for (int i = 9; i < count; i++) {
        real h = strtold(words[i], NULL), worst = 0, end = 0;
        long steps = (long)floor(time / h * (1 + 1e-13)), every = (long)ceil(period / h / SAMPLES);
        long compared = (long)fmin(floor(period / h / every), steps / every);
        run r = {.q = start.q, .p = start.p};
        state exact = near_end;
        steps_of(&r, h, steps - compared * every);
        for (long k = compared; k >= 0; k--) {
            follow(&exact, (steps - k * every) * h);
            end = fmax(fabs(r.q - exact.q) / reach_q, fabs(r.p - exact.p) / reach_p);
            worst = fmax(worst, end);
            if (k) steps_of(&r, h, every);
        }
        real numbers_of[] = {r.squares.sum / steps, r.largest, r.lambda.sum, worst, end};
        printf("%ld", steps);
        for (int k = 0; k < 5; k++) printf(" %.17Lg", (long double)numbers_of[k]);
        printf("\n");
    }
    return 0;
}
