/* The seed model in plain C99: records side by side in lanes, short loops over lanes, no intrinsics.

   Shaft and housing in x and y, nine balls, unbalance, one spall of the inner race narrower than the distance between balls; classical
   Runge-Kutta (docs/model.md). What the recipe of the seed sets to zero is left out. Balls stand still in the frame of the cage, directions
   are turned by half a step at a time, and the spall corrects the force of the one ball nearest to it: no trigonometry in the loop.

   Given from outside: LANES, SPALL (0 none, 1 rectangular, 2 geometric), STEPS per sample, and FIRST, FIRST_TAPS and LAST_TAPS of the filters. */
#include <math.h>
#include <string.h>

enum { BALLS = 9, COORDINATES = 4, STATE = 8 };
enum { X1, Y1, X2, Y2, U1, V1, U2, V2 };
enum { STIFFNESS, GAP, IM1, IM2, C1, K2X, K2Y, C2X, C2Y, WX, WY, UNBALANCE, CAGE_TURN_C, CAGE_TURN_S, SHAFT_TURN_C, SHAFT_TURN_S,
       PASSING, HALF, ARC, DEPTH, BALL, PARAMS };
enum { CAGE_C, CAGE_S, SHAFT_C, SHAFT_S, PLACE, TURNS };

#define EACH for (int i = 0; i < LANES; i++)
typedef double row[LANES];

static const double SPACING = 0.69813170079773183077;
static const double COS[BALLS + 1] = {1, .76604444311897803520, .17364817766693034885, -.5, -.93969262078590838405,
                                      -.93969262078590838405, -.5, .17364817766693034885, .76604444311897803520, 1};
static const double SIN[BALLS + 1] = {0, .64278760968653932632, .98480775301220805937, .86602540378443864676, .34202014332566873304,
                                      -.34202014332566873304, -.86602540378443864676, -.98480775301220805937, -.64278760968653932632, 0};

/* The ball nearest to the spall: its direction in the frame of the cage, and how far it drops. */
typedef struct { row c, s, drop; } nearest;

static void half_turn(row *restrict turn, const row *restrict p)
{
    EACH {
        double c = turn[CAGE_C][i], s = turn[CAGE_S][i];
        turn[CAGE_C][i] = c * p[CAGE_TURN_C][i] - s * p[CAGE_TURN_S][i];
        turn[CAGE_S][i] = s * p[CAGE_TURN_C][i] + c * p[CAGE_TURN_S][i];
    }
    EACH {
        double c = turn[SHAFT_C][i], s = turn[SHAFT_S][i];
        turn[SHAFT_C][i] = c * p[SHAFT_TURN_C][i] - s * p[SHAFT_TURN_S][i];
        turn[SHAFT_S][i] = s * p[SHAFT_TURN_C][i] + c * p[SHAFT_TURN_S][i];
    }
    EACH turn[PLACE][i] += p[PASSING][i];
    EACH turn[PLACE][i] -= turn[PLACE][i] >= BALLS ? BALLS : 0;
}

static void find_nearest(const row *restrict turn, const row *restrict p, nearest *restrict near)
{
    row inside;
    EACH {
        double ball = rint(turn[PLACE][i]);
        near->c[i] = COS[(int)ball];
        near->s[i] = SIN[(int)ball];
        inside[i] = p[HALF][i] - SPACING * fabs(turn[PLACE][i] - ball);
    }
#if SPALL == 1
    EACH near->drop[i] = inside[i] > 0 ? p[DEPTH][i] : 0;
#else
    EACH {
        double x = fmax(inside[i], 0), y = x * x;
        double sine = x * (1 - y / 6 * (1 - y / 20 * (1 - y / 42 * (1 - y / 72 * (1 - y / 110)))));
        double chord = fmin(p[ARC][i] * sine, p[BALL][i]), square = chord * chord;
        double ball = p[BALL][i] - sqrt(fmax(p[BALL][i] * p[BALL][i] - square, 0));
        double race = p[ARC][i] - sqrt(fmax(p[ARC][i] * p[ARC][i] - square, 0));
        near->drop[i] = fmin(ball + race, p[DEPTH][i]);
    }
#endif
}

static void accelerations(const row *restrict q, const row *restrict turn, const nearest *restrict near, const row *restrict p, row *restrict a)
{
    row x, y, fx, fy;
    EACH {
        double dx = q[X1][i] - q[X2][i], dy = q[Y1][i] - q[Y2][i];
        x[i] = dx * turn[CAGE_C][i] + dy * turn[CAGE_S][i];
        y[i] = dy * turn[CAGE_C][i] - dx * turn[CAGE_S][i];
    }
    EACH fx[i] = fy[i] = 0;
    for (int ball = 0; ball < BALLS; ball++)
        EACH {
            double squeeze = fmax(x[i] * COS[ball] + y[i] * SIN[ball] - p[GAP][i], 0), force = squeeze * sqrt(squeeze);
            fx[i] += force * COS[ball];
            fy[i] += force * SIN[ball];
        }
#if SPALL
    EACH {
        double squeeze = x[i] * near->c[i] + y[i] * near->s[i] - p[GAP][i];
        double above = fmax(squeeze, 0), fallen = fmax(squeeze - near->drop[i], 0);
        double less = fallen * sqrt(fallen) - above * sqrt(above);
        fx[i] += less * near->c[i];
        fy[i] += less * near->s[i];
    }
#endif
    EACH {
        double c = turn[CAGE_C][i], s = turn[CAGE_S][i], k = p[STIFFNESS][i];
        double jx = k * (fx[i] * c - fy[i] * s) + p[C1][i] * (q[U1][i] - q[U2][i]);
        double jy = k * (fx[i] * s + fy[i] * c) + p[C1][i] * (q[V1][i] - q[V2][i]);
        a[0][i] = (p[WX][i] + p[UNBALANCE][i] * turn[SHAFT_C][i] - jx) * p[IM1][i];
        a[1][i] = (p[WY][i] + p[UNBALANCE][i] * turn[SHAFT_S][i] - jy) * p[IM1][i];
        a[2][i] = (jx - p[C2X][i] * q[U2][i] - p[K2X][i] * q[X2][i]) * p[IM2][i];
        a[3][i] = (jy - p[C2Y][i] * q[V2][i] - p[K2Y][i] * q[Y2][i]) * p[IM2][i];
    }
}

/* Next stage: its state from the slopes of the one before, which join the sum of all slopes. */
static void move(const row *restrict q, const row *restrict rates, const row *restrict a, double h, double weight, row *restrict next,
                 row *restrict sum)
{
    for (int k = 0; k < COORDINATES; k++)
        EACH {
            sum[k][i] += weight * rates[k][i];
            sum[k + COORDINATES][i] += weight * a[k][i];
            next[k][i] = q[k][i] + h * rates[k][i];
            next[k + COORDINATES][i] = q[k + COORDINATES][i] + h * a[k][i];
        }
}

/* One step: the state after it, the turn after it, and the accelerations `a` before it. `start` is the nearest ball, before and after. */
static inline void step(row *restrict q, row *restrict turn, const row *restrict p, double dt, nearest *restrict start, row *restrict a)
{
    row stage[COORDINATES], odd[STATE], even[STATE], sum[STATE];
    nearest middle;
    for (int k = 0; k < STATE; k++)
        EACH sum[k][i] = q[k][i];
    accelerations(q, turn, start, p, a);
    move(q, q + COORDINATES, a, dt / 2, dt / 6, odd, sum);
    half_turn(turn, p);
    find_nearest(turn, p, &middle);
    accelerations(odd, turn, &middle, p, stage);
    move(q, odd + COORDINATES, stage, dt / 2, dt / 3, even, sum);
    accelerations(even, turn, &middle, p, stage);
    move(q, even + COORDINATES, stage, dt, dt / 3, odd, sum);
    half_turn(turn, p);
    find_nearest(turn, p, start);
    accelerations(odd, turn, start, p, stage);
    for (int k = 0; k < COORDINATES; k++)
        EACH {
            q[k][i] = sum[k][i] + dt / 6 * odd[k + COORDINATES][i];
            q[k + COORDINATES][i] = sum[k + COORDINATES][i] + dt / 6 * stage[k][i];
        }
}

/* Steps, with the four accelerations low-passed and decimated by STEPS, in two stages: FIRST_TAPS taps decimate by FIRST, and LAST_TAPS
   taps by STEPS / FIRST; FIRST_TAPS is 0 for one stage. Single precision, all lanes of the four channels in one row. */
enum { BLOCK = 64, LAST = STEPS / FIRST, LAST_KEPT = LAST_TAPS - 1, KEPT = FIRST_TAPS ? FIRST_TAPS - 1 : LAST_KEPT };
typedef float output[COORDINATES * LANES];

/* `n` outputs, each a sum of rows of the history weighted by the taps, `factor` rows apart. */
static inline void decimate(const output *restrict history, const float *restrict taps, int n_taps, int factor, int n, output *restrict out)
{
    enum { WIDTH = LANES < 16 ? COORDINATES * LANES : 64 }; /* sums that stay in registers */
    for (int place = 0; place < n; place++, history += factor)
        for (int first = 0; first < COORDINATES * LANES; first += WIDTH) {
            float total[WIDTH] = {0};
            for (int tap = 0; tap < n_taps; tap++)
                for (int i = 0; i < WIDTH; i++)
                    total[i] += taps[tap] * history[tap][first + i];
            for (int i = 0; i < WIDTH; i++)
                out[place][first + i] = total[i];
        }
}

/* Outputs of the filters, shape (sample, coordinate, lane), for a multiple of BLOCK samples; the history is zero before the first step. */
void march(double *state, double *turning, const double *params, double dt, long samples, const float *first_taps,
                     const float *last_taps, float *out)
{
    static output history[KEPT + BLOCK * STEPS], halfway[LAST_KEPT + BLOCK * LAST];
    row *q = (row *)state, *turn = (row *)turning;
    const row *p = (const row *)params;
    row a[COORDINATES];
    nearest start;
    memset(history, 0, sizeof history);
    memset(halfway, 0, sizeof halfway);
    find_nearest(turn, p, &start);
    for (long sample = 0; sample < samples; sample += BLOCK) {
        for (int n = 0; n < BLOCK * STEPS; n++) {
            step(q, turn, p, dt, &start, a);
            for (int k = 0; k < COORDINATES; k++)
                EACH history[KEPT + n][k * LANES + i] = (float)a[k][i];
        }
        output *made = (output *)out + sample;
        if (FIRST_TAPS) {
            decimate(history, first_taps, FIRST_TAPS, FIRST, BLOCK * LAST, halfway + LAST_KEPT);
            decimate(halfway, last_taps, LAST_TAPS, LAST, BLOCK, made);
            memmove(halfway, halfway + BLOCK * LAST, LAST_KEPT * sizeof *halfway);
        } else
            decimate(history, last_taps, LAST_TAPS, STEPS, BLOCK, made);
        memmove(history, history + BLOCK * STEPS, KEPT * sizeof *history);
    }
}
