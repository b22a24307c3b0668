/* crash.c - a crash inside a plugin says which plugin it was, and then ends the program as it would have ended.
 *
 * The handler only reads what was written before the crash and writes to the standard error, as it must: nothing that
 * takes a lock or memory. It runs on a stack of its own, since a plugin may have used up the thread's. Signals
 * outside plugins go on as if it were not there. */
#define _XOPEN_SOURCE 700 /* sigaltstack */
#include "base/inside.h"
#include "plugin/descriptor.h"
#include "plugin/loader.h"

#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <stddef.h>
#include <unistd.h>

typedef struct fault {
    int signal;
    const char *name;
    struct sigaction before; /* what was done about it before this file was asked */
} fault;

static fault faults[] = {{.signal = SIGSEGV, .name = "SIGSEGV, memory that is not its own"},
                         {.signal = SIGBUS, .name = "SIGBUS, memory that is not there"},
                         {.signal = SIGFPE, .name = "SIGFPE, a whole number divided by zero"},
                         {.signal = SIGILL, .name = "SIGILL, an instruction that does not exist"},
                         {.signal = SIGABRT, .name = "SIGABRT, abort() or a failed assertion"}};

/* A sentence that is put together without the C library's help, and said at once: several threads may crash. */
typedef struct sentence {
    char text[PATH_MAX + 512];
    size_t length;
} sentence;

static void add(sentence *s, const char *text)
{
    for (; text && *text && s->length < sizeof s->text; text++)
        s->text[s->length++] = *text;
}

static void name_plugin(const tl_inside *inside, const char *signal)
{
    sentence s = {.length = 0};
    const char *path = inside->path;
    add(&s, "talus: ");
    if (inside->kind) {
        const tl_plugin *plugin = tl_plugin_of(inside->kind, &path);
        add(&s, tl_kind_type_name(inside->kind->type));
        add(&s, " '");
        add(&s, inside->kind->name);
        add(&s, "' of ");
        add(&s, plugin ? "plugin '" : "a plugin");
        add(&s, plugin ? plugin->id : "");
        add(&s, plugin ? "' (" : " (");
        add(&s, path);
        add(&s, ")");
    } else {
        add(&s, "plugin ");
        add(&s, path);
    }
    add(&s, " crashed in its function '");
    add(&s, inside->function);
    add(&s, "', or in what that called: ");
    add(&s, signal);
    add(&s, "\n");
    /* to a closed standard error nothing can be said */
    ssize_t written = write(STDERR_FILENO, s.text, s.length);
    (void)written;
}

static void on_crash(int signal, siginfo_t *info, void *context)
{
    (void)context;
    int kept = errno;
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
        if (faults[i].signal != signal)
            continue;
        tl_inside inside = tl_inside_plugin;
        tl_leave(); /* a crash in here is not the plugin's */
        if (inside.function)
            name_plugin(&inside, faults[i].name);
        sigaction(signal, &faults[i].before, NULL);
    }
    /* on return a faulty instruction faults again; a signal that was sent must be sent again */
    if (info->si_code <= 0)
        raise(signal);
    errno = kept;
}

void tl_plugin_name_crashes(void)
{
    static char stack[TL_SIGNAL_STACK];
    stack_t now, own = {.ss_sp = stack, .ss_size = sizeof stack};
    if (sigaltstack(NULL, &now) == 0 && now.ss_flags & SS_DISABLE)
        sigaltstack(&own, NULL);
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
        struct sigaction action = {.sa_flags = SA_SIGINFO | SA_ONSTACK};
        action.sa_sigaction = on_crash;
        sigemptyset(&action.sa_mask);
        sigaction(faults[i].signal, &action, &faults[i].before);
    }
}
