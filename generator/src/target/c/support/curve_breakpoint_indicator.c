/* A function whose sign changes where a curve is not smooth: of slope 1 or -1, its magnitude the distance to the nearest such place; 1
   where there is none. */
static double bryant_curve_breakpoint_indicator(const struct bryant_curve *c, double x)
{
    const int p = bryant_curve_piece(c->kink, c->kinks, x);
    double distance;
    if (c->kinks == 0)
        return 1.0 + (x - x);
    if (p == 0)
        distance = c->kink[0] - x;
    else if (p == c->kinks)
        distance = -(c->kink[p - 1] - x);
    else
        distance = bryant_minimum(-(c->kink[p - 1] - x), c->kink[p] - x);
    return p % 2 == 0 ? distance : -distance;
}
