/* fuzz_file.c - files of blocks with anything in them: FUZZ_GENERATOR reads each, and makes blocks that can be run or a sentence.
 *
 * The bytes go into a file in memory, which generators read like any other. */
#define _GNU_SOURCE /* memfd_create */
#include <stdint.h>
#include <stdio.h>
#include <sys/mman.h>
#include <talus/talus.h>
#include <unistd.h>

int LLVMFuzzerInitialize(int *count, char ***arguments);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void say_nothing(void *user, const char *text)
{
    (void)user;
    (void)text;
}

int LLVMFuzzerInitialize(int *count, char ***arguments)
{
    (void)count;
    (void)arguments;
    tl_plugins_load_default();
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tl_error error;
    tl_model *m;
    char path[64];
    int file = memfd_create("fuzz" FUZZ_ENDING, 0);
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    tl_model_config config = tl_model_config_default();
    if (file < 0 || write(file, data, size) != (ssize_t)size ||
        tl_model_create(&config, &m, &error) != TL_OK)
        return 0;
    tl_model_log(m, say_nothing, NULL);
    tl_generate_summary summary;
    const tl_value values[] = {tl_arg_text("file", path)
#ifdef FUZZ_DENSITY
                                   ,
                               tl_arg_number("density", 2500), tl_arg_text("format", FUZZ_FORMAT)
#endif
    };
    tl_generate(m, FUZZ_GENERATOR, &(tl_args){values, sizeof values / sizeof *values}, &summary);
    tl_model_destroy(m);
    close(file);
    return 0;
}
