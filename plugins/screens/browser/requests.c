/* requests.c - what is asked of the server, and what it answers.
 *
 *     GET /           the page
 *     GET /scene      frames without an end, as docs/scene_format.md tells
 *     POST /command   a command for the model, one JSON object
 *
 * A request shows the token, in the header X-Talus-Token or in the address, or gets 403, whatever it asks for. The page
 * needs none, for it holds nothing of the run. A body that is not long is read to its end before the answer. A
 * connection that is closed before is reset, and the answer lost. Every answer but the frames closes its connection, so
 * that none is kept for nothing. A request that is no HTTP gets the library's own answer, which holds nothing. */
#define _DEFAULT_SOURCE /* strcasecmp */
#include "server.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Bytes of a body that are read, to be thrown away, where a request is refused. */
#define MOST_READ 65536
/* Room for a sentence of page.check. */
#define WHY 512
/* Bytes of frames that are copied at once. */
#define AT_ONCE 65536

/* A request on its way. */
typedef struct request {
    unsigned status; /* known before the body: a refusal, or 0 */
    const char *text;
    const char *allow; /* methods, of a 405 */
    size_t seen;       /* bytes of the body */
    char body[TL_SCREEN_COMMAND];
    seat *seat; /* of GET /scene, once it is answered */
} request;

/* ---------------------------------------------------------------- answers ---------------- */

/* Sends a response, which is NULL without memory, and lets go of it. */
static enum MHD_Result send_response(struct MHD_Connection *connection, unsigned status, struct MHD_Response *response,
                                     const char *type, bool closes)
{
    static const char *const headers[][2] = {{"X-Frame-Options", "DENY"},
                                             {"X-Content-Type-Options", "nosniff"},
                                             {"Cross-Origin-Resource-Policy", "same-origin"},
                                             {"Referrer-Policy", "no-referrer"},
                                             {"Cache-Control", "no-store"}};
    if (!response)
        return MHD_NO;
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++)
        MHD_add_response_header(response, headers[i][0], headers[i][1]);
    MHD_add_response_header(response, "Content-Type", type);
    if (closes)
        MHD_add_response_header(response, "Connection", "close");
    enum MHD_Result result = MHD_queue_response(connection, status, response);
    MHD_destroy_response(response);
    return result;
}

/* An answer of one sentence. */
static enum MHD_Result say(struct MHD_Connection *connection, unsigned status, const char *text, const char *allow)
{
    struct MHD_Response *response =
        MHD_create_response_from_buffer(strlen(text), (void *)(uintptr_t)text, MHD_RESPMEM_MUST_COPY);
    if (response && allow)
        MHD_add_response_header(response, "Allow", allow);
    return send_response(connection, status, response, "text/plain; charset=utf-8", true);
}

static enum MHD_Result send_page(const server *s, struct MHD_Connection *connection)
{
    struct MHD_Response *response = MHD_create_response_from_buffer(s->page_length, s->page, MHD_RESPMEM_PERSISTENT);
    return send_response(connection, MHD_HTTP_OK, response, "text/html; charset=utf-8", true);
}

/* ---------------------------------------------------------------- frames ----------------- */

static ssize_t read_frames(void *cls, uint64_t at, char *to, size_t room)
{
    (void)at;
    seat *own = cls;
    if (own->gone)
        return MHD_CONTENT_READER_END_WITH_ERROR;
    ptrdiff_t given = mailbox_read(own->server->mail, &own->w, to, room);
    if (given < 0)
        return MHD_CONTENT_READER_END_WITH_ERROR;
    if (given > 0)
        return (ssize_t)given;
    if (own->server->closing)
        return MHD_CONTENT_READER_END_OF_STREAM;
    own->waits = true;
    MHD_suspend_connection(own->connection);
    return 0;
}

/* A free place among the watchers, or NULL. */
static seat *take_seat(server *s, struct MHD_Connection *connection)
{
    const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    for (size_t i = 0; info && i < MOST_WATCHERS; i++)
        if (!s->seats[i]) {
            seat *own = calloc(1, sizeof *own);
            if (!own)
                return NULL;
            own->server = s;
            own->connection = connection;
            own->socket = info->connect_fd;
            s->seats[i] = own;
            mailbox_join(s->mail, &own->w);
            return own;
        }
    return NULL;
}

static void leave_seat(seat *own)
{
    server *s = own->server;
    for (size_t i = 0; i < MOST_WATCHERS; i++)
        if (s->seats[i] == own)
            s->seats[i] = NULL;
    mailbox_leave(s->mail, &own->w);
    free(own);
}

static enum MHD_Result send_frames(server *s, struct MHD_Connection *connection, request *r)
{
    r->seat = take_seat(s, connection);
    if (!r->seat)
        return say(connection, MHD_HTTP_SERVICE_UNAVAILABLE,
                   "8 pages look at the run, which is the most it serves; close another one.", NULL);
    /* One who reads slowly, or has no news to read, is not silent. */
    MHD_set_connection_option(connection, MHD_CONNECTION_OPTION_TIMEOUT, 0U);
    struct MHD_Response *response =
        MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, AT_ONCE, read_frames, r->seat, NULL);
    return send_response(connection, MHD_HTTP_OK, response, "application/octet-stream", false);
}

/* ---------------------------------------------------------------- commands --------------- */

static enum MHD_Result take_command(const server *s, struct MHD_Connection *connection, const request *r)
{
    char why[WHY] = "";
    if (r->seen >= TL_SCREEN_COMMAND)
        return say(connection, MHD_HTTP_CONTENT_TOO_LARGE,
                   "A command has at most 511 bytes; send long lists of blocks in parts.", NULL);
    if (memchr(r->body, '\0', r->seen))
        return say(connection, MHD_HTTP_BAD_REQUEST, "A command has no byte 0 in it.", NULL);
    if (!s->check(r->body, r->seen, why, sizeof why))
        return say(connection, MHD_HTTP_BAD_REQUEST, why, NULL);
    if (s->closing)
        return say(connection, MHD_HTTP_SERVICE_UNAVAILABLE, "The run has ended.", NULL);
    if (!mailbox_post(s->mail, r->body, r->seen))
        return say(connection, MHD_HTTP_SERVICE_UNAVAILABLE,
                   "64 commands wait for the run already; send this one again later.", NULL);
    return say(connection, MHD_HTTP_ACCEPTED, "", NULL);
}

/* ---------------------------------------------------------------- requests --------------- */

/* The value of a header that may be there once; `*count` is how often it is. */
typedef struct header {
    const char *name, *value;
    unsigned count;
} header;

static enum MHD_Result find_header(void *cls, enum MHD_ValueKind kind, const char *name, const char *value)
{
    (void)kind;
    header *wanted = cls;
    if (strcasecmp(name, wanted->name) == 0) {
        wanted->value = value ? value : "";
        wanted->count++;
    }
    return MHD_YES;
}

static header header_of(struct MHD_Connection *connection, const char *name)
{
    header wanted = {name, NULL, 0};
    MHD_get_connection_values(connection, MHD_HEADER_KIND, find_header, &wanted);
    return wanted;
}

static bool comes_from_here(struct MHD_Connection *connection)
{
    header host = header_of(connection, "host"), origin = header_of(connection, "origin"),
           site = header_of(connection, "sec-fetch-site");
    return host.count == 1 && origin.count <= 1 && site.count <= 1 && host_is_local(host.value) &&
           origin_is_own(host.value, origin.value, site.value);
}

static bool shows_token(const server *s, struct MHD_Connection *connection)
{
    const char *sent = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "X-Talus-Token");
    if (!sent)
        sent = MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, "token");
    return token_is(sent, s->token);
}

static bool is_excess(struct MHD_Connection *connection)
{
    const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    return info && info->socket_context;
}

static void refuse(request *r, unsigned status, const char *text)
{
    r->status = status;
    r->text = text;
}

/* What can be said before the body is read. */
static void judge(const server *s, struct MHD_Connection *connection, const char *path, const char *method, request *r)
{
    bool posts = strcmp(path, "/command") == 0;
    bool known = posts || strcmp(path, "/") == 0 || strcmp(path, "/scene") == 0;
    if (is_excess(connection))
        refuse(r, MHD_HTTP_SERVICE_UNAVAILABLE,
               "The run has 12 connections, which is the most it serves; close another page.");
    else if (!comes_from_here(connection))
        refuse(r, MHD_HTTP_FORBIDDEN, "The run answers only to its own page, at 127.0.0.1 or localhost.");
    else if (strcmp(path, "/favicon.ico") == 0) /* which browsers ask for by themselves, without the token */
        refuse(r, MHD_HTTP_NOT_FOUND, "There is no such page.");
    /* the page holds nothing of the run: loaded again it has the token still, and its address has not */
    else if (strcmp(path, "/") != 0 && !shows_token(s, connection))
        refuse(r, MHD_HTTP_FORBIDDEN, "The token is missing or wrong; open the address that the run has printed.");
    else if (!known)
        refuse(r, MHD_HTTP_NOT_FOUND, "There is no such page.");
    else if (strcmp(method, posts ? "POST" : "GET") != 0) {
        refuse(r, MHD_HTTP_METHOD_NOT_ALLOWED, "This page is asked for by another method.");
        r->allow = posts ? "POST" : "GET";
    } else if (posts && !s->commands)
        refuse(r, MHD_HTTP_FORBIDDEN, "This run takes no commands: it only shows.");
}

/* Whether a body of the length that the request tells is too long to be read to its end. */
static bool is_long(struct MHD_Connection *connection)
{
    header length = header_of(connection, "content-length");
    return length.count > 0 && (strlen(length.value) > 9 || atol(length.value) > MOST_READ);
}

static enum MHD_Result answer(server *s, struct MHD_Connection *connection, const char *path, request *r)
{
    if (r->status)
        return say(connection, r->status, r->text, r->allow);
    if (strcmp(path, "/") == 0)
        return send_page(s, connection);
    if (strcmp(path, "/scene") == 0)
        return send_frames(s, connection, r);
    return take_command(s, connection, r);
}

enum MHD_Result answer_request(void *cls, struct MHD_Connection *connection, const char *path, const char *method,
                               const char *version, const char *data, size_t *size, void **of)
{
    (void)version;
    server *s = cls;
    request *r = *of;
    if (!r) {
        r = *of = calloc(1, sizeof *r);
        if (!r)
            return MHD_NO;
        judge(s, connection, path, method, r);
        if (!is_long(connection))
            return MHD_YES;
        r->seen = MOST_READ;
        return answer(s, connection, path, r);
    }
    if (*size == 0)
        return answer(s, connection, path, r);
    for (size_t i = 0; i < *size && r->seen + i < sizeof r->body && !r->status; i++)
        r->body[r->seen + i] = data[i];
    r->seen += *size;
    *size = 0;
    return r->seen <= MOST_READ ? MHD_YES : MHD_NO;
}

void request_ended(void *cls, struct MHD_Connection *connection, void **of, enum MHD_RequestTerminationCode how)
{
    (void)cls;
    (void)connection;
    (void)how;
    request *r = *of;
    if (r && r->seat)
        leave_seat(r->seat);
    free(r);
    *of = NULL;
}

void connection_changed(void *cls, struct MHD_Connection *connection, void **context,
                        enum MHD_ConnectionNotificationCode what)
{
    (void)connection;
    server *s = cls;
    if (what == MHD_CONNECTION_NOTIFY_CLOSED)
        s->connections--;
    else
        *context = s->connections++ < MOST_CONNECTIONS ? NULL : s;
}
