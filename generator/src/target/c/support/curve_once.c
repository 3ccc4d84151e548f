/* Integral of a curve from its first point to x. */
static double bryant_curve_once(const struct bryant_curve *c, double x)
{
    const int p = bryant_curve_piece(c->x, c->points, x), k = p > 0 ? p - 1 : 0;
    const double s = x - c->x[k];
    double sum = c->m[p] / 2.0;
    if (c->c2) {
        sum = MULTIPLY_ADD(c->c3[p] / 4.0, s, c->c2[p] / 3.0);
        sum = MULTIPLY_ADD(sum, s, c->m[p] / 2.0);
    }
    sum = MULTIPLY_ADD(sum, s, c->y[k]);
    return bryant_curve_guard(c, x, MULTIPLY_ADD(sum, s, c->once[k]));
}
