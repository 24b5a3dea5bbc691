#include "generate/words.h"

#include <string.h>

#include "description/description.h"

const cm1e_word_t cm1e_words_of_fmmus[] = {
    {"Outputs", CM1E_FMMU_OUTPUTS}, {"Inputs", CM1E_FMMU_INPUTS}, {"MBoxState", CM1E_FMMU_MAILBOX_STATE}, {0}};
const cm1e_word_t cm1e_words_of_sync_managers[] = {
    {"MBoxOut", CM1E_SM_MAILBOX_OUT}, {"MBoxIn", CM1E_SM_MAILBOX_IN}, {"Outputs", CM1E_SM_OUTPUTS},
    {"Inputs", CM1E_SM_INPUTS}, {0}};
const cm1e_word_t cm1e_words_of_transitions[] = {
    {"IP", CM1E_TRANSITION_IP}, {"PS", CM1E_TRANSITION_PS}, {"SO", CM1E_TRANSITION_SO}, {"SP", CM1E_TRANSITION_SP},
    {"OP", CM1E_TRANSITION_OP}, {"OS", CM1E_TRANSITION_OS}, {0}};

int cm1e_word_value(const cm1e_word_t *words, const char *text, int fallback)
{
    for (; words->text; words++)
        if (strcasecmp(words->text, text) == 0)
            return words->value;
    return fallback;
}

const char *cm1e_word_text(const cm1e_word_t *words, int value)
{
    for (; words->text; words++)
        if (words->value == value)
            return words->text;
    return NULL;
}
