/**
 * @file random_group.h
 * Axes groups of a random program: blocks that act on them, with inputs of which many make sense, and what must hold of
 * a group whatever it is told. Part of random_program.h.
 */
#ifndef CM1E_TESTS_RANDOM_GROUP_H
#define CM1E_TESTS_RANDOM_GROUP_H

#include "block_judge.h"

enum { GROUPS_MOST = 2 };

/** Where a line that was begun at rest is to end, as long as nothing else is known to have touched it. */
typedef struct group_story {
    bool known;
    int instance;
    double end[CM1E_GROUP_AXES], origin[CM1E_GROUP_AXES];
} group_story_t;

struct random_group {
    AXES_GROUP_REF_t reference;
    cm1e_group_t *group;
    cm1e_group_state_t state;       /**< last judged */
    bool reset_asked;               /**< since GroupErrorStop */
    bool edge_in_cycle;             /**< who was aborted by it may have been called before */
    int still_cycles, braking_cycles;
    group_story_t story;
};
extern struct random_group groups[GROUPS_MOST];
extern int group_count;
extern unsigned long long led_total, group_done_total;
extern unsigned group_seen[CM1E_GROUP_STATE_COUNT];

struct random_group *random_group_of(const instance_t *fb);

/* ---- to make and to end them ------------------------------------------------------------------------------------- */

void make_groups(void);

/** When their axes are gone. */
void end_groups(void);

/* ---- inputs ------------------------------------------------------------------------------------------------------ */

void choose_of_group(instance_t *fb);
void bring_on(const struct random_group *g);

/** The block may act now: while a group has work for its axes, others are asked for less often. */
bool leaves_groups_alone(const instance_t *fb);

/* ---- what must hold ---------------------------------------------------------------------------------------------- */

void judge_group_states(const instance_t *fb);

/** An axis is led by the group whose member it is, and then in SynchronizedMotion; in that state it is led, or
 *  follows. */
void judge_led(void);

/** Moves with a command, and only then; what is to come to rest does. */
void judge_group(struct random_group *g, int longest, int stuck);

/** A line from rest that was taken: where it goes. `set`: where its axes were. */
void begin_group_story(const instance_t *fb, int n, const double *set, cm1e_group_state_t before);

/** Done: those of its axes that stand and have no other names for their places since are where it was to end. One that
 *  has failed since is braked where its motor is. */
void judge_group_arrival(int n);

#endif
