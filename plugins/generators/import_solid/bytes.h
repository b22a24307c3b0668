/* bytes.h - numbers of binary files. */
#ifndef IMPORT_SOLID_BYTES_H
#define IMPORT_SOLID_BYTES_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

typedef enum number_type { INT8, UINT8, INT16, UINT16, INT32, UINT32, INT64, UINT64, FLOAT32, FLOAT64 } number_type;

static const size_t number_bytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};

/* The number of a type at `at`, the lowest byte first or last. */
static inline double number_at(const char *at, number_type type, bool big_endian)
{
    size_t bytes = number_bytes[type];
    uint64_t word = 0;
    float single;
    double value;
    for (size_t i = 0; i < bytes; i++)
        word |= (uint64_t)(unsigned char)at[big_endian ? bytes - 1 - i : i] << 8 * i;
    uint32_t low = (uint32_t)word;
    switch (type) {
    case INT8: return (double)(int8_t)(uint8_t)word;
    case INT16: return (double)(int16_t)(uint16_t)word;
    case INT32: return (double)(int32_t)low;
    case INT64: return (double)(int64_t)word;
    case FLOAT32: memcpy(&single, &low, sizeof single); return (double)single;
    case FLOAT64: memcpy(&value, &word, sizeof value); return value;
    case UINT8:
    case UINT16:
    case UINT32:
    case UINT64: break;
    }
    return (double)word;
}

/* Constant: relative rounding of coordinates in single and in double precision. */
#define SINGLE_ROUNDING 1.2e-7
#define DOUBLE_ROUNDING 2.3e-16

#endif
