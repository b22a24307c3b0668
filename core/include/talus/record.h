/* talus/record.h - records of ground motion: read, corrected, asked, and followed by driven blocks: part of
 * talus/talus.h. */
#ifndef TALUS_RECORD_H
#define TALUS_RECORD_H

#include <stddef.h>
#include <talus/plugin.h>
#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Samples of one component of a motion at equal intervals. Accelerations are linear between samples, and integrated
 * exactly; of velocities the accelerations between samples are constant. After its end a record goes on with its last
 * velocity. It never changes. Those who use it hold it. */
typedef struct tl_record tl_record;

/* What the samples are. */
enum { TL_RECORD_ACCELERATION, TL_RECORD_VELOCITY };
/* What is taken off a motion that drifts: nothing; the mean acceleration; or b1 + 2 b2 t of the acceleration, with
 * which b1 t + b2 t^2 is the velocity's best fit by least squares. */
enum { TL_BASELINE_NONE, TL_BASELINE_MEAN, TL_BASELINE_PARABOLA };

/* Units of samples: as the file says, and m/s2 or m/s where it says nothing; or one of these. */
enum {
    TL_RECORD_UNIT_OWN,
    TL_RECORD_UNIT_M_S2,
    TL_RECORD_UNIT_G, /* 9.80665 m/s2 */
    TL_RECORD_UNIT_CM_S2,
    TL_RECORD_UNIT_M_S,
    TL_RECORD_UNIT_CM_S
};

/* Most samples of a record. */
#define TL_RECORD_MOST 10000000

typedef struct tl_record_options {
    const char *file;                 /* for tl_record_read */
    double dt;                        /* s from one sample to the next, > 0; 0: as the file says */
    double scale;                     /* by which all are multiplied */
    int32_t quantity, unit, baseline; /* TL_RECORD_ACCELERATION or _VELOCITY, TL_RECORD_UNIT_*, TL_BASELINE_* */
    /* Hz: Butterworth filters of second order at both, forward and backward, so without a shift in time; 0: none */
    double band[2];
    int64_t column; /* of a file with several numbers in a line, from 1; 0: the last of two, or all of a block */
} tl_record_options;

/* Makes a record of samples, which the caller lets go of. TL_E_ARGUMENT: fewer than 2 samples or more than
 * TL_RECORD_MOST, one that is no finite number, or dt not > 0. Also a band that is not 0 <= low < high < 1 / (2 dt),
 * and a unit that is none of the quantity. */
TL_API tl_status tl_record_make(const double *samples, size_t count, const tl_record_options *options,
                                tl_record **record, tl_error *error);
/* Makes one of a file: lines of numbers with commas or blanks between them, or the text of PEER's AT2 and VT2 files,
 * whose header tells NPTS and DT. Lines that begin with no number are skipped before the first sample. With a dt of 0
 * and two columns the first is the time. */
TL_API tl_status tl_record_read(const tl_record_options *options, tl_record **record, tl_error *error);
/* The same of the bytes of a file, which a 0 ends; `file` is its name in errors. */
TL_API tl_status tl_record_of_text(const char *file, const char *text, size_t length, const tl_record_options *options,
                                   tl_record **record, tl_error *error);
TL_API tl_record *tl_record_hold(const tl_record *record);
TL_API void tl_record_let_go(tl_record *record);

/* s between samples, the number of samples, and s from the first to the last. */
TL_API double tl_record_dt(const tl_record *record);
TL_API size_t tl_record_count(const tl_record *record);
/* At a time after the first sample, s: m/s2, m/s and m. After the last one the acceleration is 0, and the velocity
 * stays. */
TL_API double tl_record_acceleration(const tl_record *record, double t);
TL_API double tl_record_velocity(const tl_record *record, double t);
TL_API double tl_record_displacement(const tl_record *record, double t);
/* The largest |a|, m/s2, and |v| at a sample, m/s. */
TL_API double tl_record_peak(const tl_record *record);
TL_API double tl_record_peak_velocity(const tl_record *record);
/* Arias intensity, m/s: pi / (2 g) int a^2 dt with g = 9.80665 m/s2. */
TL_API double tl_record_arias(const tl_record *record);
/* Pseudo-acceleration w^2 |u|max, m/s2, of oscillators of these periods, s, > 0. `damping` is their fraction of
 * critical damping, in [0, 1). The solution is exact under linear accelerations (Nigam and Jennings, Bull. Seism. Soc.
 * Am. 59, 1969). */
TL_API tl_status tl_record_spectrum(const tl_record *record, double damping, const double *periods, size_t count,
                                    double *out, tl_error *error);

#ifdef __cplusplus
}
#endif
#endif
