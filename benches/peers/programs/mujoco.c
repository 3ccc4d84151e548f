/* MuJoCo: `mujoco accelerations MODEL.xml` and `mujoco fall MODEL.xml DURATION STEP`.
 *
 * A state is qpos then qvel. Timed is mj_forward with the copies of a state in and of its accelerations out, or a whole fall: the
 * reset and its calls of mj_step, by the Runge-Kutta method of order 4. */
#include "common.h"

#include <mujoco/mujoco.h>
#include <string.h>

struct context {
    const mjModel *model;
    mjData *data;
    const double *states;
    double *results;
    int count, steps;
};

static void set(struct context *c, const double *state) {
    memcpy(c->data->qpos, state, sizeof(double) * (size_t)c->model->nq);
    memcpy(c->data->qvel, state + c->model->nq, sizeof(double) * (size_t)c->model->nv);
}

static void pass(void *context) {
    struct context *c = (struct context *)context;
    int nv = (int)c->model->nv, width = (int)c->model->nq + nv;
    for (int i = 0; i < c->count; i++) {
        set(c, c->states + i * width);
        mj_forward(c->model, c->data);
        memcpy(c->results + i * nv, c->data->qacc, sizeof(double) * (size_t)nv);
    }
}

static void fall(void *context) {
    struct context *c = (struct context *)context;
    mj_resetData(c->model, c->data);
    set(c, c->states);
    for (int i = 0; i < c->steps; i++) mj_step(c->model, c->data);
}

int main(int argc, char **argv) {
    if (argc < 3) stop("accelerations MODEL.xml, or fall MODEL.xml DURATION STEP");
    char error[1000] = "";
    mjModel *model = mj_loadXML(argv[2], NULL, error, sizeof error);
    if (!model) stop(error);
    int nq = (int)model->nq, nv = (int)model->nv;
    struct context c = {.model = model, .data = mj_makeData(model)};
    c.states = read_states(&c.count, nq + nv);
    c.results = (double *)malloc(sizeof(double) * (size_t)(c.count * nv));
    if (!c.data || !c.results) stop("no memory");
    if (!strcmp(argv[1], "accelerations")) {
        print_batches(c.count, pass, &c);
        for (int i = 0; i < c.count; i++) print_row(c.results + i * nv, nv);
    } else if (!strcmp(argv[1], "fall") && argc == 5) {
        model->opt.integrator = mjINT_RK4;
        model->opt.timestep = atof(argv[4]);
        c.steps = (int)(atof(argv[3]) / model->opt.timestep + 0.5);
        print_runs(fall, &c);
        for (int i = 0; i < nq; i++) printf("%.17g ", c.data->qpos[i]);
        print_row(c.data->qvel, nv);
    } else {
        stop("accelerations or fall?");
    }
    return 0;
}
