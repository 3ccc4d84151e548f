/* Ordinate of a curve at x. */
static double bryant_curve_value(const struct bryant_curve *c, double x)
{
    const int p = bryant_curve_piece(c->x, c->points, x), k = p > 0 ? p - 1 : 0;
    const double s = x - c->x[k];
    double slope = c->m[p];
    if (c->c2) {
        slope = MULTIPLY_ADD(c->c3[p], s, c->c2[p]);
        slope = MULTIPLY_ADD(slope, s, c->m[p]);
    }
    return bryant_curve_guard(c, x, MULTIPLY_ADD(slope, s, c->y[k]));
}
