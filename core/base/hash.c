/* hash.c - see hash.h. Two chains of the SplitMix64 mixer over 8-byte words. */
#include "base/hash.h"

#include "base/random.h"

#include <math.h>
#include <string.h>

tl_hash tl_hash_start(void)
{
    return (tl_hash){0x54616c7573000001u, 0x54616c7573000002u};
}

void tl_hash_word(tl_hash *hash, uint64_t word)
{
    hash->a = tl_mix64(hash->a ^ word);
    hash->b = tl_mix64(hash->b + (word << 32 | word >> 32));
}

void tl_hash_bytes(tl_hash *hash, const void *data, size_t bytes)
{
    const unsigned char *p = data;
    tl_hash_word(hash, bytes);
    for (; bytes >= 8; bytes -= 8, p += 8) {
        uint64_t word;
        memcpy(&word, p, 8);
        tl_hash_word(hash, word);
    }
    if (bytes) {
        uint64_t word = 0;
        memcpy(&word, p, bytes);
        tl_hash_word(hash, word);
    }
}

void tl_hash_numbers(tl_hash *hash, const double *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        double number = isnan(numbers[i]) ? NAN : numbers[i];
        tl_hash_bytes(hash, &number, sizeof number);
    }
}
