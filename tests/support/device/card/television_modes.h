// SPDX-License-Identifier: Apache-2.0
// The modes that the kernel lists for televisions, as it makes them of their EDID (drm_edid.c). Timings: CTA-861-G,
// table 1, by video identification code. The signals that every 3D television takes: HDMI 1.4a, 8.2.3.2 and appendix H,
// as in the kernel's stereo_mandatory_modes.
#pragma once

#include <xf86drmMode.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <iterator>
#include <tuple>
#include <vector>

namespace relievo::test {

struct CeaTiming {
  int vic, width, height, htotal, vtotal, clock_khz;
  bool interlaced = false;
};
inline constexpr CeaTiming kCeaTimings[] = {
    {1, 640, 480, 800, 525, 25'175},       {3, 720, 480, 858, 525, 27'000},
    {4, 1280, 720, 1650, 750, 74'250},     {5, 1920, 1080, 2200, 1125, 74'250, true},
    {16, 1920, 1080, 2200, 1125, 148'500}, {18, 720, 576, 864, 625, 27'000},
    {19, 1280, 720, 1980, 750, 74'250},    {20, 1920, 1080, 2640, 1125, 74'250, true},
    {31, 1920, 1080, 2640, 1125, 148'500}, {32, 1920, 1080, 2750, 1125, 74'250},
    {33, 1920, 1080, 2640, 1125, 74'250},  {34, 1920, 1080, 2200, 1125, 74'250},
    {60, 1280, 720, 3300, 750, 59'400},    {62, 1280, 720, 3300, 750, 74'250},
    {93, 3840, 2160, 5500, 2250, 297'000}, {94, 3840, 2160, 5280, 2250, 297'000},
    {95, 3840, 2160, 4400, 2250, 297'000}, {96, 3840, 2160, 5280, 2250, 594'000},
    {97, 3840, 2160, 4400, 2250, 594'000},
};

// At 60, 30 and 24 Hz the kernel adds the rate divided by 1.001.
inline drmModeModeInfo ceaMode(int vic, std::uint32_t stereo = 0, bool slower = false, bool preferred = false) {
  const auto* const of =
      std::find_if(std::begin(kCeaTimings), std::end(kCeaTimings), [vic](auto& t) { return t.vic == vic; });
  drmModeModeInfo mode{};
  mode.hdisplay = static_cast<std::uint16_t>(of->width);
  mode.vdisplay = static_cast<std::uint16_t>(of->height);
  mode.htotal = static_cast<std::uint16_t>(of->htotal);
  mode.vtotal = static_cast<std::uint16_t>(of->vtotal);
  mode.clock = static_cast<std::uint32_t>(std::lround(of->clock_khz / (slower ? 1.001 : 1.0)));
  mode.flags = stereo | (of->interlaced ? DRM_MODE_FLAG_INTERLACE : 0U);
  mode.type = preferred ? DRM_MODE_TYPE_PREFERRED | DRM_MODE_TYPE_DRIVER : DRM_MODE_TYPE_DRIVER;
  const double frames = 1e3 * mode.clock / (double{1} * mode.htotal * mode.vtotal);
  mode.vrefresh = static_cast<std::uint32_t>(std::lround(of->interlaced ? 2 * frames : frames));
  std::snprintf(mode.name, sizeof mode.name, "%dx%d%s", of->width, of->height, of->interlaced ? "i" : "");
  return mode;
}

class TelevisionModes {
 public:
  TelevisionModes& plain(std::vector<int> vics, int preferred) {
    for (const int vic : vics) add(vic, 0, vic == preferred);
    return *this;
  }
  TelevisionModes& stereo(std::uint32_t flag, std::vector<int> vics) {
    for (const int vic : vics) add(vic, flag, false);
    return *this;
  }
  // Preferred ones first, then by size and rate (drm_mode_compare).
  [[nodiscard]] std::vector<drmModeModeInfo> listed() const {
    const auto key = [](const drmModeModeInfo& m) {
      return std::tuple((m.type & DRM_MODE_TYPE_PREFERRED) != 0, m.hdisplay * m.vdisplay, m.vrefresh, m.clock);
    };
    std::vector<drmModeModeInfo> modes;
    for (const drmModeModeInfo& m : modes_) {
      modes.insert(std::ranges::upper_bound(modes, key(m), std::ranges::greater{}, key), m);
    }
    return modes;
  }

 private:
  void add(int vic, std::uint32_t flag, bool preferred) {
    modes_.push_back(ceaMode(vic, flag, false, preferred));
    if (modes_.back().vrefresh % 25 != 0 && vic > 3) modes_.push_back(ceaMode(vic, flag, true));
  }
  std::vector<drmModeModeInfo> modes_;
};

// One without 3D.
inline std::vector<drmModeModeInfo> plainTelevision() {
  return TelevisionModes().plain({16, 31, 5, 20, 4, 19, 32, 18, 3, 1}, 16).listed();
}
// One that takes what it must (3D_present alone): side by side only in interlaced modes.
inline std::vector<drmModeModeInfo> mandatoryTelevision() {
  return TelevisionModes()
      .plain({16, 31, 5, 20, 4, 19, 32, 18, 3, 1}, 16)
      .stereo(DRM_MODE_FLAG_3D_FRAME_PACKING, {32, 4, 19})
      .stereo(DRM_MODE_FLAG_3D_TOP_AND_BOTTOM, {32, 4, 19})
      .stereo(DRM_MODE_FLAG_3D_SIDE_BY_SIDE_HALF, {5, 20})
      .listed();
}
// One that says more of its own (3D_Structure_ALL): also both halves at 50 and 60 Hz, and frame packing of 576 rows.
inline std::vector<drmModeModeInfo> generousTelevision() {
  return TelevisionModes()
      .plain({95, 16, 31, 34, 5, 20, 4, 19, 32, 18, 3, 1}, 95)
      .stereo(DRM_MODE_FLAG_3D_FRAME_PACKING, {32, 34, 4, 19, 18})
      .stereo(DRM_MODE_FLAG_3D_TOP_AND_BOTTOM, {16, 31, 32, 34, 4, 19})
      .stereo(DRM_MODE_FLAG_3D_SIDE_BY_SIDE_HALF, {16, 31, 32, 5, 20, 4, 19})
      .stereo(DRM_MODE_FLAG_3D_L_DEPTH, {32})
      .listed();
}
// A monitor with line-wise polarisers, whose only 3D signal is side by side.
inline std::vector<drmModeModeInfo> halvesTelevision() {
  return TelevisionModes().plain({16, 4, 3, 1}, 16).stereo(DRM_MODE_FLAG_3D_SIDE_BY_SIDE_HALF, {16}).listed();
}

}  // namespace relievo::test
