// SPDX-License-Identifier: Apache-2.0
// A display card (KMS) and one of its screens: finding it, setting its mode, page flips, restoring it.
#pragma once

#include <xf86drmMode.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/egl/kms/kms_mode.h"
#include "platform/clock.h"
#include "platform/error.h"
#include "platform/unique_fd.h"

namespace relievo::kms {

// Opens a card with atomic mode setting, universal planes and stereo modes. Unsupported for a card without screen
// outputs (a render-only one) or without atomic mode setting; PermissionDenied, NotFound.
[[nodiscard]] Result<UniqueFd> openCard(const std::string& path);
// The cards of this machine, sorted by number: "/dev/dri/card0", ..
[[nodiscard]] std::vector<std::string> cardPaths();

struct Connector {
  std::uint32_t id = 0;
  std::string name;  // "HDMI-A-1"
  bool connected = false;
  std::vector<drmModeModeInfo> modes;
};
// The name of the card's driver in the kernel: "amdgpu", "vc4". Empty if it does not say.
[[nodiscard]] std::string driverOf(int card);
// With `probe`, the kernel asks the screens, up to a tenth of a second each; without, its last known state is read.
[[nodiscard]] std::vector<Connector> readConnectors(int card, bool probe);

// The path from a buffer to one screen: connector, CRTC and primary plane, with the ids of their properties (kernel
// documentation gpu/drm-kms.rst, atomic mode setting). Display's thread only.
class Screen {
 public:
  // Becomes the card's master and saves its current state. PermissionDenied if another program is master; Unsupported
  // without a free CRTC. `card` must outlive the screen.
  [[nodiscard]] static Result<std::unique_ptr<Screen>> take(int card, std::uint32_t connector);
  // Restores the saved state and drops the master role.
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  // The only commit that may blank the screen; waits until it is done. `framebuffer` must have the size that
  // scanOut(mode, packing) says.
  [[nodiscard]] Result<void> setMode(const drmModeModeInfo& mode, Packing packing, std::uint32_t framebuffer);
  // Shows `framebuffer` at the next refresh, without waiting. InvalidState while another flip is pending.
  [[nodiscard]] Result<void> flip(std::uint32_t framebuffer);
  // Waits for a pending flip. Lost if it takes over `longest`.
  [[nodiscard]] Result<void> finishFlip(Duration longest);
  // The time of the last completed flip, on CLOCK_MONOTONIC.
  [[nodiscard]] MonotonicTime lastFlip() const noexcept { return last_flip_; }

  // The kernel's last known state; does not block.
  [[nodiscard]] bool connected() const;

 private:
  explicit Screen(int card) noexcept : card_(card) {}
  Result<void> findParts(std::uint32_t connector);
  Result<void> commit(drmModeAtomicReq& request, std::uint32_t flags);
  Result<void> readEvents();

  struct Free {
    void operator()(drmModeCrtc* crtc) const noexcept { drmModeFreeCrtc(crtc); }
    void operator()(drmModeAtomicReq* request) const noexcept { drmModeAtomicFree(request); }
  };

  int card_;
  bool master_ = false;
  std::uint32_t connector_ = 0, crtc_ = 0, plane_ = 0;
  std::uint32_t connector_crtc_ = 0, crtc_mode_ = 0, crtc_active_ = 0, plane_framebuffer_ = 0;  // properties
  std::uint32_t mode_blob_ = 0;
  std::unique_ptr<drmModeCrtc, Free> before_;
  std::uintptr_t flip_ = 0;  // number of the pending flip; 0: none
  MonotonicTime last_flip_;
};

}  // namespace relievo::kms
