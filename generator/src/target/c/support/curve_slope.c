/* Slope of a curve at x: at a point that of the piece to its right, at the end of a curve that must not be left that of the last piece. */
static double bryant_curve_slope(const struct bryant_curve *c, double x)
{
    const int p = bryant_curve_piece(c->x, c->points, x), k = p > 0 ? p - 1 : 0;
    const double s = x - c->x[k];
    double slope;
    if (c->c2) {
        slope = MULTIPLY_ADD(3.0 * c->c3[p], s, 2.0 * c->c2[p]);
        return bryant_curve_guard(c, x, MULTIPLY_ADD(slope, s, c->m[p]));
    }
    slope = c->bounded && !(x < c->x[c->points - 1]) ? c->m[c->points - 1] : c->m[p];
    return bryant_curve_guard(c, x, slope + (x - x));
}
