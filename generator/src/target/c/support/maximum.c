/* The larger one; a where either is NaN. */
static double bryant_maximum(double a, double b)
{
    return a < b ? b : a;
}
