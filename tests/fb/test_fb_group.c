/*
 * The blocks of axes groups, on axes without frames: what PLCopen Part 1 v2.0, 2.4.1 says of their outputs, in every
 * call; every block in every state of the group and every buffer mode, each behind each, triggered again, and with an
 * axis that loses its power in every phase. The witness of axes_bench.h looks at every set-point.
 */
#include <stdlib.h>

#include "block_table.h"
#include "cm1e/plcopen.h"
#include "effort.h"
#include "group_bench.h"
#include "quick_check.h"

/* ---- a block ----------------------------------------------------------------------------------------------------- */

typedef struct shown {
    BOOL execute, done, busy, active, accepted, aborted, error;
    WORD error_id;
} shown_t;

typedef struct fb {
    const block_t *type;
    shown_t now, before;
    bool refused; /* the last edge was */
    _Alignas(16) unsigned char memory[1024];
} fb_t;

enum { FBS = 5 };
static fb_t fbs[FBS];
static int fb_count;

static const block_member_t *member_of(const fb_t *fb, const char *name)
{
    for (size_t i = 0; i < fb->type->member_count; i++)
        if (strcmp(fb->type->members[i].name, name) == 0)
            return &fb->type->members[i];
    return NULL;
}

static void put(fb_t *fb, const char *name, const void *value, size_t size)
{
    const block_member_t *member = member_of(fb, name);
    if (member) {
        ck_assert_msg(size <= member->size, "%s.%s", fb->type->name, name);
        memcpy(fb->memory + member->offset, value, size);
    }
}

static void put_number(fb_t *fb, const char *name, double value) { put(fb, name, &value, sizeof value); }
static void put_mode(fb_t *fb, MC_BUFFER_MODE mode) { put(fb, "BufferMode", &mode, sizeof mode); }
static bool has(const fb_t *fb, const char *name) { return member_of(fb, name) != NULL; }

static BOOL flag(const fb_t *fb, const char *name)
{
    const block_member_t *member = member_of(fb, name);
    return member ? fb->memory[member->offset] : FALSE;
}

/* With inputs that suit where the axes stand in these tests. */
static fb_t *make(const char *name)
{
    static const double end[8] = {2.0, 1.0, 0.5}, border[8] = {1.0, 2.0, 0.5};
    const AXES_GROUP_REF_t *reference = &group_reference;
    static AXIS_REF_t axis;
    const AXIS_REF_t *axis_pointer = &axis;
    const MC_IDENT_IN_GROUP ident = 2;
    ck_assert_int_lt(fb_count, FBS);
    fb_t *fb = &fbs[fb_count++];
    memset(fb, 0, sizeof *fb);
    for (size_t i = 0; i < block_count && !fb->type; i++)
        if (strcmp(block_table[i].name, name) == 0)
            fb->type = &block_table[i];
    ck_assert_msg(fb->type && fb->type->size <= sizeof fb->memory, "%s", name);
    put(fb, "AxesGroup", &reference, sizeof reference);
    if (strcmp(name, "MC_AddAxisToGroup") == 0) {
        axis = axes_reference(1);
        put(fb, "Axis", &axis_pointer, sizeof axis_pointer);
    }
    put(fb, "IdentInGroup", &ident, sizeof ident);
    put(fb, "Position", end, sizeof end);
    put(fb, "Distance", end, sizeof end);
    put(fb, "EndPoint", end, sizeof end);
    put(fb, "AuxPoint", border, sizeof border);
    put_number(fb, "Velocity", 3.0);
    return fb;
}

static shown_t show(const fb_t *fb)
{
    shown_t now = {flag(fb, "Execute") || flag(fb, "Enable"), flag(fb, "Done"), flag(fb, "Busy"), flag(fb, "Active"),
                   flag(fb, "CommandAccepted"), flag(fb, "CommandAborted"), flag(fb, "Error"), 0};
    memcpy(&now.error_id, fb->memory + member_of(fb, "ErrorID")->offset, sizeof now.error_id);
    return now;
}

#define RULE(condition, rule)                                                                                        \
    AXES_MUST(condition, "%s: %s (X%d D%d B%d A%d C%d E%d 0x%04X)", fb->type->name, rule, now->execute, now->done,   \
              now->busy, now->active, now->aborted, now->error, now->error_id)

static void call(fb_t *fb)
{
    fb->before = fb->now;
    fb->type->call(fb->memory);
    fb->now = show(fb);
    const shown_t *now = &fb->now, *before = &fb->before;
    const int results = now->done + now->aborted + now->error;
    const bool edge = now->execute && !before->execute;
    RULE(now->done + now->busy + now->aborted + now->error <= 1, "outputs exclude each other");
    RULE(!now->execute || now->busy || results, "Execute and no output");
    RULE(!now->error == !now->error_id, "Error and ErrorID");
    RULE(!now->active || now->busy, "Active without Busy");
    RULE(!has(fb, "CommandAccepted") || now->accepted == (now->busy || now->done), "CommandAccepted");
    RULE(!now->busy || before->busy || edge, "Busy without an edge");
    RULE(!before->busy || now->busy || results || has(fb, "Enable"), "Busy fell and nothing rose");
    RULE(now->execute || !results || before->busy || edge, "a result outlives Execute");
    RULE(!has(fb, "Active") || !before->active || now->active || !now->busy || edge || group->interruption.on,
         "Active fell while Busy");
    RULE(!now->active || edge || !group->interruption.on, "Active while its group is interrupted");
    if (edge)
        fb->refused = now->error;
}

static void program(void)
{
    for (int i = 0; i < fb_count; i++)
        call(&fbs[i]);
}

/* Somewhere else than where make() goes. */
static void elsewhere(fb_t *fb)
{
    static const double other[8] = {-1.0, 2.0, 0.0}, by_way[8] = {0.0, 2.5, 0.0};
    put(fb, "Position", other, sizeof other);
    put(fb, "EndPoint", other, sizeof other);
    put(fb, "AuxPoint", by_way, sizeof by_way);
}

static void execute(fb_t *fb, BOOL value) { put(fb, "Execute", &value, sizeof value); }

/* The edge, and what the block says of it. */
static WORD start(fb_t *fb)
{
    execute(fb, TRUE);
    axes_cycles(1);
    return fb->now.error_id;
}

static bool ended(const fb_t *fb) { return !fb->now.busy; }

static void until_ended(fb_t *fb)
{
    for (int i = 0; i < 30000 && !ended(fb); i++)
        axes_cycles(1);
    AXES_MUST(ended(fb), "%s never ends", fb->type->name);
}

/* ---- the group --------------------------------------------------------------------------------------------------- */

static char scene[160];

static void begin(void)
{
    fb_count = 0;
    group_begin(3);
    axes_bench.program = program;
    axes_bench.run = scene;
}

static fb_t *into(cm1e_group_state_t state)
{
    begin();
    fb_t *fb = make(state == CM1E_GROUP_STOPPING   ? "MC_GroupStop"
                    : state == CM1E_GROUP_DISABLED ? "MC_GroupDisable" : "MC_MoveLinearAbsolute");
    if (state != CM1E_GROUP_STANDBY)
        start(fb);
    axes_cycles(50);
    if (state == CM1E_GROUP_ERROR_STOP) {
        fake_bus_fault(axes_motor(2), 0x2310);
        axes_cycles(400);
    }
    group_must_be(state);
    return fb;
}

static const char *const moves[] = {"MC_MoveLinearAbsolute", "MC_MoveLinearRelative", "MC_MoveCircularAbsolute",
                                    "MC_MoveCircularRelative", "MC_MoveDirectAbsolute", "MC_MoveDirectRelative",
                                    "MC_GroupHalt", "MC_GroupStop"};
enum { MOVES = sizeof moves / sizeof *moves, HALT = MOVES - 2, STOP = MOVES - 1 };

static const cm1e_error_t refusals[CM1E_GROUP_STATE_COUNT] = {
    [CM1E_GROUP_DISABLED] = CM1E_ERROR_GROUP_DISABLED,
    [CM1E_GROUP_STOPPING] = CM1E_ERROR_GROUP_STOPPING,
    [CM1E_GROUP_ERROR_STOP] = CM1E_ERROR_GROUP_ERROR_STOP,
};

/* ---- every block, state and mode --------------------------------------------------------------------------------- */

static bool halts_by_blending(int move, int mode) { return move == HALT && mode >= mcBlendingLow; }

START_TEST(test_every_move_in_every_state_and_mode)
{
    for (int state = 0; state < CM1E_GROUP_STATE_COUNT; state++)
        for (int mode = mcAborting; mode <= mcBlendingHigh; mode++) {
            snprintf(scene, sizeof scene, "%s in %s, mode %d", moves[_i],
                     cm1e_group_state_name((cm1e_group_state_t)state), mode);
            into((cm1e_group_state_t)state);
            fb_t *fb = make(moves[_i]);
            elsewhere(fb);
            put_mode(fb, (MC_BUFFER_MODE)mode);
            const cm1e_error_t right = refusals[state]                ? refusals[state]
                                       : halts_by_blending(_i, mode) ? CM1E_ERROR_AXIS_BUFFER_MODE : CM1E_OK;
            const WORD id = start(fb);
            AXES_MUST(id == cm1e_error_id(right), "ErrorID 0x%04X instead of 0x%04X: %s", id, cm1e_error_id(right),
                      group_text());
            until_ended(fb);
            AXES_MUST(right != CM1E_OK || fb->now.done, "it is not Done: %s", group_text());
            execute(fb, FALSE);
            axes_cycles(2000);
        }
}
END_TEST

/* Administrative blocks: in which states they are taken; D S M P E as in test_group_states. */
START_TEST(test_every_administrative_block_in_every_state)
{
    static const struct {
        const char *name;
        const char *taken; /* by cm1e_group_state_t; x: Error */
    } blocks[] = {
        {"MC_AddAxisToGroup", "xxxxx"}, /* it is one already */
        {"MC_RemoveAxisFromGroup", "yxxxx"},
        {"MC_UngroupAllAxes", "yyyyy"},
        {"MC_GroupEnable", "yyxxx"},
        {"MC_GroupDisable", "yyyyy"},
        {"MC_GroupReset", "yyyyy"},
        {"MC_GroupInterrupt", "xxyxx"},
        {"MC_GroupContinue", "xxxxx"}, /* nothing is interrupted */
    };
    for (size_t b = 0; b < sizeof blocks / sizeof *blocks; b++)
        for (int state = 0; state < CM1E_GROUP_STATE_COUNT; state++) {
            snprintf(scene, sizeof scene, "%s in %s", blocks[b].name, cm1e_group_state_name((cm1e_group_state_t)state));
            into((cm1e_group_state_t)state);
            fb_t *fb = make(blocks[b].name);
            start(fb);
            until_ended(fb);
            AXES_MUST(fb->now.done == (blocks[b].taken[state] == 'y'), "Done %d, ErrorID 0x%04X: %s", fb->now.done,
                      fb->now.error_id, group_text());
            execute(fb, FALSE);
            axes_cycles(500);
        }
}
END_TEST

START_TEST(test_reading_blocks_in_every_state)
{
    static const char *const states[CM1E_GROUP_STATE_COUNT] = {"GroupDisabled", "GroupStandby", "GroupMoving",
                                                               "GroupStopping", "GroupErrorStop"};
    static const char *const names[] = {"MC_GroupReadStatus", "MC_GroupReadError", "MC_GroupReadConfiguration",
                                        "MC_GroupReadPosition", "MC_GroupReadVelocity"};
    for (int state = 0; state < CM1E_GROUP_STATE_COUNT; state++)
        for (size_t n = 0; n < 5; n++) {
            snprintf(scene, sizeof scene, "%s in %s", names[n], states[state]);
            into((cm1e_group_state_t)state);
            fb_t *fb = make(names[n]);
            const BOOL on = TRUE, off = FALSE;
            for (int again = 0; again < 2; again++) {
                put(fb, "Enable", &on, sizeof on);
                axes_cycles(3);
                AXES_MUST(flag(fb, "Valid") && flag(fb, "Busy") && !flag(fb, "Error"), "Valid %d", flag(fb, "Valid"));
                for (int other = 0; other < CM1E_GROUP_STATE_COUNT && n == 0; other++)
                    AXES_MUST(flag(fb, states[other]) == (other == state), "%s", states[other]);
                put(fb, "Enable", &off, sizeof off);
                axes_cycles(1);
                AXES_MUST(!flag(fb, "Valid") && !flag(fb, "Busy") && !flag(fb, states[state]), "an output stays");
            }
        }
}
END_TEST

/* ---- one behind the other ---------------------------------------------------------------------------------------- */

START_TEST(test_every_move_behind_every_other_in_every_mode)
{
    const int stride = sweep_stride(1, 5); /* a sample: each of them at one moment */
    for (int first = 0; first < MOVES; first++)
        for (int second = 0; second < MOVES; second++)
            for (int mode = mcAborting; mode <= mcBlendingHigh; mode++)
                for (int phase = 1 + 211 * ((first + second + mode) % stride); phase < 900; phase += 211 * stride) {
                    if (first == STOP || (second == STOP && mode != mcAborting) || halts_by_blending(second, mode))
                        continue;
                    snprintf(scene, sizeof scene, "%s, after %d cycles %s in mode %d", moves[first], phase,
                             moves[second], mode);
                    begin();
                    fb_t *a = make(moves[first]), *b = make(moves[second]);
                    ck_assert_uint_eq(start(a), 0);
                    axes_cycles(phase);
                    elsewhere(b);
                    put_mode(b, (MC_BUFFER_MODE)mode);
                    const bool running = a->now.busy, aborts = mode == mcAborting || second == STOP;
                    ck_assert_uint_eq(start(b), 0);
                    if (running && aborts)
                        axes_cycles(1);
                    AXES_MUST(!running || a->now.aborted == aborts, "the first one: aborted %d", a->now.aborted);
                    AXES_MUST(!running || aborts || !b->now.active, "the second one is Active while the first moves");
                    until_ended(a);
                    until_ended(b);
                    AXES_MUST(b->now.done, "the second one is not Done: %s", group_text());
                    AXES_MUST(a->now.done || (running && aborts), "the first one is not Done");
                    execute(b, FALSE);
                    axes_cycles(3);
                    group_must_be(CM1E_GROUP_STANDBY);
                }
}
END_TEST

/* A new edge of the same instance: its outputs no longer show the first command. */
START_TEST(test_every_move_triggered_again)
{
    for (int phase = 1; phase < 700; phase += 43) {
        snprintf(scene, sizeof scene, "%s, again after %d cycles", moves[_i], phase);
        begin();
        fb_t *line = make("MC_MoveLinearAbsolute"), *fb = make(moves[_i]);
        start(line);
        axes_cycles(200);
        ck_assert_uint_eq(start(fb), 0);
        axes_cycles(phase);
        execute(fb, FALSE);
        axes_cycles(1);
        const bool busy = fb->now.busy;
        const WORD id = start(fb);
        AXES_MUST(id == 0, "ErrorID 0x%04X: %s", id, group_text());
        AXES_MUST(!busy || _i == STOP || fb->now.busy || fb->now.done, "it does not begin anew");
        until_ended(fb);
        AXES_MUST(fb->now.done, "it is not Done");
        execute(fb, FALSE);
        axes_cycles(3);
        group_must_be(CM1E_GROUP_STANDBY);
    }
}
END_TEST

START_TEST(test_a_pulse_of_one_call_shows_the_result_for_one_call)
{
    snprintf(scene, sizeof scene, "%s, a pulse", moves[_i]);
    begin();
    fb_t *fb = make(moves[_i]);
    start(fb);
    execute(fb, FALSE);
    int shown = fb->now.done; /* of a halt at rest, in the call of its edge; then it still is Execute's */
    for (int i = 0; i < 5000; i++) {
        axes_cycles(1);
        shown += fb->now.done;
        AXES_MUST(!fb->now.aborted && !fb->now.error, "another result");
    }
    ck_assert_int_eq(shown, 1);
    group_must_be(CM1E_GROUP_STANDBY);
}
END_TEST

/* ---- interrupted ------------------------------------------------------------------------------------------------- */

/* By the same instances twice. Its blocks are Busy all the time, and Active but for the interruption. */
START_TEST(test_every_move_is_interrupted_and_goes_on)
{
    for (int phase = 1; phase < 700; phase += phase < 5 ? 1 : 67)
        for (int rest = 1; rest < 200; rest += 61) {
            snprintf(scene, sizeof scene, "%s, interrupted after %d cycles for %d", moves[_i], phase, rest);
            begin();
            fb_t *line = make("MC_MoveLinearRelative"), *fb = make(moves[_i]), *next = make("MC_MoveLinearAbsolute");
            fb_t *interrupt = make("MC_GroupInterrupt"), *go_on = make("MC_GroupContinue");
            start(line);
            axes_cycles(100);
            ck_assert_uint_eq(start(fb), 0);
            put_mode(next, mcBuffered);
            start(next);
            for (int again = 0; again < 2; again++) {
                axes_cycles(phase);
                if (group_info().state != CM1E_GROUP_MOVING)
                    break;
                const bool busy = fb->now.busy, active = fb->now.active, waits = next->now.busy;
                ck_assert_uint_eq(start(interrupt), 0);
                axes_cycles(rest);
                AXES_MUST(fb->now.busy == busy && next->now.busy == waits, "an interrupted block has ended");
                AXES_MUST(!fb->now.active && !next->now.active, "Active while it is interrupted");
                const bool rests = interrupt->now.done;
                ck_assert_uint_eq(start(go_on), 0);
                ck_assert(go_on->now.done);
                axes_cycles(1);
                AXES_MUST(!active || fb->now.active || fb->now.done, "it is not Active again");
                const bool done = interrupt->now.done; /* it may be so in the cycle in which it goes on */
                const WORD id = done ? 0 : cm1e_error_id(CM1E_ERROR_CANCELLED);
                AXES_MUST((done || !rests) && interrupt->now.error_id == id, "the interrupt: Done %d, 0x%04X", done,
                          interrupt->now.error_id);
                execute(interrupt, FALSE);
                execute(go_on, FALSE);
                axes_cycles(1);
            }
            until_ended(next);
            ck_assert(fb->now.done && next->now.done);
            axes_cycles(2);
            group_must_be(CM1E_GROUP_STANDBY);
        }
}
END_TEST

/* ---- the group itself -------------------------------------------------------------------------------------------- */

START_TEST(test_no_group_another_group_and_a_group_that_goes)
{
    AXES_GROUP_REF_t other, *pointer = &other;
    begin();
    ck_assert_int_eq(cm1e_group_create(&other, NULL, NULL), CM1E_OK);
    fb_t *fb = make("MC_MoveLinearAbsolute");
    start(fb);
    axes_cycles(100);
    put(fb, "AxesGroup", &pointer, sizeof pointer); /* while it is busy */
    axes_cycles(1);
    ck_assert_uint_eq(fb->now.error_id, cm1e_error_id(CM1E_ERROR_FB_AXIS_CHANGED));
    group_must_be(CM1E_GROUP_MOVING); /* neither is touched */
    execute(fb, FALSE);
    axes_cycles(2000);
    group_must_be(CM1E_GROUP_STANDBY);
    ck_assert_double_eq(group_at(0), 2.0);
    pointer = NULL;
    put(fb, "AxesGroup", &pointer, sizeof pointer);
    ck_assert_uint_eq(start(fb), cm1e_error_id(CM1E_ERROR_GROUP_REF));
    execute(fb, FALSE);
    axes_cycles(1);
    pointer = &other;
    put(fb, "AxesGroup", &pointer, sizeof pointer);
    ck_assert_int_eq(cm1e_group_destroy(other), CM1E_OK);
    ck_assert_uint_eq(start(fb), cm1e_error_id(CM1E_ERROR_GROUP_REF));
}
END_TEST

START_TEST(test_a_stop_that_is_in_error_still_holds_the_group)
{
    AXES_GROUP_REF_t other, *pointer = &other;
    begin();
    ck_assert_int_eq(cm1e_group_create(&other, NULL, NULL), CM1E_OK);
    fb_t *line = make("MC_MoveLinearAbsolute"), *stop = make("MC_GroupStop");
    start(line);
    axes_cycles(300);
    start(stop);
    put(stop, "AxesGroup", &pointer, sizeof pointer);
    axes_cycles(1000);
    ck_assert(stop->now.error);
    group_must_be(CM1E_GROUP_STOPPING);
    execute(stop, FALSE);
    axes_cycles(3);
    group_must_be(CM1E_GROUP_STANDBY);
    ck_assert_int_eq(cm1e_group_destroy(other), CM1E_OK);
}
END_TEST

START_TEST(test_a_refused_override_says_which_factor)
{
    static const struct { double velocity, acceleration, jerk; const char *why; } cases[] = {
        {2, 1, 1, "VelFactor"}, {NAN, 1, 1, "VelFactor"}, {1, 0, 1, "AccFactor"}, {1, 1, 0, "JerkFactor"},
    };
    begin();
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        MC_GroupSetOverride_t fb = {.AxesGroup = &group_reference, .Enable = TRUE, .VelFactor = cases[i].velocity,
                                    .AccFactor = cases[i].acceleration, .JerkFactor = cases[i].jerk};
        MC_GroupSetOverride(&fb);
        AXES_MUST(fb.ErrorID == cm1e_error_id(CM1E_ERROR_AXIS_OVERRIDE), "0x%04X", fb.ErrorID);
        AXES_MUST(strstr(group_text(), cases[i].why), "no %s in: %s", cases[i].why, group_text());
    }
}
END_TEST

/* ---- MC_MoveDirect... -------------------------------------------------------------------------------------------- */

/* Four axes, of which the third one has a tenth of the velocity of the others; distances, and the axis that needs the
 * longest time for its one. */
static const struct {
    double way[8];
    int slowest;
} direct_ways[] = {{{40, 20, 1, -5}, 0}, {{1, 30, -29, 0}, 2}, {{0, 0, 0, 25}, 3}, {{-0.5, 0.25, 0, 40}, 3}};

static void four_axes(void)
{
    fb_count = 0;
    group_end();
    axes_describe(4);
    axes_config(2)->max_velocity = 5.0;
    axes_make();
    axes_enable_all();
    axes_bench.program = program;
    axes_bench.run = scene;
}

/* Cycles until it is Done; the axes keep on a straight line meanwhile. */
static int direct_cycles(fb_t *fb, const double *way, int slowest)
{
    int cycles = 0;
    for (execute(fb, TRUE); !fb->now.done && cycles < 20000; cycles++) {
        axes_cycles(1);
        for (int n = 0; n < 4; n++)
            AXES_MUST(fabs(group_at(n) - group_at(slowest) / way[slowest] * way[n]) < 1e-9, "axis %d is off the line", n);
    }
    AXES_MUST(fb->now.done && fabs(group_at(slowest) - way[slowest]) < 1e-9, "not Done there: %s", group_text());
    return cycles;
}

static int cycles_alone(int n, double way)
{
    AXIS_REF_t axis = axes_reference(n);
    MC_MoveRelative_t move = {.Axis = &axis, .Distance = way, .Execute = TRUE,
                              .Velocity = axes_bench.axes[n]->limits.maximum.velocity};
    int cycles = 0;
    for (; !move.Done && cycles < 20000; cycles++) {
        MC_MoveRelative(&move);
        AXES_MUST(!move.Error, "0x%04X", move.ErrorID);
        axes_cycles(1);
    }
    return cycles;
}

START_TEST(test_a_direct_motion_takes_as_long_as_its_slowest_axis_alone)
{
    for (size_t i = 0; i < sizeof direct_ways / sizeof *direct_ways; i++) {
        const double *way = direct_ways[i].way;
        snprintf(scene, sizeof scene, "way %zu", i);
        four_axes();
        const int alone = cycles_alone(direct_ways[i].slowest, way[direct_ways[i].slowest]);
        four_axes();
        group_form();
        AXES_MUST(cm1e_group_enable(group) == CM1E_OK, "%s", group_text());
        fb_t *fb = make(_i ? "MC_MoveDirectRelative" : "MC_MoveDirectAbsolute");
        put(fb, _i ? "Distance" : "Position", way, sizeof direct_ways[i].way);
        const int together = direct_cycles(fb, way, direct_ways[i].slowest);
        AXES_MUST(abs(together - alone) <= 2, "%d cycles, the axis alone needs %d", together, alone);
    }
}
END_TEST

/* The block is refused in every call, and its text appears once, and again when another factor is refused. */
START_TEST(test_a_refused_override_does_not_hide_the_text_of_a_command)
{
    begin();
    MC_GroupSetOverride_t fb = {.AxesGroup = &group_reference, .Enable = TRUE, .VelFactor = 2, .AccFactor = 1,
                                .JerkFactor = 1};
    MC_GroupSetOverride(&fb);
    AXES_MUST(strstr(group_text(), "2 was given. VelFactor"), "%s", group_text());
    fb.VelFactor = 3;
    MC_GroupSetOverride(&fb);
    AXES_MUST(strstr(group_text(), "3 was given. VelFactor"), "%s", group_text());
    fb_t *line = make("MC_MoveLinearAbsolute");
    put_number(line, "Velocity", NAN);
    start(line);
    char *before = strdup(group_text());
    AXES_MUST(line->now.error && !strstr(before, "VelFactor"), "%s", before);
    MC_GroupSetOverride(&fb);
    AXES_MUST(strcmp(group_text(), before) == 0, "%s", group_text());
    free(before);
}
END_TEST

/* ---- an axis that is lost ---------------------------------------------------------------------------------------- */

START_TEST(test_power_loss_of_an_axis_in_every_phase)
{
    for (int victim = 0; victim < 3; victim++)
        for (int phase = 1; phase < 1200; phase += phase < 8 ? 1 : 113) {
            snprintf(scene, sizeof scene, "%s, axis %d loses its power after %d cycles", moves[_i], victim, phase);
            begin();
            fb_t *line = make("MC_MoveLinearRelative"), *fb = make(moves[_i]), *waiting = make("MC_MoveLinearAbsolute");
            start(line);
            axes_cycles(150);
            ck_assert_uint_eq(start(fb), 0);
            put_mode(waiting, mcBuffered);
            const bool can_wait = _i != STOP;
            if (can_wait)
                start(waiting);
            axes_cycles(phase);
            const bool busy = fb->now.busy, waits = waiting->now.busy;
            const bool moving = group_info().state == CM1E_GROUP_MOVING || (_i == STOP && busy);
            axes_power(victim, false);
            axes_cycles(2);
            const WORD lost = cm1e_error_id(CM1E_ERROR_GROUP_ERROR_STOP);
            AXES_MUST(!busy || fb->now.error_id == lost, "ErrorID 0x%04X", fb->now.error_id);
            AXES_MUST(!can_wait || !waits || waiting->now.error_id == lost, "waiting: ErrorID 0x%04X",
                      waiting->now.error_id);
            group_must_be(moving ? CM1E_GROUP_ERROR_STOP : _i == STOP ? CM1E_GROUP_STOPPING : CM1E_GROUP_STANDBY);
            axes_cycles(1000);
            for (int n = 0; n < 3; n++)
                AXES_MUST(axes_info(n).set_velocity == 0.0, "axis %d still moves", n);
            fb_count = 0;
            fb_t *reset = make("MC_GroupReset");
            axes_power(victim, true);
            start(reset);
            until_ended(reset);
            ck_assert(reset->now.done);
        }
}
END_TEST

/* ---- blocks with a single axis beside ---------------------------------------------------------------------------- */

START_TEST(test_the_group_s_axes_and_their_own_blocks)
{
    AXIS_REF_t axis;
    begin();
    axis = axes_reference(1);
    fb_t *line = make("MC_MoveLinearAbsolute");
    MC_MoveAbsolute_t move = {.Axis = &axis, .Position = 1.0, .Velocity = 1.0, .Execute = TRUE};
    MC_Stop_t stop = {.Axis = &axis};
    start(line);
    axes_cycles(200);
    MC_MoveAbsolute(&move);
    ck_assert_uint_eq(move.ErrorID, cm1e_error_id(CM1E_ERROR_AXIS_IN_GROUP));
    stop.Execute = TRUE;
    MC_Stop(&stop);
    ck_assert(stop.Busy);
    axes_cycles(2);
    ck_assert_uint_eq(line->now.error_id, cm1e_error_id(CM1E_ERROR_GROUP_ERROR_STOP));
    group_must_be(CM1E_GROUP_ERROR_STOP);
    for (int i = 0; i < 1000; i++) {
        MC_Stop(&stop);
        axes_cycles(1);
    }
    ck_assert(stop.Done);
    stop.Execute = FALSE;
    MC_Stop(&stop);
    axes_cycles(2);
    for (int n = 0; n < 3; n++)
        axes_must_be(n, CM1E_AXIS_STANDSTILL);
    fb_t *reset = make("MC_GroupReset");
    start(reset);
    until_ended(reset);
    execute(line, FALSE);
    axes_cycles(1);
    start(line);
    until_ended(line);
    ck_assert(line->now.done);
}
END_TEST

/* A slave of an axis of the group follows it without a cycle of delay, in any order of the axes. */
START_TEST(test_an_axis_of_the_group_is_a_master)
{
    static const int orders[][3] = {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}};
    snprintf(scene, sizeof scene, "a slave, order %d", _i);
    fb_count = 0;
    group_end();
    axes_begin(3);
    axes_bench.run = scene;
    memcpy(axes_bench.order, orders[_i], sizeof orders[_i]);
    group_create();
    ck_assert_int_eq(cm1e_group_add(group, axes_reference(0), 0), CM1E_OK);
    ck_assert_int_eq(cm1e_group_add(group, axes_reference(1), 0), CM1E_OK);
    ck_assert_int_eq(cm1e_group_enable(group), CM1E_OK);
    axes_bench.program = program;
    const cm1e_command_id_t gear = axes_gear_in(2, 0, 1, 2);
    axes_wait_reached(2, gear, 2000);
    const double x = group_at(0), slave = group_at(2);
    fb_t *line = make("MC_MoveLinearAbsolute");
    start(line);
    while (line->now.busy) {
        axes_cycles(1);
        ck_assert_double_eq_tol(group_at(2) - slave, (group_at(0) - x) / 2.0, 1.0 / 50000.0);
    }
    ck_assert(line->now.done);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("blocks of axes groups");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    tcase_add_loop_test(all, test_every_move_in_every_state_and_mode, 0, MOVES);
    tcase_add_test(all, test_every_administrative_block_in_every_state);
    tcase_add_test(all, test_reading_blocks_in_every_state);
    tcase_add_test(all, test_every_move_behind_every_other_in_every_mode);
    tcase_add_loop_test(all, test_every_move_triggered_again, 0, MOVES);
    tcase_add_loop_test(all, test_a_pulse_of_one_call_shows_the_result_for_one_call, 0, MOVES);
    tcase_add_loop_test(all, test_every_move_is_interrupted_and_goes_on, 0, STOP);
    tcase_add_test(all, test_no_group_another_group_and_a_group_that_goes);
    tcase_add_test(all, test_a_stop_that_is_in_error_still_holds_the_group);
    tcase_add_test(all, test_a_refused_override_says_which_factor);
    tcase_add_loop_test(all, test_a_direct_motion_takes_as_long_as_its_slowest_axis_alone, 0, 2);
    tcase_add_test(all, test_a_refused_override_does_not_hide_the_text_of_a_command);
    tcase_add_loop_test(all, test_power_loss_of_an_axis_in_every_phase, 0, MOVES);
    tcase_add_test(all, test_the_group_s_axes_and_their_own_blocks);
    tcase_add_loop_test(all, test_an_axis_of_the_group_is_a_master, 0, 3);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
