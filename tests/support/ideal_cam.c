#include "ideal_cam.h"

/** Solves a[n][n] x = b, in place; the matrix has a strong diagonal. */
static void ideal_solve(long double a[IDEAL_POINTS][IDEAL_POINTS], long double *b, int n)
{
    for (int i = 0; i < n; i++)
        for (int row = i + 1; row < n; row++) {
            const long double part = a[row][i] / a[i][i];
            for (int column = i; part != 0 && column < n; column++)
                a[row][column] -= part * a[i][column];
            b[row] -= part * b[i];
        }
    for (int i = n - 1; i >= 0; i--) {
        for (int column = i + 1; column < n; column++)
            b[i] -= a[i][column] * b[column];
        b[i] /= a[i][i];
    }
}

static long double ideal_width(const ideal_cam_t *cam, int i)
{
    return (long double)cam->points[i + 1].Master - (long double)cam->points[i].Master;
}

static long double ideal_slope(const ideal_cam_t *cam, int i)
{
    return ((long double)cam->points[i + 1].Slave - (long double)cam->points[i].Slave) / ideal_width(cam, i);
}

/** Slope and curvature continuous at every inner point; none of the latter at the ends, or, periodic, both the same. */
static void ideal_spline(ideal_cam_t *cam)
{
    static long double a[IDEAL_POINTS][IDEAL_POINTS];
    const int n = cam->count, last = n - 2;
    long double b[IDEAL_POINTS] = {0};
    memset(a, 0, sizeof a);
    for (int i = 1; i <= n - 2; i++) {
        a[i][i - 1] = ideal_width(cam, i - 1);
        a[i][i] = 2 * (ideal_width(cam, i - 1) + ideal_width(cam, i));
        a[i][i + 1] = ideal_width(cam, i);
        b[i] = 6 * (ideal_slope(cam, i) - ideal_slope(cam, i - 1));
    }
    a[0][0] = a[n - 1][n - 1] = 1;
    if (cam->periodic && n > 2) { /* the last point is the first one again */
        a[0][0] = 2 * (ideal_width(cam, last) + ideal_width(cam, 0));
        a[0][1] += ideal_width(cam, 0);
        a[0][last] += ideal_width(cam, last);
        b[0] = 6 * (ideal_slope(cam, 0) - ideal_slope(cam, last));
        a[last][n - 1] = 0;
        a[last][0] += ideal_width(cam, last);
        ideal_solve(a, b, n - 1);
        b[n - 1] = b[0];
    } else {
        ideal_solve(a, b, n);
    }
    memcpy(cam->curvature, b, sizeof b);
}

void ideal_cam_init(ideal_cam_t *cam, const MC_CAM_REF *table, bool periodic)
{
    memset(cam, 0, sizeof *cam);
    memcpy(cam->points, table->Points, table->NumberOfPoints * sizeof cam->points[0]);
    cam->count = table->NumberOfPoints;
    cam->curve = table->Curve;
    cam->periodic = periodic;
    if (cam->curve == mcCamCubicSpline)
        ideal_spline(cam);
}

static long double ideal_between(const ideal_cam_t *cam, int i, long double x)
{
    const MC_CAM_POINT *p = &cam->points[i], *q = p + 1;
    const long double h = ideal_width(cam, i), t = (x - (long double)p->Master) / h, u = 1 - t;
    const long double s0 = p->Slave, s1 = q->Slave;
    if (cam->curve == mcCamLinear)
        return s0 * u + s1 * t;
    if (cam->curve == mcCamCubicSpline)
        return s0 * u + s1 * t +
               h * h / 6 * (cam->curvature[i] * (u * u * u - u) + cam->curvature[i + 1] * (t * t * t - t));
    /* Bernstein: the control points that value, slope and curvature at either end make */
    const long double v0 = h * p->Velocity, v1 = h * q->Velocity;
    const long double a0 = h * h * p->Acceleration, a1 = h * h * q->Acceleration;
    const long double c[6] = {s0, s0 + v0 / 5, s0 + 2 * v0 / 5 + a0 / 20, s1 - 2 * v1 / 5 + a1 / 20, s1 - v1 / 5, s1};
    static const int binomial[6] = {1, 5, 10, 10, 5, 1};
    long double sum = 0;
    for (int k = 0; k < 6; k++)
        sum += binomial[k] * powl(t, k) * powl(u, 5 - k) * c[k];
    return sum;
}

long double ideal_cam_at(const ideal_cam_t *cam, long double x)
{
    const long double first = cam->points[0].Master, last = cam->points[cam->count - 1].Master;
    long double advance = 0;
    if (cam->periodic) {
        const long double turns = floorl((x - first) / (last - first));
        x -= turns * (last - first);
        advance = turns * ((long double)cam->points[cam->count - 1].Slave - (long double)cam->points[0].Slave);
    }
    if (x <= first)
        return advance + (long double)cam->points[0].Slave;
    for (int i = 0; i < cam->count - 1; i++)
        if (x <= (long double)cam->points[i + 1].Master)
            return advance + ideal_between(cam, i, x);
    return advance + (long double)cam->points[cam->count - 1].Slave;
}
