/* zone_clusters.h - clusters: groups of about six zones of a block that hang together by sides. */
#ifndef TL_GEOMETRY_ZONE_CLUSTERS_H
#define TL_GEOMETRY_ZONE_CLUSTERS_H

#include "base/error.h"

/* Most zones of a cluster, how many it has as a rule, and below how many it joins another. */
#define TL_CLUSTER_MOST 10
#define TL_CLUSTER_FULL 6
#define TL_CLUSTER_FEW 3

typedef struct tl_zone_clusters {
    uint32_t count;
    uint32_t *start; /* [count + 1] into zone; clusters in the order in which they were begun */
    uint32_t *zone;  /* [zones] each cluster's, as they were added */
} tl_zone_clusters;

/* Makes clusters of the zones of one block. `beside` are the zones opposite each corner, UINT32_MAX where there is
 * none. Every zone is in one cluster. Clusters smaller than TL_CLUSTER_FEW have no neighbour that has room for them. */
tl_status tl_zone_clusters_make(const uint32_t (*zone)[4], const uint32_t (*beside)[4], uint32_t zone_count,
                                tl_zone_clusters *clusters, tl_error *error);
void tl_zone_clusters_free(tl_zone_clusters *clusters);

#endif
