/* guard.c - who may ask: the token, and what a browser says about where a request comes from. */
#define _DEFAULT_SOURCE /* getrandom, strcasecmp */
#include "guard.h"

#include <string.h>
#include <strings.h>
#include <sys/random.h>

/* Digits of a port. */
#define PORT_DIGITS 5

bool token_draw(char token[TOKEN_TEXT])
{
    unsigned char bytes[(TOKEN_TEXT - 1) / 2];
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes)
        return false;
    for (size_t i = 0; i < sizeof bytes; i++) {
        token[2 * i] = "0123456789abcdef"[bytes[i] >> 4];
        token[2 * i + 1] = "0123456789abcdef"[bytes[i] & 15];
    }
    token[TOKEN_TEXT - 1] = '\0';
    return true;
}

bool token_is(const char *given, const char token[TOKEN_TEXT])
{
    if (!given || strlen(given) != TOKEN_TEXT - 1)
        return false;
    volatile unsigned char differs = 0;
    for (size_t i = 0; i < TOKEN_TEXT - 1; i++)
        differs = (unsigned char)(differs | (given[i] ^ token[i]));
    return differs == 0;
}

bool host_is_local(const char *host)
{
    static const char *const names[] = {"127.0.0.1", "localhost"};
    for (size_t i = 0; host && i < sizeof names / sizeof *names; i++) {
        size_t length = strlen(names[i]);
        if (strncasecmp(host, names[i], length) != 0)
            continue;
        const char *port = host + length;
        if (*port == '\0')
            return true;
        size_t digits = *port == ':' ? strspn(port + 1, "0123456789") : 0;
        return digits > 0 && digits <= PORT_DIGITS && port[1 + digits] == '\0';
    }
    return false;
}

bool origin_is_own(const char *host, const char *origin, const char *fetch_site)
{
    static const char scheme[] = "http://";
    bool same_site = !fetch_site || strcmp(fetch_site, "same-origin") == 0 || strcmp(fetch_site, "none") == 0;
    bool same_origin = !origin || (strncmp(origin, scheme, sizeof scheme - 1) == 0 &&
                                   strcasecmp(origin + sizeof scheme - 1, host) == 0);
    return same_site && same_origin;
}
