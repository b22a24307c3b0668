/* test_table.c - columns that grow together, and one that comes later than the rows. */
#include "base/table.h"

#include "check.h"

#include <stdint.h>

typedef struct sample_table {
    tl_table table;
    double *size;
    uint32_t *count;
    double *late;
} sample_table;

static void make(sample_table *t, size_t rows)
{
    memset(t, 0, sizeof *t);
    tl_table_init(&t->table, t);
    TL_COLUMN(&t->table, t, size, 0);
    TL_COLUMN(&t->table, t, count, 0);
    CHECK(tl_table_resize(&t->table, rows));
    for (size_t i = 0; i < rows; i++) {
        t->size[i] = 0.5 * (double)i;
        t->count[i] = (uint32_t)i;
    }
}

static bool widen(sample_table *t)
{
    const tl_column late = TL_COLUMN_NEW(t, late, TL_COLUMN_STATE);
    return tl_table_widen(&t->table, &late, 1);
}

static void a_late_column_is_zero_and_the_rest_stays(void)
{
    enum { ROWS = 37 };
    sample_table t;
    make(&t, ROWS);
    size_t bytes = tl_table_bytes(&t.table), capacity = t.table.capacity;
    CHECK(widen(&t));
    CHECK_INT(t.table.rows, ROWS);
    CHECK_INT(tl_table_bytes(&t.table), bytes + capacity * sizeof *t.late);
    CHECK_INT((uintptr_t)t.late % TL_ALIGN, 0);
    for (size_t i = 0; i < ROWS; i++) {
        CHECK(t.size[i] == 0.5 * (double)i);
        CHECK_INT(t.count[i], i);
        CHECK(t.late[i] == 0);
        t.late[i] = (double)i;
    }
    CHECK(tl_table_resize(&t.table, 3 * ROWS));
    CHECK(t.late[ROWS - 1] == ROWS - 1 && t.late[ROWS] == 0);
    tl_table_free(&t.table);
}

static void an_empty_table_takes_a_late_column(void)
{
    sample_table t;
    make(&t, 0);
    CHECK(widen(&t));
    CHECK(t.late == NULL);
    CHECK(tl_table_resize(&t.table, 1));
    CHECK(t.late != NULL && t.late[0] == 0);
    tl_table_free(&t.table);
}

static void rows_that_come_back_are_zero(void)
{
    sample_table t;
    make(&t, 20);
    CHECK(tl_table_resize(&t.table, 5));
    CHECK(tl_table_resize(&t.table, 20));
    CHECK(t.size[4] == 2 && t.size[5] == 0 && t.count[19] == 0);
    tl_table_free(&t.table);
}

TEST_MAIN(RUN(a_late_column_is_zero_and_the_rest_stays), RUN(an_empty_table_takes_a_late_column),
          RUN(rows_that_come_back_are_zero))
