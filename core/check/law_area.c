/* law_area.c - a point of twice the area, with the same stresses, carries twice the force and twice the energy. */
#include "check/law.h"

#include <math.h>

/* Relative error that rounding may come to. */
#define ERROR 1e-8

/* How a column goes with the area. */
static double power_of(const tl_law_trial *t, int column)
{
    if (column >= TL_AT_STATE)
        return t->law.of.extensive[column - TL_AT_STATE] ? 2 : 1;
    bool goes = column == TL_AT_AREA || column == TL_AT_F_N0 || column >= TL_AT_F_N;
    return goes ? 2 : 1;
}

/* Points whose states begin anew, where they do so when areas change; and their twins of twice the area. */
static void make_twins(const tl_law_trial *t, tl_check_points *one, tl_check_points *two)
{
    const int last = TL_AT_STATE + (int)t->law.of.columns;
    *one = t->in;
    for (int k = TL_AT_STATE; k < last; k++)
        for (size_t i = 0; i < TL_CHECK_POINTS && t->law.of.resets[k - TL_AT_STATE]; i++)
            one->c[k][i] = t->law.of.initial[k - TL_AT_STATE];
    *two = *one;
    for (int k = 0; k < last; k++)
        for (size_t i = 0; i < TL_CHECK_POINTS; i++)
            two->c[k][i] *= power_of(t, k);
}

static void compare(tl_law_trial *t, int column, size_t i, double one, double is)
{
    bool force = column < TL_AT_STORED, energy = column < TL_AT_STATE;
    double expected = power_of(t, column) * one;
    double scale = force ? t->scale[i] : energy ? t->scale[i] * t->law.closure : fabs(one);
    if (fabs(is - expected) > ERROR * (scale + fabs(expected)))
        tl_check_note(t->c, TL_LAW_AREA,
                      "with twice the area and the same stresses %s is %g, not %g",
                      force    ? "a force"
                      : energy ? "an energy"
                               : "a state",
                      is, expected);
}

void tl_law_check_area(tl_law_trial *t)
{
    tl_check_points one, two, out_one, out_two;
    tl_check_call call = {0};
    if (tl_check_failed(t->c, TL_LAW_AREA))
        return;
    make_twins(t, &one, &two);
    out_one = one;
    out_two = two;
    if (!tl_law_call(t, &one, &out_one, NULL, 0, TL_CHECK_POINTS, &call) ||
        !tl_law_call(t, &two, &out_two, NULL, 0, TL_CHECK_POINTS, &call))
        return;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++)
        for (int k = TL_AT_F_N; k < TL_AT_STATE + (int)t->law.of.columns; k++)
            if (k < TL_AT_STATE || !t->law.of.resets[k - TL_AT_STATE])
                compare(t, k, i, out_one.c[k][i], out_two.c[k][i]);
}
