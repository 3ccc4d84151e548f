/* What the programs of the other engines share: states from standard input, times and results to standard output, in the
 * format of ours/src/main.rs; and how they are timed, as in ours/src/time.rs: a batch is as many passes over all states as last
 * 2 ms, and who compares takes the median over the batches. */
#ifndef COMMON_H
#define COMMON_H

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { BATCHES = 31, RUNS = 11 };

static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Ends the program with a reason. */
static void stop(const char *reason) {
    fprintf(stderr, "%s\n", reason);
    exit(1);
}

/* The states on standard input, row by row: their number, then each. */
static double *read_states(int *count, int width) {
    if (scanf("%d", count) != 1 || *count < 1) stop("the number of states is missing");
    double *states = (double *)malloc(sizeof(double) * (size_t)*count * (size_t)width);
    if (!states) stop("no memory");
    for (int i = 0; i < *count * width; i++)
        if (scanf("%lf", &states[i]) != 1) stop("a state is too short");
    return states;
}

static void print_row(const double *row, int width) {
    for (int i = 0; i < width; i++) printf("%.17g%c", row[i], i + 1 < width ? ' ' : '\n');
}

static double elapsed(int passes, void (*pass)(void *), void *context) {
    double start = seconds();
    for (int i = 0; i < passes; i++) pass(context);
    return seconds() - start;
}

/* Prints the times per evaluation [ns] of each batch; a pass evaluates all of `count` states once. */
static void print_batches(int count, void (*pass)(void *), void *context) {
    int passes = 1;
    while (elapsed(passes, pass, context) < 2e-3) passes *= 2;
    double times[BATCHES];
    for (int i = 0; i < BATCHES; i++) times[i] = elapsed(passes, pass, context) * 1e9 / passes / count;
    print_row(times, BATCHES);
}

/* Prints the times of single runs [ns], after one that is not counted. */
static void print_runs(void (*run)(void *), void *context) {
    double times[RUNS];
    run(context);
    for (int i = 0; i < RUNS; i++) times[i] = elapsed(1, run, context) * 1e9;
    print_row(times, RUNS);
}

#endif
