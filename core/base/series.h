/* series.h - when a turn is small enough to be taken from a series. */
#ifndef TL_BASE_SERIES_H
#define TL_BASE_SERIES_H

/* Tolerance: half angles, rad, below which sine, cosine and tangent are taken from their series, whose next term is
 * then below rounding. That gives the same bits with any mathematics library, and is faster. */
#define TL_SERIES_HALF_ANGLE 0.05

#endif
