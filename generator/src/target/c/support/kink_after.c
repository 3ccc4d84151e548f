/* The first time after t at which rate * time passes a point of a curve, rate > 0: the smallest double at which it is as computed;
   INFINITY where none is left. */
static double bryant_kink_after(const struct bryant_curve *c, double rate, double t)
{
    double next = INFINITY;
    int k, i;
    for (k = 0; k < c->points; k++) {
        double time;
        if (!(t * rate < c->x[k]))
            continue;
        time = c->x[k] / rate;
        for (i = 0; i < 4; i++) {
            const double earlier = nextafter(time, -INFINITY);
            if (time * rate < c->x[k])
                time = nextafter(time, INFINITY);
            else if (!(earlier * rate < c->x[k]))
                time = earlier;
        }
        if (time > t && time < next)
            next = time;
    }
    return next;
}
