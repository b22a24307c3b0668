/* interrupt.c - Ctrl-C (SIGINT) as a Lua error.
 *
 * A *watch* is held while a script or a long call of the kernel runs. The first Ctrl-C is noted, which ends a run of
 * the kernel after its step and cancels a generator or a file. It also sets a hook on the Lua state that runs, so that
 * Lua code ends at its next instruction. Whichever comes first raises the error: once for each Ctrl-C. A second Ctrl-C
 * before that ends the program.
 *
 * The program watches as long as a script runs. In a stock interpreter only calls of the kernel are watched. Outside of
 * them its own handler is in force, as it was.
 *
 * Limit: Lua has no way to find the coroutine that runs. One that neither yields nor uses a model is ended by the
 * second Ctrl-C only. */
#include "lua/interrupt.h"

#include "lua/fail.h"

#include <signal.h>
#include <stdatomic.h>
#include <string.h>

/* What every message of an interrupt holds. */
#define SENTENCE "stopped by Ctrl-C"
/* At the prompt a run that was interrupted gives its result; the rest of the line then has so many instructions. */
#define REST_OF_LINE 1000

static atomic_bool asked;             /* by a Ctrl-C for which no error has been raised yet */
static _Atomic(lua_State *) listener; /* the state whose hook is set by a Ctrl-C */
static _Atomic(lua_State *) hooked;   /* the state whose hook was set, or NULL */
static struct {
    lua_Hook call;
    int mask, count;
} script_hook; /* what the script had hooked before */
static unsigned depth;
static struct sigaction previous;
static lua_State *prompt; /* the state of the prompt's line, or NULL */
static bool raised;

static void unhook(void)
{
    lua_State *L = atomic_exchange(&hooked, NULL);
    if (L)
        lua_sethook(L, script_hook.call, script_hook.mask, script_hook.count);
}

static int raise_interrupt(lua_State *L, const char *what, const char *outcome)
{
    unhook();
    atomic_store(&asked, false);
    raised = true;
    return tl_lua_fail(L, "%s%s" SENTENCE "%s%s", what, what[0] ? ": " : "", outcome[0] ? "; " : "", outcome);
}

static void on_hook(lua_State *L, lua_Debug *record)
{
    (void)record;
    raise_interrupt(L, "", "");
}

static void on_interrupt(int signal_number)
{
    lua_State *L = atomic_load(&listener);
    if (!L || atomic_exchange(&asked, true)) {
        struct sigaction standard = {.sa_handler = SIG_DFL};
        sigemptyset(&standard.sa_mask);
        sigaction(signal_number, &standard, NULL);
        raise(signal_number);
        return;
    }
    script_hook.call = lua_gethook(L);
    script_hook.mask = lua_gethookmask(L);
    script_hook.count = lua_gethookcount(L);
    atomic_store(&hooked, L);
    lua_sethook(L, on_hook, LUA_MASKCALL | LUA_MASKRET | LUA_MASKLINE | LUA_MASKCOUNT, 1);
}

bool tl_lua_interrupt_asked(void)
{
    return atomic_load(&asked);
}

void tl_lua_interrupt_check(lua_State *L)
{
    if (atomic_load(&asked))
        raise_interrupt(L, "", "");
}

/* ---------------------------------------------------------------- watches ---------------- */

static tl_lua_watch watch_begin(lua_State *L, bool even_if_ignored)
{
    tl_lua_watch watch = {.outer = atomic_exchange(&listener, L)};
    if (depth++ == 0) {
        /* Reads and writes of the script's files go on after a Ctrl-C. */
        struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = SA_RESTART};
        sigemptyset(&action.sa_mask);
        sigaction(SIGINT, NULL, &previous);
        if (previous.sa_handler != SIG_IGN || even_if_ignored)
            sigaction(SIGINT, &action, NULL);
    }
    return watch;
}

tl_lua_watch tl_lua_watch_begin(lua_State *L)
{
    return watch_begin(L, false); /* an interpreter that ignores Ctrl-C goes on doing so */
}

static void watch_end(const tl_lua_watch *watch)
{
    if (--depth == 0)
        sigaction(SIGINT, &previous, NULL);
    atomic_store(&listener, watch->outer);
}

tl_status tl_lua_watch_end(lua_State *L, const tl_lua_watch *watch, tl_status status, const char *what,
                           const char *outcome)
{
    bool cancelled = status == TL_E_CANCELLED;
    watch_end(watch);
    if (atomic_load(&asked))
        raise_interrupt(L, cancelled ? what : "", cancelled ? outcome : "");
    return status;
}

void tl_lua_watch_end_run(lua_State *L, const tl_lua_watch *watch, const char *what)
{
    watch_end(watch);
    if (!atomic_load(&asked))
        return;
    if (L != prompt)
        raise_interrupt(L, what, "the step is whole and the model can go on");
    unhook();
    atomic_store(&hooked, L);
    lua_sethook(L, on_hook, LUA_MASKCOUNT, REST_OF_LINE);
}

/* ---------------------------------------------------------------- the program ------------ */

int tl_lua_watch_call(lua_State *L, int arguments, int results, int handler, bool at_prompt)
{
    raised = false;
    prompt = at_prompt ? L : NULL;
    tl_lua_watch watch = watch_begin(L, true); /* as shells have it ignored in the background */
    int status = lua_pcall(L, arguments, results, handler);
    watch_end(&watch);
    unhook();
    atomic_store(&asked, false);
    prompt = NULL;
    return status;
}

bool tl_lua_interrupted(const char *message)
{
    return raised && message && strstr(message, SENTENCE);
}
