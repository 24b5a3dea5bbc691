/* All three kinds of curve are stored as position, slope and curvature at the points: the polynomial of degree 5
 * between two points is then the straight line, the cubic or the polynomial. */
#include <math.h>
#include <stddef.h>

#include "core/extreme.h"
#include "core/rare.h"
#include "motion/cam.h"
#include "motion/pieces.h"

/* Fraction of the known extremes: an interval that cannot exceed them by more is not evaluated. */
static const double next_to_nothing = 1e-9;

/* Distance between two points. From there on the polynomials of numbers up to 1e30 are finite, roundings included. */
static const double shortest = 1e-30;

static double span(const cm1e_cam_knot_t *knots, int i) { return knots[i + 1].master - knots[i].master; }

static double chord(const cm1e_cam_knot_t *knots, int i)
{
    return (knots[i + 1].slave - knots[i].slave) / span(knots, i);
}

static cm1e_cam_fault_t take_points(cm1e_cam_knot_t *knots, const MC_CAM_REF *table, int *at)
{
    const bool whole = table->Curve == mcCamPolynomial5;
    for (*at = 0; *at < table->NumberOfPoints; ++*at) {
        const MC_CAM_POINT *point = &table->Points[*at];
        const double slope = whole ? point->Velocity : 0, curvature = whole ? point->Acceleration : 0;
        if (!cm1e_motion_is_number(point->Master) || !cm1e_motion_is_number(point->Slave) ||
            !cm1e_motion_is_number(slope) || !cm1e_motion_is_number(curvature))
            return CM1E_CAM_NO_NUMBER;
        if (*at > 0 && !(point->Master > knots[*at - 1].master))
            return CM1E_CAM_NOT_RISING;
        knots[*at] = (cm1e_cam_knot_t){point->Master, point->Slave, slope, curvature};
    }
    return CM1E_CAM_GOOD;
}

static void draw_lines(cm1e_cam_knot_t *knots, int count)
{
    for (int i = 0; i + 1 < count; i++)
        knots[i].slope = chord(knots, i);
    knots[count - 1].slope = knots[count - 2].slope;
}

/** The spline with this curvature at both ends; of the points only `part` (1, or 0: as if they were on a line). The
 *  slopes are room for the elimination. */
static void bend(cm1e_cam_knot_t *knots, int count, double part, double curvature)
{
    knots[0].curvature = knots[count - 1].curvature = curvature;
    knots[0].slope = 0;
    for (int i = 1; i + 1 < count; i++) { /* down: curvature = (that kept as curvature) - slope * (the next one) */
        const double before = span(knots, i - 1) / 6, behind = span(knots, i) / 6;
        const double middle = 2 * (before + behind) - before * knots[i - 1].slope;
        const double step = part * (chord(knots, i) - chord(knots, i - 1));
        knots[i].slope = behind / middle;
        knots[i].curvature = (step - before * knots[i - 1].curvature) / middle;
    }
    for (int i = count - 2; i > 0; i--)
        knots[i].curvature -= knots[i].slope * knots[i + 1].curvature;
}

/** Periodic: with the curvature at the ends for which the slopes there are the same. */
static void draw_spline(cm1e_cam_knot_t *knots, int count, bool periodic)
{
    bend(knots, count, 1, 0);
    if (periodic && count > 2) {
        const int last = count - 2;
        const double first_h = span(knots, 0), last_h = span(knots, last);
        const double step = chord(knots, 0) - chord(knots, last) -
                            (first_h * knots[1].curvature + last_h * knots[last].curvature) / 6;
        bend(knots, count, 0, 1);
        const double each = (first_h * (2 + knots[1].curvature) + last_h * (2 + knots[last].curvature)) / 6;
        bend(knots, count, 1, step / each);
    }
    for (int i = 0; i + 1 < count; i++)
        knots[i].slope = chord(knots, i) - span(knots, i) * (2 * knots[i].curvature + knots[i + 1].curvature) / 6;
    const double h = span(knots, count - 2);
    knots[count - 1].slope = periodic ? knots[0].slope
                                      : chord(knots, count - 2) +
                                            h * (knots[count - 2].curvature + 2 * knots[count - 1].curvature) / 6;
}

bool cm1e_cam_interval(const cm1e_cam_t *cam, int i, cm1e_curve_t *curve)
{
    const cm1e_cam_knot_t *a = &cam->knots[i], *b = a + 1;
    if (cam->curve == mcCamLinear) {
        *curve = (cm1e_curve_t){a->master - cam->start, b->master - a->master, {a->slave, a->slope}};
        return true;
    }
    const cm1e_curve_point_t first = {.position = a->slave, .slope = a->slope, .curvature = a->curvature};
    const cm1e_curve_point_t last = {.position = b->slave, .slope = b->slope, .curvature = b->curvature};
    return cm1e_curve_between(curve, a->master - cam->start, &first, b->master - cam->start, &last);
}

/** Bounds of an interval that cost next to nothing: a polynomial stays within its control points (Bernstein), its
 *  derivatives within the differences of these. */
static void hull(const cm1e_cam_knot_t *a, cm1e_curve_extremes_t *hull)
{
    const cm1e_cam_knot_t *b = a + 1;
    const double h = b->master - a->master, fifth = h / 5, bend = h * h / 20;
    double point[6] = {a->slave, a->slave + fifth * a->slope, a->slave + 2 * fifth * a->slope + bend * a->curvature,
                       b->slave - 2 * fifth * b->slope + bend * b->curvature, b->slave - fifth * b->slope, b->slave};
    double low[4], high[4], factor = 1;
    for (int k = 0; k < 4; k++) {
        low[k] = high[k] = point[0] * factor;
        for (int i = 0; i < 6 - k; i++) {
            low[k] = smaller(low[k], point[i] * factor);
            high[k] = larger(high[k], point[i] * factor);
            if (i < 5 - k)
                point[i] = point[i + 1] - point[i];
        }
        factor *= (5 - k) / h;
    }
    *hull = (cm1e_curve_extremes_t){low[0], high[0], low[1], high[1], larger(-low[2], high[2]),
                                    larger(-low[3], high[3])};
}

static void widen(cm1e_curve_extremes_t *all, const cm1e_curve_extremes_t *part)
{
    all->lowest = smaller(all->lowest, part->lowest);
    all->highest = larger(all->highest, part->highest);
    all->least_slope = smaller(all->least_slope, part->least_slope);
    all->most_slope = larger(all->most_slope, part->most_slope);
    all->curvature = larger(all->curvature, part->curvature);
    all->third = larger(all->third, part->third);
}

static bool adds(const cm1e_curve_extremes_t *all, const cm1e_curve_extremes_t *part)
{
    const double position = next_to_nothing * (all->highest - all->lowest);
    const double slope = next_to_nothing * larger(fabs(all->least_slope), fabs(all->most_slope));
    return part->lowest < all->lowest - position || part->highest > all->highest + position ||
           part->least_slope < all->least_slope - slope || part->most_slope > all->most_slope + slope ||
           part->curvature > all->curvature * (1 + next_to_nothing);
}

static void find_corners(cm1e_cam_t *cam)
{
    const cm1e_cam_knot_t *knots = cam->knots;
    cam->corner = cam->periodic ? fabs(knots[0].slope - knots[cam->count - 1].slope) : 0;
    cam->shortest = span(knots, 0);
    for (int i = 1; i + 1 < cam->count; i++) {
        cam->corner = larger(cam->corner, fabs(knots[i].slope - knots[i - 1].slope));
        cam->shortest = smaller(cam->shortest, span(knots, i));
    }
}

static cm1e_cam_fault_t find_extremes(cm1e_cam_t *cam, int *at)
{
    cm1e_curve_extremes_t all = {INFINITY, -INFINITY, INFINITY, -INFINITY, 0, 0};
    for (*at = 0; *at < cam->count; ++*at) {
        const cm1e_cam_knot_t *knot = &cam->knots[*at];
        if (!isfinite(knot->slope) || !isfinite(knot->curvature))
            return CM1E_CAM_STEEP;
        widen(&all, &(cm1e_curve_extremes_t){knot->slave, knot->slave, knot->slope, knot->slope,
                                             fabs(knot->curvature), 0});
    }
    for (*at = 0; *at + 1 < cam->count; ++*at) {
        cm1e_curve_t curve;
        cm1e_curve_extremes_t part;
        const double h = span(cam->knots, *at);
        const double from = cam->knots[*at].master - cam->start, to = cam->knots[*at + 1].master - cam->start;
        if (!(h >= shortest && to > from)) /* of lines too: the number of a period must be finite */
            return CM1E_CAM_STEEP;
        if (cam->curve == mcCamLinear)
            continue;
        hull(&cam->knots[*at], &part);
        if (!isfinite(part.third / (h * h))) /* about the highest coefficient */
            return CM1E_CAM_STEEP;
        all.third = larger(all.third, part.third);
        if (!adds(&all, &part))
            continue;
        if (!cm1e_cam_interval(cam, *at, &curve))
            return CM1E_CAM_STEEP;
        cm1e_curve_extremes(&curve, &part);
        widen(&all, &part);
    }
    cam->extremes = all;
    *at = 0;
    const double most = all.third + all.curvature + (all.most_slope - all.least_slope) + (all.highest - all.lowest);
    return isfinite(most) && isfinite(cam->length) ? CM1E_CAM_GOOD : CM1E_CAM_STEEP;
}

cm1e_cam_fault_t cm1e_cam_compile(cm1e_cam_t *cam, cm1e_cam_knot_t *knots, int capacity, const MC_CAM_REF *table,
                                  bool periodic, int *at)
{
    const int count = table->NumberOfPoints;
    *at = 0;
    if (!table->Points || count < 2)
        return CM1E_CAM_TOO_FEW;
    if (count > capacity) {
        *at = capacity;
        return CM1E_CAM_TOO_MANY;
    }
    if ((unsigned)table->Curve > mcCamLinear)
        return CM1E_CAM_CURVE;
    const cm1e_cam_fault_t fault = take_points(knots, table, at);
    if (fault != CM1E_CAM_GOOD)
        return fault;
    if (table->Curve == mcCamLinear)
        draw_lines(knots, count);
    else if (table->Curve == mcCamCubicSpline)
        draw_spline(knots, count, periodic);
    *cam = (cm1e_cam_t){
        .knots = knots,
        .count = count,
        .curve = table->Curve,
        .periodic = periodic,
        .start = knots[0].master,
        .length = knots[count - 1].master - knots[0].master,
        .advance = knots[count - 1].slave - knots[0].slave,
    };
    find_corners(cam);
    return find_extremes(cam, at);
}

static void find(const cm1e_cam_t *cam, cm1e_cam_place_t *place, double phase)
{
    const double master = cam->start + phase;
    int low = 0, high = cam->count - 1; /* a knot not above it, and one above it or the last one */
    const int near = place->knot;
    if (near >= 0 && near + 2 < cam->count && cam->knots[near + 1].master <= master &&
        master < cam->knots[near + 2].master) {
        low = near + 1;
        high = near + 2;
    }
    if (near >= 1 && near < cam->count && cam->knots[near - 1].master <= master && master < cam->knots[near].master) {
        low = near - 1;
        high = near;
    }
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (cam->knots[middle].master <= master)
            low = middle;
        else
            high = middle;
    }
    place->knot = low;
    (void)cm1e_cam_interval(cam, low, &place->curve); /* cannot fail: it succeeded when the cam was compiled */
}

/** In a period, of the one that `place` has found. */
static double phase_of(const cm1e_cam_place_t *place, double way) { return (way - place->turn_way) - place->turn_rest; }

static double take_turn(const cm1e_cam_t *cam, cm1e_cam_place_t *place, double turn, double way)
{
    place->turn = turn;
    place->turn_way = turn * cam->length;
    place->turn_rest = fma(turn, cam->length, -place->turn_way);
    return phase_of(place, way);
}

CM1E_RARE static double find_turn(const cm1e_cam_t *cam, cm1e_cam_place_t *place, double way)
{
    double phase = take_turn(cam, place, floor(way / cam->length), way);
    if (phase < 0) /* the quotient was rounded to a whole number */
        phase = take_turn(cam, place, place->turn - 1, way);
    if (phase >= cam->length)
        phase = take_turn(cam, place, place->turn + 1, way);
    return phase >= 0 && phase < cam->length ? phase : 0; /* 0: rounding, or periods too far away to be told apart */
}

void cm1e_cam_sample(const cm1e_cam_t *cam, cm1e_cam_place_t *place, double master, cm1e_cam_sample_t *sample)
{
    const double way = master - cam->start;
    double phase = way, turn = 0;
    if (cam->periodic) {
        phase = phase_of(place, way);
        if (!(phase >= 0 && phase < cam->length))
            phase = find_turn(cam, place, way);
        turn = place->turn;
    } else if (!(way > 0) || way >= cam->length) {
        const bool behind = way > 0;
        *sample = (cm1e_cam_sample_t){{.position = cam->knots[behind ? cam->count - 1 : 0].slave}, behind ? 1 : -1,
                                      behind ? cam->length : 0};
        return;
    }
    if (!(phase >= place->curve.from && phase - place->curve.from < place->curve.length))
        find(cam, place, phase);
    *sample = (cm1e_cam_sample_t){cm1e_curve_at(&place->curve, phase), turn, phase};
}
