/* How many vectors of LANES numbers a processor multiplies and adds, or takes the roots of, in a second: twelve at a time, none waits for
   another. The roots are those of numbers with long mantissas, because some dividers are faster at short ones. */
#include <math.h>

#define EACH(k) for (int k = 0; k < 12; k++)
typedef double vector __attribute__((vector_size(8 * LANES)));

double multiply_and_add(long times)
{
    vector x[12], a = {0}, b = {0};
    EACH(k) x[k] = (vector){0} + k;
    a += 0.999999;
    b += 1e-9;
    for (long i = 0; i < times; i++) {
#pragma GCC unroll 12
        EACH(k) x[k] = x[k] * a + b;
        __asm__ volatile("" ::"x"(x[0]));
    }
    vector sum = {0};
    EACH(k) sum += x[k];
    return sum[0];
}

double roots(long times)
{
    vector x[12], root[12];
    EACH(k) x[k] = (vector){0} + 1.7234234987234 + k;
    for (long i = 0; i < times; i++) {
#pragma GCC unroll 12
        EACH(k)
        {
            __asm__ volatile("" : "+x"(x[k])); /* so that the compiler takes the roots again in every pass */
#pragma GCC unroll 8
            for (int lane = 0; lane < LANES; lane++)
                root[k][lane] = sqrt(x[k][lane]);
            __asm__ volatile("" ::"x"(root[k]));
        }
    }
    return root[0][0];
}
