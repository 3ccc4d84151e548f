/* How many of these increasing numbers are not above x: the piece of a curve that x lies in. */
static int bryant_curve_piece(const double *numbers, int count, double x)
{
    int first = 0, last = count;
    while (first < last) {
        const int middle = (first + last) / 2;
        if (x < numbers[middle])
            last = middle;
        else
            first = middle + 1;
    }
    return first;
}
