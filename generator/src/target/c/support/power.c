/* The bits of a number, and the number with these bits. */
static unsigned long long bryant_bits(double x)
{
    unsigned long long bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static double bryant_of_bits(unsigned long long bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* The first 26 bits of a. */
static double bryant_head(double a)
{
    return bryant_of_bits(bryant_bits(a) & 0xfffffffff8000000ULL);
}

/* The logarithm of a positive finite number, to 65 bits, as a sum of two numbers of which the first has 26 bits. */
static double bryant_logarithm(double x, double *rest)
{
    static const double c[8] = {0.2, 0.14285714285714682, 0.11111111110828116, 0.09090909167657202,
                                0.07692297485447729, 0.06667402119112673, 0.05853124270461193, 0.058615255140488765};
    const int subnormal = x < 2.2250738585072014e-308;
    const unsigned long long bits = bryant_bits(subnormal ? x * 0x1p54 : x);
    /* x = 2^k m with m from the root of 1/2 to that of 2 */
    const unsigned long long raised = bits + (0x3ff0000000000000ULL - 0x3fe6a09e667f3bcdULL);
    const double k = (double)(raised >> 52 & 0xfff) - (subnormal ? 1077.0 : 1023.0);
    const double m = bryant_of_bits(bits - (raised & 0xfff0000000000000ULL) + 0x3ff0000000000000ULL);
    const double f = m - 1.0, inverse = 1.0 / (m + 1.0);
    const double d = bryant_head(m + 1.0), d_rest = m - (d - 1.0);
    const double s = bryant_head(f * inverse);
    const double left = MULTIPLY_ADD(-s, d_rest, MULTIPLY_ADD(-s, d, f)), s_rest = left * inverse;
    const double square = s * s, z = bryant_head(square), z_rest = square - z + s_rest * (s + s + s_rest);
    const double whole = z + z_rest, zq = whole * bryant_horner(whole, c, 8), third = 1.0 / 3.0;
    const double factor = bryant_head(third + zq), factor_rest = third - factor + zq + 1.850371707708594e-17;
    const double product = z * factor, product_rest = MULTIPLY_ADD(z, factor_rest, z_rest * (factor + factor_rest));
    const double w = bryant_head(product), w_rest = product - w + product_rest;
    const double more = s * w, more_rest = MULTIPLY_ADD(s, w_rest, s_rest * (w + w_rest));
    const double half = s + more, half_rest = s - half + more + (s_rest + more_rest);
    const double turned = k * 0.693147180559663, large = turned + (half + half);
    const double lost = turned - large + (half + half);
    const double small = lost + MULTIPLY_ADD(k, 2.8235290563031577e-13, half_rest + half_rest);
    const double log = bryant_head(large + small);
    *rest = large - log + small;
    return log;
}

/* e^(x + more), where more is at most a unit in the last place of x. */
static double bryant_exponential(double x, double more)
{
    static const double c[11] = {
        0.5, 0.1666666666666667, 0.04166666666666667, 0.008333333333326084, 0.0013888888888883711, 0.0001984126987500228,
        2.480158732567746e-5, 2.755725517000089e-6, 2.755727347871858e-7, 2.5105312729622103e-8, 2.09147553258932e-9};
    double shifted, k, first, second, r, low, large, lost, tail, result;
    int n, half;
    if (x != x)
        return x;
    x = x < -746.0 ? -746.0 : x;
    x = 710.0 < x ? 710.0 : x;
    shifted = MULTIPLY_ADD(x, 1.4426950408889634, 6755399441055744.0);
    k = shifted - 6755399441055744.0;
    first = MULTIPLY_ADD(-k, 0.693147180559663, x);
    second = MULTIPLY_ADD(k, 2.8235290563031577e-13, -more);
    r = first - second;
    low = r - first + second;
    large = r + 1.0;
    lost = r - (large - 1.0);
    tail = MULTIPLY_ADD(r * r, bryant_horner(r, c, 11), -low);
    result = large + (lost + tail);
    /* 2^k in two factors, so that the result may be subnormal or infinite */
    n = (int)k + 2046;
    half = n >> 1;
    return result * ldexp(1.0, half - 1023) * ldexp(1.0, n - half - 1023);
}

/* x^y, within a unit in the last place; zeros, infinities, NaN and negative numbers as in the C standard. The bits are those of Rust, on every
   platform. */
static double bryant_power(double x, double y)
{
    const double limit = 0x1p66, infinity = INFINITY, size = fabs(x);
    double limited = y < -limit ? -limit : y, log, log_rest, power, power_rest, exact, rest, sum, lost, result;
    int is_small, is_whole, is_odd;
    limited = limit < limited ? limit : limited;
    log = bryant_logarithm(size, &log_rest);
    power = bryant_head(limited);
    power_rest = limited - power;
    exact = power * log;
    rest = MULTIPLY_ADD(power, log_rest, power_rest * (log + log_rest));
    sum = exact + rest;
    lost = exact - sum + rest;
    result = bryant_exponential(sum, fabs(sum) < 1000.0 ? lost : 0.0);
    if (0.0 < x && x < infinity && fabs(y) < infinity)
        return result;
    if (y == 0.0 || x == 1.0)
        return 1.0;
    if (x != x || y != y)
        return NAN;
    if (x == 0.0 || size == infinity)
        result = (x == 0.0) == (y > 0.0) ? 0.0 : infinity;
    /* from 2^53 on, every number is even */
    is_small = fabs(y) < 9007199254740992.0;
    is_whole = !is_small || (double)(long long)y == y;
    is_odd = is_small && is_whole && ((long long)y & 1);
    if (!signbit(x))
        return result;
    if (is_odd)
        return -result;
    return is_whole || x == 0.0 || size == infinity ? result : NAN;
}
