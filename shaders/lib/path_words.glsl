// Where a path's words are in memory. Software drivers keep those of a path together, which share a line of a cache; GPUs those
// of the same field, which neighbouring lanes ask for together.
#ifndef PATH_WORDS_GLSL
#define PATH_WORDS_GLSL
#include "lib/buffers.glsl"

const uint WORD_STRIDE = uint(SLOTS) + uint(SLOTS == 0); // from one word of a path to its next

#define PATH_WORD(slot, field) path_words[place_of_word(slot, field)]

uint place_of_word(uint slot, uint field) {
    return SLOTS == 0 ? slot * uint(MOST_PATH_WORDS) + field : field * uint(SLOTS) + slot;
}

#endif
