/* How hard a master may brake whose slave is on a cam (cam.h).
 *
 * While the master brakes with a, its velocity after the way x is v^2 - 2ax. Where the slope of the cam is s, and its
 * curvature makes it flatter by k, the slave brakes with sa + k(v^2 - 2ax). That is at most `own` if
 *
 *     a (s - 2kx) <= own - kv^2
 *
 * The way is walked in steps from here to where the master stands. In each step the largest s and k count, and the x of
 * its beginning. So the bound is never too high. The way gets longer as the bound gets lower, until both fit. */
#include <math.h>

#include "core/extreme.h"
#include "motion/cam.h"

/* Steps: of the shortest way, and of the way so far. */
static const double part_of_way = 1.0 / 16.0;

/** Where the walk is, and what it has found. */
typedef struct walk {
    const cm1e_cam_t *cam;
    const cm1e_cam_braking_t *asked;
    bool forwards;
    int knot;              /**< the interval */
    double phase, way;     /**< of the master: from `start` of the cam, and since the walk began */
    double most, least;    /**< bounds of the deceleration; if they cross, none is known to be good */
} walk_t;

/** The range of a derivative of the curve in a step. */
typedef struct range {
    double low, high;
} range_t;

static double either(range_t range) { return larger(fabs(range.low), fabs(range.high)); }

static range_t range_of(const double *points, int count)
{
    range_t range = {points[0], points[0]};
    for (int i = 1; i < count; i++)
        range = (range_t){smaller(range.low, points[i]), larger(range.high, points[i])};
    return range;
}

/** Slope and curvature from `phase` on, over the distance h: a polynomial stays within its control points (Bernstein).
 *  */
static void ranges(const cm1e_curve_t *curve, double phase, double h, range_t *slope, range_t *curvature)
{
    const double *c = curve->coefficient, x = phase - curve->from;
    const cm1e_curve_point_t here = cm1e_curve_at(curve, phase);
    const double a = here.slope, b = here.curvature * h, d = here.third / 2 * h * h,
                 e = (4 * c[4] + 20 * c[5] * x) * h * h * h, f = 5 * c[5] * h * h * h * h;
    const double slopes[] = {a, a + b / 4, a + b / 2 + d / 6, a + b * 3 / 4 + d / 2 + e / 4, a + b + d + e + f};
    const double bends[] = {b / h, (b + d * 2 / 3) / h, (b + d * 4 / 3 + e) / h, (b + 2 * d + 3 * e + 4 * f) / h};
    *slope = range_of(slopes, 5);
    *curvature = range_of(bends, 4);
}

/** The largest curvature that makes the cam flatter on the way of the master; at least 0. */
static double flattening(const walk_t *w, range_t slope, range_t curvature)
{
    if (slope.low < 0 && slope.high > 0)
        return either(curvature);
    const bool rises = slope.high > 0 ? w->forwards : !w->forwards;
    return larger(0, rises ? -curvature.low : curvature.high);
}

/** The slave's view of the master may be a cycle old. */
static double certain_way(const walk_t *w) { return larger(0, w->way - fabs(w->asked->velocity) * w->asked->cycle_s); }

static void bound_in_step(walk_t *w, range_t slope, range_t curvature)
{
    const double v = w->asked->velocity, bend = flattening(w, slope, curvature);
    const double left = w->asked->own - bend * v * v, each = either(slope) - 2 * bend * certain_way(w);
    if (each > 0)
        w->most = smaller(w->most, left / each);
    else if (left < 0) /* braking hard enough, the master is slow there */
        w->least = larger(w->least, each < 0 ? left / each : INFINITY);
}

/** A corner takes the slave a step of its velocity in a cycle. */
static void bound_at_corner(walk_t *w, double before, double behind)
{
    const double steeper = larger(fabs(before), fabs(behind)), v = w->asked->velocity;
    const double drop = before * behind < 0 ? fabs(before - behind) : fabs(before) - fabs(behind);
    const double square = larger(0, v * v - 2 * w->asked->gentle * certain_way(w));
    if (drop > 0)
        w->most = smaller(w->most, (w->asked->own - drop * sqrt(square) / w->asked->cycle_s) / steeper);
}

/** The slope at an end of the interval, inside it. */
static double slope_at_end(const walk_t *w, bool upper)
{
    const bool own = !upper || w->cam->curve == mcCamLinear;
    return w->cam->knots[own ? w->knot : w->knot + 1].slope;
}

/** Goes on to the next interval. false: the cam ends here. */
static bool next_interval(walk_t *w)
{
    const int last = w->cam->count - 2, next = w->forwards ? w->knot + 1 : w->knot - 1;
    const bool over = next < 0 || next > last;
    const double before = slope_at_end(w, w->forwards);
    if (over && !w->cam->periodic) {
        bound_at_corner(w, before, 0);
        return false;
    }
    w->knot = !over ? next : w->forwards ? 0 : last;
    w->phase = w->cam->knots[w->forwards ? w->knot : w->knot + 1].master - w->cam->start;
    bound_at_corner(w, before, slope_at_end(w, !w->forwards));
    return true;
}

/** Where the master is. false: it does not come onto the cam (any more). */
static bool begin(walk_t *w)
{
    const cm1e_cam_t *cam = w->cam;
    cm1e_cam_place_t place = {0};
    cm1e_cam_sample_t here;
    cm1e_cam_sample(cam, &place, w->asked->master, &here);
    w->knot = place.knot;
    w->phase = here.phase;
    if (cam->periodic || here.turn == 0)
        return true;
    const bool behind = here.turn > 0;
    w->knot = behind ? cam->count - 2 : 0;
    w->way = fabs(w->asked->master - cam->start - here.phase);
    return behind != w->forwards;
}

/** Looks at the next step of the way. false: the cam has ended. */
static bool step(walk_t *w, double shortest)
{
    const cm1e_cam_knot_t *a = &w->cam->knots[w->knot];
    const double end = (w->forwards ? a[1].master : a[0].master) - w->cam->start;
    const double to_end = fabs(end - w->phase), h = smaller(to_end, part_of_way * larger(shortest, w->way));
    cm1e_curve_t curve;
    range_t slope, curvature;
    if (h > 0 && cm1e_cam_interval(w->cam, w->knot, &curve)) {
        ranges(&curve, w->forwards ? w->phase : w->phase - h, h, &slope, &curvature);
        bound_in_step(w, slope, curvature);
    }
    w->way += h;
    w->phase += w->forwards ? h : -h;
    return h < to_end || next_interval(w);
}

double cm1e_cam_hardest_braking(const cm1e_cam_t *cam, const cm1e_cam_braking_t *asked)
{
    const double v = asked->velocity, cycle = fabs(v) * asked->cycle_s, square = v * v / 2;
    walk_t w = {.cam = cam, .asked = asked, .forwards = v > 0, .most = asked->hard, .least = asked->gentle};
    if (!(asked->hard > asked->gentle) || cycle >= (cam->curve == mcCamLinear ? cam->shortest : cam->length))
        return asked->gentle;
    bool on_cam = begin(&w);
    for (; *asked->steps > 0 && w.most > w.least; --*asked->steps) {
        if (!on_cam || w.way > square / w.most + 2 * cycle)
            return w.most;
        on_cam = step(&w, square / asked->hard);
    }
    return asked->gentle;
}
