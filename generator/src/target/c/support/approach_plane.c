/* How deep two ellipses overlap in the plane x-z, and along which direction: the smallest phi(n) = h1(n) + h2(n) - n d with
   h = sqrt(n Q n), by Halley's iteration for the angle of n. A matrix is xx, zz, xz. */
struct bryant_overlap_plane {
    /* n, of any length, n^2, phi with its derivatives by the angle, and Q1 n / h1 */
    double n[2], squared, depth, slope, curvature, third, u[2];
};

static double bryant_dot_plane(const double a[2], const double b[2])
{
    return MULTIPLY_ADD(a[0], b[0], a[1] * b[1]);
}

static void bryant_times_plane(const double q[3], const double a[2], double result[2])
{
    result[0] = MULTIPLY_ADD(q[0], a[0], q[2] * a[1]);
    result[1] = MULTIPLY_ADD(q[2], a[0], q[1] * a[1]);
}

/* n Q n */
static double bryant_product_plane(const double q[3], const double n[2])
{
    double stretched[2];
    bryant_times_plane(q, n, stretched);
    return bryant_dot_plane(n, stretched);
}

static void bryant_overlap_along_plane(double q[2][3], const double d[2], const double n[2], struct bryant_overlap_plane *o)
{
    const double across[2] = {-n[1], n[0]};
    double reach[2], turning[2], bend[2], radius[2], grows[2], length, grown, sum;
    int i;
    o->n[0] = n[0];
    o->n[1] = n[1];
    o->squared = bryant_dot_plane(n, n);
    length = o->squared * o->squared;
    for (i = 0; i < 2; i++) {
        const double flat = q[i][0] * q[i][1] - q[i][2] * q[i][2];
        double stretched[2], square, inverse;
        bryant_times_plane(q[i], n, stretched);
        square = bryant_dot_plane(n, stretched);
        turning[i] = bryant_dot_plane(across, stretched);
        reach[i] = sqrt(square);
        inverse = 1.0 / square;
        bend[i] = reach[i] * inverse;
        radius[i] = flat * bend[i] * inverse * length;
        grows[i] = turning[i] * inverse;
        if (i == 0) {
            o->u[0] = bend[0] * stretched[0];
            o->u[1] = bend[0] * stretched[1];
        }
    }
    o->depth = reach[0] + reach[1] - bryant_dot_plane(n, d);
    sum = MULTIPLY_ADD(turning[0], bend[0], turning[1] * bend[1]);
    o->slope = sum - bryant_dot_plane(across, d);
    grown = MULTIPLY_ADD(radius[0], grows[0], radius[1] * grows[1]);
    o->curvature = radius[0] + radius[1] - o->depth;
    o->third = MULTIPLY_ADD(-3.0, grown, -o->slope);
}

/* The tangent of the angle of Halley's step, at most the longest; downhill where phi is not convex. */
static double bryant_halley(const struct bryant_overlap_plane *o, double small)
{
    const double half = -0.5 * o->slope;
    double below = MULTIPLY_ADD(o->curvature, o->curvature, half * o->third), above, tangent;
    if (0.0 < o->curvature && 0.0 < below) {
        above = o->slope * o->curvature;
    } else {
        above = 0.5 * o->slope;
        below = fabs(o->slope) < small ? small : fabs(o->slope);
    }
    tangent = -(above / below);
    tangent = tangent < -0.5 ? -0.5 : tangent;
    return 0.5 < tangent ? 0.5 : tangent;
}

/* Of the matrices of both [m^2] and the vector d from the first centre to the second [m]: n, phi, and the vector from the first centre to
   the middle between the two points that are furthest along n. With `early`, of bodies that do not touch, n is the normal of any
   line between them. */
static void bryant_approach_plane(const double argument[8], int early, double result[5])
{
    double q[2][3], d[2], line[2], n[2], normal[2], bend[2], m[3], size, small, distance, squared, scale, half, before = INFINITY;
    /* where the slope of phi was last negative, and where not */
    double side[2][2] = {{0.0, 0.0}, {0.0, 0.0}};
    struct bryant_overlap_plane now;
    int i, k, ended, steps;
    for (i = 0; i < 2; i++)
        for (k = 0; k < 3; k++)
            q[i][k] = argument[3 * i + k];
    d[0] = argument[6];
    d[1] = argument[7];
    squared = bryant_dot_plane(d, d);
    if (early) {
        const double reach = sqrt(bryant_product_plane(q[0], d)) + sqrt(bryant_product_plane(q[1], d)), depth = reach - squared;
        if (depth < 0.0) {
            scale = 1.0 / sqrt(squared);
            result[0] = scale * d[0];
            result[1] = scale * d[1];
            result[2] = scale * depth;
            result[3] = 0.5 * d[0];
            result[4] = 0.5 * d[1];
            return;
        }
    }
    size = sqrt(q[0][0] + q[0][1]) + sqrt(q[1][0] + q[1][1]);
    small = 1e-9 * size;
    distance = sqrt(squared < 1e-36 ? 1e-36 : squared);
    for (k = 0; k < 2; k++)
        line[k] = distance < small ? (k == 0 ? 1.0 : 0.0) : 1.0 / distance * d[k];
    for (i = 0; i < 2; i++)
        bend[i] = 1.0 / sqrt(bryant_product_plane(q[i], line));
    for (k = 0; k < 3; k++)
        m[k] = MULTIPLY_ADD(bend[0], q[0][k], bend[1] * q[1][k]);
    {
        const double adjugate[3] = {m[1], m[0], -m[2]};
        bryant_times_plane(adjugate, line, normal);
    }
    scale = 1.0 / sqrt(bryant_dot_plane(normal, normal));
    n[0] = scale * normal[0];
    n[1] = scale * normal[1];
    bryant_overlap_along_plane(q, d, n, &now);
    ended = early && now.depth < 0.0;
    for (steps = 0; steps < 60 && !ended; steps++) {
        const int falls = now.slope < 0.0;
        const double *other = falls ? side[1] : side[0];
        const double steep = fabs(now.slope);
        double tangent, turn;
        int at_end, slow;
        side[falls ? 0 : 1][0] = now.n[0];
        side[falls ? 0 : 1][1] = now.n[1];
        tangent = bryant_halley(&now, small);
        at_end = !(1e-7 * 1e-7 < tangent * tangent);
        slow = 0.5 * before < steep && !at_end;
        before = steep;
        n[0] = MULTIPLY_ADD(-tangent, now.n[1], now.n[0]);
        n[1] = MULTIPLY_ADD(tangent, now.n[0], now.n[1]);
        /* beyond the other end, which lies in the sense of the step */
        turn = n[0] * other[1] - n[1] * other[0];
        if (0.0 < bryant_dot_plane(other, other) && (slow || (falls ? turn : -turn) < 0.0)) {
            n[0] = now.n[0] + other[0];
            n[1] = now.n[1] + other[1];
        }
        bryant_overlap_along_plane(q, d, n, &now);
        ended = at_end || (early && now.depth < 0.0);
    }
    scale = 1.0 / sqrt(now.squared);
    result[0] = scale * now.n[0];
    result[1] = scale * now.n[1];
    result[2] = scale * now.depth;
    half = -0.5 * result[2];
    result[3] = MULTIPLY_ADD(half, result[0], now.u[0]);
    result[4] = MULTIPLY_ADD(half, result[1], now.u[1]);
}
