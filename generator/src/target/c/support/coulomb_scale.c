/* The factor s of a friction force -s v: limit / sqrt(max(v^2, tolerance^2)) [N s/m]. */
static double bryant_coulomb_scale(double limit, double speed_squared, double tolerance)
{
    const double least = tolerance * tolerance;
    return limit / sqrt(speed_squared < least ? least : speed_squared);
}
