/**
 * @file words.h
 * Words that reader and writer of a format share, and what they stand for: those of ETG.2000, which ETG.2100 took over.
 */
#ifndef CM1E_GENERATE_WORDS_H
#define CM1E_GENERATE_WORDS_H

typedef struct cm1e_word {
    const char *text;
    int value;
} cm1e_word_t;

/** By cm1e_fmmu_use_t, cm1e_sync_manager_use_t, cm1e_transitions; NULL ends each list. What is not used has no word. */
extern const cm1e_word_t cm1e_words_of_fmmus[], cm1e_words_of_sync_managers[], cm1e_words_of_transitions[];

/** Whatever the case of the letters; `fallback`: it is none of these words. */
int cm1e_word_value(const cm1e_word_t *words, const char *text, int fallback);
/** NULL: there is no word for it. */
const char *cm1e_word_text(const cm1e_word_t *words, int value);

#endif
