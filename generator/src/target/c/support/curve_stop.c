/* When what a curve of time accelerates comes to rest. The search goes piece by piece, and each piece is divided where the curve changes its
   sign, so that the velocity is monotone in each part. */
static double bryant_sign(double x)
{
    return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0;
}

/* A piece of the curve, times a factor. */
struct bryant_braking {
    double x, y, m, c2, c3, factor;
};

static double bryant_braking_acceleration(const struct bryant_braking *b, double x)
{
    const double s = x - b->x;
    double sum = b->c3 * s;
    sum = (sum + b->c2) * s;
    sum = (sum + b->m) * s;
    return b->factor * (sum + b->y);
}

/* The velocity gained from the point of the piece. */
static double bryant_braking_integral(const struct bryant_braking *b, double x)
{
    const double s = x - b->x;
    double sum = s * b->c3 / 4.0;
    sum = s * (b->c2 / 3.0 + sum);
    sum = s * (b->m / 2.0 + sum);
    return b->factor * (s * (b->y + sum));
}

/* The end of low ... high at which `sign * (base + (f(x) - begin)) > 0` first fails, f being the integral, or the acceleration. */
static double bryant_braking_halve(const struct bryant_braking *b, int integral, double sign, double base, double begin, double low, double high)
{
    for (;;) {
        const double middle = low + 0.5 * (high - low);
        int holds;
        if (middle <= low || middle >= high)
            return high;
        if (integral)
            holds = sign * (base + (bryant_braking_integral(b, middle) - begin)) > 0.0;
        else
            holds = bryant_sign(bryant_braking_acceleration(b, middle)) == sign;
        if (holds)
            low = middle;
        else
            high = middle;
    }
}

/* Where the acceleration changes its sign between these, or the end. */
static double bryant_braking_turn(const struct bryant_braking *b, double from, double to)
{
    const double begin = bryant_braking_acceleration(b, from);
    if (to == INFINITY) {
        const double turn = from - begin / (b->factor * b->m);
        return turn > from && isfinite(turn) ? turn : to;
    }
    if (bryant_sign(begin) * bryant_sign(bryant_braking_acceleration(b, to)) >= 0.0)
        return to;
    return bryant_braking_halve(b, 0, bryant_sign(begin), 0.0, 0.0, from, to);
}

/* The first x > 0 at which velocity + factor * (integral of the curve from 0 to x) is 0, 0 where it never is; `crosses` says whether it
   goes through 0 there. A velocity of 0 counts from where it is not 0. */
static double bryant_curve_first_stop(const struct bryant_curve *c, double velocity, double factor, int *crosses)
{
    /* what was gone through: the sign of the velocity, the sum of all that it was made of, whether it is 0 within rounding */
    double sign = bryant_sign(velocity), size = fabs(velocity);
    int near = 0, p, part;
    *crosses = 0;
    if (!isfinite(velocity) || !isfinite(factor) || factor == 0.0)
        return 0.0;
    for (p = 0; p <= c->points; p++) {
        const int k = p > 0 ? p - 1 : 0;
        const double from = p == 0 ? 0.0 : c->x[k] < 0.0 ? 0.0 : c->x[k], to = p < c->points ? c->x[p] : INFINITY;
        struct bryant_braking b;
        double turn;
        if (to <= from)
            continue;
        if (c->bounded && p == 0)
            return 0.0;
        if (c->bounded && p == c->points) {
            *crosses = near;
            return near ? from : 0.0;
        }
        b.x = c->x[k];
        b.y = c->y[k];
        b.m = c->m[p];
        b.c2 = c->c2 ? c->c2[p] : 0.0;
        b.c3 = c->c3 ? c->c3[p] : 0.0;
        b.factor = factor;
        turn = bryant_braking_turn(&b, from, to);
        for (part = 0; part < 2; part++) {
            const double start = part == 0 ? from : turn, end = part == 0 ? turn : to;
            const double begin = bryant_braking_integral(&b, start);
            double gain, reached, rounding;
            if (end <= start)
                continue;
            if (end == INFINITY) {
                double length = 1.0;
                gain = factor * b.m;
                if (gain == 0.0)
                    gain = bryant_braking_acceleration(&b, start);
                if (sign == 0.0)
                    return 0.0;
                if (near && (sign * gain >= 0.0 || sign * velocity <= 0.0)) {
                    *crosses = !(sign * gain >= 0.0);
                    return start;
                }
                if (sign * gain >= 0.0)
                    return 0.0;
                for (; length < 1.7976931348623157e308; length *= 2.0) {
                    const double more = bryant_braking_integral(&b, start + length) - begin;
                    if (sign * (velocity + more) <= 0.0) {
                        *crosses = 1;
                        return bryant_braking_halve(&b, 1, sign, velocity, begin, start, start + length);
                    }
                }
                return 0.0;
            }
            reached = bryant_braking_integral(&b, end);
            gain = reached - begin;
            size += fabs(begin) + fabs(reached);
            if (sign == 0.0) {
                sign = bryant_sign(gain);
                velocity += gain;
                continue;
            }
            if (near && (sign * gain >= 0.0 || sign * velocity <= 0.0)) {
                *crosses = !(sign * gain >= 0.0);
                return start;
            }
            reached = sign * (velocity + gain);
            rounding = 64.0 * 2.220446049250313e-16 * size;
            if (reached < -rounding) {
                *crosses = 1;
                return bryant_braking_halve(&b, 1, sign, velocity, begin, start, end);
            }
            velocity += gain;
            near = reached <= rounding;
        }
    }
    return 0.0;
}

/* The same, with the last digits by two of Newton's steps. */
static double bryant_curve_stop(const struct bryant_curve *c, double velocity, double factor)
{
    int crosses, i;
    double x = bryant_curve_first_stop(c, velocity, factor, &crosses);
    for (i = 0; i < 2; i++) {
        const double slope = factor * bryant_curve_value(c, x);
        const double left = MULTIPLY_ADD(factor, bryant_curve_integral(c, x), velocity);
        const double step = left / (0.0 < fabs(slope) ? slope : 1.0);
        if (0.0 < fabs(slope) && fabs(step) < 1e-3 * x && crosses)
            x = x - step;
        if (c->bounded && c->x[c->points - 1] < x)
            x = c->x[c->points - 1];
    }
    return x + (velocity - velocity) + (factor - factor);
}
