/* set.h - a kind of element with its parameters. */
#ifndef TL_ELEMENT_SET_H
#define TL_ELEMENT_SET_H

#include "base/error.h"
#include "base/hash.h"
#include "element/elements.h"

/* Makes a set of a plugin's kind and arguments; with `from`, parameters not given are taken from it. `context` begins
 * the sentence of an error. On failure *out is empty. */
tl_status tl_element_set_make(const tl_kind *kind, const tl_args *args, const tl_element_set *from, const char *context,
                              tl_error *error, tl_element_set *out);
/* Adds its parameters to a hash. */
void tl_element_set_hash(const tl_element_set *set, tl_hash *hash);
void tl_element_set_clear(tl_element_set *set);
/* How many states of nodes, or of the whole, a kind has. */
uint32_t tl_element_columns(const tl_kind *kind, bool whole);
/* The column of a state by its name, and whether it is one of the whole; false: the kind has none of that name. */
bool tl_element_column(const tl_kind *kind, const char *name, uint32_t *column, bool *whole);
/* Gives the tables the columns of states that a kind needs. false: out of memory. */
bool tl_elements_hold_states(struct tl_elements *e, uint32_t of_nodes, uint32_t of_whole);
/* Likewise the columns of nodes whose base is not `local`, on blocks that had moved, on faces (`turned`: whose normals
 * are others in the frames of bodies), in zones, or that are damped. */
bool tl_nodes_hold_base(tl_node_table *n);
bool tl_nodes_hold_from(tl_node_table *n);
bool tl_nodes_hold_normals(tl_node_table *n, bool turned);
bool tl_nodes_hold_zones(tl_node_table *n);
bool tl_nodes_hold_damping(tl_node_table *n);

#endif
