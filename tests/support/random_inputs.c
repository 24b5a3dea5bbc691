#include "random_inputs.h"

#include <math.h>

#include "chance.h"

double absurd(double sensible)
{
    static const double odd[] = {NAN, INFINITY, -INFINITY, 0, -1, 1e300, -1e300, 1e-300, 4e9, -4e9, 1e18, 0x1p53, -0.0};
    if (!one_in(60))
        return sensible;
    return odd[pick(sizeof odd / sizeof odd[0])];
}

/* Small values more often than large ones. */
static double spread(double most) { return most * pow(10, -uniform(0, 3)); }
static double dynamics(double most) { return one_in(3) ? 0 : absurd(most * uniform(0.02, 1.005)); }

static double random_real(const char *name, const ranges_t *axis)
{
    static const struct {
        const char *name;
        double low, high;
    } plain[] = {{"TimeScale", 0, 3}, {"PositionScale", -1, 1}, {"VelocityScale", -1, 1}, {"AccelerationScale", -1, 1},
                 {"Torque", -50, 50}, {"TorqueRamp", 0, 100}, {"TorqueLimit", 0, 60}, {"Value", -10, 1000}};
    const double sign = one_in(2) ? 1 : -1;
    for (size_t i = 0; i < sizeof plain / sizeof plain[0]; i++)
        if (strcmp(name, plain[i].name) == 0)
            return absurd(one_in(4) ? 0 : uniform(plain[i].low, plain[i].high));
    if (strcmp(name, "TransitionParameter") == 0)
        return absurd(spread(axis->reach * 0.3));
    if (strcmp(name, "VelFactor") == 0)
        return absurd(one_in(3) ? (double)pick(2) : uniform(0, 1));
    if (strstr(name, "Factor"))
        return absurd(one_in(2) ? 1 : uniform(0.05, 1));
    if (strstr(name, "Velocity"))
        return absurd((one_in(4) ? sign : 1) * (one_in(3) ? spread(axis->velocity) : uniform(0, axis->velocity)));
    if (strstr(name, "Acceleration"))
        return dynamics(axis->acceleration);
    if (strstr(name, "Deceleration"))
        return dynamics(axis->deceleration);
    if (strstr(name, "Jerk"))
        return dynamics(axis->jerk);
    return absurd(sign * (one_in(2) ? spread(axis->reach) : uniform(0, axis->reach)));
}

static int random_enum(const char *name)
{
    static const int direction[] = {0, 1, 2, 3, 4};
    if (one_in(60))
        return pick(2) ? pick(12) - 2 : (int)(chance() >> 33);
    if (strstr(name, "Direction"))
        return direction[pick(5)];
    if (strcmp(name, "Mode") == 0 && !one_in(20))
        return pick(2); /* CMD and CPIO are dead ends */
    if (strcmp(name, "BufferMode") == 0)
        return one_in(2) ? mcAborting : pick(6);
    if (strcmp(name, "TransitionMode") == 0)
        return one_in(2) ? mcTMNone : mcTMCornerDistance + pick(2);
    if (strcmp(name, "CoordSystem") == 0)
        return mcACS;
    if (strncmp(name, "Circ", 4) == 0 || strcmp(name, "PathChoice") == 0)
        return pick(2);
    return pick(3);
}

static INT random_integer(const char *name)
{
    if (one_in(40))
        return (INT)(chance() >> 40);
    return strcmp(name, "ParameterNumber") == 0 ? (INT)(1 + pick(18)) : (INT)pick(5);
}

/* Strings in CML, and others: longer than they may be, without an end. */
static void random_text(char *text, size_t size)
{
    static const char *const strings[] = {"?99.1", "K53.1", "K53.1=100", "?90.1", "O2", "|.1", "(.1", ").1", "",
                                          "K37=1", "?99.2", "K53.1,?96.1"};
    snprintf(text, size, "%s", strings[pick(12)]);
    if (one_in(8))
        for (size_t i = 0; i < size; i++)
            text[i] = (char)chance();
}

static void random_member(instance_t *fb, const block_member_t *m, const ranges_t *axis)
{
    void *place = fb->memory + m->offset;
    double reals[CM1E_GROUP_AXES] = {0}; /* an array, of groups */
    for (size_t i = 0; m->type == BLOCK_LREAL && i < m->size / sizeof(LREAL); i++)
        reals[i] = random_real(m->name, axis);
    const int number = m->type == BLOCK_ENUM ? random_enum(m->name) : 0;
    const INT small = m->type == BLOCK_INT ? random_integer(m->name) : 0;
    const TIME time = one_in(3) ? 0 : one_in(30) ? (TIME)chance() : (TIME)uniform(0, 2e9);
    switch (m->type) {
    case BLOCK_LREAL: memcpy(place, reals, m->size); break;
    case BLOCK_ENUM: memcpy(place, &number, sizeof number); break;
    case BLOCK_INT: memcpy(place, &small, sizeof small); break;
    case BLOCK_TIME: memcpy(place, &time, sizeof time); break;
    case BLOCK_BOOL: *(BOOL *)place = one_in(3); break;
    case BLOCK_UINT: *(UINT *)place = one_in(20) ? (UINT)chance() : (UINT)pick(6); break;
    case BLOCK_STRING: random_text(place, m->size); break;
    case BLOCK_DINT: *(DINT *)place = one_in(20) ? (DINT)chance() : (DINT)pick(9) - 4; break;
    case BLOCK_UDINT: *(UDINT *)place = one_in(20) ? (UDINT)chance() : (UDINT)pick(6); break;
    case BLOCK_DWORD: *(DWORD *)place = (DWORD)chance(); break;
    default: break;
    }
}

static bool is_trigger(const block_member_t *m)
{
    return strcmp(m->name, "Execute") == 0 || strcmp(m->name, "Enable") == 0;
}

void random_inputs(instance_t *fb, const ranges_t *axis, bool all)
{
    const block_t *type = fb->view->type;
    const size_t one = (size_t)pick((int)type->member_count);
    for (size_t i = 0; i < type->member_count; i++) {
        const block_member_t *m = &type->members[i];
        if (m->section == BLOCK_INPUT && !is_trigger(m) && (all || i == one))
            random_member(fb, m, axis);
    }
}
