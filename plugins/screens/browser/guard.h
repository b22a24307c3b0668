/* guard.h - who may ask: the token, and what a browser says about where a request comes from. Functions of texts. */
#ifndef TALUS_BROWSER_GUARD_H
#define TALUS_BROWSER_GUARD_H

#include <stdbool.h>

/* 128 bits in hexadecimal, and a 0. */
#define TOKEN_TEXT 33

/* Draws a token from the system; false: it has none to give. */
bool token_draw(char token[TOKEN_TEXT]);
/* In a time that does not depend on how much of it is right. `given` may be NULL. */
bool token_is(const char *given, const char token[TOKEN_TEXT]);

/* Whether `host` names this machine's loopback: 127.0.0.1 or localhost, with any port or none.
 *
 * Against DNS rebinding: a page of another site has its own name in Host, whatever address that name is made to point
 * to. So the names decide. The port must be free, for `ssh -L OTHER:127.0.0.1:PORT` makes the browser name OTHER. */
bool host_is_local(const char *host);

/* Whether a request comes from a page of this server, or from nobody's page: an address that was typed or opened by
 * another program. `host` as sent; the others NULL where they were not sent. */
bool origin_is_own(const char *host, const char *origin, const char *fetch_site);

#endif
