// From a point to the sensor, as particles look: which pixel sees it, and how much what it sends there counts.
#ifndef TOWARD_SENSOR_GLSL
#define TOWARD_SENSOR_GLSL
#include "sensors/camera.glsl"

struct SensorLook {
    vec3 direction; // unit, towards the sensor
    float distance; // world units
    float weight;   // that a pixel's value has from light sent that way per steradian
    uint pixel;     // film entry; NO_PIXEL: none sees the point
};

// The part of a filter per pixel, `aside` of a pixel's middle along an axis: filter_quantile's density.
float filter_density(float aside) {
    const float count = float(FILTER_QUANTILES);
    float reach = frame_block.filter_quantiles[FILTER_QUANTILES];
    if (PIXEL_FILTER == PIXEL_BOX)
        return aside < reach ? 0.5 / reach : 0.0;
    uint i = 0u;
    [[unroll]] for (int bit = FILTER_QUANTILE_BITS - 1; bit >= 0; --bit)
        i += frame_block.filter_quantiles[i + (1u << bit)] <= aside ? 1u << bit : 0u;
    float low = frame_block.filter_quantiles[i], between = frame_block.filter_quantiles[i + 1u] - low;
    float x = float(i) + (aside - low) / between;
    return between > 0.0 && aside < reach ? (1.0 - x / count) / (count * between) : 0.0;
}

// The film entry of one of the pixels to which the picture's point `p` counts, and how much it does over the chance of that one.
uint pixel_at(vec2 p, vec2 u, out float weight) {
    p = clamp(p, -1.0e6, 1.0e6);
    vec2 pixel = floor(p);
    weight = 1.0;
    if (PIXEL_FILTER != PIXEL_EVEN) {
        float reach = frame_block.filter_quantiles[FILTER_QUANTILES];
        vec2 first = ceil(p - 0.5 - reach);
        vec2 count = floor(p - 0.5 + reach) - first + 1.0;
        pixel = first + min(floor(u * count), count - 1.0);
        vec2 aside = abs(p - 0.5 - pixel);
        weight = count.x * count.y * filter_density(aside.x) * filter_density(aside.y);
    }
    uvec2 at = uvec2(ivec2(pixel)) - uvec2(frame.crop_x, frame.crop_y);
    bool is_there = at.x < frame.crop_width && at.y < frame.crop_height;
    return is_there ? at.y * frame.crop_width + at.x : NO_PIXEL;
}

// Pixels of the picture per steradian, over the square of the distance; of a ray that comes from `distance` away to where it meets what is
// at `position`.
float seen_weight(vec3 position, vec3 ray, float distance) {
    SensorParams s = frame.sensors[0];
    float weight;
    if (SENSOR == SENSOR_ORTHOGRAPHIC) {
        weight = 1.0 / (length(s.right) * length(s.down)); // at right angles
    } else if (SENSOR == SENSOR_EQUIRECTANGULAR) {
        vec3 q = position - s.position;
        float level = length(vec2(dot(q, s.corner), dot(q, s.right))); // beside the poles' axis
        weight = 1.0 / (max(level, 1.0e-12 * distance) * abs(s.angle_step.x * s.angle_step.y) * distance);
    } else {
        float depth = s.start + dot(position - s.position, s.forward);
        weight = 1.0 / (dot(ray, s.forward) * abs(dot(s.corner, cross(s.right, s.down))) * depth * depth);
    }
    return weight;
}

// See camera_ray, whose inverse this is; its lens is met at the point `at`. The eye may be so far away that single precision knows nothing
// of how a point lies to it: hence all is measured from where rays begin.
SensorLook toward_eye(SensorParams s, vec3 from, vec2 at, out vec2 p) {
    vec3 q = from - s.position;
    float depth = s.start + dot(q, s.forward);
    vec3 slope = vec3(0.0);
    float focus = 0.0;
    if (SENSOR == SENSOR_LENS) {
        slope = at.x * s.lens_u + at.y * s.lens_v;
        focus = s.lens_lever + s.start;
    }
    vec3 aside = (q - (depth - s.start) * s.corner + (depth - focus) * slope) / depth;
    p = vec2(dot(aside, s.right) / dot(s.right, s.right), dot(aside, s.down) / dot(s.down, s.down));
    vec3 v = q + s.start * s.corner - focus * slope;
    return SensorLook(-normalize(v), length(v), 0.0, depth > s.start ? 0u : NO_PIXEL);
}

SensorLook toward_plane(SensorParams s, vec3 from, out vec2 p) {
    vec3 q = from - s.position;
    p = vec2(dot(q, s.right) / dot(s.right, s.right), dot(q, s.down) / dot(s.down, s.down));
    float depth = dot(q, s.corner);
    return SensorLook(-s.corner, depth, 0.0, depth > 0.0 ? 0u : NO_PIXEL);
}

SensorLook toward_panorama(SensorParams s, vec3 from, out vec2 p) {
    vec3 q = from - s.position;
    float ahead = dot(q, s.corner), aside = dot(q, s.right), up = -dot(q, s.down), level = sqrt(ahead * ahead + aside * aside);
    vec2 angle = vec2(level > 0.0 ? atan(aside, ahead) : 0.0, atan(up, level));
    p = (angle - s.first_angle) / s.angle_step;
    float turn = 2.0 * PI / abs(s.angle_step.x);
    p.x -= turn * floor(p.x / turn);
    return SensorLook(-normalize(q), length(q), 0.0, dot(q, q) > 0.0 ? 0u : NO_PIXEL);
}

// A panorama's plane has a point many times, once in every turn, and beyond a pole once more: filters reach across, and camera_ray goes on
// there. One of those that pixels of the window may count, of `count`; false if there is none. Of filters that reach beyond one pole at
// a time: see why_no_particles.
bool image_in_panorama(SensorParams s, vec2 u, inout vec2 p, out float count) {
    float turn = 2.0 * PI / abs(s.angle_step.x);
    float reach = PIXEL_FILTER != PIXEL_EVEN ? frame_block.filter_quantiles[FILTER_QUANTILES] : 0.0;
    float latitude = s.first_angle.y + p.y * s.angle_step.y;
    float to_pole = ((latitude > 0.0 ? 0.5 : -0.5) * PI - latitude) / s.angle_step.y; // pixels downwards
    count = 1.0;
    if (abs(to_pole) < reach) {
        count = 2.0;
        if (u.y < 0.5)
            p += vec2(0.5 * turn, 2.0 * to_pole);
    }
    float low = float(frame.crop_x) - reach, high = float(frame.crop_x + frame.crop_width) + reach;
    float first = ceil((low - p.x) / turn), turns = floor((high - p.x) / turn) - first + 1.0;
    p.x += turn * (first + min(floor(u.x * turns), turns - 1.0));
    count *= turns;
    return turns > 0.0;
}

SensorLook toward_sensor(vec3 from, inout Rng rng) {
    SensorParams s = frame.sensors[0];
    vec4 u = to_uniform(next_words(rng));
    vec2 p;
    SensorLook look;
    if (SENSOR == SENSOR_ORTHOGRAPHIC)
        look = toward_plane(s, from, p);
    else if (SENSOR == SENSOR_EQUIRECTANGULAR)
        look = toward_panorama(s, from, p);
    else
        look = toward_eye(s, from, SENSOR == SENSOR_LENS ? aperture_point(s, u.xy) : vec2(0.0), p);
    if (look.pixel != NO_PIXEL) {
        float filtered, images = 1.0;
        bool is_in_window = SENSOR != SENSOR_EQUIRECTANGULAR || image_in_panorama(s, u.xy, p, images);
        look.pixel = is_in_window ? pixel_at(p, u.zw, filtered) : NO_PIXEL;
        filtered *= images;
        look.weight = look.pixel != NO_PIXEL ? filtered * seen_weight(from, -look.direction, look.distance) : 0.0;
    }
    return look;
}

#endif
