#include <stdio.h>

int main(void) {
    const double h = 0.001, delta = 1;
    double p = 0, q = 1.5;
    printf("step,p,q\n");
    for (int n = 0; n <= 5000; n++) {
        printf("%d,%.17g,%.17g\n", n, p, q);
        const double f = -q - delta * q * q * q;      /* p' = f(q) */
        const double g = (-1 - 3 * delta * q * q) * p; /* p'' */
        p += h * f + h * h / 2 * g;
        q += h * (p - h * f - h * h / 2 * g) + h * h / 2 * f;
    }
}
