/**
 * A judge of every text about an axis or an axes group that a test asks for: the linker puts it in front of
 * cm1e_axis_error_text() and cm1e_group_error_text(). The text is asked for again with less room. Then nothing is written
 * behind the room, and what is there is the beginning of the text.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/axis.h"
#include "cm1e/group.h"

void __real_cm1e_axis_error_text(AXIS_REF_t axis, char *text, size_t size);
void __wrap_cm1e_axis_error_text(AXIS_REF_t axis, char *text, size_t size);
void __real_cm1e_group_error_text(AXES_GROUP_REF_t group, char *text, size_t size);
void __wrap_cm1e_group_error_text(AXES_GROUP_REF_t group, char *text, size_t size);

enum { BEHIND = 8, MARK = 0x7E, ROOMS = 3 };

/** What a text that needs more room becomes. It may end in front of a blank, but has no blank at its end. */
static void judge(const char *whole, size_t size, char *less, size_t room)
{
    size_t marks = 0;
    while (marks < BEHIND && less[room + marks] == MARK)
        marks++;
    const size_t length = strnlen(whole, size), left = strnlen(less, room);
    if (length == size || (length > 0 && whole[length - 1] == ' ') || marks < BEHIND || left == room ||
        memcmp(less, whole, left) != 0 || (left != room - 1 && !(left + 2 == room && whole[left] == ' '))) {
        fprintf(stderr, "with room for %zu bytes \"%s\" becomes \"%.*s\", and %zu of %d marks are left\n", room, whole,
                (int)room, less, marks, BEHIND);
        abort();
    }
    free(less);
}

/** A byte less than the text needs, half of it, and one byte. */
static char *make_room(const char *text, int n, size_t *room)
{
    const size_t length = strlen(text), rooms[ROOMS] = {length, length / 2, 1};
    *room = rooms[n] > 0 ? rooms[n] : 1;
    char *less = malloc(*room + BEHIND);
    if (!less)
        abort();
    memset(less, MARK, *room + BEHIND);
    return less;
}

void __wrap_cm1e_axis_error_text(AXIS_REF_t axis, char *text, size_t size)
{
    size_t room;
    __real_cm1e_axis_error_text(axis, text, size);
    for (int n = 0; n < ROOMS && text && size > 0; n++) {
        char *less = make_room(text, n, &room);
        __real_cm1e_axis_error_text(axis, less, room);
        judge(text, size, less, room);
    }
}

void __wrap_cm1e_group_error_text(AXES_GROUP_REF_t group, char *text, size_t size)
{
    size_t room;
    __real_cm1e_group_error_text(group, text, size);
    for (int n = 0; n < ROOMS && text && size > 0; n++) {
        char *less = make_room(text, n, &room);
        __real_cm1e_group_error_text(group, less, room);
        judge(text, size, less, room);
    }
}
