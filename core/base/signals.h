/* signals.h - the signals that end a program, put off for a while. */
#ifndef TL_BASE_SIGNALS_H
#define TL_BASE_SIGNALS_H

#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stddef.h>

/* Blocks SIGTERM, SIGINT, SIGHUP and SIGQUIT for this thread and those that it starts: `all` of them, or those that
 * nothing handles. They end the program. *before is what to go back to. */
static inline void tl_signals_hold(sigset_t *before, bool all)
{
    static const int ending[] = {SIGTERM, SIGINT, SIGHUP, SIGQUIT};
    sigset_t set;
    sigemptyset(&set);
    for (size_t i = 0; i < sizeof ending / sizeof *ending; i++) {
        struct sigaction action;
        if (all || sigaction(ending[i], NULL, &action) != 0 || action.sa_handler == SIG_DFL)
            sigaddset(&set, ending[i]);
    }
    pthread_sigmask(SIG_BLOCK, &set, before);
}

/* Goes back; those that have come meanwhile arrive now. */
static inline void tl_signals_release(const sigset_t *before)
{
    pthread_sigmask(SIG_SETMASK, before, NULL);
}

#endif
