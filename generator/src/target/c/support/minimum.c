/* The smaller one; a where either is NaN. */
static double bryant_minimum(double a, double b)
{
    return b < a ? b : a;
}
