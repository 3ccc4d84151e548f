/* Force of a contact or a belt [N]: max(0, elastic + viscous) where the penetration [m] or elongation is positive, 0 elsewhere. */
static double bryant_normal_force(double penetration, double elastic, double viscous)
{
    double force = elastic + viscous;
    force = force < 0.0 ? 0.0 : force;
    return 0.0 < penetration ? force : penetration - penetration;
}
