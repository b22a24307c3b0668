/* vtk_numbers.h - types and numbers of a legacy VTK file, and what is known of it while it is read. */
#ifndef TL_MESH_VTK_NUMBERS_H
#define TL_MESH_VTK_NUMBERS_H

#include "mesh/filling.h"

typedef enum tl_vtk_kind { TL_VTK_SIGNED, TL_VTK_UNSIGNED, TL_VTK_REAL, TL_VTK_BITS, TL_VTK_TEXT } tl_vtk_kind;

typedef struct tl_vtk_type {
    tl_vtk_kind kind;
    uint32_t bytes; /* 0: of bits and texts */
} tl_vtk_type;

typedef struct tl_vtk {
    tl_mesh_reading *r;
    bool binary, offsets, typed;
    size_t cells;
    uint32_t *start;    /* [cells + 1] into corner */
    uint32_t *corner;   /* points of cells */
    uint32_t *line;     /* [cells] */
    uint8_t *kind;      /* [cells] */
    tl_mesh_key *group; /* [cells] */
    double data;        /* how many values arrays have: of cells, or of points */
    bool of_cells;
    int group_rank, part_rank; /* of the arrays that have told groups and blocks; 0: none has */
    bool named;                /* groups have their names already */
} tl_vtk;

tl_status tl_vtk_read_type(tl_vtk *v, const char *what, tl_vtk_type *type);
/* Goes to where a list begins that is announced at the end of this line. */
tl_status tl_vtk_list_begin(tl_vtk *v, double count, tl_vtk_type type, const char *what);
/* The next number of it. */
tl_status tl_vtk_next(tl_vtk *v, tl_vtk_type type, const char *what, double *number);
tl_status tl_vtk_next_whole(tl_vtk *v, tl_vtk_type type, const char *what, double most, double *number);

#endif
