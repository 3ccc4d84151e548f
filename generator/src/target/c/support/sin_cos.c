/* a + b = sum + error, exactly (Knuth). */
static double bryant_sum(double a, double b, double *error)
{
    const double sum = a + b, of_b = sum - a;
    *error = (a - (sum - of_b)) + (b - of_b);
    return sum;
}

/* a as a sum of two numbers of 26 bits (Veltkamp). */
static double bryant_half(double a, double *rest)
{
    const double shifted = 134217729.0 * a, half = shifted - (shifted - a);
    *rest = a - half;
    return half;
}

/* What whole quarter turns leave of |x| >= 65536 [rad], as a sum of two numbers, and how many they are, modulo 4 (Payne and Hanek 1983):
   of 2/pi the 256 bits are taken from where they change x 2/pi modulo 4. */
static int bryant_quarter_turns(double x, double rest[2])
{
    /* 2/pi: the 64 bits before the point, and 1280 bits after it */
    static const unsigned long table[44] = {
        0x0UL, 0x0UL, 0xa2f9836eUL, 0x4e441529UL, 0xfc2757d1UL, 0xf534ddc0UL, 0xdb629599UL, 0x3c439041UL,
        0xfe5163abUL, 0xdebbc561UL, 0xb7246e3aUL, 0x424dd2e0UL, 0x06492eeaUL, 0x09d1921cUL, 0xfe1deb1cUL, 0xb129a73eUL,
        0xe88235f5UL, 0x2ebb4484UL, 0xe99c7026UL, 0xb45f7e41UL, 0x3991d639UL, 0x835339f4UL, 0x9c845f8bUL, 0xbdf9283bUL,
        0x1ff897ffUL, 0xde05980fUL, 0xef2f118bUL, 0x5a0a6d1fUL, 0x6d367ecfUL, 0x27cb09b7UL, 0x4f463f66UL, 0x9e5fea2dUL,
        0x7527bac7UL, 0xebe5f17bUL, 0x3d0739f7UL, 0x8a5292eaUL, 0x6bfb5fb1UL, 0x1f8d5d08UL, 0x56033046UL, 0xfc7b6babUL,
        0xf0cfbc20UL, 0x9af4361dUL, 0x0UL, 0x0UL};
    unsigned long long product[8], low, high, carry;
    double fraction = 0.0, small = 0.0, unit = 1.0, sum, error, error_2, high_1, low_1, high_2, low_2;
    const double quarter = 1.5707963267948966, rest_of_quarter = 6.123233995736766e-17;
    int exponent, start, i, quarters, above;
    const double mantissa = frexp(fabs(x), &exponent);
    const unsigned long long m = (unsigned long long)ldexp(mantissa, 53);
    /* |x| = m 2^(exponent - 53) */
    start = exponent + 9 < 0 ? 0 : exponent + 9;
    low = m & 0xffffffffULL;
    high = m >> 32;
    for (i = 0; i < 8; i++) {
        const int word = start / 32 + i, shift = start % 32;
        const unsigned long long first = word < 44 ? table[word] : 0, next = word + 1 < 44 ? table[word + 1] : 0;
        product[i] = ((first << 32 | next) << shift >> 32) & 0xffffffffULL;
    }
    /* times m, modulo 2^256, the last word first */
    {
        unsigned long long window[8];
        carry = 0;
        for (i = 7; i >= 0; i--) {
            window[i] = product[i];
            carry += low * window[i];
            product[i] = carry & 0xffffffffULL;
            carry >>= 32;
        }
        carry = 0;
        for (i = 6; i >= 0; i--) {
            carry += high * window[i + 1] + product[i];
            product[i] = carry & 0xffffffffULL;
            carry >>= 32;
        }
    }
    /* two bits before the point, and the fraction; above a half, it is one quarter turn less the complement */
    quarters = (int)(product[0] >> 30);
    for (i = 0; i < 8; i++)
        product[i] = (product[i] << 2 | (i < 7 ? product[i + 1] >> 30 : 0)) & 0xffffffffULL;
    above = (int)(product[0] >> 31);
    for (i = 0; i < 8; i++) {
        const double part = (double)(above ? product[i] ^ 0xffffffffULL : product[i]);
        unit *= 1.0 / 4294967296.0;
        sum = bryant_sum(fraction, part * unit, &error);
        error += small;
        fraction = sum + error;
        small = error - (fraction - sum);
    }
    sum = fraction * quarter;
    high_1 = bryant_half(fraction, &low_1);
    high_2 = bryant_half(quarter, &low_2);
    error = ((high_1 * high_2 - sum) + high_1 * low_2 + low_1 * high_2) + low_1 * low_2;
    error_2 = error + (fraction * rest_of_quarter + small * quarter);
    rest[0] = sum + error_2;
    rest[1] = error_2 - (rest[0] - sum);
    if (above) {
        quarters++;
        rest[0] = -rest[0];
        rest[1] = -rest[1];
    }
    if (x < 0.0) {
        quarters = -quarters;
        rest[0] = -rest[0];
        rest[1] = -rest[1];
    }
    return quarters & 3;
}

/* Sine and cosine of x [rad], within a unit in the last place; NaN where x is not finite. Products and sums are rounded as those of the equations, so
   that the bits are the same on every platform. */
static void bryant_sin_cos(double x, double *sine, double *cosine)
{
    const double round = 6755399441055744.0;
    const double turned = MULTIPLY_ADD(x, 0.63661977236758138, round);
    const double k = turned - round;
    const double first = MULTIPLY_ADD(-k, 1.5707963267923333, x), second = k * 2.5633441515839558e-12;
    double hi = first - second;
    double low = MULTIPLY_ADD(k, 1.0562999066987428e-23, hi - first + second);
    double r2, s, c, large, lost, of_sine, of_cosine;
    int quarters = 0;
    if (fabs(x) < 65536.0) {
        quarters = (int)k & 3;
    } else if (fabs(x) <= 1.7976931348623157e308) {
        double rest[2];
        quarters = bryant_quarter_turns(x, rest);
        hi = rest[0];
        low = -rest[1];
    }
    r2 = hi * hi;
    s = 1.58969099521155e-10;
    s = MULTIPLY_ADD(s, r2, -2.5050760253406863e-8);
    s = MULTIPLY_ADD(s, r2, 2.7557313707070068e-6);
    s = MULTIPLY_ADD(s, r2, -0.0001984126982985795);
    s = MULTIPLY_ADD(s, r2, 0.00833333333332249);
    s = MULTIPLY_ADD(s, r2, -0.16666666666666632);
    of_sine = hi - MULTIPLY_ADD(hi * r2, -s, low);
    c = -1.1359647557788195e-11;
    c = MULTIPLY_ADD(c, r2, 2.087572321298175e-9);
    c = MULTIPLY_ADD(c, r2, -2.7557314351390663e-7);
    c = MULTIPLY_ADD(c, r2, 2.480158728947673e-5);
    c = MULTIPLY_ADD(c, r2, -0.001388888888887411);
    c = MULTIPLY_ADD(c, r2, 0.0416666666666666);
    /* 1 - r^2 / 2 with what its rounding took away */
    large = MULTIPLY_ADD(r2, -0.5, 1.0);
    lost = MULTIPLY_ADD(r2, -0.5, 1.0 - large);
    of_cosine = large + MULTIPLY_ADD(r2 * r2, c, MULTIPLY_ADD(hi, low, lost));
    *sine = quarters & 1 ? of_cosine : of_sine;
    *cosine = quarters & 1 ? of_sine : of_cosine;
    if (quarters & 2)
        *sine = -*sine;
    if ((quarters + 1) & 2)
        *cosine = -*cosine;
}
