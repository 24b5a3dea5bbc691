/* Cams of any points: a cam is refused, or all that is said of it is finite, and so is every sample: within the extremes, and
 * the same whichever one was asked for before. Then MC_CamTableSelect and MC_CamIn with such a cam, and what else acts on
 * the slave, judged by block_machine.h.
 *
 * An input: number of points and curve; for each point four numbers; positions of the master; the kind of the machine; then
 * instructions, each a byte with its operand. */
#include <math.h>
#include <string.h>

#include "block_machine.h"
#include "fuzz.h"
#include "motion/cam.h"

enum { POINTS = 8, SAMPLES = 32, MOST_CYCLES = 800, LONG_CYCLES = 150 };

static MC_CAM_POINT points[POINTS + 1]; /* one more than a cam may have */
static MC_CAM_REF table;

/* ---- the curve --------------------------------------------------------------------------------------------------- */

/** Rising masters, mostly: others are refused at once. */
static bool take_cam(const uint8_t **at, const uint8_t *end)
{
    const unsigned head = fuzz_take(at, end, 1), form = fuzz_take(at, end, 1);
    double master = fuzz_take_real(at, end);
    table = (MC_CAM_REF){.Points = head % 32 == 31 ? NULL : points, .NumberOfPoints = (UINT)(head % (POINTS + 2)),
                         .Curve = (MC_CAM_CURVE)(form % 4)};
    for (int i = 0; i < POINTS; i++) {
        const double step = fuzz_take_real(at, end);
        master = form & 8 ? step : master + fabs(step);
        points[i] = (MC_CAM_POINT){.Master = master, .Slave = fuzz_take_real(at, end)};
        if (form & 16) {
            points[i].Velocity = fuzz_take_real(at, end);
            points[i].Acceleration = fuzz_take_real(at, end);
        }
    }
    return form & 4;
}

static void judge_cam(const cm1e_cam_t *cam)
{
    const double all[] = {cam->start, cam->length, cam->advance, cam->extremes.lowest, cam->extremes.highest,
                          cam->extremes.least_slope, cam->extremes.most_slope, cam->extremes.curvature,
                          cam->extremes.third, cam->corner, cam->shortest};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (!isfinite(all[i]))
            fuzz_fail("a cam that is accepted has %g as its number %zu", all[i], i);
    if (!(cam->length > 0) || !(cam->shortest > 0) || cam->extremes.lowest > cam->extremes.highest)
        fuzz_fail("length %g, shortest %g, %g ... %g", cam->length, cam->shortest, cam->extremes.lowest,
                  cam->extremes.highest);
}

static void sample(const cm1e_cam_t *cam, cm1e_cam_place_t *place, double master)
{
    const cm1e_curve_extremes_t *most = &cam->extremes;
    const double slope = fmax(fabs(most->least_slope), fabs(most->most_slope));
    const double size = fmax(fabs(most->lowest), fabs(most->highest)) + cam->length * slope;
    const double rounding = 1e-6 * (size + cam->length * cam->length * most->curvature) + 1e-100;
    cm1e_cam_place_t fresh = {0};
    cm1e_cam_sample_t first, again, alone;
    if (!isfinite(master))
        return;
    cm1e_cam_sample(cam, place, master, &first);
    cm1e_cam_sample(cam, &fresh, master, &alone);
    const double shown[] = {first.point.position, first.point.slope, first.point.curvature, first.point.third, first.turn,
                            first.phase};
    for (size_t i = 0; i < sizeof shown / sizeof *shown; i++)
        if (!isfinite(shown[i]))
            fuzz_fail("at %g: %g as number %zu", master, shown[i], i);
    if (first.phase < 0 || first.phase > cam->length)
        fuzz_fail("at %g: %g of a period of %g", master, first.phase, cam->length);
    if (first.point.position < most->lowest - rounding || first.point.position > most->highest + rounding)
        fuzz_fail("at %g: %g beyond %g ... %g", master, first.point.position, most->lowest, most->highest);
    if (fabs(first.point.position - alone.point.position) > rounding || first.turn != alone.turn)
        fuzz_fail("at %g: %g in period %g after another sample, %g in %g as the first one", master, first.point.position,
                  first.turn, alone.point.position, alone.turn);
    if (cm1e_cam_sample_again(cam, place, master, &again) &&
        (again.point.position != first.point.position || again.turn != first.turn || again.phase != first.phase))
        fuzz_fail("at %g: %g, and %g the short way", master, first.point.position, again.point.position);
}

static void play_curve(const uint8_t **at, const uint8_t *end, bool periodic)
{
    cm1e_cam_t cam;
    cm1e_cam_knot_t knots[POINTS];
    cm1e_cam_place_t place = {0};
    int wrong;
    const cm1e_cam_fault_t fault = cm1e_cam_compile(&cam, knots, POINTS, &table, periodic, &wrong);
    if ((unsigned)fault > CM1E_CAM_STEEP || wrong < 0 || wrong > POINTS)
        fuzz_fail("fault %d at %d", fault, wrong);
    if (fault != CM1E_CAM_GOOD)
        return;
    judge_cam(&cam);
    for (int i = 0; i < cam.count; i++)
        for (int side = -1; side < 2; side++)
            sample(&cam, &place, nextafter(knots[i].master, knots[i].master + side));
    const unsigned samples = fuzz_take(at, end, 1) % SAMPLES;
    for (unsigned i = 0; i < samples && *at < end; i++)
        sample(&cam, &place, cam.start + fuzz_take_real(at, end) * (i % 2 ? cam.length : 1));
}

/* ---- the blocks -------------------------------------------------------------------------------------------------- */

enum { MASTER = 1 };
static const struct {
    const char *name;
    int axis;
} pool[] = {{"MC_MoveVelocity", MASTER}, {"MC_CamTableSelect", 0}, {"MC_CamIn", 0}, {"MC_CamOut", 0},
            {"MC_PhasingAbsolute", 0}, {"MC_MoveSuperimposed", 0}, {"MC_SetPosition", MASTER},
            {"MC_CamTableSelect", 2}, {"MC_CamIn", 2}, {"MC_MoveRelative", MASTER}, {"MC_CamIn", 0},
            {"MC_Reset", 0}, {"MC_Reset", 2}, {"MC_Halt", MASTER}, {"MC_SetPosition", 0}, {"MC_GearIn", 0}};
enum { POOL = sizeof pool / sizeof *pool };

static void make_pool(void)
{
    for (int i = 0; i < POOL; i++) {
        instance_t *fb = machine_make(pool[i].name, pool[i].axis);
        point_at(fb, "CamTable", &table);
        point_at(fb, "Master", &machine.named[MASTER]);
        put(fb, "CamTableID", 0);
        put(fb, "StartMode", mcRelative);
    }
}

/** A block that couples by a cam gets the last one that was selected for its slave, unless `other`. */
static void turn_trigger(instance_t *fb, bool other)
{
    const block_member_t *id = member_of(fb->view->type, "CamTableID");
    for (int i = 0; i < POOL && !other && strcmp(name_of(fb), "MC_CamIn") == 0; i++) {
        const instance_t *from = &machine.blocks[i];
        if (strcmp(name_of(from), "MC_CamTableSelect") == 0 && from->of == fb->of)
            memcpy(fb->memory + id->offset, from->memory + place_of(from->view->type, "CamTableID"), id->size);
    }
    trigger(fb, !fb->now.trigger);
}

static void put_input(instance_t *fb, const uint8_t **at, const uint8_t *end)
{
    const block_t *type = fb->view->type;
    const block_member_t *m = &type->members[fuzz_take(at, end, 1) % type->member_count];
    if (m->section == BLOCK_INPUT)
        machine_put(fb, m, at, end);
}

static void play_blocks(const uint8_t **at, const uint8_t *end)
{
    int left = MOST_CYCLES;
    machine_begin(fuzz_take(at, end, 1));
    make_pool();
    while (*at < end && left > 0) {
        const unsigned code = fuzz_take(at, end, 1), operand = fuzz_take(at, end, 1);
        instance_t *fb = &machine.blocks[operand % POOL];
        const int cycles = operand >= 0xE0 ? LONG_CYCLES : 1 + (int)operand % 64;
        switch (code % 4) {
        case 0:
            machine_cycles(cycles < left ? cycles : left);
            left -= cycles;
            break;
        case 1:
            put_input(fb, at, end);
            break;
        case 2:
            turn_trigger(fb, operand >= 0xF0);
            break;
        default: /* another point of the table, for the next selection */
            points[operand % POINTS].Slave = fuzz_take_real(at, end);
        }
    }
    machine_cycles(2);
    machine_end();
}

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    (void)written, (void)must;
    const uint8_t *at = bytes, *end = size ? bytes + size : bytes;
    const bool periodic = take_cam(&at, end);
    play_curve(&at, end, periodic);
    if (at < end)
        play_blocks(&at, end);
    return false;
}

/** Sensible cams of all curves, with and without an approach. */
void fuzz_seeds(void)
{
    for (unsigned seed = 0; seed < 48; seed++) {
        const bool bends = seed & 16;
        uint8_t bytes[200] = {(uint8_t)(3 + seed % 6), (uint8_t)(seed % 3 | (seed & 8 ? 4 : 0) | (bends ? 16 : 0)), 15};
        size_t at = 3;
        for (int i = 0; i < POINTS; i++) {
            const uint8_t point[] = {0x90, (uint8_t)(i ? 80 : 0), 0, 0x40, (uint8_t)(i % 2 ? 200 : 0), 3,
                                     0x40, 10, 0, 15};
            memcpy(bytes + at, point, sizeof point);
            at += bends ? sizeof point : 6;
        }
        const uint8_t script[] = {3, 0x90, 20, 0, 0x90, 40, 0, 0x40, 0, 2, /* samples */
                                  (uint8_t)(seed * 11), 2, 1, 0, 2, 2, 0, 0, 40, 2, 2, 0, 0xE0, 2, 4, 0, 60, 2, 5, 0, 60,
                                  1, 2, 4, 0x90, 5, 0, 2, 10, 0, 0xE0, 2, 9, 0, 60, 2, 3, 0, 60, 2, 13, 0, 0xE0};
        memcpy(bytes + at, script, sizeof script);
        at += sizeof script;
        char name[16];
        snprintf(name, sizeof name, "cam_%u", seed);
        fuzz_seed(name, bytes, at);
    }
}
