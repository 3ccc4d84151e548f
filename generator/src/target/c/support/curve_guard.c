/* y, but NaN outside of a curve that must not be left. */
static double bryant_curve_guard(const struct bryant_curve *c, double x, double y)
{
    return c->bounded && (x < c->x[0] || c->x[c->points - 1] < x) ? NAN : y;
}
