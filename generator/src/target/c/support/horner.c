/* c[0] + c[1] z + ... + c[count - 1] z^(count - 1) */
static double bryant_horner(double z, const double *c, int count)
{
    double sum = c[count - 1];
    int i;
    for (i = count - 2; i >= 0; i--)
        sum = MULTIPLY_ADD(sum, z, c[i]);
    return sum;
}
