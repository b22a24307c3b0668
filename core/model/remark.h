/* remark.h - the remarks that are made once a model. */
#ifndef TL_MODEL_REMARK_H
#define TL_MODEL_REMARK_H

/* Their numbers are bits in saved files: new ones come last. */
typedef enum tl_remark {
    TL_REMARK_UNDAMPED,  /* solve without damping */
    TL_REMARK_GRAVITY,   /* points upward */
    TL_REMARK_STEP,      /* a given one is far too long */
    TL_REMARK_FRICTION,  /* looks like a coefficient */
    TL_REMARK_SOFT,      /* blocks sink in under their weight */
    TL_REMARK_STIFF,     /* the closure under weight is lost in rounding */
    TL_REMARK_DENSITY,   /* is not that of a solid, or does not go with the stiffness */
    TL_REMARK_TENSION,   /* initial stress pulls */
    TL_REMARK_OVERLAP,   /* blocks overlap when they come into contact */
    TL_REMARK_CLOSURE,   /* a contact closes by much of a block's thickness */
    TL_REMARK_UNDECIDED, /* a run for equilibrium has ended before it, without failure */
    TL_REMARK_SEAT,      /* overlaps press with more than the weight before the first step */
    TL_REMARK_MOVED,     /* at rest after a movement that is a word on stiffness */
    TL_REMARK_RECORD     /* a step is longer than those of a record */
} tl_remark;

#endif
