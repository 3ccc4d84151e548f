/* A function that CasADi generated for a robot, from Pinocchio's algorithm over symbols: `function`.
 *
 * It is compiled together with the generated text, which defines
 *     function(q, v, a) -> WIDTH results by columns of matrices.
 * NQ, NV and WIDTH are given when it is compiled. */
#include "common.h"

int function(const double **arg, double **res, long long *iw, double *w, int mem);

struct context {
    const double *states;
    double *results;
    int count;
};

static void pass(void *context) {
    struct context *c = (struct context *)context;
    for (int i = 0; i < c->count; i++) {
        const double *state = c->states + (size_t)i * (NQ + 2 * NV);
        const double *arg[] = {state, state + NQ, state + NQ + NV};
        double *res[] = {c->results + (size_t)i * WIDTH};
        function(arg, res, NULL, NULL, 0);
    }
}

int main(void) {
    struct context c;
    c.states = read_states(&c.count, NQ + 2 * NV);
    c.results = (double *)malloc(sizeof(double) * (size_t)c.count * WIDTH);
    if (!c.results) stop("no memory");
    print_batches(c.count, pass, &c);
    for (int i = 0; i < c.count; i++) print_row(c.results + (size_t)i * WIDTH, WIDTH);
    return 0;
}
