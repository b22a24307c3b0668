/* hash.h - a 128-bit digest of the state's bytes, for comparing states (not against an adversary). */
#ifndef TL_BASE_HASH_H
#define TL_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

typedef struct tl_hash {
    uint64_t a, b;
} tl_hash;

tl_hash tl_hash_start(void);
/* Mixes bytes in, in order; the split into calls matters. */
void tl_hash_bytes(tl_hash *hash, const void *data, size_t bytes);
void tl_hash_word(tl_hash *hash, uint64_t word);
/* Numbers; all NaN are the same. */
void tl_hash_numbers(tl_hash *hash, const double *numbers, size_t count);

#endif
