/* Integral of a curve from 0 to x. */
static double bryant_curve_integral(const struct bryant_curve *c, double x)
{
    const double from = bryant_curve_once(c, 0.0);
    return bryant_curve_once(c, x) - from;
}
