/* The smallest x on a rising piece of a curve at which it has the ordinate y; NaN where there is none. */
static double bryant_curve_inverse(const struct bryant_curve *c, double y)
{
    const int last = c->points - 1;
    double x = NAN;
    int k;
    if (!c->c2) {
        if (c->m[last] > 0.0) {
            double top;
            if (c->goes_on)
                top = c->x[last] + (y - c->y[last]) / c->m[last + 1];
            else
                top = c->y[last] < y ? NAN : c->x[last] + (y - y);
            x = y < c->y[last] ? NAN : top;
        }
        for (k = last - 1; k >= 0; k--) {
            if (c->m[k + 1] > 0.0) {
                const double here = c->x[k] + (y - c->y[k]) / c->m[k + 1];
                const double inside = y < c->y[k + 1] ? here : x;
                const double below = k == 0 && c->goes_on ? here : x;
                x = y < c->y[k] ? below : inside;
            }
        }
        return x;
    }
    if (c->goes_on && c->m[last + 1] > 0.0 && c->y[last] < y)
        x = c->x[last] + (y - c->y[last]) / c->m[last + 1];
    for (k = 0; k < last; k++) {
        /* the leftmost rising piece that has y */
        if (c->y[k + 1] > c->y[k] && !(y < c->y[k]) && !(c->y[k + 1] < y)) {
            const double m = c->m[k + 1], c2 = c->c2[k + 1], c3 = c->c3[k + 1];
            const double h = c->x[k + 1] - c->x[k];
            double low = 0.0, high = h, s, found;
            int i;
            for (i = 0; i < 54; i++) {
                const double middle = 0.5 * (low + high);
                double value = MULTIPLY_ADD(c3, middle, c2);
                value = MULTIPLY_ADD(value, middle, m);
                value = MULTIPLY_ADD(value, middle, c->y[k]);
                if (value < y)
                    low = middle;
                else
                    high = middle;
            }
            s = high;
            for (i = 0; i < 2; i++) {
                double slope = MULTIPLY_ADD(3.0, c3 * s, 2.0 * c2), value = MULTIPLY_ADD(c3, s, c2);
                slope = MULTIPLY_ADD(slope, s, m);
                value = MULTIPLY_ADD(value, s, m);
                value = MULTIPLY_ADD(value, s, c->y[k]);
                s = s - (0.0 < slope ? (value - y) / slope : 0.0);
            }
            s = s < 0.0 ? 0.0 : s;
            found = c->x[k] + (h < s ? h : s);
            if (found < INFINITY)
                x = found;
            break;
        }
    }
    if (c->goes_on && c->m[0] > 0.0 && y < c->y[0])
        x = c->x[0] + (y - c->y[0]) / c->m[0];
    return x + (y - y);
}
