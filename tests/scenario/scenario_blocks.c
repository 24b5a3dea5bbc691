/* Members of blocks by their names, from the table of all blocks. */
#include <string.h>

#include "scenario_private.h"

enum { LOOKS = 40, MEMBERS = 4093 };

const block_t *block_type(const char *name)
{
    for (size_t i = 0; i < block_count; i++)
        if (strcmp(block_table[i].name, name) == 0)
            return &block_table[i];
    return NULL;
}

/** What was found at some places of the members; names are never changed. Most of a run would go into comparing them. */
static struct { const block_t *type; const char *name; const block_member_t *member; } found_members[MEMBERS];

static const block_member_t *find_member(const block_t *type, const char *name)
{
    for (size_t i = 0; i < type->member_count; i++)
        if (strcmp(type->members[i].name, name) == 0)
            return &type->members[i];
    return NULL;
}

const block_member_t *block_member(const block_t *type, const char *name)
{
    const size_t at = ((uintptr_t)type / sizeof *type * 37 + (uintptr_t)name) % MEMBERS;
    if (found_members[at].type != type || found_members[at].name != name) {
        found_members[at].type = type;
        found_members[at].name = name;
        found_members[at].member = find_member(type, name);
    }
    return found_members[at].member;
}

const char *const step_homings[] = {"MC_StepAbsoluteSwitch", "MC_StepLimitSwitch", "MC_StepBlock", "MC_HomeDirect",
                                    "MC_FinishHoming", "MC_HomeAbsolute", "MC_StepReferencePulse",
                                    "MC_StepReferenceFlyingSwitch", NULL};
const char *const origin_blocks[] = {"MC_SetPosition", "MC_Home", "MC_HomeDirect", "MC_HomeAbsolute",
                                      "MC_StepAbsoluteSwitch", "MC_StepLimitSwitch", "MC_StepBlock",
                                      "MC_StepReferencePulse", "MC_StepReferenceFlyingSwitch", "MC_FinishHoming", NULL};
const char *const limit_blocks[] = {"MC_WriteParameter", NULL};
const char *const table_blocks[] = {"MC_PositionProfile", "MC_VelocityProfile", "MC_AccelerationProfile", NULL};

/** What has been looked for in the program, for each axis: 0: not yet, 1: it has it, -1: it has not. */
static struct { const char *const *blocks; signed char found[SCENARIO_AXES]; } looks[LOOKS];
static int look_count;

void program_forget(void)
{
    memset(looks, 0, sizeof looks);
    look_count = 0;
}

static bool look_for(const scenario_t *scenario, int axis, const char *const *blocks)
{
    for (int i = 0; i < scenario->step_count; i++)
        for (int n = 0; blocks[n] && (int)scenario->steps[i].axis == axis; n++)
            if (strcmp(scenario_blocks[(int)scenario->steps[i].block], blocks[n]) == 0)
                return true;
    return false;
}

bool program_has(const scenario_t *scenario, int axis, const char *const *blocks)
{
    int n = 0;
    while (n < look_count && looks[n].blocks != blocks)
        n++;
    if (n == LOOKS)
        return look_for(scenario, axis, blocks);
    if (n == look_count)
        looks[look_count++].blocks = blocks;
    signed char *found = &looks[n].found[axis];
    if (*found == 0)
        *found = look_for(scenario, axis, blocks) ? 1 : -1;
    return *found > 0;
}

bool block_flag(const instance_t *block, const char *name)
{
    const block_member_t *member = block_member(block->type, name);
    return member && block->memory[member->offset] != 0;
}

double block_number(const instance_t *block, const char *name)
{
    const block_member_t *member = block_member(block->type, name);
    double value = 0;
    if (member && member->type == BLOCK_LREAL && member->size == sizeof value)
        memcpy(&value, block->memory + member->offset, sizeof value);
    return value;
}

bool block_is(const instance_t *block, const char *name) { return strcmp(block->type->name, name) == 0; }

void block_point(instance_t *block, const char *name, const void *what)
{
    const block_member_t *member = block_member(block->type, name);
    if (member)
        memcpy(block->memory + member->offset, &what, sizeof what);
}

void block_put(instance_t *block, const char *name, double value)
{
    const block_member_t *member = block_member(block->type, name);
    if (!member || member->section != BLOCK_INPUT)
        return;
    void *place = block->memory + member->offset;
    const int64_t whole = (int64_t)value;
    switch (member->type) {
    case BLOCK_LREAL: memcpy(place, &value, sizeof value); break;
    case BLOCK_BOOL:
    case BLOCK_INT:
    case BLOCK_UINT:
    case BLOCK_DINT:
    case BLOCK_UDINT:
    case BLOCK_WORD:
    case BLOCK_DWORD:
    case BLOCK_ENUM: memcpy(place, &whole, member->size); break; /* little endian */
    default: break;
    }
}
