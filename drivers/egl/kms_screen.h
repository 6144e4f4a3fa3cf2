// SPDX-License-Identifier: Apache-2.0
// A card of the kernel's mode setting, and one of its screens: found, set to a mode, flipped, given back.
#pragma once

#include <xf86drmMode.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/clock.h"
#include "platform/error.h"
#include "platform/unique_fd.h"

namespace relievo::kms {

// Opened with atomic mode setting, universal planes and stereo modes. Unsupported for a card without a screen's logic
// (a render-only one) or without atomic mode setting; PermissionDenied, NotFound.
[[nodiscard]] Result<UniqueFd> openCard(const std::string& path);
// The cards of this machine by number: "/dev/dri/card0", ..
[[nodiscard]] std::vector<std::string> cardPaths();

struct Connector {
  std::uint32_t id = 0;
  std::string name;  // "HDMI-A-1"
  bool connected = false;
  std::vector<drmModeModeInfo> modes;
};
// `probe` asks the screens themselves, which takes them up to a tenth of a second; without it what the kernel knows.
[[nodiscard]] std::vector<Connector> readConnectors(int card, bool probe);

// The way from a buffer to one screen: connector, CRTC and primary plane, with the ids of their properties. Display's
// thread. All of it as the kernel's documentation says (gpu/drm-kms.rst, atomic mode setting).
class Screen {
 public:
  // Becomes the card's master and keeps what it shows now, for the end. PermissionDenied when another program is
  // master; Unsupported without a free CRTC. `card` is borrowed.
  [[nodiscard]] static Result<std::unique_ptr<Screen>> take(int card, std::uint32_t connector);
  // Shows what was shown before, and lets the card go.
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  // The only commit that may blank the screen. Waits until it is done. `framebuffer` is of the mode's scan-out size.
  [[nodiscard]] Result<void> setMode(const drmModeModeInfo& mode, std::uint32_t framebuffer);
  // With the next refresh, without waiting. One at a time: InvalidState while one is under way.
  [[nodiscard]] Result<void> flip(std::uint32_t framebuffer);
  // Waits for a flip that is under way. Lost when it does not come in time.
  [[nodiscard]] Result<void> finishFlip(Duration longest);
  // When the last flip was done, on CLOCK_MONOTONIC.
  [[nodiscard]] MonotonicTime lastFlip() const noexcept { return last_flip_; }

  // By what the kernel knows: not blocking.
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
  std::uintptr_t flip_ = 0;  // the number of the one that is under way; 0: none is
  MonotonicTime last_flip_;
};

}  // namespace relievo::kms
