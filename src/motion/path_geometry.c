/* Lines and arcs. Positions are computed from an end, never from a centre: the centre of an almost straight arc is so
 * far away that a position computed from there would lose its precision. */
#include <math.h>

#include "core/extreme.h"
#include "motion/path_piece.h"

static const double PI = 3.14159265358979323846;

/** Points that lie on a line to within this fraction of their distance do not define an arc. */
static const double STRAIGHT = 1e-10;

/** Tolerance of the distances of both ends from the centre, as a fraction of the radius. */
static const double OUT_OF_ROUND = 1e-6;

/** ... and as a fraction of the length of the arc, along which the difference is distributed. */
static const double SHORT_OUT_OF_ROUND = 1e-3;

/** Ends that are closer than this fraction of the radius count as equal. */
static const double FULL_CIRCLE = 1e-9;

/** Heights that differ by less than this fraction of the radius are equal. */
static const double LEVEL = 1e-9;

/** Radii within this angle (rad) are on a line, or so near to one that an error of an end turns the plane of a long arc
 *  by too much. */
static const double ON_A_LINE = 1e-9, NEARLY_ON_A_LINE = 0.02;

enum { X, Y, Z };

typedef struct {
    double x[CM1E_PATH_SPACE];
} vector_t;

static vector_t sum(vector_t a, double factor, vector_t b)
{
    for (int i = 0; i < CM1E_PATH_SPACE; i++)
        a.x[i] += factor * b.x[i];
    return a;
}

static vector_t scaled(double factor, vector_t a) { return sum((vector_t){{0}}, factor, a); }
static double dot(vector_t a, vector_t b) { return a.x[X] * b.x[X] + a.x[Y] * b.x[Y] + a.x[Z] * b.x[Z]; }
static double norm(vector_t a) { return sqrt(dot(a, a)); }

static vector_t cross(vector_t a, vector_t b)
{
    return (vector_t){{a.x[Y] * b.x[Z] - a.x[Z] * b.x[Y], a.x[Z] * b.x[X] - a.x[X] * b.x[Z],
                       a.x[X] * b.x[Y] - a.x[Y] * b.x[X]}};
}

static vector_t between(const cm1e_path_frame_t *frame, const double *from, const double *to)
{
    vector_t difference = {{0}};
    for (int i = 0; i < frame->space; i++)
        difference.x[i] = to[i] - from[i];
    return difference;
}

static void set_ends(cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, const double *from, const double *to)
{
    for (int i = 0; i < frame->axes; i++) {
        piece->from[i] = from[i];
        piece->to[i] = to[i];
    }
}

void cm1e_path_make_line(cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, const double *from,
                         const double *to)
{
    double in_space = 0, others = 0;
    for (int i = 0; i < frame->axes; i++) {
        const double way = fabs(to[i] - from[i]);
        if (i < frame->space)
            in_space = hypot(in_space, way);
        else
            others = hypot(others, way);
    }
    piece->kind = CM1E_PATH_LINE;
    piece->measured = in_space > CM1E_PATH_NO_SPACE * others ? frame->space : frame->axes;
    piece->length = piece->measured == frame->space ? in_space : hypot(in_space, others);
    set_ends(piece, frame, from, to);
    for (int i = 0; i < frame->axes; i++)
        piece->direction[i] = piece->length > 0 ? (to[i] - from[i]) / piece->length : 0;
    if (frame->axes < CM1E_PATH_AXES) /* lines are computed for pairs of axes */
        piece->from[frame->axes] = piece->to[frame->axes] = piece->direction[frame->axes] = 0;
}

/** `u` and `v`: at both ends. */
static void set_arc(cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, double radius, double angle,
                    const vector_t u[2], const vector_t v[2])
{
    piece->kind = CM1E_PATH_ARC;
    piece->measured = frame->space;
    piece->radius = radius;
    piece->length = radius * angle;
    for (int end = 0; end < 2; end++)
        for (int i = 0; i < CM1E_PATH_SPACE; i++) {
            piece->u[end][i] = u[end].x[i];
            piece->v[end][i] = v[end].x[i];
        }
    for (int i = 0; i < frame->axes; i++)
        piece->direction[i] = i < frame->space ? 0 : (piece->to[i] - piece->from[i]) / piece->length;
}

/** Over a chord: `along` it and `bulge` to the side of the arc (unit vectors), `high` is how far to that side of the
 *  chord the centre is. */
static void set_arc_over_chord(cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, vector_t along,
                               vector_t bulge, double chord, double high)
{
    const double radius = hypot(chord / 2, high), half = atan2(chord / 2, -high);
    const double s = chord / 2 / radius, c = -high / radius;
    const vector_t u[2] = {sum(scaled(c, bulge), -s, along), sum(scaled(c, bulge), s, along)};
    const vector_t v[2] = {sum(scaled(c, along), s, bulge), sum(scaled(c, along), -s, bulge)};
    set_arc(piece, frame, radius, 2 * half, u, v);
}

bool cm1e_path_make_border_arc(cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, const double *from,
                               const double *border, const double *to)
{
    const vector_t chord = between(frame, from, to), first = between(frame, from, border);
    const double length = norm(chord), reach = larger(length, norm(first));
    if (frame->space < 2 || !(length > STRAIGHT * reach))
        return false;
    const vector_t along = scaled(1 / length, chord);
    const double way = dot(first, along);
    const vector_t aside = sum(first, -way, along);
    const double high = norm(aside);
    if (!(high > STRAIGHT * reach))
        return false;
    set_ends(piece, frame, from, to);
    set_arc_over_chord(piece, frame, along, scaled(1 / high, aside), length,
                       (way * (way - length) + high * high) / (2 * high));
    return true;
}

static bool is_level(vector_t first, vector_t second, double radius)
{
    return fabs(first.x[Z]) <= LEVEL * radius && fabs(second.x[Z]) <= LEVEL * radius;
}

/** Whether a small error of an end could turn the plane of a half or a full circle, and all of the circle with it. */
static bool plane_may_turn(vector_t first, vector_t second, double radius, double angle)
{
    return angle > PI / 2 && norm(cross(first, second)) <= NEARLY_ON_A_LINE * radius * radius &&
           !is_level(first, second, radius);
}

/** The normal of the plane, which defines the sense of rotation. Returns false if there is no plane. */
static bool find_normal(vector_t first, vector_t second, double radius, vector_t *normal)
{
    *normal = cross(first, second);
    const double size = norm(*normal);
    if (size <= NEARLY_ON_A_LINE * radius * radius && is_level(first, second, radius)) {
        *normal = (vector_t){{0, 0, 1}};
        return true;
    }
    if (size <= ON_A_LINE * radius * radius)
        return false;
    *normal = scaled(1 / size, *normal);
    for (int i = Z; i >= X; i--)
        if (fabs(normal->x[i]) > 1e-9) {
            if (normal->x[i] < 0)
                *normal = scaled(-1, *normal);
            break;
        }
    return true;
}

bool cm1e_path_make_centre_arc(cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, const double *from,
                               const double *centre, cm1e_path_way_t way, const double *to)
{
    vector_t first = between(frame, centre, from), second = between(frame, centre, to);
    const double radius = norm(first);
    vector_t normal;
    if (frame->space < 2 || !(radius > 0) || fabs(norm(second) - radius) > OUT_OF_ROUND * radius ||
        !find_normal(first, second, radius, &normal))
        return false;
    if (way == CM1E_PATH_CLOCKWISE)
        normal = scaled(-1, normal);
    set_ends(piece, frame, from, to);
    double angle = atan2(dot(normal, cross(first, second)), dot(first, second));
    if (norm(between(frame, from, to)) <= FULL_CIRCLE * radius) {
        angle = 2 * PI;
        second = first;
    } else if (angle <= 0) {
        angle += 2 * PI;
    }
    if (plane_may_turn(first, second, radius, angle) ||
        fabs(norm(second) - radius) > SHORT_OUT_OF_ROUND * radius * angle)
        return false;
    const vector_t u[2] = {scaled(1 / radius, first), scaled(1 / norm(second), second)};
    const vector_t v[2] = {cross(normal, u[0]), cross(normal, u[1])};
    set_arc(piece, frame, radius, angle, u, v);
    /* Both ends are kept: the deviation of the second one from the circle is distributed along the arc. */
    for (int i = 0; i < frame->space; i++)
        piece->direction[i] = (to[i] - from[i] - radius * (u[1].x[i] - u[0].x[i])) / piece->length;
    return true;
}

/** At `l` from an end (0: the beginning) of a line or an arc; the position counts from there. */
static void line_or_arc_from(const cm1e_path_piece_t *piece, int axes, int end, double l, cm1e_path_point_t *point)
{
    for (int i = 0; i < axes; i++) {
        point->position[i] = piece->direction[i] * l;
        point->tangent[i] = piece->direction[i];
        point->curvature[i] = 0;
    }
    if (piece->kind == CM1E_PATH_LINE)
        return;
    const double s = sin(l / piece->radius), c = cos(l / piece->radius), s2 = sin(l / piece->radius / 2);
    for (int i = 0; i < piece->measured; i++) {
        const double u = piece->u[end][i], v = piece->v[end][i];
        /* NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Assign): measured is at most axes */
        point->position[i] += piece->radius * (v * s - 2 * u * s2 * s2);
        point->tangent[i] += v * c - u * s;
        point->curvature[i] = -(u * c + v * s) / piece->radius;
    }
}

static void line_or_arc_at(const cm1e_path_piece_t *piece, int axes, double length, cm1e_path_point_t *point)
{
    double l;
    const int end = cm1e_path_nearer_end(piece, length, &l);
    const double *origin = end ? piece->to : piece->from;
    line_or_arc_from(piece, axes, end, l, point);
    for (int i = 0; i < axes; i++)
        point->position[i] += origin[i];
}

/* ---- curves ------------------------------------------------------------------------------------------------------ */

static void derivatives(const cm1e_path_piece_t *curve, int axes, double x, double first[], double second[])
{
    for (int i = 0; i < axes; i++) {
        const double b = curve->power[2][i], c = curve->power[3][i], d = curve->power[4][i], e = curve->power[5][i];
        first[i] = curve->power[1][i] + x * (2 * b + x * (3 * c + x * (4 * d + x * 5 * e)));
        if (second)
            second[i] = 2 * b + x * (6 * c + x * (12 * d + x * 20 * e));
    }
}

static double speed(const cm1e_path_piece_t *curve, double x)
{
    double first[CM1E_PATH_AXES], square = 0;
    derivatives(curve, curve->measured, x, first, NULL);
    for (int i = 0; i < curve->measured; i++)
        square += first[i] * first[i];
    return sqrt(square);
}

/** The length between two parameters, by Gauss and Legendre with 5 points. */
static double length_between(const cm1e_path_piece_t *curve, double from, double to)
{
    static const double node[] = {0, 0.53846931010568309, 0.90617984593866399};
    static const double weight[] = {0.56888888888888889, 0.47862867049936647, 0.23692688505618909};
    const double middle = (from + to) / 2, half = (to - from) / 2;
    double whole = weight[0] * speed(curve, middle);
    for (int i = 1; i < 3; i++)
        whole += weight[i] * (speed(curve, middle - half * node[i]) + speed(curve, middle + half * node[i]));
    return whole * half;
}

/** Where the inner points of the hull are, in parts of the way to the junction, by the cosine of the turn: what makes
 *  the velocity that the curvature and its change allow highest, from straight on to nearly back. */
static void hull_of(double cosine, double *first, double *second)
{
    const double bend = (1 - cosine) / 2;
    *first = 0.40 - 0.12 * bend;
    *second = 0.85 - 0.40 * bend;
}

double cm1e_path_reach_per_deviation(double cosine)
{
    double first, second;
    hull_of(cosine, &first, &second);
    const double middle = (1 + 5 * (1 - first) + 10 * (1 - second)) / 32; /* of the way, weights of the hull's points */
    return 1 / (middle * sqrt(larger(2 - 2 * cosine, 1e-12)));
}

void cm1e_path_make_curve(cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, const cm1e_path_piece_t *before,
                          double leave, const cm1e_path_piece_t *after, double enter)
{
    cm1e_path_point_t a, b;
    line_or_arc_from(before, frame->axes, 1, -leave, &a);
    line_or_arc_from(after, frame->axes, 0, enter, &b);
    double cosine = 0;
    for (int i = 0; i < before->measured; i++)
        cosine += a.tangent[i] * b.tangent[i];
    double first, second;
    hull_of(cosine, &first, &second);
    piece->kind = CM1E_PATH_CURVE;
    piece->measured = before->measured;
    for (int i = 0; i < frame->axes; i++) {
        const double out = leave * a.tangent[i], in = enter * b.tangent[i];
        const double p0 = a.position[i], p1 = p0 + first * out;
        const double p2 = p0 + second * out + 1.25 * first * first * leave * leave * a.curvature[i];
        const double p5 = b.position[i], p4 = p5 - first * in;
        const double p3 = p5 - second * in + 1.25 * first * first * enter * enter * b.curvature[i];
        piece->power[0][i] = before->to[i] + p0; /* the others have its shape however far away it is */
        piece->power[1][i] = 5 * (p1 - p0);
        piece->power[2][i] = 10 * ((p0 - p1) + (p2 - p1));
        piece->power[3][i] = 10 * ((p3 - p0) - 3 * (p2 - p1));
        piece->power[4][i] = 5 * ((p0 - p1) + 3 * (p2 - p1) - 3 * (p3 - p2) + (p4 - p3));
        piece->power[5][i] = (p5 - p0) - 5 * (p4 - p1) + 10 * (p3 - p2);
    }
    piece->at[0] = 0;
    for (int k = 0; k < CM1E_PATH_KNOTS; k++)
        piece->at[k + 1] = piece->at[k] + length_between(piece, (double)k / CM1E_PATH_KNOTS,
                                                         (double)(k + 1) / CM1E_PATH_KNOTS);
    piece->length = piece->at[CM1E_PATH_KNOTS];
}

/** The parameter at a length: Newton's method on the length from the last knot. */
static double parameter_at(const cm1e_path_piece_t *curve, double length)
{
    int knot = 0;
    while (knot < CM1E_PATH_KNOTS - 1 && length > curve->at[knot + 1])
        knot++;
    const double from = (double)knot / CM1E_PATH_KNOTS, step = 1.0 / CM1E_PATH_KNOTS;
    const double part = (length - curve->at[knot]) / (curve->at[knot + 1] - curve->at[knot]);
    double x = from + step * part;
    for (int i = 0; i < 4; i++) {
        const double less = (curve->at[knot] + length_between(curve, from, x) - length) / speed(curve, x);
        x = smaller(larger(x - less, 0), 1);
        if (fabs(less) < 1e-8)
            break;
    }
    return x;
}

static void curve_at(const cm1e_path_piece_t *piece, int axes, double length, cm1e_path_point_t *point)
{
    const double x = parameter_at(piece, length);
    double second[CM1E_PATH_AXES];
    derivatives(piece, axes, x, point->tangent, second);
    double square = 0, along = 0;
    for (int i = 0; i < piece->measured; i++) {
        square += point->tangent[i] * point->tangent[i];
        along += point->tangent[i] * second[i];
    }
    const double per_length = 1 / sqrt(square);
    for (int i = 0; i < axes; i++) {
        double position = piece->power[5][i];
        for (int k = 4; k >= 0; k--)
            position = piece->power[k][i] + x * position;
        point->position[i] = position;
        point->curvature[i] = (second[i] - point->tangent[i] * along / square) / square;
        point->tangent[i] *= per_length;
    }
}

void cm1e_path_curve_derivatives(const cm1e_path_piece_t *curve, int axes, double x,
                                 double by_length[3][CM1E_PATH_AXES])
{
    double first[CM1E_PATH_AXES], second[CM1E_PATH_AXES], third[CM1E_PATH_AXES];
    double dot11 = 0, dot12 = 0, dot22 = 0, dot13 = 0;
    derivatives(curve, axes, x, first, second);
    for (int i = 0; i < axes; i++)
        third[i] = 6 * curve->power[3][i] + x * (24 * curve->power[4][i] + x * 60 * curve->power[5][i]);
    for (int i = 0; i < curve->measured; i++) {
        /* NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): measured is at most axes */
        dot11 += first[i] * first[i];
        dot12 += first[i] * second[i];
        dot22 += second[i] * second[i];
        /* NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): measured is at most axes */
        dot13 += first[i] * third[i]; /* cppcheck-suppress uninitvar ; measured is at most axes */
    }
    /* v, v' and v'' are the derivatives of the length by the parameter. */
    const double v = sqrt(dot11), v1 = dot12 / v, v2 = (dot22 + dot13 - v1 * v1) / v;
    for (int i = 0; i < axes; i++) {
        const double tangent = first[i] / v, curvature = (second[i] - tangent * v1) / dot11;
        by_length[0][i] = tangent;
        by_length[1][i] = curvature;
        by_length[2][i] = (third[i] - 3 * v * v1 * curvature - tangent * v2) / (dot11 * v);
    }
}

void cm1e_path_point_at(const cm1e_path_piece_t *piece, int axes, double length, cm1e_path_point_t *point)
{
    if (piece->kind == CM1E_PATH_CURVE)
        curve_at(piece, axes, length, point);
    else
        line_or_arc_at(piece, axes, length, point);
}

/** How far a point is from a line or an arc, as if that had no ends, by the axes that measure it. */
static double distance_from(const cm1e_path_piece_t *piece, const double *point)
{
    const double *u = piece->u[0], *v = piece->v[0];
    const bool arc = piece->kind == CM1E_PATH_ARC;
    double square = 0, out = 0, along = 0;
    for (int i = 0; i < piece->measured; i++) {
        /* NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): measured is at most axes */
        const double from = point[i] - piece->from[i];
        square += from * from;
        out += arc ? from * u[i] : 0;
        along += from * (arc ? v[i] : piece->direction[i]);
    }
    if (!arc)
        return sqrt(larger(0, square - along * along));
    const double high = sqrt(larger(0, square - out * out - along * along)), r = piece->radius;
    return hypot(high, (out * out + along * along + 2 * r * out) / (hypot(r + out, along) + r));
}

double cm1e_path_deviation(const cm1e_path_piece_t *curve, const cm1e_path_frame_t *frame,
                           const cm1e_path_piece_t *before, const cm1e_path_piece_t *after)
{
    enum { STEPS = 32 };
    double nearest = INFINITY, farthest = 0;
    for (int k = 0; k <= STEPS; k++) {
        const double x = (double)k / STEPS;
        double point[CM1E_PATH_AXES], in_space = 0, aside = 0;
        for (int i = 0; i < frame->axes; i++) {
            point[i] = curve->power[5][i];
            for (int j = 4; j >= 0; j--)
                point[i] = curve->power[j][i] + x * point[i];
            const double off = fabs(point[i] - before->to[i]);
            if (i < frame->space)
                in_space += off * off;
            else
                aside = larger(aside, off);
        }
        nearest = smaller(nearest, larger(sqrt(in_space), aside));
        farthest = larger(farthest, smaller(distance_from(before, point), distance_from(after, point)));
    }
    return larger(nearest, farthest);
}

/* ---- extent ------------------------------------------------------------------------------------------------------ */

/** Of a curve: of the points of its hull. */
static void curve_extent(const cm1e_path_piece_t *piece, int axis, double *lowest, double *highest)
{
    static const double choose[6] = {1, 5, 10, 10, 5, 1};
    for (int j = 0; j <= 5; j++) {
        double point = 0, ways = 1; /* the sum over i <= j of C(j, i) / C(5, i) power[i] */
        for (int i = 0; i <= j; i++) {
            point += ways / choose[i] * piece->power[i][axis];
            ways = ways * (j - i) / (i + 1);
        }
        *lowest = j ? smaller(*lowest, point) : point;
        *highest = j ? larger(*highest, point) : point;
    }
}

void cm1e_path_extent(const cm1e_path_piece_t *piece, const cm1e_path_frame_t *frame, int axis, double *lowest,
                      double *highest)
{
    if (piece->kind == CM1E_PATH_CURVE) {
        curve_extent(piece, axis, lowest, highest);
        return;
    }
    *lowest = smaller(piece->from[axis], piece->to[axis]);
    *highest = larger(piece->from[axis], piece->to[axis]);
    if (piece->kind == CM1E_PATH_LINE || axis >= frame->space)
        return;
    /* It turns where the tangent is 0. */
    double angle = atan2(piece->v[0][axis], piece->u[0][axis]);
    for (angle = angle < 0 ? angle + PI : angle; angle * piece->radius < piece->length; angle += PI) {
        cm1e_path_point_t point;
        cm1e_path_point_at(piece, frame->axes, angle * piece->radius, &point);
        *lowest = smaller(*lowest, point.position[axis]);
        *highest = larger(*highest, point.position[axis]);
    }
}
