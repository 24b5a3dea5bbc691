#include "device/cml_command.h"

#include <string.h>
#include <strings.h>

enum { QUERY_PARAMETERS = 90, QUERY_POSITION = 96, QUERY_STATUS = 99, OUTPUTS = 4, MOTORS = 4, DIGITS_MOST = 9 };

bool cm1e_cml_parameter_can_move(unsigned number)
{
    return (number >= 26 && number <= 32) || number == 36 || number == 37;
}

/* ---- characters -------------------------------------------------------------------------------------------------- */

static bool is_digit(char c) { return c >= '0' && c <= '9'; }
static bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }
static bool is_printable(char c) { return c >= ' ' && c <= '~'; }

/* Reads digits at `at` and moves behind them. false: there are none, or the number has more than 32 bits. */
static bool take_number(const char **at, const char *end, unsigned *number)
{
    const char *begin = *at;
    *number = 0;
    while (*at < end && is_digit(**at) && *at - begin < DIGITS_MOST)
        *number = *number * 10 + (unsigned)(*(*at)++ - '0');
    return *at > begin && !(*at < end && is_digit(**at));
}

/* Reads digits with a sign, up to the ten digits of INT32_MAX and INT32_MIN. */
static bool take_value(const char **at, const char *end, int32_t *value)
{
    const bool negative = *at < end && **at == '-';
    const char *begin = *at += negative;
    int64_t sum = 0;
    for (; *at < end && is_digit(**at) && *at - begin <= DIGITS_MOST; (*at)++)
        sum = sum * 10 + (**at - '0');
    sum = negative ? -sum : sum;
    *value = (int32_t)sum;
    return *at > begin && *value == sum && !(*at < end && is_digit(**at));
}

static bool take(const char **at, const char *end, char wanted)
{
    if (*at == end || **at != wanted)
        return false;
    (*at)++;
    return true;
}

/* ---- what is sent ------------------------------------------------------------------------------------------------ */

/* A sign, perhaps a number, perhaps ".ID", perhaps "=value"; and nothing else. */
static bool take_apart(cm1e_cml_command_t *command, const char *at, const char *end)
{
    if (at == end)
        return false;
    command->sign = *at++;
    if (at < end && is_digit(*at)) {
        command->numbered = true;
        if (!take_number(&at, end, &command->number))
            return false;
    }
    if (take(&at, end, '.') && !take_number(&at, end, &command->id))
        return false;
    if (take(&at, end, '=')) {
        int32_t value;
        command->valued = true;
        if (!take_value(&at, end, &value))
            return false;
    }
    return at == end;
}

static void judge(cm1e_cml_command_t *command)
{
    const unsigned number = command->number;
    command->kind = CM1E_CML_MOTION;
    command->reply = CM1E_CML_UNKNOWN;
    if (command->sign == 'K' && command->numbered) {
        command->kind = !command->valued ? CM1E_CML_QUERY
                        : cm1e_cml_parameter_can_move(number) ? CM1E_CML_MOTION : CM1E_CML_PARAMETER;
        command->reply = command->valued ? CM1E_CML_SILENT : CM1E_CML_ONE_LINE;
    } else if (command->valued) {
        return;
    } else if (command->sign == '?' && command->numbered) {
        command->kind = CM1E_CML_QUERY;
        command->reply = number == QUERY_POSITION || number == QUERY_STATUS ? CM1E_CML_ONE_LINE : CM1E_CML_LIST;
    } else if ((command->sign == 'O' || command->sign == 'F') && number >= 1 && number <= OUTPUTS) {
        command->kind = CM1E_CML_OUTPUT;
        command->reply = CM1E_CML_SILENT;
    } else if (command->sign == '|' && !command->numbered) {
        command->reply = CM1E_CML_SEARCH;
    } else if ((command->sign == '(' || command->sign == ')') && !command->numbered) {
        command->reply = CM1E_CML_SILENT; /* motor enable, motor free */
    }
}

cm1e_cml_command_t cm1e_cml_next(const char **text)
{
    cm1e_cml_command_t command = {.kind = CM1E_CML_MOTION, .reply = CM1E_CML_UNKNOWN};
    const char *begin = *text, *comma = strchr(begin, ',');
    if (take_apart(&command, begin, comma ? comma : begin + strlen(begin)))
        judge(&command);
    else
        command.sign = 0;
    *text = comma ? comma + 1 : NULL;
    return command;
}

cm1e_cml_kind_t cm1e_cml_kind(const char *text)
{
    cm1e_cml_kind_t strongest = CM1E_CML_QUERY;
    while (text) {
        const cm1e_cml_command_t command = cm1e_cml_next(&text);
        strongest = command.kind > strongest ? command.kind : strongest;
    }
    return strongest;
}

/* Cut off in the middle: the bridge would send the rest as another line (BR 7.2.2). */
static bool is_cut(const char *begin, const char *end)
{
    const char last = end[-1];
    const bool lonely = end - begin == 1 && strchr("K?OF", last);
    return last == '=' || last == '.' || last == '-' || lonely;
}

const char *cm1e_cml_check(const char *text, unsigned id)
{
    const size_t size = text ? strnlen(text, CM1E_CML_BYTES + 1) : 0;
    if (size == 0)
        return "is empty";
    if (size > CM1E_CML_BYTES)
        return "is longer than 64 bytes";
    for (size_t i = 0; i < size; i++)
        if (!is_printable(text[i]))
            return text[i] == '\r' || text[i] == '\n' ? "has CR or LF in it, which the bridge adds by itself"
                                                      : "has characters in it that are no printable ASCII";
    do {
        const char *begin = text;
        const cm1e_cml_command_t command = cm1e_cml_next(&text);
        const char *end = text ? text - 1 : begin + strlen(begin);
        if (begin == end)
            return "has nothing before, between or behind its commas";
        if (is_cut(begin, end))
            return "has a command that is cut off: one without its number or value";
        if (command.sign != 0 && command.id != 0 && command.id != id)
            return "names another motor: the number behind the point is the connector of this one, or missing";
    } while (text);
    return NULL;
}

/* ---- what comes back --------------------------------------------------------------------------------------------- */

/* "Null", and nothing at all, in whatever case the device sends it. */
static bool is_nothing(const char *at, size_t size)
{
    static const char word[] = "null";
    return size == 0 || (size == sizeof word - 1 && strncasecmp(at, word, size) == 0);
}

/* A name, for a K parameter with its number, ".ID", "=value". false: it is another text. */
static bool take_answer(cm1e_cml_answer_t *answer, const char *at, const char *end)
{
    size_t length = 0;
    for (; at < end && is_letter(*at) && length + 1 < sizeof answer->name; at++)
        answer->name[length++] = *at;
    const bool numbered = at < end && is_digit(*at);
    if (length == 0 || (numbered && !take_number(&at, end, &answer->number)))
        return false;
    if (!take(&at, end, '.') || !take_number(&at, end, &answer->id) || !take(&at, end, '=') ||
        !take_value(&at, end, &answer->value) || at != end)
        return false;
    const bool is_k = strcmp(answer->name, "K") == 0;
    if (numbered != is_k)
        return false;
    answer->what = is_k                                   ? CM1E_CML_K
                   : strcmp(answer->name, "Ux") == 0      ? CM1E_CML_STATUS
                   : strcmp(answer->name, "Origin") == 0  ? CM1E_CML_ORIGIN : CM1E_CML_VALUE;
    return true;
}

/* A line of a kind that is known must be whole: "K53.1=" or "Ux.9=8" is no text. */
static bool begins_as_known(const char *at, size_t size)
{
    return (size >= 2 && at[0] == 'K' && is_digit(at[1])) || (size >= 3 && memcmp(at, "Ux.", 3) == 0) ||
           (size >= 7 && memcmp(at, "Origin.", 7) == 0);
}

cm1e_error_t cm1e_cml_parse(cm1e_cml_answer_t *answer, const void *bytes, size_t size)
{
    if (!answer || (!bytes && size > 0))
        return CM1E_ERROR_INVALID_ARGUMENT;
    const char *at = bytes;
    size_t length = 0, whole;
    *answer = (cm1e_cml_answer_t){.what = CM1E_CML_NOTHING};
    while (length < size && is_printable(at[length]))
        length++;
    for (whole = length; whole < size && (at[whole] == '\r' || at[whole] == '\n'); whole++)
        ;
    const bool ends = whole == size || at[whole] == '\0';
    if (!ends || size > CM1E_CML_BYTES)
        return CM1E_ERROR_CML_ANSWER;
    if (is_nothing(at, length))
        return CM1E_OK;
    if (whole == length)
        return CM1E_ERROR_CML_ANSWER;
    if (take_answer(answer, at, at + length) && answer->id >= 1 && answer->id <= MOTORS)
        return CM1E_OK;
    *answer = (cm1e_cml_answer_t){.what = CM1E_CML_TEXT};
    return begins_as_known(at, length) ? CM1E_ERROR_CML_ANSWER : CM1E_OK;
}

bool cm1e_cml_answers(const cm1e_cml_command_t *command, const cm1e_cml_answer_t *answer)
{
    switch (command->reply) {
    case CM1E_CML_ONE_LINE:
        if (command->sign == 'K')
            return answer->what == CM1E_CML_K && answer->number == command->number;
        return command->number == QUERY_STATUS ? answer->what == CM1E_CML_STATUS
                                               : answer->what == CM1E_CML_VALUE && strcmp(answer->name, "Px") == 0;
    case CM1E_CML_SEARCH: return answer->what == CM1E_CML_ORIGIN || answer->what == CM1E_CML_STATUS;
    case CM1E_CML_LIST:
        return command->number == QUERY_PARAMETERS ? answer->what == CM1E_CML_K : answer->what != CM1E_CML_NOTHING;
    case CM1E_CML_UNKNOWN: return answer->what != CM1E_CML_NOTHING;
    case CM1E_CML_SILENT:
    default: return false;
    }
}
