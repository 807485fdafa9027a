// How a path is laid aside, and taken up again.
//
// The words of the fields that a scene's paths have follow one another, row by row, so that those of a path at a vertex come
// first, then those of a look, then those of a segment: a path has as many as it needs where it is. Where a driver writes out
// each access to memory for every lane they are copied in loops, or what it has to compile doubles. What is copied has all
// rows, filled or not, so that each field is at a place that the driver knows.
#ifndef STAGE_LAID_ASIDE_GLSL
#define STAGE_LAID_ASIDE_GLSL
#include "lib/path_words.glsl"
#include "stages/lane.glsl"

uint copied[MOST_PATH_WORDS];

// What the rows of path_state.h ask for: the same in all passes of a render, but for walks, of which `generate` knows less.
#define STATE_CONDITIONS                                                                                              \
    bool sees = SHADOW_RAYS_WALK;                                                                                     \
    bool flight_rests = SHADOW_RAYS_WALK && NEE == NEE_TENTATIVE;                                                     \
    bool keeps_place = SHADOW_RAYS_WALK && KEEPS_PLACE;                                                               \
    bool looks_along = SHADOW_RAYS_WALK && LOOKS_ALONG;                                                               \
    bool chooses_light = SHADOW_RAYS_WALK && LIGHTS != LIGHTS_LONE;                                                   \
    bool has_cache = SHADOW_RAYS_WALK && NEE == NEE_CACHED;                                                           \
    bool meets_lights = MEETS_LIGHTS;                                                                                 \
    bool has_surfaces = HAS_SURFACES, has_parts = SHAPE == SHAPE_MESH, repeats = REPEATS;                             \
    bool has_layers = HAS_LAYERS, has_particles = HAS_PARTICLES, weighs_families = PATHS == PATHS_BOTH;               \
    bool splits = SPLITS;

// Which rows a path needs that does `todo` next, each with those before. `amid`, a constant: whether it may be amid a segment.
const uint VERTEX_ROWS = 0u, LOOK_ROWS = 1u, SEGMENT_ROWS = 2u;
bool may_be_amid(const bool amid) {
    return amid || NEE == NEE_TENTATIVE;
}
bool may_look(const bool amid) {
    return may_be_amid(amid) || SHADOW_RAYS_WALK || SETS_OUT;
}
uint rows_of(uint todo, const bool amid) {
    bool seeks = HAS_SURFACES && amid && (todo == TODO_SEEK || todo == TODO_CHECK);
    bool looks = SHADOW_RAYS_WALK && todo == TODO_LOOK;
    bool goes = amid && (todo == TODO_FLY || (SHADOW_RAYS_WALK && todo == TODO_SEE));
    if (seeks || goes || (looks && NEE == NEE_TENTATIVE))
        return SEGMENT_ROWS;
    return looks || sets_out_again(todo) ? LOOK_ROWS : VERTEX_ROWS;
}

// Where a path's first word is: in memory, or where it is copied to.
uint begin_at(uint slot) {
    return COPIES != 0 ? 0u : slot * uint(MOST_PATH_WORDS);
}

// The commonest types are spelled out: calls within calls take longer to inline, at every start.
void put(uint word, inout uint at) {
    if (COPIES != 0)
        copied[at] = word;
    else
        path_words[at] = word;
    at += 1u;
}
void put(float x, inout uint at) {
    if (COPIES != 0)
        copied[at] = floatBitsToUint(x);
    else
        path_words[at] = floatBitsToUint(x);
    at += 1u;
}
void put(vec3 v, inout uint at) {
    uvec3 words = floatBitsToUint(v);
    if (COPIES != 0) {
        copied[at] = words.x;
        copied[at + 1u] = words.y;
        copied[at + 2u] = words.z;
    } else {
        path_words[at] = words.x;
        path_words[at + 1u] = words.y;
        path_words[at + 2u] = words.z;
    }
    at += 3u;
}
void put(int i, inout uint at) {
    put(uint(i), at);
}
void put(vec2 v, inout uint at) {
    put(v.x, at);
    put(v.y, at);
}
void put(ivec3 v, inout uint at) {
    put(uint(v.x), at);
    put(uint(v.y), at);
    put(uint(v.z), at);
}

void take(out uint word, inout uint at) {
    if (COPIES != 0)
        word = copied[at];
    else
        word = path_words[at];
    at += 1u;
}
void take(out float x, inout uint at) {
    if (COPIES != 0)
        x = uintBitsToFloat(copied[at]);
    else
        x = uintBitsToFloat(path_words[at]);
    at += 1u;
}
void take(out vec3 v, inout uint at) {
    uvec3 words;
    if (COPIES != 0)
        words = uvec3(copied[at], copied[at + 1u], copied[at + 2u]);
    else
        words = uvec3(path_words[at], path_words[at + 1u], path_words[at + 2u]);
    v = uintBitsToFloat(words);
    at += 3u;
}
void take(out int i, inout uint at) {
    uint word;
    take(word, at);
    i = int(word);
}
void take(out vec2 v, inout uint at) {
    take(v.x, at);
    take(v.y, at);
}
void take(out ivec3 v, inout uint at) {
    take(v.x, at);
    take(v.y, at);
    take(v.z, at);
}

uint words_of(uint x) { return 1u; }
uint words_of(int x) { return 1u; }
uint words_of(float x) { return 1u; }
uint words_of(vec2 x) { return 2u; }
uint words_of(vec3 x) { return 3u; }
uint words_of(ivec3 x) { return 3u; }

#define COUNT(type, name) count += words_of(it.name);
#define COUNT_WHEN(type, name, when)                                                                                  \
    if (when)                                                                                                         \
        count += words_of(it.name);
#define PUT(type, name) put(it.name, at);
#define PUT_WHEN(type, name, when)                                                                                    \
    if (when)                                                                                                         \
        put(it.name, at);
#define TAKE(type, name) take(it.name, at);
#define TAKE_WHEN(type, name, when)                                                                                   \
    if (when)                                                                                                         \
        take(it.name, at);
// What is not kept is 0.
#define TAKE_OR_CLEAR(type, name, when)                                                                               \
    if (when)                                                                                                         \
        take(it.name, at);                                                                                            \
    else                                                                                                              \
        it.name = type(0);

uint words_of(PathState it) {
    uint count = 0u;
    VERTEX_STATE(COUNT)
    return count;
}
uint words_of(Walk it) {
    WALK_CONDITIONS
    uint count = 0u;
    WALK_STATE(COUNT_WHEN)
    return count;
}
uint words_of(PartSearch it) {
    uint count = 0u;
    SEARCH_STATE(COUNT)
    return count;
}
uint words_of(SurfaceSearch it) {
    uint count = 0u;
    SEEK_STATE(COUNT)
    return count;
}
uint words_of(Split it) {
    uint count = 0u;
    SPLIT_STATE(COUNT)
    return count;
}
void put(PathState it, inout uint at) {
    VERTEX_STATE(PUT)
}
void put(Walk it, inout uint at) {
    WALK_CONDITIONS
    WALK_STATE(PUT_WHEN)
}
void put(PartSearch it, inout uint at) {
    SEARCH_STATE(PUT)
}
void put(SurfaceSearch it, inout uint at) {
    SEEK_STATE(PUT)
}
void put(Split it, inout uint at) {
    SPLIT_STATE(PUT)
}
void take(out PathState it, inout uint at) {
    VERTEX_STATE(TAKE)
}
void take(out Walk it, inout uint at) {
    WALK_CONDITIONS
    WALK_STATE(TAKE_OR_CLEAR)
}
void take(out PartSearch it, inout uint at) {
    SEARCH_STATE(TAKE)
}
void take(out SurfaceSearch it, inout uint at) {
    SEEK_STATE(TAKE)
}
void take(out Split it, inout uint at) {
    SPLIT_STATE(TAKE)
}

// `pixel`: see PathState.
void lay_aside(uint slot, uint pixel, Rng rng, Lane it, const bool amid) {
    STATE_CONDITIONS
    it.path.draw = rng.draw;
    it.path.todo = it.todo;
    it.path.pixel = pixel;
    uint at = begin_at(slot);
    put(it.path, at);
    PATH_STATE(PUT_WHEN)
    uint rows = rows_of(it.todo, amid), count = at;
    if (may_look(amid) && (COPIES != 0 || rows >= LOOK_ROWS)) {
        LOOK_STATE(PUT_WHEN)
        count = rows >= LOOK_ROWS ? at : count;
    }
    if (may_be_amid(amid) && (COPIES != 0 || rows == SEGMENT_ROWS)) {
        SEGMENT_STATE(PUT_WHEN)
        count = rows == SEGMENT_ROWS ? at : count;
    }
    if (COPIES != 0)
        for (uint i = 0u; i < by_lane(count); i += WORDS_AT_ONCE) {
            PATH_WORD(slot, i) = copied[i];
            PATH_WORD(slot, i + 1u) = copied[i + 1u];
            PATH_WORD(slot, i + 2u) = copied[i + 2u];
            PATH_WORD(slot, i + 3u) = copied[i + 3u];
        }
}

void take_up(uint slot, inout Lane it, out Rng rng, const bool amid) {
    STATE_CONDITIONS
    uint rows = rows_of(PATH_WORD(slot, PATH_TODO), amid);
    if (COPIES != 0) {
        uint count = words_of(it.path);
        PATH_STATE(COUNT_WHEN)
        if (rows >= LOOK_ROWS) {
            LOOK_STATE(COUNT_WHEN)
        }
        if (rows == SEGMENT_ROWS) {
            SEGMENT_STATE(COUNT_WHEN)
        }
        for (uint i = 0u; i < by_lane(count); i += WORDS_AT_ONCE) {
            copied[i] = PATH_WORD(slot, i);
            copied[i + 1u] = PATH_WORD(slot, i + 1u);
            copied[i + 2u] = PATH_WORD(slot, i + 2u);
            copied[i + 3u] = PATH_WORD(slot, i + 3u);
        }
    }
    uint at = begin_at(slot);
    take(it.path, at);
    PATH_STATE(TAKE_WHEN)
    if (may_look(amid) && (COPIES != 0 || rows >= LOOK_ROWS)) {
        LOOK_STATE(TAKE_WHEN)
    }
    if (may_be_amid(amid) && (COPIES != 0 || rows == SEGMENT_ROWS)) {
        SEGMENT_STATE(TAKE_WHEN)
    }
    it.todo = it.path.todo;
    rng = pixel_rng(it.path.place, it.path.sample_index, it.path.draw);
}

#undef COUNT
#undef COUNT_WHEN
#undef PUT
#undef PUT_WHEN
#undef TAKE
#undef TAKE_WHEN
#undef TAKE_OR_CLEAR

#endif
