/* contact_polygons.h - the polygons on which contacts act, of many contacts at once. */
#ifndef TL_QUERY_CONTACT_POLYGONS_H
#define TL_QUERY_CONTACT_POLYGONS_H

#include "model/model.h"

/* Of each listed contact. A flush one has one polygon, halfway between its two faces. A field contact has one for each
 * pair of faces that are the nearest on the surface of its pressure. Blocks that meet by segments have one for each
 * segment. */
typedef struct tl_contact_polygons {
    size_t contacts, polygons, corners;
    uint32_t *first; /* [contacts + 1] number of a contact's first polygon */
    uint32_t *start; /* [polygons + 1] number of a polygon's first corner */
    tl_vec3 *corner; /* relative to the model's origin, m; counter-clockwise seen against the contact's normal */
} tl_contact_polygons;

/* Finds those of rows of contacts that are up to date: tl_contacts_listed. Freed by tl_contact_polygons_free, also
 * after a failure: out of memory. The same for any number of threads. */
tl_status tl_contact_polygons_find(tl_model *m, const uint32_t *rows, size_t count, tl_contact_polygons *out);
void tl_contact_polygons_free(tl_contact_polygons *polygons);

#endif
