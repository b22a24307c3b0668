/* zone_clusters.c - clusters: groups of about six zones of a block that hang together by sides.
 *
 * Greedy: the zone with the lowest number that has no cluster begins one. The neighbour that brings the fewest new
 * corners is added, the lowest of several, until there are TL_CLUSTER_FULL or no neighbour is left. A zone that touches
 * a cluster by one side brings one corner, by two or three sides mostly none, so clusters come out compact.
 *
 * Clusters with fewer than TL_CLUSTER_FEW zones then join a neighbour in the order of their numbers: the one with the
 * fewest zones, the lowest of several, that has at most TL_CLUSTER_MOST with them. */
#include "geometry/zone_clusters.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define NONE UINT32_MAX

typedef struct making {
    const uint32_t (*zone)[4], (*beside)[4];
    uint32_t count;                      /* zones */
    uint32_t *of;                        /* [zone] its cluster */
    uint32_t (*member)[TL_CLUSTER_MOST]; /* [cluster] */
    uint32_t *size;                      /* [cluster] */
    uint32_t cluster_count;
} making;

static void put_in(making *m, uint32_t cluster, uint32_t zone)
{
    m->of[zone] = cluster;
    m->member[cluster][m->size[cluster]++] = zone;
}

/* How many corners of a zone no zone of a cluster has. */
static int new_corners(const making *m, uint32_t cluster, uint32_t zone)
{
    int fresh = 4;
    for (int i = 0; i < 4; i++) {
        bool found = false;
        for (uint32_t k = 0; k < m->size[cluster] && !found; k++) {
            const uint32_t *v = m->zone[m->member[cluster][k]], corner = m->zone[zone][i];
            found = v[0] == corner || v[1] == corner || v[2] == corner || v[3] == corner;
        }
        fresh -= found;
    }
    return fresh;
}

/* The free neighbour of a cluster that brings the fewest corners; NONE: it has none. */
static uint32_t best_neighbour(const making *m, uint32_t cluster)
{
    uint32_t best = NONE;
    int fewest = 5;
    for (uint32_t k = 0; k < m->size[cluster]; k++)
        for (int i = 0; i < 4; i++) {
            const uint32_t next = m->beside[m->member[cluster][k]][i];
            if (next == NONE || next == best || m->of[next] != NONE)
                continue;
            const int fresh = new_corners(m, cluster, next);
            if (fresh < fewest || (fresh == fewest && next < best))
                fewest = fresh, best = next;
        }
    return best;
}

static void grow_all(making *m)
{
    for (uint32_t z = 0; z < m->count; z++) {
        if (m->of[z] != NONE)
            continue;
        const uint32_t cluster = m->cluster_count++;
        put_in(m, cluster, z);
        while (m->size[cluster] < TL_CLUSTER_FULL) {
            const uint32_t next = best_neighbour(m, cluster);
            if (next == NONE)
                break;
            put_in(m, cluster, next);
        }
    }
}

/* The neighbour that a small cluster joins; NONE: none has room. */
static uint32_t host_of(const making *m, uint32_t cluster)
{
    uint32_t host = NONE;
    for (uint32_t k = 0; k < m->size[cluster]; k++)
        for (int i = 0; i < 4; i++) {
            const uint32_t next = m->beside[m->member[cluster][k]][i], other = next == NONE ? cluster : m->of[next];
            if (other == cluster || m->size[other] + m->size[cluster] > TL_CLUSTER_MOST)
                continue;
            if (host == NONE || m->size[other] < m->size[host] || (m->size[other] == m->size[host] && other < host))
                host = other;
        }
    return host;
}

static void join_small(making *m)
{
    for (uint32_t c = 0; c < m->cluster_count; c++) {
        if (m->size[c] >= TL_CLUSTER_FEW)
            continue;
        const uint32_t host = host_of(m, c);
        for (uint32_t k = 0; host != NONE && k < m->size[c]; k++)
            put_in(m, host, m->member[c][k]);
        m->size[c] = host == NONE ? m->size[c] : 0;
    }
}

static void list_all(const making *m, tl_zone_clusters *clusters)
{
    uint32_t at = 0;
    for (uint32_t c = 0; c < m->cluster_count; c++) {
        if (m->size[c] == 0)
            continue;
        clusters->start[clusters->count++] = at;
        memcpy(clusters->zone + at, m->member[c], m->size[c] * sizeof *clusters->zone);
        at += m->size[c];
    }
    clusters->start[clusters->count] = at;
}

tl_status tl_zone_clusters_make(const uint32_t (*zone)[4], const uint32_t (*beside)[4], uint32_t zone_count,
                                tl_zone_clusters *clusters, tl_error *error)
{
    const size_t zones = (size_t)zone_count + 1;
    making m = {.zone = zone, .beside = beside, .count = zone_count};
    *clusters = (tl_zone_clusters){0};
    m.of = malloc(zones * sizeof *m.of);
    m.member = malloc(zones * sizeof *m.member);
    m.size = calloc(zones, sizeof *m.size);
    clusters->start = malloc(zones * sizeof *clusters->start);
    clusters->zone = malloc(zones * sizeof *clusters->zone);
    const bool made = m.of && m.member && m.size && clusters->start && clusters->zone;
    if (made) {
        memset(m.of, 0xff, zones * sizeof *m.of);
        grow_all(&m);
        join_small(&m);
        list_all(&m, clusters);
    } else {
        tl_zone_clusters_free(clusters);
    }
    free(m.of);
    free(m.member);
    free(m.size);
    return made ? TL_OK : tl_fail_memory(error);
}

void tl_zone_clusters_free(tl_zone_clusters *clusters)
{
    free(clusters->start);
    free(clusters->zone);
    *clusters = (tl_zone_clusters){0};
}
