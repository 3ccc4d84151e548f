/* A function through points (x, y): straight lines, or cubics y_k + m s + c2 s^2 + c3 s^3 with s = x - x_k. Piece 0 lies left of the
   first point, piece k + 1 right of point k. */
struct bryant_curve {
    int points;
    /* whether it must not be left: it is NaN outside then */
    int bounded;
    /* whether its outermost pieces go on as lines; otherwise its outermost values stay */
    int goes_on;
    const double *x, *y;
    /* by piece; c2 and c3 are NULL of lines */
    const double *m, *c2, *c3;
    /* by point: the integral and the double integral from the first point */
    const double *once, *twice;
    /* the abscissae at which it is not smooth */
    int kinks;
    const double *kink;
};
