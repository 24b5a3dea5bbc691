/* Sorts measured values, of which the benches print the median and the like. */
#ifndef CM1E_BENCH_SORT_H
#define CM1E_BENCH_SORT_H

#include <stdlib.h>

static inline int compare_values(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static inline void sort_values(double *values, size_t count)
{
    qsort(values, count, sizeof values[0], compare_values);
}

#endif
