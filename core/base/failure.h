/* failure.h - of several failures in a parallel phase, the one that counts. */
#ifndef TL_BASE_FAILURE_H
#define TL_BASE_FAILURE_H

#include <pthread.h>
#include <talus/plugin.h>

/* The first failure of a parallel phase, by chunk, and the point or row it came from. */
typedef struct tl_failure {
    pthread_mutex_t lock;
    tl_error error;
    size_t chunk, point;
} tl_failure;

void tl_failure_init(tl_failure *failure);
void tl_failure_destroy(tl_failure *failure);
/* Notes a failure, on any thread; that of the lowest chunk counts. */
void tl_failure_note(tl_failure *failure, size_t chunk, tl_status status, size_t point,
                     const char *text);

#endif
