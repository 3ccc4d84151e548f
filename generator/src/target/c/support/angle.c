/* The angle of the point (x, y) [rad], in [-pi, pi], within two units in the last place. Signs of zeros count. The method and the bits are those of
   Rust, on every platform: of the shorter coordinate and the longer one, t = short / long up to a half, and (short - long) / (short + long) beyond. */
static double bryant_angle(double y, double x)
{
    static const double c[13] = {
        -0.3333333333333333, 0.19999999999999485, -0.14285714285598292, 0.11111111100846038, -0.0909090861740441,
        0.07692294642346584, -0.06666434610072569, 0.05879567778394658, -0.052400287643869586, 0.04627715206833518,
        -0.038057958199378225, 0.02499287662220333, -0.009206337670391992};
    const double up = fabs(y), right = fabs(x), far = 0x1p900, largest = 1.7976931348623157e308;
    const int steep = right < up, left = signbit(x) != 0;
    double short_one = steep ? right : up, long_one = steep ? up : right;
    double above, below, below_rest, inverse, t, rest, z, tail, eighths, first, large, lost, angle;
    int beyond;
    if (!(1.0 / far < long_one && long_one < far)) {
        /* another point in the same direction, whose coordinates have reciprocals */
        const int infinite = largest < long_one;
        double scale;
        if (infinite)
            short_one = largest < short_one ? 1.0 : short_one * 0.0;
        if (infinite || long_one < 4.9406564584124654e-324)
            long_one = 1.0;
        scale = long_one < 1.0 / far ? 0x1p600 : far < long_one ? 0x1p-600 : 1.0;
        short_one = short_one * scale;
        long_one = long_one * scale;
    }
    beyond = long_one * 0.5 < short_one;
    above = beyond ? short_one - long_one : short_one;
    below = beyond ? short_one + long_one : long_one;
    below_rest = beyond ? short_one - (below - long_one) : 0.0;
    inverse = 1.0 / below;
    t = above * inverse;
    rest = MULTIPLY_ADD(-t, below, above);
    rest = MULTIPLY_ADD(-t, below_rest, rest);
    z = t * t;
    tail = MULTIPLY_ADD(t * z, bryant_horner(z, c, 13), rest * inverse);
    /* the other eighth, quarter and half */
    eighths = beyond ? 1.0 : 0.0;
    eighths = steep ? 2.0 - eighths : eighths;
    eighths = left ? 4.0 - eighths : eighths;
    if (steep != left) {
        t = -t;
        tail = -tail;
    }
    first = eighths * 0.7853981633974456;
    large = first + t;
    lost = first - large + t;
    angle = large + (lost + MULTIPLY_ADD(eighths, 2.6951514290790595e-15, tail));
    return signbit(y) ? -angle : angle;
}
