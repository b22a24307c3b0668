/* fuzz_file.c - files of blocks with anything in them: the generator FUZZ_GENERATOR reads each, and makes blocks or a sentence.
 * With FUZZ_ZONES the file is then read once more, for the zones of these blocks, and for those of a cube.
 *
 * The bytes go into a file that lies in memory, for a disk would take most of the time. Its name in the folder that the target
 * runs in is a link, so that the reader is chosen by its ending. */
#define _GNU_SOURCE
#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <talus/number.h>
#include <talus/talus.h>
#include <talus/zones.h>
#include <unistd.h>

int LLVMFuzzerInitialize(int *count, char ***arguments);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void say_nothing(void *user, const char *text)
{
    (void)user;
    (void)text;
}

static int file = -1; /* in memory */

int LLVMFuzzerInitialize(int *count, char ***arguments)
{
    char path[64];
    (void)count;
    (void)arguments;
    tl_plugins_load_default();
    file = memfd_create(FUZZ_FILE, 0);
    tl_text_print(path, sizeof path, "/proc/self/fd/%d", file);
    unlink(FUZZ_FILE);
    if (file < 0 || symlink(path, FUZZ_FILE) != 0)
        abort();
    return 0;
}

static bool write_bytes(const uint8_t *data, size_t size)
{
    return ftruncate(file, 0) == 0 && pwrite(file, data, size, 0) == (ssize_t)size;
}

#ifdef FUZZ_ZONES
/* Each block by itself, for the others may not fit; then some steps. */
static void fill_blocks(tl_model *m)
{
    const tl_value box[] = {TL_ARG_VECTOR("min", 0, 0, 0), TL_ARG_VECTOR("max", 1, 1, 1),
                            tl_arg_number("density", 2500)};
    const tl_value moduli[] = {tl_arg_number("young", 1e9), tl_arg_number("poisson", 0.25)};
    const tl_args properties = {moduli, 2}, cube = {box, 3};
    tl_zoning how = tl_zoning_default();
    tl_solve_result result;
    tl_zoned made;
    tl_id *blocks = NULL;
    size_t count = 0;
    tl_block_filter all = tl_block_filter_default();
    how.solid = "rock";
    how.file = FUZZ_FILE;
    tl_generate(m, "box", &cube, NULL);
    if (tl_model_solid(m, "rock", "elastic", &properties) == TL_OK &&
        tl_blocks_select(m, &all, &blocks, &count) == TL_OK)
        for (size_t k = 0; k < count; k++)
            tl_blocks_deform(m, &blocks[k], 1, &how, &made);
    free(blocks);
    tl_model_cycle(m, 3, &result);
}
#endif

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tl_error error;
    tl_model *m;
    tl_model_config config = tl_model_config_default();
    if (!write_bytes(data, size) || tl_model_create(&config, &m, &error) != TL_OK)
        return 0;
    tl_model_log(m, say_nothing, NULL);
    tl_generate_summary summary;
    const tl_value values[] = {tl_arg_text("file", FUZZ_FILE), tl_arg_number("density", 2500)};
    const tl_args args = {values, FUZZ_VALUES};
    tl_generate(m, FUZZ_GENERATOR, &args, &summary);
#ifdef FUZZ_ZONES
    fill_blocks(m);
#endif
    tl_model_destroy(m);
    return 0;
}
