// SPDX-License-Identifier: Apache-2.0
// Atomic commits on one CRTC, and the events that complete them.
#include "drivers/egl/kms/kms_screen.h"

#include <fcntl.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "drivers/egl/kms/kms_leftovers.h"
#include "drivers/egl/kms/kms_objects.h"

namespace relievo::kms {
namespace {

constexpr const char* kFolder = "/dev/dri";
constexpr const char* kGone = "the screen was unplugged; checking again every second";
constexpr const char* kTaken =
    "another program uses this card's screens; end it (sudo systemctl stop display-manager), or use a window";

// The CRTCs that can drive a connector, as a bit mask over the card's list.
std::uint32_t possibleCrtcs(int card, const drmModeConnector& connector) {
  std::uint32_t possible = 0;
  for (int i = 0; i < connector.count_encoders; ++i) {
    if (const auto encoder = own(drmModeGetEncoder(card, connector.encoders[i]))) possible |= encoder->possible_crtcs;
  }
  return possible;
}

std::uint32_t primaryPlane(int card, std::uint32_t crtc_bit) {
  const auto planes = own(drmModeGetPlaneResources(card));
  for (std::uint32_t i = 0; planes != nullptr && i < planes->count_planes; ++i) {
    const auto plane = own(drmModeGetPlane(card, planes->planes[i]));
    if (plane == nullptr || (plane->possible_crtcs & crtc_bit) == 0) continue;
    if (propertyOf(card, plane->plane_id, DRM_MODE_OBJECT_PLANE, "type").value == DRM_PLANE_TYPE_PRIMARY) {
      return plane->plane_id;
    }
  }
  return 0;
}

}  // namespace

std::vector<std::string> cardPaths() {
  std::vector<std::string> paths;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(kFolder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().filename().string().starts_with("card")) paths.push_back(entry->path());
  }
  std::ranges::sort(paths, [](const std::string& a, const std::string& b) {
    return std::pair(a.size(), a) < std::pair(b.size(), b);  // card10 after card9
  });
  return paths;
}

Result<UniqueFd> openCard(const std::string& path) {
  UniqueFd card(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  if (!card.valid() && errno == EACCES) {
    return fail(
        ErrorCode::PermissionDenied,
        "no permission to use the display card; add the user to the group video (sudo usermod -aG video $USER) and "
        "log in again",
        errno);
  }
  if (!card.valid())
    return fail(ErrorCode::NotFound, "there is no such display card; ls /dev/dri lists the cards", errno);
  const auto resources = own(drmModeGetResources(card.get()));
  if (resources == nullptr || resources->count_crtcs == 0) {
    return fail(ErrorCode::Unsupported, "this card has no screen outputs; name another, such as kms:/dev/dri/card1");
  }
  if (drmSetClientCap(card.get(), DRM_CLIENT_CAP_UNIVERSAL_PLANES, 1) != 0 ||
      drmSetClientCap(card.get(), DRM_CLIENT_CAP_ATOMIC, 1) != 0) {
    return fail(ErrorCode::Unsupported, "the card's driver has no atomic mode setting; install a newer kernel");
  }
  // Ignored: without stereo support the connectors simply list no stereo modes.
  static_cast<void>(drmSetClientCap(card.get(), DRM_CLIENT_CAP_STEREO_3D, 1));
  drmDropMaster(card.get());  // the first to open a card becomes its master
  return card;
}

std::string driverOf(int card) {
  const auto version = own(drmGetVersion(card));
  if (version == nullptr || version->name == nullptr) return {};
  return {version->name, static_cast<std::size_t>(version->name_len)};
}

std::vector<Connector> readConnectors(int card, bool probe) {
  std::vector<Connector> connectors;
  const auto resources = own(drmModeGetResources(card));
  for (int i = 0; resources != nullptr && i < resources->count_connectors; ++i) {
    const std::uint32_t id = resources->connectors[i];
    const auto found = own(probe ? drmModeGetConnector(card, id) : drmModeGetConnectorCurrent(card, id));
    if (found == nullptr || found->connector_type == DRM_MODE_CONNECTOR_WRITEBACK) continue;
    const char* type = drmModeGetConnectorTypeName(found->connector_type);
    Connector connector{
        .id = id,
        .name = std::string(type == nullptr ? "screen" : type) + "-" + std::to_string(found->connector_type_id),
        .connected = found->connection == DRM_MODE_CONNECTED};
    connector.modes.assign(found->modes, found->modes + found->count_modes);
    connectors.push_back(std::move(connector));
  }
  return connectors;
}

Result<std::unique_ptr<Screen>> Screen::take(int card, std::uint32_t connector) {
  std::unique_ptr<Screen> screen(new Screen(card));
  if (drmSetMaster(card) != 0) return fail(ErrorCode::PermissionDenied, kTaken, errno);
  screen->master_ = true;
  if (auto found = screen->findParts(connector); !found) return std::unexpected(found.error());
  screen->before_.reset(drmModeGetCrtc(card, screen->crtc_));
  return screen;
}

Result<void> Screen::findParts(std::uint32_t connector_id) {
  connector_ = connector_id;
  const auto resources = own(drmModeGetResources(card_));
  const auto connector = own(drmModeGetConnectorCurrent(card_, connector_id));
  if (resources == nullptr || connector == nullptr) return fail(ErrorCode::Lost, kGone, errno);
  const std::uint32_t possible = possibleCrtcs(card_, *connector);
  for (int i = 0; i < resources->count_crtcs && plane_ == 0; ++i) {
    if ((possible >> i & 1U) == 0) continue;
    crtc_ = resources->crtcs[i];
    plane_ = primaryPlane(card_, 1U << i);
  }
  connector_crtc_ = propertyOf(card_, connector_, DRM_MODE_OBJECT_CONNECTOR, "CRTC_ID").id;
  crtc_mode_ = propertyOf(card_, crtc_, DRM_MODE_OBJECT_CRTC, "MODE_ID").id;
  crtc_active_ = propertyOf(card_, crtc_, DRM_MODE_OBJECT_CRTC, "ACTIVE").id;
  plane_framebuffer_ = propertyOf(card_, plane_, DRM_MODE_OBJECT_PLANE, "FB_ID").id;
  if (plane_ != 0 && connector_crtc_ != 0 && crtc_mode_ != 0 && crtc_active_ != 0 && plane_framebuffer_ != 0) return {};
  return fail(ErrorCode::Unsupported, "the card has no free CRTC or plane for this screen; use another of its screens");
}

Result<void> Screen::setMode(const drmModeModeInfo& mode, Packing packing, std::uint32_t framebuffer) {
  if (mode_blob_ != 0) drmModeDestroyPropertyBlob(card_, std::exchange(mode_blob_, 0U));
  if (drmModeCreatePropertyBlob(card_, &mode, sizeof mode, &mode_blob_) != 0) {
    return fail(ErrorCode::Exhausted, "the card cannot store the mode; choose another --size", errno);
  }
  const ScanOut size = scanOut(mode, packing);
  const auto width = static_cast<std::uint64_t>(size.plane_width),
             height = static_cast<std::uint64_t>(size.plane_height);
  const std::unique_ptr<drmModeAtomicReq, Free> request(drmModeAtomicAlloc());
  if (request == nullptr) return fail(ErrorCode::Exhausted, "no memory to set the screen's mode; close other programs");
  drmModeAtomicAddProperty(request.get(), connector_, connector_crtc_, crtc_);
  drmModeAtomicAddProperty(request.get(), crtc_, crtc_mode_, mode_blob_);
  drmModeAtomicAddProperty(request.get(), crtc_, crtc_active_, 1);
  const std::pair<const char*, std::uint64_t> plane[] = {
      {"FB_ID", framebuffer}, {"CRTC_ID", crtc_},      {"SRC_X", 0},      {"SRC_Y", 0},
      {"SRC_W", width << 16}, {"SRC_H", height << 16},  // 16.16 fixed point
      {"CRTC_X", 0},          {"CRTC_Y", 0},           {"CRTC_W", width}, {"CRTC_H", height}};
  for (const auto& [name, value] : plane) {
    const std::uint32_t id = propertyOf(card_, plane_, DRM_MODE_OBJECT_PLANE, name).id;
    drmModeAtomicAddProperty(request.get(), plane_, id, value);
  }
  const int before = drmModeAtomicGetCursor(request.get());
  const bool left = addLeftovers(card_, {connector_, crtc_, plane_}, *request);
  auto committed = commit(*request, DRM_MODE_ATOMIC_ALLOW_MODESET);
  if (committed || !left || committed.error().code != ErrorCode::Io) return committed;
  drmModeAtomicSetCursor(request.get(), before);  // the card may not take them together
  return commit(*request, DRM_MODE_ATOMIC_ALLOW_MODESET);
}

Result<void> Screen::flip(std::uint32_t framebuffer) {
  static std::uintptr_t flips = 0;
  if (flip_ != 0) return fail(ErrorCode::InvalidState, "a flip is pending; call finishFlip first");
  const std::unique_ptr<drmModeAtomicReq, Free> request(drmModeAtomicAlloc());
  if (request == nullptr) return fail(ErrorCode::Exhausted, "no memory for a page flip; close other programs");
  drmModeAtomicAddProperty(request.get(), plane_, plane_framebuffer_, framebuffer);
  flip_ = ++flips;
  auto committed = commit(*request, DRM_MODE_ATOMIC_NONBLOCK | DRM_MODE_PAGE_FLIP_EVENT);
  if (!committed) flip_ = 0;
  return committed;
}

Result<void> Screen::commit(drmModeAtomicReq& request, std::uint32_t flags) {
  if (drmModeAtomicCommit(card_, &request, flags, reinterpret_cast<void*>(flip_)) == 0) return {};
  const int error = errno;
  if (error == EACCES) return fail(ErrorCode::Lost, "another program has taken the screen; trying again", error);
  if (error == ENODEV || !connected()) return fail(ErrorCode::Lost, kGone, error);
  return fail(ErrorCode::Io, "the card rejects the picture; choose another --size or --stereo", error);
}

// An event may be for a Screen that was destroyed; so every flip of the process has a number of its own.
Result<void> Screen::readEvents() {
  alignas(drm_event_vblank) std::array<char, 1024> bytes;
  const ssize_t count = ::read(card_, bytes.data(), bytes.size());
  if (count < 0 && errno != EAGAIN && errno != EINTR) return fail(ErrorCode::Lost, kGone, errno);
  for (ssize_t at = 0; at + static_cast<ssize_t>(sizeof(drm_event)) <= count;) {
    drm_event_vblank event{};
    std::memcpy(&event.base, bytes.data() + at, sizeof event.base);
    if (event.base.type == DRM_EVENT_FLIP_COMPLETE) {
      std::memcpy(&event, bytes.data() + at, sizeof event);
      if (event.user_data == flip_) {
        flip_ = 0;
        last_flip_ = MonotonicTime(std::chrono::seconds(event.tv_sec) + std::chrono::microseconds(event.tv_usec));
      }
    }
    at += event.base.length;
  }
  return {};
}

Result<void> Screen::finishFlip(Duration longest) {
  const MonotonicClock clock;
  const MonotonicTime end = clock.now() + longest;
  while (flip_ != 0) {
    const Duration left = end - clock.now();
    if (left <= Duration(0)) return fail(ErrorCode::Lost, "the screen does not show new pictures; opening it again");
    pollfd ready{.fd = card_, .events = POLLIN, .revents = 0};
    timespec wait{};  // its fields are of 32 bits on some machines
    wait.tv_sec = static_cast<decltype(wait.tv_sec)>(left.count() / 1'000'000'000);
    wait.tv_nsec = static_cast<decltype(wait.tv_nsec)>(left.count() % 1'000'000'000);
    if (::ppoll(&ready, 1, &wait, nullptr) <= 0) continue;
    if (auto read = readEvents(); !read) return read;
  }
  return {};
}

bool Screen::connected() const {
  const auto connector = own(drmModeGetConnectorCurrent(card_, connector_));
  return connector != nullptr && connector->connection == DRM_MODE_CONNECTED;
}

Screen::~Screen() {
  if (!master_) return;
  constexpr Duration kLongestFlip = std::chrono::milliseconds(100);
  [[maybe_unused]] const auto finished = finishFlip(kLongestFlip);
  if (mode_blob_ != 0) {
    // A CRTC without a buffer was off.
    const bool was_on = before_ != nullptr && before_->mode_valid != 0 && before_->buffer_id != 0;
    drmModeSetCrtc(card_, crtc_, was_on ? before_->buffer_id : 0, was_on ? before_->x : 0, was_on ? before_->y : 0,
                   was_on ? &connector_ : nullptr, was_on ? 1 : 0, was_on ? &before_->mode : nullptr);
    drmModeDestroyPropertyBlob(card_, mode_blob_);
  }
  drmDropMaster(card_);
}

}  // namespace relievo::kms
