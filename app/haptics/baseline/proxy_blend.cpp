// SPDX-License-Identifier: Apache-2.0
// Two proxies and the way from one to the other.
#include "app/haptics/baseline/proxy_blend.h"

#include <algorithm>
#include <glm/common.hpp>

#include "app/haptics/baseline/triangle_proxy.h"
#include "app/haptics/method/frame_weights.h"

namespace relievo {

Touch ProxyBlend::update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT {
  if (window.count == 0) {
    primed_ = false;
    return Touch{.proxy_mm = hip_mm};
  }
  const auto k = static_cast<std::size_t>(FrameMoment(window, now).present);
  const TimedSurface& frame = window.frames[k];
  if (!primed_ || window.epoch != epoch_) {
    primed_ = true;
    epoch_ = window.epoch;
    on_old_ = on_new_ = last_ = Touch{.proxy_mm = hip_mm};
    present_ = frame.time;
  }
  if (frame.time != present_) {
    present_ = frame.time;
    on_old_ = on_new_;
  }
  const SurfaceInTime new_surface(window, now, TimeLaw::Hold);
  on_new_ = followFinger(new_surface, on_new_.proxy_mm, hip_mm, stiffness_, Walk::Graph);
  Touch touch = on_new_;
  if (k > 0 && window.frames[k - 1].shot == frame.shot) {
    const TimedSurface& before = window.frames[k - 1];
    const SurfaceInTime old_surface(window, before.time, TimeLaw::Hold);
    on_old_ = followFinger(old_surface, on_old_.proxy_mm, hip_mm, stiffness_, Walk::Graph);
    const double s = std::clamp(toSeconds(now - frame.time) / toSeconds(frame.time - before.time), 0.0, 1.0);
    touch.proxy_mm = glm::mix(on_old_.proxy_mm, on_new_.proxy_mm, s);
    touch.force_n = stiffness_ * (touch.proxy_mm - hip_mm);
    touch.contact = on_old_.contact || on_new_.contact;
  }
  last_ = letThroughAtJump(touch, last_.force_n, jump_threshold_n_, hip_mm);
  if (touch.contact && !last_.contact) on_old_ = on_new_ = last_;
  return last_;
}

}  // namespace relievo
