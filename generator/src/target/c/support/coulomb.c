/* Friction force or torque: -limit clamp(speed / tolerance, -1, 1). */
static double bryant_coulomb(double limit, double speed, double tolerance)
{
    double share = speed / tolerance;
    share = share < -1.0 ? -1.0 : share;
    share = 1.0 < share ? 1.0 : share;
    return -(limit * share);
}
