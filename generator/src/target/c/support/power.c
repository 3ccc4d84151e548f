/* A base that is not negative, to a power. */
static double bryant_power(double base, double exponent)
{
    return pow(base, exponent);
}
