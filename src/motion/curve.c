/* Extremes are computed over 0 <= t <= 1, where the coefficients of a polynomial and of its derivatives are of the same
 * size whatever the units are. */
#include <math.h>

#include "core/extreme.h"
#include "motion/curve.h"
#include "motion/pieces.h"

enum { DEGREE = 5, STOPS_MAX = DEGREE + 1 };

bool cm1e_curve_between(cm1e_curve_t *curve, double from, const cm1e_curve_point_t *first, double to,
                        const cm1e_curve_point_t *last)
{
    const bool backwards = to < from;
    const cm1e_curve_point_t *a = backwards ? last : first, *b = backwards ? first : last;
    const double h = fabs(to - from), curvature = a->curvature / 2;
    /* What the parabola that the curve begins with leaves to be done, each as a slope. */
    const double way = (b->position - a->position) / h - a->slope - curvature * h;
    const double slope = b->slope - a->slope - a->curvature * h;
    const double bend = (b->curvature - a->curvature) * h / 2;
    *curve = (cm1e_curve_t){
        .from = smaller(from, to),
        .length = h,
        .coefficient = {a->position, a->slope, curvature, (10 * way - 4 * slope + bend) / (h * h),
                        (-15 * way + 7 * slope - 2 * bend) / (h * h * h),
                        (6 * way - 3 * slope + bend) / (h * h * h * h)},
    };
    double sum = from + to;
    for (int i = 0; i <= DEGREE; i++)
        sum += fabs(curve->coefficient[i]);
    return h > 0 && isfinite(sum);
}

static double value(const double *polynomial, int degree, double t)
{
    double sum = polynomial[degree];
    for (int i = degree - 1; i >= 0; i--)
        sum = sum * t + polynomial[i];
    return sum;
}

/** Between a and b, where the polynomial has different signs and its derivative one. Newton's steps, halved intervals
 *  where they lead out of them. */
static double root(const double *polynomial, const double *derivative, int degree, double a, double b)
{
    const bool rises = value(polynomial, degree, a) < 0;
    double t = (a + b) / 2;
    for (int i = 0; i < 60 && b - a > 1e-15; i++) {
        const double here = value(polynomial, degree, t);
        if ((here < 0) == rises)
            a = t;
        else
            b = t;
        const double next = t - here / value(derivative, degree - 1, t);
        const double last = t;
        t = next > a && next < b ? next : (a + b) / 2;
        if (fabs(t - last) < 1e-14)
            break;
    }
    return t;
}

/** Where a polynomial changes its sign, with the ends, in their order; `stops` are those of its derivative, so it is
 *  monotonic between them. */
static int sign_changes(const double *polynomial, const double *derivative, int degree, const double *stops, int count,
                        double *changes)
{
    int found = 0;
    changes[found++] = 0;
    for (int i = 0; i + 1 < count; i++)
        if (value(polynomial, degree, stops[i]) * value(polynomial, degree, stops[i + 1]) < 0)
            changes[found++] = root(polynomial, derivative, degree, stops[i], stops[i + 1]);
    changes[found++] = 1;
    return found;
}

static void range(const double *polynomial, int degree, const double *stops, int count, double *lowest,
                  double *highest)
{
    *lowest = INFINITY;
    *highest = -INFINITY;
    for (int i = 0; i < count; i++) {
        const double here = value(polynomial, degree, stops[i]);
        *lowest = smaller(*lowest, here);
        *highest = larger(*highest, here);
    }
}

void cm1e_curve_extremes(const cm1e_curve_t *curve, cm1e_curve_extremes_t *extremes)
{
    double p[DEGREE + 1][DEGREE + 1]; /* derivative by derivative */
    double power = 1;
    for (int i = 0; i <= DEGREE; i++, power *= curve->length)
        p[0][i] = curve->coefficient[i] * power;
    for (int k = 1; k <= DEGREE; k++)
        for (int i = 0; i <= DEGREE - k; i++)
            p[k][i] = p[k - 1][i + 1] * (i + 1);

    double stops[STOPS_MAX] = {0, 1}, changes[STOPS_MAX], lowest[DEGREE], highest[DEGREE];
    int count = 2;
    for (int k = DEGREE - 1; k >= 0; k--) { /* from the straight line up */
        range(p[k], DEGREE - k, stops, count, &lowest[k], &highest[k]);
        if (k == 0)
            break; /* its own changes are not needed, and there is no room for five of them */
        count = sign_changes(p[k], p[k + 1], DEGREE - k, stops, count, changes);
        for (int i = 0; i < count; i++)
            stops[i] = changes[i];
    }
    const double h = curve->length;
    *extremes = (cm1e_curve_extremes_t){
        .lowest = lowest[0],
        .highest = highest[0],
        .least_slope = lowest[1] / h,
        .most_slope = highest[1] / h,
        .curvature = larger(fabs(lowest[2]), fabs(highest[2])) / (h * h),
        .third = larger(fabs(lowest[3]), fabs(highest[3])) / (h * h * h),
    };
}

bool cm1e_curve_point_of(cm1e_curve_point_t *point, const cm1e_motion_state_t *slave, double velocity,
                         double acceleration)
{
    *point = (cm1e_curve_point_t){.position = slave->position};
    if (slave->velocity == 0 && slave->acceleration == 0)
        return true;
    point->slope = slave->velocity / velocity;
    point->curvature = (slave->acceleration - point->slope * acceleration) / (velocity * velocity);
    return cm1e_motion_is_number(point->slope) && cm1e_motion_is_number(point->curvature);
}
