/* How far an ellipsoid of even degree n reaches along s = (x, y, z) [m], and where, with power = n / (n - 1):
   h = (sum |s_i|^power)^(1/power), then its derivatives by x, y, z. */
static void bryant_support(const double argument[4], double result[4])
{
    const double power = argument[3];
    double size[3], rest[3], largest, sum = 0.0, reach, scale;
    int i;
    for (i = 0; i < 3; i++)
        size[i] = fabs(argument[i]);
    largest = bryant_maximum(bryant_maximum(size[0], size[1]), size[2]);
    for (i = 0; i < 3; i++) {
        /* in parts of the largest, so that no power is too large or too small for a double */
        const double part = bryant_maximum(size[i] / largest, 1e-200);
        rest[i] = bryant_power(part, power - 1.0);
        sum = i == 0 ? part * rest[i] : sum + part * rest[i];
    }
    reach = bryant_power(sum, 1.0 / power);
    scale = reach / sum;
    result[0] = largest * reach;
    for (i = 0; i < 3; i++) {
        const double slope = rest[i] * scale;
        result[i + 1] = argument[i] < 0.0 ? -slope : slope;
    }
}
