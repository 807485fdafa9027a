// What is known of a path between two passes, a row a field: its words in memory, what a lane holds, laying aside, taking
// up and their test are all made of these rows, so that none can be forgotten in one of them. Words follow one another in
// the order of the rows, of those alone that a scene's paths have: see laid_aside.glsl.
#ifndef SHARED_PATH_STATE_H
#define SHARED_PATH_STATE_H

// What a lane does next.
#define TODO_TAKE 0u   // take a pixel (fused) or a path (staged) from the queue
#define TODO_DEPART 1u // from a vertex: scatter, unless it is the camera, and fly
#define TODO_LOOK 2u   // toward the light
#define TODO_FLY 3u    // go on along the flight
#define TODO_SEE 4u    // go on along the shadow ray
#define TODO_END 5u    // the path is over
#define TODO_DONE 6u   // the pixel has its samples
#define TODO_BEGIN 7u  // a path, at the camera
#define TODO_SET_OUT 8u // from a vertex, where it has scattered and seen the lamps that it shows
#define TODO_SEEK 9u    // the surface that ends the flight, before that begins
#define TODO_CHECK 10u  // whether a surface is in the way of the shadow ray, before that begins
#define TODO_GO 11u     // along a flight whose end is known, from where it has looked

// Turns of a lane of a staged pass between two looks whether its path goes on elsewhere.
#define STAGED_BURST 4u

// Legs of a look from along a flight.
#define LEG_ALONG 0u // to where it begins
#define LEG_LOOK 1u  // toward the light, as all other looks

// ROW(type, name). Of every path, at its last vertex: the camera, or a real collision.
#define VERTEX_STATE(ROW)                                                                                             \
    ROW(uint, todo)  /* TODO_...: what comes next */                                                                  \
    ROW(uint, pixel) /* fused: index into the film; staged: into the work list */                                     \
    ROW(uint, place) /* of the pixel in the picture, x | y << 16 */                                                   \
    ROW(uint, sample_index)                                                                                           \
    ROW(vec3, position)  /* render space */                                                                           \
    ROW(vec3, direction) /* unit, of travel: the camera ray's, or that which led to this collision */                 \
    ROW(vec3, radiance)  /* gathered so far */                                                                        \
    ROW(uint, draw)   /* random draws consumed; 0 at the camera, whose draw also holds the first free flight */       \
    ROW(uint, depth)  /* scattering events, this one included; 0 at the camera */                                     \
    ROW(uint, medium) /* of several, the row of that which it collided with; at a surface AT_SURFACE + its primitive */

// Those of its words that passes without lanes know.
#define PATH_TODO 0u
#define PATH_PIXEL 1u
#define PATH_PLACE 2u
#define PATH_SAMPLE 3u

// ROW(type, name, when): `when` is what a scene has to have for its paths to have the field, see laid_aside.glsl. Also of
// every path, wherever it is.
#define PATH_STATE(ROW)                                                                                               \
    ROW(Spectrum, beta, true)          /* throughput; at a collision it includes that collision's albedo */           \
    ROW(Spectrum, cached, has_cache)   /* transmittance that the shadow ray corrects */                               \
    ROW(uint, first_label, has_layers) /* part of the label of what it brings that is the same for all that comes later: see aovs.glsl */ \
    ROW(uint, is_particle, has_particles)   /* 1: it comes from a light, and looks toward the sensor */               \
    ROW(float, begun_with, has_particles || splits) /* its largest throughput at first, which roulette compares with */ \
    ROW(vec2, shares, weighs_families) /* what its first segment has to say in its weights: see families.glsl */

// Of one that looks, or has drawn a way that it does not go yet. (Nothing here hangs on several media, of which `generate` does
// not know.)
#define LOOK_STATE(ROW)                                                                                               \
    ROW(Spectrum, lit, keeps_place)         /* throughput of what a shadow ray lights, */                             \
    ROW(vec3, position, keeps_place)        /* and where that is, render space */                                     \
    ROW(uint, lit_medium, keeps_place)      /* of several, the row of that which it lights */                         \
    ROW(uint, resume, keeps_place)          /* what to do after it */                                                 \
    ROW(uint, leg, looks_along)             /* LEG_... */                                                             \
    ROW(vec3, to_light, chooses_light)      /* unit */                                                                \
    ROW(float, light_distance, chooses_light) /* world units */                                                       \
    ROW(vec3, light, chooses_light)         /* what comes along the shadow ray if nothing is in between, per unit of the \
                                               throughput that it lights */                                           \
    ROW(float, chance, has_cache)           /* with which it was sent */                                              \
    ROW(uint, label, has_layers)            /* of what it brings: see aovs.glsl */                                    \
    ROW(uint, target, has_particles)        /* the film entry that what it lights is seen in */                       \
    ROW(uint, lit_surface, has_surfaces)    /* the primitive that the shadow ray lights, or NO_SURFACE */             \
    ROW(uint, lamp_body, has_surfaces)      /* the surface whose light it looks for, or NO_SURFACE */                 \
    ROW(float, phase_pdf, meets_lights)     /* with which the flight's direction was drawn; 0 at the camera */        \
    ROW(float, reach, has_surfaces) /* of the flight, to the surface that ends it, or FAR [world units] */            \
    ROW(uint, struck, has_surfaces) /* that surface's primitive */

// Of one that is amid a segment: a free flight, or a shadow ray. Of what `generate` lays aside nothing here is read.
#define SEGMENT_STATE(ROW)                                                                                            \
    ROW(Walk, walk, true)                                                                                             \
    ROW(Split, split, splits)                                                                                         \
    ROW(Walk, flight, flight_rests)   /* to come back to from a shadow ray that was sent amid it */                   \
    ROW(Spectrum, T, sees)            /* of the shadow ray so far */                                                  \
    ROW(uint, steps, true)            /* of the segment */                                                            \
    ROW(PartSearch, search, has_parts)                                                                                \
    ROW(SurfaceSearch, seek, has_surfaces)                                                                            \
    ROW(float, flown, repeats) /* of the flight, before it came to where the path's position now is [world units] */  \
    ROW(uint, seams, repeats && has_surfaces) /* 1: the segment has passed some, and goes on */

// ROW(type, name, when): a segment as far as it has gone, and which estimators need the field; see segment.glsl.
#define WALK_STATE(ROW)                                                                                               \
    ROW(vec3, origin, true)     /* medium space, where the present part of the ray within the medium begins */        \
    ROW(vec3, direction, true)  /* what one world unit of travel becomes in medium space */                           \
    ROW(float, start, true)     /* of that part, from the vertex [world units] */                                     \
    ROW(float, t_end, true)     /* its length */                                                                      \
    ROW(float, t, true)         /* travelled in it */                                                                 \
    ROW(float, at, false)       /* where in it the last interaction was: set by every step */                         \
    ROW(uint, met, false)       /* of several media, the row of that which it was with: likewise */                   \
    ROW(vec3, tap, false)       /* of several media, with which their densities were looked up there: likewise */      \
    ROW(vec3, per_extinction, false) /* and the throughput that collided with any of them, over their extinction there [world units] */ \
    ROW(float, tau, true)       /* optical depth left: of the majorant, or, where no collision is null, of the medium */ \
    ROW(float, depth, adds_depth) /* density integrated so far, over all parts */                                     \
    ROW(float, sigma_maj, walks)  /* of the present cell [1 / world unit]; if it is empty, minus its reach, see majorant.glsl */ \
    ROW(float, rate, false)       /* of tentative collisions in the last step [1 / world unit]: set by every step */ \
    ROW(float, least, splits)     /* of them at least, on average, for each cell that it passes; 0: as sigma_maj has it */ \
    ROW(float, control, controlled) /* control density of the present cell */                                         \
    ROW(ivec3, cell, cells)       /* majorant cell; the voxel in regular tracking */                                  \
    ROW(uint, cell_row, listed) /* of several media: the cell's in their tables */ \
    ROW(int, cell_edge, bricks) /* of several media: more than 1 in a coarse cell, in which `cell` is any one */ \
    ROW(float, dt, marches)       /* marches: length of a step */                                                     \
    ROW(uint, index, marches)     /* marches: the next step */                                                        \
    ROW(uint, level, sets)        /* telescoping: the refinement */                                                   \
    ROW(uint, residue, sets)      /* telescoping: which samples the coarser sums take */                              \
    ROW(float, offset, sets)      /* telescoping: of the samples in their steps */                                    \
    ROW(float, partial, sets)     /* telescoping: depth less what half of the samples say; jackknife: depth by the first of each two */ \
    ROW(float, base, sets)        /* telescoping: with the coarsest set of samples */

// ROW(type, name): what of a flight that is split has collided so far; see split.glsl.
#define SPLIT_STATE(ROW)                                                                                              \
    ROW(float, collided)   /* of its throughput, the channels' sum; 0 of flights that are not split */                \
    ROW(Spectrum, picked)  /* of the collision that was picked among them, over that */                               \
    ROW(float, at)         /* where it was, from the vertex [world units] */                                          \
    ROW(uint, met)         /* of several media, the row of that which it was with */

// ROW(type, name): a search for the next part of a ray within meshes, as far as it has gone; see mesh.glsl.
#define SEARCH_STATE(ROW)                                                                                             \
    ROW(uint, stage)   /* SEARCH_... */                                                                               \
    ROW(float, t_from) /* beyond which */                                                                             \
    ROW(uint, node)    /* of the hierarchy, to be visited next */                                                     \
    ROW(int, winding)  /* bodies that the ray is inside of just behind t_from, by the crossings found so far */       \
    ROW(float, first)  /* distance to the first crossing, or infinitely far */                                        \
    ROW(int, turn)     /* surfaces left less those entered there */                                                   \
    ROW(float, second) /* distance to the next crossing behind that, or infinitely far */

// ROW(type, name): a search for the nearest surface along a ray, as far as it has gone; see nearest.glsl.
#define SEEK_STATE(ROW)                                                                                               \
    ROW(uint, node)     /* of the hierarchy, to be visited next */                                                    \
    ROW(float, nearest) /* distance to the nearest surface so far, or how far the ray goes */                         \
    ROW(uint, primitive) /* what it is there; NO_SURFACE: nothing yet */

// Words of a path that has all fields. Copied are some at a time; and paths begin with lines of caches, of 64 bytes, an odd
// number of lines apart, so that they do not all want the same of their sets.
#define WORDS_AT_ONCE 4
#define WORDS_float 1
#define WORDS_int 1
#define WORDS_uint 1
#define WORDS_vec2 2
#define WORDS_vec3 3
#define WORDS_ivec3 3
#define WORDS_Spectrum 3
#define WORDS(type, name) +WORDS_##type
#define WORDS_WHEN(type, name, when) +WORDS_##type
const int WORDS_Walk = 0 WALK_STATE(WORDS_WHEN);
const int WORDS_PartSearch = 0 SEARCH_STATE(WORDS);
const int WORDS_SurfaceSearch = 0 SEEK_STATE(WORDS);
const int WORDS_Split = 0 SPLIT_STATE(WORDS);
const int WORDS_Path = 0 VERTEX_STATE(WORDS) PATH_STATE(WORDS_WHEN) LOOK_STATE(WORDS_WHEN) SEGMENT_STATE(WORDS_WHEN);
const int MOST_PATH_WORDS = (WORDS_Path + 31) / 32 * 32 + 16;
#undef WORDS
#undef WORDS_WHEN
#undef WORDS_float
#undef WORDS_int
#undef WORDS_uint
#undef WORDS_vec2
#undef WORDS_vec3
#undef WORDS_ivec3
#undef WORDS_Spectrum

#endif
