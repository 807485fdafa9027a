// Where a path's words are in memory: together, so that they share lines of a cache. (Those of the same field together, for
// neighbouring lanes of GPUs, were slower: tools/results/gpu.txt.)
#ifndef PATH_WORDS_GLSL
#define PATH_WORDS_GLSL
#include "lib/buffers.glsl"

#define PATH_WORD(slot, field) path_words[(slot) * uint(MOST_PATH_WORDS) + (field)]

#endif
