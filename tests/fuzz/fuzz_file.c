/* fuzz_file.c - files of blocks with anything in them: the generator FUZZ_GENERATOR reads each, and makes blocks or a sentence.
 *
 * The bytes go into a file of the folder that the target runs in. */
#include <stdint.h>
#include <stdio.h>
#include <talus/talus.h>

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

static bool write_bytes(const uint8_t *data, size_t size)
{
    FILE *file = fopen(FUZZ_FILE, "wb");
    if (!file)
        return false;
    bool written = fwrite(data, 1, size, file) == size;
    return fclose(file) == 0 && written;
}

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
    tl_model_destroy(m);
    return 0;
}
