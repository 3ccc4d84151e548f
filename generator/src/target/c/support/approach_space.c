/* How deep two ellipsoids overlap, and along which direction.

   In the unit direction n, from the first to the second, they overlap by phi(n) = h1(n) + h2(n) - n d with h = sqrt(n Q n). The penetration
   is the smallest phi; where it is negative, the distance. Newton's step s in the tangent plane of n: M s = -P r with r = u1 + u2 - d,
   u = Q n / h, P = 1 - n n', M = K1 + K2 - phi P, K = (Q - u u') / h. A matrix is xx, yy, zz, yz, xz, xy. */
struct bryant_overlap {
    /* n, of any length, 1 / |n|, phi / |n|, 1 / h and u of both */
    double n[3], scale, depth, bend[2], u[2][3];
};

static double bryant_dot(const double a[3], const double b[3])
{
    const double last = MULTIPLY_ADD(a[1], b[1], a[2] * b[2]);
    return MULTIPLY_ADD(a[0], b[0], last);
}

static void bryant_times(const double q[6], const double a[3], double result[3])
{
    const double x = MULTIPLY_ADD(q[5], a[1], q[4] * a[2]);
    const double y = MULTIPLY_ADD(q[1], a[1], q[3] * a[2]);
    const double z = MULTIPLY_ADD(q[3], a[1], q[2] * a[2]);
    result[0] = MULTIPLY_ADD(q[0], a[0], x);
    result[1] = MULTIPLY_ADD(q[5], a[0], y);
    result[2] = MULTIPLY_ADD(q[4], a[0], z);
}

/* n Q n */
static double bryant_product(const double q[6], const double n[3])
{
    double stretched[3];
    bryant_times(q, n, stretched);
    return bryant_dot(n, stretched);
}

static void bryant_overlap_along(double q[2][6], const double d[3], const double n[3], struct bryant_overlap *o)
{
    double reach[2];
    int i, k;
    for (i = 0; i < 2; i++) {
        double stretched[3], square;
        bryant_times(q[i], n, stretched);
        square = bryant_dot(n, stretched);
        reach[i] = sqrt(square);
        o->bend[i] = reach[i] * (1.0 / square);
        for (k = 0; k < 3; k++)
            o->u[i][k] = o->bend[i] * stretched[k];
    }
    for (k = 0; k < 3; k++)
        o->n[k] = n[k];
    o->scale = 1.0 / sqrt(bryant_dot(n, n));
    o->depth = (reach[0] + reach[1] - bryant_dot(n, d)) * o->scale;
}

/* Where the search begins: along (Q1 / h1 + Q2 / h2)^-1 times the line of centres. */
static void bryant_overlap_start(double q[2][6], const double line[3], double n[3])
{
    double bend[2], m[6], adjugate[6], normal[3], scale;
    int i, k;
    for (i = 0; i < 2; i++)
        bend[i] = 1.0 / sqrt(bryant_product(q[i], line));
    for (k = 0; k < 6; k++)
        m[k] = bend[0] * q[0][k] + bend[1] * q[1][k];
    adjugate[0] = m[1] * m[2] - m[3] * m[3];
    adjugate[1] = m[0] * m[2] - m[4] * m[4];
    adjugate[2] = m[0] * m[1] - m[5] * m[5];
    adjugate[3] = m[4] * m[5] - m[0] * m[3];
    adjugate[4] = m[5] * m[3] - m[1] * m[4];
    adjugate[5] = m[3] * m[4] - m[2] * m[5];
    bryant_times(adjugate, line, normal);
    scale = 1.0 / sqrt(bryant_dot(normal, normal));
    for (k = 0; k < 3; k++)
        n[k] = scale * normal[k];
}

/* Newton's step, its length squared [rad^2], and about the trace of K1 + K2. */
static void bryant_overlap_step(double q[2][6], const double d[3], const struct bryant_overlap *o, double damping, double small,
                                double step[3], double *squared, double *stiff)
{
    static const int row[6] = {0, 1, 2, 1, 0, 0}, column[6] = {0, 1, 2, 2, 2, 1};
    const double inverse = o->scale * o->scale, level = o->depth * o->scale, lifted = level * o->scale * o->scale;
    double m[6], slope[3], turned[3], trace, product, minors[3], shift = damping, along, sum, scale;
    int k;
    for (k = 0; k < 3; k++)
        slope[k] = o->u[0][k] + o->u[1][k] - d[k];
    along = bryant_dot(o->n, slope) * inverse;
    for (k = 0; k < 3; k++)
        slope[k] = slope[k] + -along * o->n[k];
    for (k = 0; k < 6; k++) {
        const int i = row[k], j = column[k];
        double entry = MULTIPLY_ADD(o->bend[0], q[0][k], o->bend[1] * q[1][k]);
        entry = MULTIPLY_ADD(-o->bend[1] * o->u[1][i], o->u[1][j], entry);
        entry = MULTIPLY_ADD(-o->bend[0] * o->u[0][i], o->u[0][j], entry);
        entry = MULTIPLY_ADD(lifted * o->n[i], o->n[j], entry);
        m[k] = k < 3 ? entry - level : entry;
    }
    trace = m[0] + m[1] + m[2];
    minors[0] = m[0] * m[1] - m[5] * m[5];
    minors[1] = m[0] * m[2] - m[4] * m[4];
    minors[2] = m[1] * m[2] - m[3] * m[3];
    product = minors[0] + minors[1] + minors[2];
    /* the smaller eigenvalue is above product / trace where both are positive */
    if (!(small * trace < product && 0.0 < trace)) {
        const double half = 0.5 * trace, inside = half * half - product;
        const double spread = sqrt(inside < 0.0 ? 0.0 : inside), missing = small - (half - spread);
        shift = damping + (missing < 0.0 ? 0.0 : missing);
    }
    sum = trace + shift;
    bryant_times(m, slope, turned);
    scale = 1.0 / MULTIPLY_ADD(shift, sum, product);
    for (k = 0; k < 3; k++) {
        turned[k] = turned[k] + -sum * slope[k];
        step[k] = scale * turned[k];
    }
    *squared = bryant_dot(step, step) * inverse;
    *stiff = fabs(trace) + fabs(level) + fabs(level);
}

/* Of the matrices of both [m^2] and the vector d from the first centre to the second [m]: n, phi, and the vector from the first centre to
   the middle between the two points that are furthest along n. With `early`, of bodies that do not touch, n is the normal of any
   plane between them. */
static void bryant_approach_space(const double argument[15], int early, double result[7])
{
    double q[2][6], d[3], line[3], n[3], size, small, squared, distance, noise, damping = 0.0, half;
    struct bryant_overlap now, then;
    int i, k, ended = 0, steps;
    for (i = 0; i < 2; i++)
        for (k = 0; k < 6; k++)
            q[i][k] = argument[6 * i + k];
    for (k = 0; k < 3; k++)
        d[k] = argument[12 + k];
    squared = bryant_dot(d, d);
    if (early) {
        const double reach = sqrt(bryant_product(q[0], d)) + sqrt(bryant_product(q[1], d)), depth = reach - squared;
        if (depth < 0.0) {
            const double scale = 1.0 / sqrt(squared);
            for (k = 0; k < 3; k++) {
                result[k] = scale * d[k];
                result[4 + k] = 0.5 * d[k];
            }
            result[3] = scale * depth;
            return;
        }
    }
    size = sqrt(q[0][0] + q[0][1] + q[0][2]) + sqrt(q[1][0] + q[1][1] + q[1][2]);
    small = 1e-9 * size;
    distance = sqrt(squared < 1e-36 ? 1e-36 : squared);
    noise = 1e-15 * (size + distance);
    for (k = 0; k < 3; k++)
        line[k] = distance < small ? (k == 0 ? 1.0 : 0.0) : 1.0 / distance * d[k];
    bryant_overlap_start(q, line, n);
    bryant_overlap_along(q, d, n, &now);
    ended = early && now.depth < 0.0;
    for (steps = 0; steps < 60 && !ended; steps++) {
        double step[3], stiff, limit = 1.0;
        bryant_overlap_step(q, d, &now, damping, small, step, &squared, &stiff);
        if (!(squared < 0.5 * 0.5))
            limit = 0.5 / sqrt(squared < 0.5 * 0.5 ? 0.5 * 0.5 : squared);
        for (k = 0; k < 3; k++)
            n[k] = now.n[k] + limit * step[k];
        bryant_overlap_along(q, d, n, &then);
        /* uphill, by more than rounding makes of it */
        if (now.depth + noise < then.depth) {
            const double more = 8.0 * damping, least = 0.1 * stiff;
            damping = more < least ? least : more;
        } else {
            const double kept = 0.1 * damping, less = kept - 1e-3 * stiff;
            damping = less < 0.0 ? 0.0 : less;
            now = then;
        }
        ended = !(1e-9 * 1e-9 < squared) || (early && now.depth < 0.0);
    }
    half = -0.5 * now.depth;
    for (k = 0; k < 3; k++) {
        result[k] = now.scale * now.n[k];
        result[4 + k] = now.u[0][k] + half * result[k];
    }
    result[3] = now.depth;
}
