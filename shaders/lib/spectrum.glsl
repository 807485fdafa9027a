// Quantities with a value per colour channel where a scene has chromatic coefficients, and a single one where it has
// not: so a grey medium's kernel carries and computes one number. Colours themselves (radiance) are always vec3.
#ifndef SPECTRUM_GLSL
#define SPECTRUM_GLSL

#ifdef CHROMATIC
#define Spectrum vec3
#else
#define Spectrum float
#endif

Spectrum to_spectrum(vec3 c) {
#ifdef CHROMATIC
    return c;
#else
    return c.x;
#endif
}

float largest(float s) { return abs(s); }
float largest(vec3 s) { return max(max(abs(s.x), abs(s.y)), abs(s.z)); }
float smallest(float s) { return s; }
float smallest(vec3 s) { return min(min(s.x, s.y), s.z); }
float total(float s) { return s; }
float total(vec3 s) { return s.x + s.y + s.z; }

// Where the denominator is 0, nothing.
float over(float a, float b) { return b != 0.0 ? a / b : 0.0; }
vec3 over(vec3 a, vec3 b) { return mix(a / b, vec3(0.0), equal(b, vec3(0.0))); }

// 1 - exp(-x), x >= 0, with all digits where x is small: the series to x^4, of relative error x^4 / 120.
float one_minus_exp(float x) {
    return x < 0.03 ? x * (1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0)))) : 1.0 - exp(-x);
}
vec3 one_minus_exp(vec3 x) { return vec3(one_minus_exp(x.x), one_minus_exp(x.y), one_minus_exp(x.z)); }

// -log(1 - y), 0 <= y < 1, likewise: the series to y^4.
float minus_log_of_rest(float y) {
    return y < 0.03 ? y * (1.0 + y * (0.5 + y * (1.0 / 3.0 + y * 0.25))) : -log(max(1.0 - y, 1.0e-30));
}

#endif
