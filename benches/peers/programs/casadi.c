/* The code that CasADi generated for a model, from Pinocchio's algorithm over symbols: `accelerations`, or `fall DURATION STEP`.
 *
 * It is compiled together with the generated text, which defines
 *     accelerations(q, v) -> dv/dt    and, where FALL is defined,    rate(x) -> dx/dt,  x = (q, v).
 * NQ, NV and QUATERNIONS, the places of the unit quaternions in q, are given when it is compiled. The fall is by the classical
 * Runge-Kutta method of order 4 with the quaternions made unit ones after each step. */
#include "common.h"

#include <math.h>
#include <string.h>

int accelerations(const double **arg, double **res, long long *iw, double *w, int mem);
int rate(const double **arg, double **res, long long *iw, double *w, int mem);

enum { WIDTH = NQ + NV };

struct context {
    const double *states;
    double *results;
    int count, steps;
    double step;
};

static void pass(void *context) {
    struct context *c = (struct context *)context;
    for (int i = 0; i < c->count; i++) {
        const double *arg[] = {c->states + i * WIDTH, c->states + i * WIDTH + NQ};
        double *res[] = {c->results + i * NV};
        accelerations(arg, res, NULL, NULL, 0);
    }
}

#ifdef FALL
static const int quaternions[] = {QUATERNIONS};

static void evaluate(const double *x, double *slope) {
    const double *arg[] = {x};
    double *res[] = {slope};
    rate(arg, res, NULL, NULL, 0);
}

static void fall(void *context) {
    struct context *c = (struct context *)context;
    double h = c->step, *x = c->results, y[WIDTH], k1[WIDTH], k2[WIDTH], k3[WIDTH], k4[WIDTH];
    memcpy(x, c->states, sizeof y);
    for (int step = 0; step < c->steps; step++) {
        evaluate(x, k1);
        for (int i = 0; i < WIDTH; i++) y[i] = x[i] + h / 2 * k1[i];
        evaluate(y, k2);
        for (int i = 0; i < WIDTH; i++) y[i] = x[i] + h / 2 * k2[i];
        evaluate(y, k3);
        for (int i = 0; i < WIDTH; i++) y[i] = x[i] + h * k3[i];
        evaluate(y, k4);
        for (int i = 0; i < WIDTH; i++) x[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
        for (size_t j = 0; j < sizeof quaternions / sizeof *quaternions; j++) {
            double *q = x + quaternions[j];
            double s = 1 / sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
            for (int i = 0; i < 4; i++) q[i] *= s;
        }
    }
}
#endif

int main(int argc, char **argv) {
    struct context c;
    if (argc < 2) stop("accelerations, or fall DURATION STEP");
    c.states = read_states(&c.count, WIDTH);
    c.results = (double *)malloc(sizeof(double) * (size_t)c.count * WIDTH);
    if (!c.results) stop("no memory");
    if (!strcmp(argv[1], "accelerations")) {
        print_batches(c.count, pass, &c);
        for (int i = 0; i < c.count; i++) print_row(c.results + i * NV, NV);
        return 0;
    }
#ifdef FALL
    if (!strcmp(argv[1], "fall") && argc == 4) {
        c.step = atof(argv[3]);
        c.steps = (int)(atof(argv[2]) / c.step + 0.5);
        print_runs(fall, &c);
        print_row(c.results, WIDTH);
        return 0;
    }
#endif
    stop("accelerations, or fall DURATION STEP");
}
