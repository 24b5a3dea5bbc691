/**
 * @file tune_page.h
 * The page of `cm1e tune`: two runs in one chart.
 */
#ifndef CM1E_TOOLS_TUNE_PAGE_H
#define CM1E_TOOLS_TUNE_PAGE_H

#include "params.h"
#include "tune.h"

enum { TUNE_LABEL_BYTES = 48 };

/** "after K47=30 H3=5" */
void tune_label(char label[TUNE_LABEL_BYTES], const char *what, const params_t *params);

/** Both runs over the time since their beginning; the second one may be NULL. False, with a complaint: not written. */
bool tune_write_page(const char *path, const tune_record_t *one, const char *one_name, const tune_record_t *other,
                     const char *other_name);

#endif
