/* Second derivative of a curve at x. */
static double bryant_curve_second_derivative(const struct bryant_curve *c, double x)
{
    const int p = bryant_curve_piece(c->x, c->points, x), k = p > 0 ? p - 1 : 0;
    const double s = x - c->x[k];
    if (c->c2)
        return bryant_curve_guard(c, x, MULTIPLY_ADD(6.0 * c->c3[p], s, 2.0 * c->c2[p]));
    return bryant_curve_guard(c, x, x - x);
}
