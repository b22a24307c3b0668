/* law_cases.h - the laws that test_laws.c tries all alike, with their parameters. */
#ifndef TALUS_TESTS_LAW_CASES_H
#define TALUS_TESTS_LAW_CASES_H

#include "law_lanes.h"

/* kn, ks and strengths of a stiff joint, in SI units. */
#define KN 1e9
#define KS 4e8
#define FRICTION 30.0
#define COHESION 2e4
#define TENSION 1e4
#define DILATION 12.0

#define NUMBER(name, value)                                                                                            \
    {                                                                                                                  \
        .key = (name), .type = TL_VALUE_NUMBER, .number = (value)                                                      \
    }

#define WORD(name, value)                                                                                              \
    {                                                                                                                  \
        .key = (name), .type = TL_VALUE_STRING, .text = (value)                                                        \
    }

static const tl_value stiffnesses[] = {NUMBER("kn", KN), NUMBER("ks", KS)};
static const tl_value frictional[] = {NUMBER("kn", KN), NUMBER("ks", KS), NUMBER("friction", FRICTION),
                                      NUMBER("cohesion", COHESION)};
static const tl_value bonded[] = {NUMBER("kn", KN), NUMBER("ks", KS), NUMBER("friction", FRICTION),
                                  NUMBER("cohesion", COHESION), NUMBER("tension", TENSION)};

static const tl_value dilating[] = {NUMBER("kn", KN), NUMBER("ks", KS), NUMBER("friction", FRICTION),
                                    NUMBER("cohesion", COHESION), NUMBER("dilation", DILATION)};
static const tl_value bonded_dilating[] = {NUMBER("kn", KN),           NUMBER("ks", KS),
                                           NUMBER("friction", 45),     NUMBER("residual_friction", FRICTION),
                                           NUMBER("tension", TENSION), NUMBER("cohesion", COHESION),
                                           NUMBER("dilation", 20),     NUMBER("dilation_limit", 2e-4)};

static const tl_value weakening[] = {NUMBER("kn", KN),
                                     NUMBER("ks", KS),
                                     NUMBER("friction", 40),
                                     NUMBER("cohesion", COHESION),
                                     NUMBER("residual_friction", FRICTION),
                                     NUMBER("distance", 3e-3)};
static const tl_value exponential[] = {NUMBER("kn", KN),
                                       NUMBER("ks", KS),
                                       NUMBER("friction", 40),
                                       NUMBER("cohesion", COHESION),
                                       NUMBER("residual_friction", FRICTION),
                                       NUMBER("distance", 3e-3),
                                       WORD("form", "exponential")};

static const tl_value mortar[] = {
    NUMBER("kn", KN),  NUMBER("ks", KS), NUMBER("tension", TENSION),  NUMBER("cohesion", COHESION),
    NUMBER("gi", 0.3), NUMBER("gii", 2), NUMBER("friction", FRICTION)};

static const tl_value rough[] = {NUMBER("kni", 4e8),  NUMBER("ks", KS),          NUMBER("vm", 5e-4),
                                 NUMBER("jrc", 10),   NUMBER("jcs", 2e7),        NUMBER("phi_r", FRICTION),
                                 NUMBER("length", 1), NUMBER("linear_from", 1e6)};

static const tl_value creeping[] = {NUMBER("kn", KN), NUMBER("ks", KS), NUMBER("a", 0.01), NUMBER("b", 0.02),
                                    NUMBER("dc", 1e-4)};

static const tl_value yielding[] = {NUMBER("an", KN), NUMBER("as", KS), NUMBER("phi_i", 45), NUMBER("phi", FRICTION),
                                    NUMBER("roughness", 2e-3)};
static const tl_value curved_yielding[] = {NUMBER("an", 2e7),   NUMBER("en", 0.4),        NUMBER("as", 1e7),
                                           NUMBER("es", 0.3),   NUMBER("kn_max", 2 * KN), NUMBER("ks_max", KS),
                                           NUMBER("phi_i", 45), NUMBER("phi", FRICTION),  NUMBER("roughness", 2e-3)};

typedef struct law_case {
    const char *name;
    tl_args args;
    int ages; /* changes without motion, in time */
} law_case;

#define CASE(name, values)                                                                                             \
    {                                                                                                                  \
        (name), {(values), sizeof(values) / sizeof(values)[0]}, 0                                                      \
    }

/* The first five are known by their numbers. */
static const law_case law_cases[] = {
    CASE("elastic", stiffnesses),
    CASE("coulomb", frictional),
    CASE("coulomb_tensile", bonded),
    CASE("coulomb", dilating),
    CASE("coulomb_tensile", bonded_dilating),
    CASE("slip_weakening", weakening),
    CASE("slip_weakening", exponential),
    CASE("cohesive", mortar),
    CASE("barton_bandis", rough),
    CASE("continuously_yielding", yielding),
    CASE("continuously_yielding", curved_yielding),
    {"rate_state", {creeping, 5}, 1},
};

enum { LAWS = sizeof law_cases / sizeof law_cases[0] };

static inline law open_number(int number)
{
    return law_open(law_cases[number].name, &law_cases[number].args);
}

#endif
