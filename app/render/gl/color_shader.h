// SPDX-License-Identifier: Apache-2.0
// Converts the planes of a colour picture to RGB on the GPU, and HDR to SDR: asSdr in GLSL.
#pragma once

#include <string>

#include "app/scene/sdr_color.h"

namespace relievo {

// Selects what toScreen of the fragment shader does.
[[nodiscard]] inline std::string sdrDefines(std::uint8_t transfer, std::uint8_t primaries) {
  const char* const name = hdrName(transfer);
  if (name == nullptr) return "";
  return std::string("#define ") + name + "\n" + (isBt2020(primaries) ? "#define BT2020\n" : "");
}

inline constexpr const char* kColorVertexShader = R"(
uniform vec2 chroma_scale;
out highp vec2 luma_at;
out highp vec2 chroma_at;
void main() {
  luma_at = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;  // one triangle that covers the whole target
  chroma_at = luma_at * chroma_scale;
  gl_Position = vec4(luma_at * 2.0 - 1.0, 0.0, 1.0);
}
)";

// SAMPLE, which the caller defines, reads the planes. Constants of HDR: SMPTE ST 2084; ITU-R BT.2100-2, table 5;
// BT.2087-0, annex 1; BT.2390-11, 5.4.1.
inline constexpr const char* kColorFragmentShader = R"(
precision highp float;
vec3 lightOfPq(vec3 code) {  // cd/m2
  vec3 root = pow(code, vec3(32.0 / 2523.0));
  return 10000.0 * pow(max(root - 0.8359375, 0.0) / (18.8515625 - 18.6875 * root), vec3(16384.0 / 2610.0));
}
#if defined(HLG)
vec3 lightOf(vec3 code) {
  vec3 bright = (exp((code - 0.55991073) / 0.17883277) + 0.28466892) / 12.0;
  vec3 scene = mix(bright, code * code / 3.0, lessThanEqual(code, vec3(0.5)));
  return scene * (1000.0 * pow(dot(scene, vec3(0.2627, 0.6780, 0.0593)), 0.2));
}
#elif defined(PQ)
vec3 lightOf(vec3 code) {
  return lightOfPq(code);
}
#endif
#if defined(PQ) || defined(HLG)
float pqOf(float light) {
  float power = pow(light / 10000.0, 2610.0 / 16384.0);
  return pow((0.8359375 + 18.8515625 * power) / (1.0 + 18.6875 * power), 2523.0 / 32.0);
}
float compressed(float light) {
  const float whole = 0.7518271, most = 0.7723702, knee = 0.6585554;
  float e = min(pqOf(light) / whole, 1.0);
  float t = (e - knee) / (1.0 - knee), t2 = t * t, t3 = t2 * t;
  float spline = (2.0 * t3 - 3.0 * t2 + 1.0) * knee + (t3 - 2.0 * t2 + t) * (1.0 - knee)
               + (3.0 * t2 - 2.0 * t3) * most;
  return e <= knee ? light : lightOfPq(vec3(spline * whole)).r;
}
vec3 toScreen(vec3 code) {
  vec3 light = lightOf(code);
#if defined(BT2020)
  light = max(mat3(1.6605, -0.1246, -0.0182, -0.5876, 1.1329, -0.1006, -0.0728, -0.0083, 1.1187) * light, 0.0);
#endif
  float brightest = max(max(max(light.r, light.g), light.b), 1e-9);
  return pow(light * (compressed(brightest) / brightest / 203.0), vec3(1.0 / 2.4));
}
#else
vec3 toScreen(vec3 code) {
  return code;
}
#endif
precision mediump float;
in highp vec2 luma_at;
in highp vec2 chroma_at;
uniform sampler2D plane0;
uniform sampler2D plane1;
uniform sampler2D plane2;
uniform mat4x3 to_rgb;
uniform vec3 bias;
out vec4 color;
void main() {
  vec3 rgb = clamp(to_rgb * SAMPLE + bias, 0.0, 1.0);
  color = vec4(toScreen(rgb), 1.0);
}
)";

}  // namespace relievo
