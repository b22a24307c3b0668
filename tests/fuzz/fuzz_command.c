/* fuzz_command.c - commands with anything in them: each is one of the list, or a sentence says why not. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <talus/talus.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tl_view_command command;
    char why[TL_ERROR_TEXT] = "";
    int taken = tl_view_command_read((const char *)data, size, &command, why, sizeof why);
    if (taken != (why[0] == '\0') || (taken && !tl_view_op_name(command.op)) || command.block_count > TL_VIEW_BLOCKS ||
        strlen(command.joint) >= TL_VIEW_JOINT)
        abort();
    return 0;
}
