/* test_table.c - columns that grow together, in small and large tables, and one that comes later than the rows. */
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

/* Numbers that no row has by chance. */
static double size_of(size_t i)
{
    return 1 / (1.0 + (double)i);
}

/* Large tables have pages of their own, which are moved when they grow. */
static void a_large_table_keeps_its_rows_when_it_grows(void)
{
    sample_table t;
    make(&t, 5);
    size_t rows = 5;
    for (size_t i = 0; i < rows; i++)
        t.size[i] = size_of(i);
    for (int round = 0; round < 40; round++) {
        const size_t more = rows + rows / 2 + 7;
        CHECK(tl_table_resize(&t.table, more));
        bool right = true;
        for (size_t i = rows; i < more; i++) {
            right = right && t.size[i] == 0 && t.count[i] == 0;
            t.size[i] = size_of(i);
            t.count[i] = (uint32_t)i;
        }
        for (size_t i = 0; i < more; i++)
            right = right && t.size[i] == size_of(i) && t.count[i] == i;
        CHECK(right);
        CHECK_INT((uintptr_t)t.size % TL_ALIGN, 0);
        CHECK_INT((uintptr_t)t.count % TL_ALIGN, 0);
        rows = more;
        if (rows > 2000000) { /* some go, and are zero when they come back */
            rows = rows / (size_t)(3 + round % 3);
            CHECK(tl_table_resize(&t.table, rows));
        }
    }
    CHECK(widen(&t));
    bool right = true;
    for (size_t i = 0; i < rows; i++)
        right = right && t.size[i] == size_of(i) && t.count[i] == i && t.late[i] == 0;
    sample_table copy;
    CHECK(tl_table_copy(&copy.table, &copy, &t.table));
    CHECK(tl_table_resize(&copy.table, 2 * rows));
    for (size_t i = 0; i < 2 * rows; i++)
        right = right && copy.size[i] == (i < rows ? size_of(i) : 0);
    CHECK(right);
    CHECK(t.size[rows - 1] == size_of(rows - 1));
    tl_table_free(&copy.table);
    tl_table_free(&t.table);
}

TEST_MAIN(RUN(a_late_column_is_zero_and_the_rest_stays), RUN(an_empty_table_takes_a_late_column),
          RUN(rows_that_come_back_are_zero), RUN(a_large_table_keeps_its_rows_when_it_grows))
