/* vtk_contacts.h - the contacts and the joints of a frame. */
#ifndef TL_IO_VTK_CONTACTS_H
#define TL_IO_VTK_CONTACTS_H

#include "io/pieces.h"

#include <talus/output.h>

tl_status tl_vtk_contacts(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out);
tl_status tl_vtk_joints(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out);

#endif
