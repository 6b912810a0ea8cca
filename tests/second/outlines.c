/* Many points of the Duffing oscillator, delta = 1: by steps of size h, and by the exact flow. */

void lie2(double *q, double *p, double *area, long count, long steps, double h)
{
    enum { PART = 512 }; /* points that stay near the processor */
    for (long from = 0; from < count; from += PART) {
        long to = from + PART < count ? from + PART : count;
        for (long k = 0; k < steps; k++)
            for (long i = from; i < to; i++) {
                double x = q[i], y = p[i], square = x * x, stiff = 1 + 3 * square;
                double force = x * (1 + square), cube = h * h * h;
                area[i] *= 1 + cube * (3 * x * y + h / 4 * stiff * stiff);
                q[i] = x + h * (y - h / 2 * force);
                p[i] = y - h * (force + h / 2 * y * stiff);
            }
    }
}

void symplectic_euler(double *q, double *p, long count, long steps, double h)
{
    enum { PART = 512 };
    for (long from = 0; from < count; from += PART) {
        long to = from + PART < count ? from + PART : count;
        for (long k = 0; k < steps; k++)
            for (long i = from; i < to; i++) {
                p[i] -= h * (q[i] + q[i] * q[i] * q[i]);
                q[i] += h * p[i];
            }
    }
}

/* By Taylor series of order 20 in `steps` steps of size h. */
void exact(double *q, double *p, long count, long steps, double h)
{
    enum { ORDER = 20 };
    double a[ORDER + 1], b[ORDER + 1], c[ORDER + 1];
    for (long i = 0; i < count; i++) {
        double x = q[i], y = p[i];
        for (long k = 0; k < steps; k++) {
            a[0] = x, b[0] = y;
            for (int n = 0; n < ORDER; n++) {
                double square = 0, force = a[n];
                for (int j = 0; j <= n; j++) square += a[j] * a[n - j];
                c[n] = square;
                for (int j = 0; j <= n; j++) force += c[j] * a[n - j];
                a[n + 1] = b[n] / (n + 1), b[n + 1] = -force / (n + 1);
            }
            x = a[ORDER], y = b[ORDER];
            for (int n = ORDER - 1; n >= 0; n--) x = x * h + a[n], y = y * h + b[n];
        }
        q[i] = x, p[i] = y;
    }
}
