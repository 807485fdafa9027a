// Drawing from a discrete distribution: see AliasEntry. Two whole words go into it, so that the probability of every entry is met
// within 2^-32 of the number of entries.
#ifndef ALIAS_GLSL
#define ALIAS_GLSL

// A uniformly random number below `count`.
uint below(uint count, uint word) {
    uint high, low;
    umulExtended(count, word, high, low);
    return high;
}

uint choose(AliasEntry entry, uint number, uint word) {
    return word < entry.keep ? number : entry.other;
}

#endif
