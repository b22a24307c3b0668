/* test_coarse_test.c - the coarse test of a pair ends, whatever the roundings are. */
#include "contact_scene.h"
#include "narrow/coarse_test.h"

/* Two blocks of a rock cut by three joint sets that meet in two corners: libccd's search for their common part goes round in a
 * circle. */
TEST(a_search_without_end_is_ended)
{
    static const tl_vec3 a[] = {{-0x1.2b3387f4a8529p-1, 0x1.c953444f8fd24p-3, 0x1.672b2babc4798p-4},
                                {0x1.675e2dbcfafcp-2, -0x1.0de03e738cacap-3, -0x1.2fd64c8a79eaep-3},
                                {0x1.6eeb0d61d25cep-2, -0x1.800955eafa957p-3, -0x1.185bc47b40bcp-3},
                                {-0x1.4d3d9fa71c942p-2, 0x1.0925e8c53547p-5, -0x1.2b2b9f411f7c8p-2},
                                {0x1.dc1b9d69c4c18p-4, -0x1.cc956bfdb85p-9, 0x1.ecd1ba7df7b8p-3},
                                {-0x1.be42cba30ba14p-2, 0x1.6d11dbef0098ep-3, 0x1.0f7cfa8fc8c9cp-3},
                                {-0x1.b25c8c9f5c538p-2, 0x1.805aa3ccaa6d4p-3, 0x1.0fe7a41ec1b2cp-3},
                                {0x1.b97817df9c62p-4, 0x1.ba956c465115p-5, 0x1.d7e30ce254394p-3}};
    static const tl_vec3 b[] = {{0x1.5b07eee92421p-4, 0x1.4ede2b3611a8p-6, 0x1.28bbda90223a8p-2},
                                {0x1.458e8baaf8d5p-4, 0x1.35dc37e8a04ap-4, 0x1.1914f5f16a754p-2},
                                {-0x1.30102ede46468p-1, 0x1.d7aa480397558p-3, 0x1.a039489558e2p-4},
                                {-0x1.be42cba30b9fep-2, 0x1.6d11dbef0098ap-3, 0x1.0f7cfa8fc8c68p-3},
                                {-0x1.b25c8c9f5c522p-2, 0x1.805aa3ccaa6dp-3, 0x1.0fe7a41ec1af8p-3},
                                {-0x1.5094680d98485p+0, 0x1.2417f51b5c559p+0, 0x1.391f953b0621p+1},
                                {-0x1.0b0e5d3be627ep+1, 0x1.54b02d3429e28p+0, 0x1.253dd7fa63f7ep+1},
                                {-0x1.4e460676d271ep+0, 0x1.13cbf0290eaffp+0, 0x1.3aa7d9bff850ap+1}};
    const double reach = 0x1.acfdfee1b8c2bp-13;
    static scene_pair pair;
    pair = scene_pair_of(scene_hull_shape(a, sizeof a / sizeof *a), scene_hull_shape(b, sizeof b / sizeof *b),
                         tl_q_identity(), tl_v3(0, 0, 0));
    tl_pair_view *view = scene_place(&pair);
    CHECK(tl_coarse_test(view, reach));
    CHECK(tl_coarse_test(view, 10 * reach));
    /* and one that is apart is told so still */
    pair.shift = tl_v3(0, 0, 1);
    CHECK(!tl_coarse_test(scene_place(&pair), reach));
    scene_pair_free(&pair);
}

TEST_MAIN(RUN(a_search_without_end_is_ended))
