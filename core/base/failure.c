/* failure.c - of several failures in a parallel phase, the one of the lowest chunk counts, whichever thread meets it. */
#include "base/failure.h"

#include "base/error.h"

void tl_failure_init(tl_failure *f)
{
    pthread_mutex_init(&f->lock, NULL);
}

void tl_failure_destroy(tl_failure *f)
{
    pthread_mutex_destroy(&f->lock);
}

void tl_failure_note(tl_failure *f, size_t chunk, tl_status status, size_t point, const char *text)
{
    pthread_mutex_lock(&f->lock);
    if (f->error.status == TL_OK || chunk < f->chunk) {
        f->chunk = chunk;
        f->point = point;
        tl_fail(&f->error, status, "%s", text);
    }
    pthread_mutex_unlock(&f->lock);
}
