/* topics.c - all that the help tells, file by file: what there is of the module, of models and of selections. */
#include "lua/topics.h"

#include "lua/block.h"
#include "lua/boundary.h"
#include "lua/contact.h"
#include "lua/deformable.h"
#include "lua/element.h"
#include "lua/history.h"
#include "lua/law_test.h"
#include "lua/library.h"
#include "lua/lists.h"
#include "lua/model.h"
#include "lua/modes.h"
#include "lua/page.h"
#include "lua/quality.h"
#include "lua/record.h"
#include "lua/run.h"
#include "lua/safety.h"
#include "lua/seat.h"
#include "lua/solid_test.h"
#include "lua/state.h"
#include "lua/view.h"
#include "lua/water.h"
#include "lua/zones.h"

static const tl_lua_topic *const lists[] = {
    tl_lua_model_topics,    tl_lua_block_topics,   tl_lua_contact_topics,  tl_lua_deformable_topics,
    tl_lua_zone_topics,     tl_lua_lists_topics,   tl_lua_law_test_topics, tl_lua_solid_test_topics,
    tl_lua_boundary_topics, tl_lua_run_topics,     tl_lua_history_topics,  tl_lua_library_topics,
    tl_lua_quality_topics,  tl_lua_page_topics,    tl_lua_view_topics,     tl_lua_state_topics,
    tl_lua_seat_topics,     tl_lua_element_topics, tl_lua_water_topics,    tl_lua_safety_topics,
    tl_lua_record_topics,   tl_lua_modes_topics};

const tl_lua_topic *tl_lua_topic_at(size_t i)
{
    for (size_t k = 0; k < TL_LUA_COUNT(lists); k++)
        for (const tl_lua_topic *topic = lists[k]; topic->name; topic++)
            if (i-- == 0)
                return topic;
    return NULL;
}

tl_lua_spec tl_lua_topic_spec(const tl_lua_topic *topic)
{
    if (topic->spec)
        return *topic->spec;
    tl_lua_spec spec = {.keys = topic->keys};
    if (topic->function)
        spec.params = tl_function_params(topic->function, &spec.count, NULL);
    return spec;
}
