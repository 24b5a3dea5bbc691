/*
 * Two moves of one axis, one after the other, in all six buffer modes (PLCopen Part 1, 2.4.2): a fast one and then a
 * slow one on the way there, a slow one and then a fast one on the way back. The second command is always given halfway
 * through the first move. The modes differ in the velocity with which the axis passes the end of the first move: the
 * program measures and prints it, and `--svg FILE` shows it.
 *
 *     04_buffer_modes -i sim --svg modes.svg
 */
#include "example.h"

/* Revolutions, revolutions per second. */
static const LREAL middle = 2, far_end = 4, fast = 8, slow = 4;

static const struct {
    MC_BUFFER_MODE mode;
    const char *name;
} modes[] = {
    {mcAborting, "mcAborting"}, {mcBuffered, "mcBuffered"}, {mcBlendingLow, "mcBlendingLow"},
    {mcBlendingPrevious, "mcBlendingPrevious"}, {mcBlendingNext, "mcBlendingNext"},
    {mcBlendingHigh, "mcBlendingHigh"},
};
enum { MODES = sizeof modes / sizeof modes[0], THERE = 0, BACK };

static example_t example;
static MC_Power_t power = {.Axis = &example.axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
static MC_MoveAbsolute_t first = {.Axis = &example.axis, .Acceleration = 80, .Deceleration = 80, .Jerk = 2000};
static MC_MoveAbsolute_t second = {.Axis = &example.axis, .Acceleration = 80, .Deceleration = 80, .Jerk = 2000};
static int mode, way;
static bool under_way;
static LREAL position_before, passed[MODES][2]; /* velocity at the end of the first move */
static WORD error_id;

static void begin(void)
{
    first.Position = middle;
    first.Velocity = way == THERE ? fast : slow;
    second.Position = way == THERE ? far_end : 0;
    second.Velocity = way == THERE ? slow : fast;
    second.BufferMode = modes[mode].mode;
    if (way == THERE)
        cm1e_scheduler_mark(example.scheduler, modes[mode].name);
}

static void measure(const cm1e_axis_info_t *now)
{
    if ((position_before < middle) != (now->set_position < middle))
        passed[mode][way] = now->set_velocity < 0 ? -now->set_velocity : now->set_velocity;
    position_before = now->set_position;
}

/* TRUE when both moves are done. */
static bool two_moves(const cm1e_axis_info_t *now)
{
    const LREAL halfway = way == THERE ? middle / 2 : far_end - middle / 2;
    if (!under_way)
        begin();
    first.Execute = TRUE;
    MC_MoveAbsolute(&first);
    if (under_way && (way == THERE ? now->set_position >= halfway : now->set_position <= halfway))
        second.Execute = TRUE;
    MC_MoveAbsolute(&second);
    under_way = true;
    if (!second.Done)
        return false;
    first.Execute = second.Execute = under_way = FALSE; /* the next edge needs a call with FALSE before */
    MC_MoveAbsolute(&first);
    MC_MoveAbsolute(&second);
    return true;
}

static void program(void *context)
{
    (void)context;
    cm1e_axis_info_t now;
    cm1e_axis_read(example.axis, &now);
    measure(&now);
    power.Enable = mode < MODES;
    MC_Power(&power);
    if (mode == MODES) {
        if (!power.Status)
            example_finish(&example);
    } else if (power.Status && two_moves(&now)) {
        mode += way == BACK;
        way = way == THERE ? BACK : THERE;
    }
    const WORD error = power.Error ? power.ErrorID : first.Error ? first.ErrorID : second.Error ? second.ErrorID : 0;
    if (error != 0 && error_id == 0) {
        error_id = error;
        example_finish(&example);
    }
}

static void print_report(void)
{
    printf("u/s where the first move ends   %g, then %g   %g, then %g\n", fast, slow, slow, fast);
    for (int i = 0; i < mode; i++)
        printf("%-30s %8.2f %11.2f\n", modes[i].name, passed[i][THERE], passed[i][BACK]);
}

int main(int argc, char **argv)
{
    cm1e_diag_t why = {0};
    example_options(&example, argc, argv, "Two moves in a row, in all buffer modes.");
    cm1e_error_t error = example_open(&example, &why);
    if (error == CM1E_OK)
        error = example_run(&example, program, &why);
    if (example_is_done(&example, error))
        print_report();
    if (error_id != 0)
        example_tell_error(&example, error_id);
    return example_end(&example, error, &why, mode == MODES && error_id == 0);
}
