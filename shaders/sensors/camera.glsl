// Sensors: where the ray of a sample begins and goes. Cameras sample what they see evenly, so that no ray has a weight; what reads
// flux draws directions as it weighs them, so that all have the same: see measured().
#ifndef CAMERA_GLSL
#define CAMERA_GLSL
#include "lib/directions.glsl"
#include "lib/rng.glsl"

// Place of a film entry in the picture: x | y << 16. It is the key of the pixel's random numbers, the same whatever the crop. The
// division costs software drivers as much as a step of a walk: once per path is enough.
uint place_of(uint pixel) {
    uint x = frame.crop_x + pixel % frame.crop_width;
    uint y = frame.crop_y + pixel / frame.crop_width;
    return x | y << 16u;
}

Rng pixel_rng(uint place, uint sample_index, uint draw) {
    return Rng(place, sample_index, draw, frame.seed);
}

struct CameraRay {
    vec3 origin; // render space
    vec3 direction;
};

// The distance from a pixel's middle, along each axis, within which a filter has the part `u`: the inverse of its
// distribution. Linear between nodes that are even in 1 - sqrt(1 - u), and so lie close where the filter ends.
vec2 filter_quantile(vec2 u) {
    vec2 x = min((1.0 - sqrt(1.0 - u)) * float(FILTER_QUANTILES), float(FILTER_QUANTILES) * 0.9999999);
    uvec2 i = uvec2(x);
    vec2 low = vec2(frame_block.filter_quantiles[i.x], frame_block.filter_quantiles[i.y]);
    vec2 high = vec2(frame_block.filter_quantiles[i.x + 1u], frame_block.filter_quantiles[i.y + 1u]);
    return mix(low, high, x - vec2(i));
}

// Where in the picture a sample looks, pixels from its top left corner: evenly within its pixel, or about its middle as the
// filter weights.
vec2 picture_point(uint place, vec2 u) {
    vec2 p = vec2(place & 0xffffu, place >> 16u) + u;
    vec2 aside = 2.0 * u - 1.0;
    if (PIXEL_FILTER == PIXEL_BOX)
        p += 0.5 - u + aside * frame_block.filter_quantiles[FILTER_QUANTILES];
    if (PIXEL_FILTER == PIXEL_QUANTILES)
        p += 0.5 - u + sign(aside) * filter_quantile(abs(aside));
    return p;
}

// Evenly over the aperture, in units of the lens' radius.
vec2 aperture_point(SensorParams s, vec2 u) {
    vec2 p = in_disk(u.yx);
    if (s.blades > 0u) { // in one of the triangles between the middle and an edge
        float triangle = floor(u.x * float(s.blades));
        float along = u.x * float(s.blades) - triangle;
        float first = s.blade_rotation / (2.0 * PI) + triangle / float(s.blades);
        p = sqrt(u.y) * mix(on_circle(first), on_circle(first + 1.0 / float(s.blades)), along);
    }
    return p;
}

const uint LENS_DRAW = 0xffffffffu; // a number of its own, ahead of a path's first; or, of flux, whence the ray comes

// The ray through the picture at (x, y) = p:
// pinhole: along corner + x * right + y * down. It begins at position + start * (x * right + y * down): at the eye, with start
// 0; or, for eyes far from the medium, on a plane between the two;
// lens: through a point of the lens and the one of the plane that is sharp which the pinhole would see;
// orthographic: from position + x * right + y * down along corner;
// equirectangular: at angles that go evenly with p, from corner (ahead) to `right`, and away from `down`;
// irradiance: from position + x * right + y * down, by the cosine to corner, which is the normal;
// fluence: from the pixel's point, in any direction alike.
CameraRay camera_ray(uint place, uint sample_index) {
    Rng rng = pixel_rng(place, sample_index, 0u);
    vec2 p = picture_point(place, to_uniform(next_words(rng)).xy);
    SensorParams camera = frame.sensors[0];
    vec3 aside = p.x * camera.right + p.y * camera.down;
    CameraRay ray = CameraRay(camera.position + camera.start * aside,
                              normalize(camera.corner + p.x * camera.right + p.y * camera.down));
    if (SENSOR == SENSOR_LENS) {
        Rng lens_rng = pixel_rng(place, sample_index, LENS_DRAW);
        vec2 at = aperture_point(camera, to_uniform(next_words(lens_rng)).xy);
        vec3 slope = at.x * camera.lens_u + at.y * camera.lens_v;
        ray.origin += camera.lens_lever * slope;
        ray.direction = normalize(camera.corner + aside - slope);
    }
    if (SENSOR == SENSOR_ORTHOGRAPHIC)
        ray = CameraRay(camera.position + aside, camera.corner);
    if (SENSOR == SENSOR_EQUIRECTANGULAR) {
        vec2 angle = camera.first_angle + p * camera.angle_step;
        angle.x -= 2.0 * PI * round(angle.x / (2.0 * PI)); // beyond half a turn Vulkan asks nothing of cos and sin
        ray.origin = camera.position;
        ray.direction = normalize(cos(angle.y) * (cos(angle.x) * camera.corner + sin(angle.x) * camera.right) -
                                  sin(angle.y) * camera.down);
    }
    if (READS_FLUX) {
        Rng from_rng = pixel_rng(place, sample_index, LENS_DRAW);
        vec2 u = to_uniform(next_words(from_rng)).xy;
        if (SENSOR == SENSOR_IRRADIANCE) // the sine's square is even, and 1 - cos without cancellation
            ray = CameraRay(camera.position + aside, by_cosine(camera.corner, u));
        if (SENSOR == SENSOR_FLUENCE)
            ray = CameraRay(sensor_points[(place >> 16u) * camera.row + (place & 0xffffu)],
                            in_any_direction(u));
    }
    return ray;
}

// What the sensor reads of a ray's radiance: its integral over directions, weighted as they are drawn. Of cosines that is pi
// times the mean, of all alike 4 pi times.
vec3 measured(vec3 radiance) {
    if (SENSOR == SENSOR_IRRADIANCE)
        radiance *= PI;
    if (SENSOR == SENSOR_FLUENCE)
        radiance *= 4.0 * PI;
    return radiance;
}

#endif
