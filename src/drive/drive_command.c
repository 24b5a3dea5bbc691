#include "drive/drive_command.h"

#include "core/clock.h"
#include "drive/drive_kind.h"
#include "drive/drive_private.h"

enum { PHASE_IDLE = 0, PHASE_READY, PHASE_COMMAND, PHASE_ANSWER, PHASE_SEARCH };

enum { READY = 0x0007, SEARCH_COMPLETED = 0xF8, SEARCH_TIMED_OUT = 0xF9 };
enum { CYCLES = 5 };      /* "Wait for 5 cycles of PDO sending" (BR appendix 1) */
enum { ATTEMPTS = 3 };    /* to end a search: F607h, and F107h thereafter */
static const int64_t answer_ns = 100 * MS_IN_NS;
static const int64_t search_ns = 90000 * MS_IN_NS;
static const int64_t silence_ns = 100 * MS_IN_NS; /* so long without inputs: the bus is away */
static const int64_t release_ns = 2000 * MS_IN_NS;

static uint8_t high_byte(const cm1e_drive_t *drive) { return (uint8_t)(drive->feedback.statusword >> 8); }

static bool in_cmd(const cm1e_drive_t *drive)
{
    return drive->mode.words->commands && drive->mode.words == drive->mode.wanted->words;
}

uint16_t cm1e_drive_cmd_word(const cm1e_drive_t *drive)
{
    const cm1e_drive_cmd_run_t *run = &drive->behind->cmd;
    const bool command = run->phase == PHASE_COMMAND || run->phase == PHASE_ANSWER || run->phase == PHASE_SEARCH;
    return (uint16_t)((command ? run->sending << 8 : 0) | (run->ready ? READY : 0));
}

static void send(cm1e_drive_t *drive, cm1e_drive_cmd_t command, bool ending)
{
    cm1e_drive_cmd_run_t *run = &drive->behind->cmd;
    run->sending = command;
    run->ending = ending;
    run->phase = PHASE_READY;
    run->cycles = 0;
    run->ready = true;
    run->heard_ns = drive->now_ns;
}

static void begin(cm1e_drive_t *drive, cm1e_drive_cmd_t command)
{
    drive->behind->cmd.command = command;
    drive->behind->cmd.state = CM1E_DRIVE_CMD_SENDING;
    drive->behind->cmd.attempts = 0;
    send(drive, command, false);
}

static bool is_command(cm1e_drive_cmd_t command)
{
    return command == CM1E_DRIVE_CMD_MOTOR_FREE || command == CM1E_DRIVE_CMD_MOTOR_ENABLE ||
           command == CM1E_DRIVE_CMD_ORIGIN_SEARCH || command == CM1E_DRIVE_CMD_RESET_COUNTER ||
           command == CM1E_DRIVE_CMD_ORIGIN_SEARCH_ABORT;
}

static bool stops(cm1e_drive_cmd_t command)
{
    return command == CM1E_DRIVE_CMD_MOTOR_FREE || command == CM1E_DRIVE_CMD_ORIGIN_SEARCH_ABORT;
}

cm1e_error_t cm1e_drive_cmd_start(cm1e_drive_t *drive, cm1e_drive_cmd_t command, int64_t timeout_ns)
{
    if (!is_command(command) || timeout_ns < 0)
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (!in_cmd(drive))
        return CM1E_ERROR_STATE;
    if (!drive->feedback.online)
        return CM1E_ERROR_AXIS_OFFLINE;
    if ((drive->behind->cmd.phase != PHASE_IDLE || drive->behind->cmd.may_search) && !stops(command))
        return CM1E_ERROR_BUSY;
    drive->behind->cmd.timeout_ns = timeout_ns ? timeout_ns : search_ns;
    drive->behind->cmd.release_ns = 0;
    begin(drive, command);
    return CM1E_OK;
}

cm1e_drive_cmd_state_t cm1e_drive_cmd_state(const cm1e_drive_t *drive)
{
    return drive->behind ? drive->behind->cmd.state : CM1E_DRIVE_CMD_IDLE;
}

/* The result of an attempt to end a search is the result of the search itself. */
static void end(cm1e_drive_cmd_run_t *run, cm1e_drive_cmd_state_t state)
{
    run->phase = PHASE_IDLE;
    if (!run->ending)
        run->state = state;
}

static void answered(cm1e_drive_t *drive)
{
    cm1e_drive_cmd_run_t *run = &drive->behind->cmd;
    if (run->sending == CM1E_DRIVE_CMD_ORIGIN_SEARCH) {
        run->phase = PHASE_SEARCH;
        run->state = CM1E_DRIVE_CMD_SEARCHING;
        run->deadline_ns = drive->now_ns + run->timeout_ns;
        return;
    }
    if (stops(run->sending))
        run->may_search = false;
    end(run, CM1E_DRIVE_CMD_DONE);
}

static void search_step(cm1e_drive_t *drive, uint8_t shown)
{
    cm1e_drive_cmd_run_t *run = &drive->behind->cmd;
    if (shown == SEARCH_COMPLETED || shown == SEARCH_TIMED_OUT) {
        run->may_search = false;
        end(run, shown == SEARCH_COMPLETED ? CM1E_DRIVE_CMD_DONE : CM1E_DRIVE_CMD_SEARCH_TIME_OUT);
    } else if (drive->now_ns >= run->deadline_ns) {
        end(run, CM1E_DRIVE_CMD_GIVEN_UP);
    }
}

/* A short search may end before its beginning is seen. An answer that was there before the command belongs to another
 * command. */
static void answer_step(cm1e_drive_t *drive, uint8_t shown)
{
    cm1e_drive_cmd_run_t *run = &drive->behind->cmd;
    const bool over = run->sending == CM1E_DRIVE_CMD_ORIGIN_SEARCH && shown != run->before &&
                      (shown == SEARCH_COMPLETED || shown == SEARCH_TIMED_OUT);
    if (shown == run->sending || over)
        answered(drive);
    else if (drive->now_ns >= run->deadline_ns)
        end(run, CM1E_DRIVE_CMD_NOT_SENT);
    if (over)
        search_step(drive, shown);
}

/* The inputs of another cycle have arrived, so the outputs of one more cycle have, too. */
static void count(cm1e_drive_t *drive)
{
    cm1e_drive_cmd_run_t *run = &drive->behind->cmd;
    if (++run->cycles < CYCLES)
        return;
    run->cycles = 0;
    if (run->phase == PHASE_READY) {
        run->phase = PHASE_COMMAND;
        run->before = high_byte(drive);
        run->may_search |= run->sending == CM1E_DRIVE_CMD_ORIGIN_SEARCH;
    } else {
        run->phase = PHASE_ANSWER;
        run->deadline_ns = drive->now_ns + answer_ns;
    }
}

static void lose(cm1e_drive_t *drive)
{
    cm1e_drive_cmd_run_t *run = &drive->behind->cmd;
    if (cm1e_drive_cmd_busy(run->state))
        run->state = CM1E_DRIVE_CMD_LOST;
    run->phase = PHASE_IDLE;
    run->attempts = 0;
}

static void leave(cm1e_drive_t *drive)
{
    lose(drive);
    drive->behind->cmd.ready = false;
    if (drive->mode.shown) /* another mode is shown: no command of CMD is under way any more */
        drive->behind->cmd.may_search = false;
}

void cm1e_drive_cmd_step(cm1e_drive_t *drive)
{
    cm1e_drive_cmd_run_t *run = &drive->behind->cmd;
    if (!in_cmd(drive)) {
        if (run->ready || run->may_search)
            leave(drive);
        return;
    }
    if (drive->feedback.fresh)
        run->heard_ns = drive->now_ns;
    if (run->phase != PHASE_IDLE &&
        (!cm1e_drive_operational(drive) || drive->now_ns - run->heard_ns >= silence_ns))
        lose(drive);
    if (run->phase == PHASE_IDLE && run->may_search && run->attempts < ATTEMPTS && drive->feedback.online)
        send(drive, run->attempts++ == 0 ? CM1E_DRIVE_CMD_ORIGIN_SEARCH_ABORT : CM1E_DRIVE_CMD_MOTOR_FREE, true);
    else if (drive->feedback.fresh && (run->phase == PHASE_READY || run->phase == PHASE_COMMAND))
        count(drive);
    if (drive->feedback.fresh && run->phase == PHASE_ANSWER)
        answer_step(drive, high_byte(drive));
    else if (drive->feedback.fresh && run->phase == PHASE_SEARCH)
        search_step(drive, high_byte(drive));
}

bool cm1e_drive_cmd_release(cm1e_drive_t *drive)
{
    if (!in_cmd(drive) || !cm1e_drive_operational(drive))
        return true;
    cm1e_drive_cmd_run_t *run = &drive->behind->cmd;
    if (!run->ready)
        return true;
    if (run->release_ns == 0)
        run->release_ns = drive->now_ns;
    if (drive->now_ns - run->release_ns >= release_ns ||
        (run->command == CM1E_DRIVE_CMD_MOTOR_FREE && run->state == CM1E_DRIVE_CMD_DONE))
        return true;
    if (cm1e_drive_cmd_moves(drive) && !stops(run->sending))
        begin(drive, CM1E_DRIVE_CMD_ORIGIN_SEARCH_ABORT);
    else if (run->phase == PHASE_IDLE)
        begin(drive, CM1E_DRIVE_CMD_MOTOR_FREE);
    return false;
}
