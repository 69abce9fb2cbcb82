/* The seed model of plain.c with AVX-512 intrinsics: the whole Runge-Kutta step of eight records in registers, as a ceiling.

   Same arguments and rows as plain.c; LANES is a multiple of eight. squeeze^1.5 is squeeze^2 / sqrt(squeeze): the estimate of the
   inverse root to 14 bits takes one correction of third order, and is several times faster than the instruction for the root. */
#include <immintrin.h>

enum { BALLS = 9, COORDINATES = 4, STATE = 8 };
enum { STIFFNESS, GAP, IM1, IM2, C1, K2X, K2Y, C2X, C2Y, WX, WY, UNBALANCE, CAGE_TURN_C, CAGE_TURN_S, SHAFT_TURN_C, SHAFT_TURN_S,
       PASSING, HALF, ARC, DEPTH, BALL, PARAMS };
enum { CAGE_C, CAGE_S, SHAFT_C, SHAFT_S, PLACE, TURNS };

typedef __m512d v;
#define ALL(x) _mm512_set1_pd(x)
#define INLINE static inline __attribute__((always_inline))

static const double SPACING = 0.69813170079773183077;
static const double COS[16] = {1, .76604444311897803520, .17364817766693034885, -.5, -.93969262078590838405,
                               -.93969262078590838405, -.5, .17364817766693034885, .76604444311897803520, 1};
static const double SIN[16] = {0, .64278760968653932632, .98480775301220805937, .86602540378443864676, .34202014332566873304,
                               -.34202014332566873304, -.86602540378443864676, -.98480775301220805937, -.64278760968653932632, 0};

typedef struct { v c, s, drop; } nearest;

INLINE v power(v squeeze) /* to 1.5, nothing below zero */
{
    v x = _mm512_max_pd(squeeze, ALL(1e-30)), r = _mm512_rsqrt14_pd(x), root = x * r, e = ALL(1) - root * r;
    return x * root * (ALL(1) + e * (ALL(.5) + e * (ALL(.375) + e * ALL(.3125))));
}

INLINE void half_turn(v *turn, const v *p)
{
    v c = turn[CAGE_C], s = turn[CAGE_S], sc = turn[SHAFT_C], ss = turn[SHAFT_S], place = turn[PLACE] + p[PASSING];
    turn[CAGE_C] = c * p[CAGE_TURN_C] - s * p[CAGE_TURN_S];
    turn[CAGE_S] = s * p[CAGE_TURN_C] + c * p[CAGE_TURN_S];
    turn[SHAFT_C] = sc * p[SHAFT_TURN_C] - ss * p[SHAFT_TURN_S];
    turn[SHAFT_S] = ss * p[SHAFT_TURN_C] + sc * p[SHAFT_TURN_S];
    turn[PLACE] = _mm512_mask_sub_pd(place, _mm512_cmp_pd_mask(place, ALL(BALLS), _CMP_GE_OQ), place, ALL(BALLS));
}

INLINE nearest find_nearest(const v *turn, const v *p)
{
    v ball = _mm512_roundscale_pd(turn[PLACE], 0), inside = p[HALF] - ALL(SPACING) * _mm512_abs_pd(turn[PLACE] - ball);
    __m512i place = _mm512_cvtpd_epi64(ball);
    nearest near;
    near.c = _mm512_permutex2var_pd(_mm512_loadu_pd(COS), place, _mm512_loadu_pd(COS + 8));
    near.s = _mm512_permutex2var_pd(_mm512_loadu_pd(SIN), place, _mm512_loadu_pd(SIN + 8));
#if SPALL == 1
    near.drop = _mm512_maskz_mov_pd(_mm512_cmp_pd_mask(inside, ALL(0), _CMP_GT_OQ), p[DEPTH]);
#else
    v x = _mm512_max_pd(inside, ALL(0)), y = x * x;
    v tail = ALL(1) - y * ALL(1. / 42) * (ALL(1) - y * ALL(1. / 72) * (ALL(1) - y * ALL(1. / 110)));
    v sine = x * (ALL(1) - y * ALL(1. / 6) * (ALL(1) - y * ALL(1. / 20) * tail));
    v chord = _mm512_min_pd(p[ARC] * sine, p[BALL]), square = chord * chord;
    v of_ball = p[BALL] - _mm512_sqrt_pd(_mm512_max_pd(p[BALL] * p[BALL] - square, ALL(0)));
    v of_race = p[ARC] - _mm512_sqrt_pd(_mm512_max_pd(p[ARC] * p[ARC] - square, ALL(0)));
    near.drop = _mm512_min_pd(of_ball + of_race, p[DEPTH]);
#endif
    return near;
}

INLINE void accelerations(const v *q, const v *turn, nearest near, const v *p, v *a)
{
    v dx = q[0] - q[2], dy = q[1] - q[3], c = turn[CAGE_C], s = turn[CAGE_S];
    v x = dx * c + dy * s, y = dy * c - dx * s, fx = ALL(0), fy = ALL(0);
#pragma GCC unroll 9
    for (int ball = 0; ball < BALLS; ball++) {
        v force = power(x * ALL(COS[ball]) + y * ALL(SIN[ball]) - p[GAP]);
        fx += force * ALL(COS[ball]);
        fy += force * ALL(SIN[ball]);
    }
#if SPALL
    v squeeze = x * near.c + y * near.s - p[GAP], less = power(squeeze - near.drop) - power(squeeze);
    fx += less * near.c;
    fy += less * near.s;
#endif
    v jx = p[STIFFNESS] * (fx * c - fy * s) + p[C1] * (q[4] - q[6]), jy = p[STIFFNESS] * (fx * s + fy * c) + p[C1] * (q[5] - q[7]);
    a[0] = (p[WX] + p[UNBALANCE] * turn[SHAFT_C] - jx) * p[IM1];
    a[1] = (p[WY] + p[UNBALANCE] * turn[SHAFT_S] - jy) * p[IM1];
    a[2] = (jx - p[C2X] * q[6] - p[K2X] * q[2]) * p[IM2];
    a[3] = (jy - p[C2Y] * q[7] - p[K2Y] * q[3]) * p[IM2];
}

INLINE void move(const v *q, const v *rates, const v *a, v h, v weight, v *next, v *sum)
{
    for (int k = 0; k < COORDINATES; k++) {
        sum[k] += weight * rates[k];
        sum[k + COORDINATES] += weight * a[k];
        v rate = rates[k];
        next[k] = q[k] + h * rate;
        next[k + COORDINATES] = q[k + COORDINATES] + h * a[k];
    }
}

static void march_eight(double *state, double *turning, const double *params, double dt, long samples, long steps, double *out)
{
    v q[STATE], sum[STATE], odd[STATE], even[STATE], a[COORDINATES], turn[TURNS], p[PARAMS];
    for (int k = 0; k < STATE; k++) q[k] = _mm512_loadu_pd(state + k * LANES);
    for (int k = 0; k < TURNS; k++) turn[k] = _mm512_loadu_pd(turning + k * LANES);
    for (int k = 0; k < PARAMS; k++) p[k] = _mm512_loadu_pd(params + k * LANES);
    v half = ALL(dt / 2), whole = ALL(dt), sixth = ALL(dt / 6), third = ALL(dt / 3);
    nearest start = find_nearest(turn, p);
    for (long sample = 0; sample < samples; sample++, out += COORDINATES * LANES)
        for (long step = 0; step < steps; step++) {
            for (int k = 0; k < STATE; k++) sum[k] = q[k];
            accelerations(q, turn, start, p, a);
            if (step == 0)
                for (int k = 0; k < COORDINATES; k++) _mm512_storeu_pd(out + k * LANES, a[k]);
            move(q, q + COORDINATES, a, half, sixth, odd, sum);
            half_turn(turn, p);
            nearest middle = find_nearest(turn, p);
            accelerations(odd, turn, middle, p, a);
            move(q, odd + COORDINATES, a, half, third, even, sum);
            accelerations(even, turn, middle, p, a);
            move(q, even + COORDINATES, a, whole, third, odd, sum);
            half_turn(turn, p);
            start = find_nearest(turn, p);
            accelerations(odd, turn, start, p, a);
            for (int k = 0; k < COORDINATES; k++) {
                q[k] = sum[k] + sixth * odd[k + COORDINATES];
                q[k + COORDINATES] = sum[k + COORDINATES] + sixth * a[k];
            }
        }
    for (int k = 0; k < STATE; k++) _mm512_storeu_pd(state + k * LANES, q[k]);
    for (int k = 0; k < TURNS; k++) _mm512_storeu_pd(turning + k * LANES, turn[k]);
}

void march(double *state, double *turning, const double *params, double dt, long samples, long steps, double *out)
{
    for (int first = 0; first < LANES; first += 8)
        march_eight(state + first, turning + first, params + first, dt, samples, steps, out + first);
}
