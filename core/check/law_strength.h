/* law_strength.h - whether what a law marks as strengths is what its strength is made of. */
#ifndef TL_CHECK_LAW_STRENGTH_H
#define TL_CHECK_LAW_STRENGTH_H

#include "check/law_points.h"

/* Makes a law of parameters, and takes it away. */
typedef tl_status (*tl_check_open_fn)(tl_checker *c, void *params, tl_check_law *law);
typedef void (*tl_check_close_fn)(tl_check_law *law);

/* Tries a law with its strengths divided by 0.5 and 2. `law` is that of the parameters. */
tl_status tl_law_check_strengths(tl_checker *c, const tl_check_law *law, const void *params, tl_check_open_fn open,
                                 tl_check_close_fn close, tl_check_seen *seen);
/* After all sets: whether most bore what they should. */
void tl_law_tell_strengths(tl_checker *c, const tl_check_seen *seen);

#endif
