/* `then` where a < b, `otherwise` elsewhere; NaN where either is not finite and the comparison fails. */
static double bryant_choose(double a, double b, double then, double otherwise)
{
    return a < b ? then : otherwise + ((a - a) + (b - b));
}
