/* Double integral of a curve from 0 to x. */
static double bryant_curve_double_integral(const struct bryant_curve *c, double x)
{
    const double slope = bryant_curve_once(c, 0.0), from = bryant_curve_twice(c, 0.0);
    const double line = slope * x, way = bryant_curve_twice(c, x) - from;
    return way - line;
}
