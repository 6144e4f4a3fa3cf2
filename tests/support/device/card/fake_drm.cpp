// SPDX-License-Identifier: Apache-2.0
// The functions of libdrm that the display driver calls: one connector, one CRTC, one plane, and a mouse
// pointer's.
#include <drm_fourcc.h>
#include <unistd.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/device/card/card_state.h"

using relievo::test::CardState;
using relievo::test::theCard;

namespace {

constexpr auto kConnector = CardState::kConnector, kEncoder = CardState::kEncoder, kCrtc = CardState::kCrtc,
               kPlane = CardState::kPlane, kPointer = CardState::kPointer;
const std::vector<std::string> kConnectorProperties{"CRTC_ID", "HDR_OUTPUT_METADATA", "Colorspace"},
    kCrtcProperties{"MODE_ID", "ACTIVE", "GAMMA_LUT"},
    kPlaneProperties{"type",  "FB_ID",  "CRTC_ID", "SRC_X",  "SRC_Y", "SRC_W",
                     "SRC_H", "CRTC_X", "CRTC_Y",  "CRTC_W", "CRTC_H"};

const std::vector<std::string>& propertiesOf(std::uint32_t object) {
  return object == kConnector ? kConnectorProperties : object == kCrtc ? kCrtcProperties : kPlaneProperties;
}

// What the driver frees in one piece stays in memory until the program ends.
template <class T>
T* keep(std::size_t count = 1) {
  static std::vector<std::vector<char>> kept;
  kept.emplace_back(count * sizeof(T));
  return reinterpret_cast<T*>(kept.back().data());
}
std::uint32_t* one(std::uint32_t id) {
  auto* const ids = keep<std::uint32_t>();
  *ids = id;
  return ids;
}

int reject(int why) {
  ++theCard().rejected;
  errno = why;
  return -1;
}

std::uint64_t leftAt(std::uint32_t object, const std::string& property) {
  const auto found = theCard().left.find({object, property});
  return found == theCard().left.end() ? 0 : found->second;
}

void completeFlip(std::uint64_t user_data) {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  drm_event_vblank event{};
  event.base = {DRM_EVENT_FLIP_COMPLETE, sizeof event};
  event.user_data = user_data;
  event.tv_sec = static_cast<std::uint32_t>(now.tv_sec);
  event.tv_usec = static_cast<std::uint32_t>(now.tv_nsec / 1000);
  if (::write(theCard().events.get(), &event, sizeof event) != sizeof event) std::abort();
}

}  // namespace

struct _drmModeAtomicReq {
  struct Change {
    std::pair<std::uint32_t, std::string> property;  // of an object
    std::uint64_t value;
  };
  std::vector<Change> changes;
};

namespace {

std::optional<std::uint64_t> valueOf(const drmModeAtomicReq& request, std::uint32_t object, const char* name) {
  const auto is = [&](auto& change) { return change.property == std::pair(object, std::string(name)); };
  const auto found = std::find_if(request.changes.begin(), request.changes.end(), is);
  return found == request.changes.end() ? std::nullopt : std::optional(found->value);
}

// The kernel's check of a plane against its buffer and the mode: with one tall picture the CRTC is as high as both
// (drm_mode_set_crtcinfo, CRTC_STEREO_DOUBLE); vc4's plane is as large as the mode, and the right eye's picture lies
// beside it in the buffer.
bool fits(const drmModeAtomicReq& request, const drmModeModeInfo& mode, const relievo::test::CardPicture& buffer) {
  const bool packed = (mode.flags & DRM_MODE_FLAG_3D_MASK) == DRM_MODE_FLAG_3D_FRAME_PACKING;
  const bool halves = packed && theCard().driver == "vc4";
  const auto width = static_cast<std::uint64_t>(mode.hdisplay);
  const auto height = static_cast<std::uint64_t>(packed && !halves ? mode.vdisplay + mode.vtotal : mode.vdisplay);
  const auto is = [&](const char* name, std::uint64_t wanted) {
    return valueOf(request, kPlane, name).value_or(~std::uint64_t{0}) == wanted;
  };
  return is("SRC_X", 0) && is("SRC_Y", 0) && is("SRC_W", width << 16) && is("SRC_H", height << 16) && is("CRTC_X", 0) &&
         is("CRTC_Y", 0) && is("CRTC_W", width) && is("CRTC_H", height) && is("CRTC_ID", kCrtc) &&
         static_cast<std::uint64_t>(buffer.width) == (halves ? 2 * width : width) &&
         static_cast<std::uint64_t>(buffer.height) == height;
}

bool takesChangesOfLeft(const drmModeAtomicReq& request) {
  CardState& card = theCard();
  for (const auto& [property, value] : request.changes) {
    if (!card.left.contains(property)) continue;
    if (card.keeps_left) return false;
    card.left[property] = value;
  }
  return true;
}

}  // namespace

extern "C" {

drmVersionPtr drmGetVersion(int /*card*/) {
  auto* const version = keep<drmVersion>();
  version->name = theCard().driver.data();
  version->name_len = static_cast<int>(theCard().driver.size());
  return version;
}
void drmFreeVersion(drmVersionPtr /*version*/) {}
int drmSetClientCap(int /*card*/, std::uint64_t /*capability*/, std::uint64_t /*value*/) {
  return 0;
}
int drmSetMaster(int /*card*/) {
  return 0;
}
int drmDropMaster(int /*card*/) {
  return 0;
}

drmModeResPtr drmModeGetResources(int /*card*/) {
  auto* const all = keep<drmModeRes>();
  all->count_connectors = all->count_crtcs = all->count_encoders = 1;
  all->connectors = one(kConnector);
  all->crtcs = one(kCrtc);
  all->encoders = one(kEncoder);
  return all;
}
void drmModeFreeResources(drmModeResPtr /*all*/) {}

drmModeConnectorPtr drmModeGetConnector(int /*card*/, std::uint32_t id) {
  auto* const connector = keep<drmModeConnector>();
  connector->connector_id = id;
  connector->connector_type = DRM_MODE_CONNECTOR_HDMIA;
  connector->connector_type_id = 1;
  connector->connection = DRM_MODE_CONNECTED;
  connector->count_modes = static_cast<int>(theCard().modes.size());
  connector->modes = theCard().modes.data();
  connector->count_encoders = 1;
  connector->encoders = one(kEncoder);
  return connector;
}
drmModeConnectorPtr drmModeGetConnectorCurrent(int card, std::uint32_t id) {
  return drmModeGetConnector(card, id);
}
void drmModeFreeConnector(drmModeConnectorPtr /*one*/) {}
const char* drmModeGetConnectorTypeName(std::uint32_t /*type*/) {
  return "HDMI-A";
}

drmModeEncoderPtr drmModeGetEncoder(int /*card*/, std::uint32_t id) {
  auto* const encoder = keep<drmModeEncoder>();
  encoder->encoder_id = id;
  encoder->possible_crtcs = 1;
  return encoder;
}
void drmModeFreeEncoder(drmModeEncoderPtr /*one*/) {}

drmModePlaneResPtr drmModeGetPlaneResources(int /*card*/) {
  auto* const all = keep<drmModePlaneRes>();
  all->count_planes = 2;
  all->planes = keep<std::uint32_t>(2);
  all->planes[0] = kPlane;
  all->planes[1] = kPointer;
  return all;
}
void drmModeFreePlaneResources(drmModePlaneResPtr /*all*/) {}
drmModePlanePtr drmModeGetPlane(int /*card*/, std::uint32_t id) {
  auto* const plane = keep<drmModePlane>();
  plane->plane_id = id;
  plane->possible_crtcs = 1;
  plane->crtc_id = static_cast<std::uint32_t>(leftAt(id, "CRTC_ID"));
  return plane;
}
void drmModeFreePlane(drmModePlanePtr /*one*/) {}

// A property's number is 100 times its object's number plus the property's place in the object's list.
drmModeObjectPropertiesPtr drmModeObjectGetProperties(int /*card*/, std::uint32_t object, std::uint32_t /*type*/) {
  const auto count = static_cast<std::uint32_t>(propertiesOf(object).size());
  auto* const all = keep<drmModeObjectProperties>();
  all->count_props = count;
  all->props = keep<std::uint32_t>(count);
  all->prop_values = keep<std::uint64_t>(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    all->props[i] = object * 100 + i;
    const std::string& name = propertiesOf(object)[i];
    const std::uint64_t type = object == kPlane ? DRM_PLANE_TYPE_PRIMARY : DRM_PLANE_TYPE_CURSOR;
    all->prop_values[i] = name == "type" ? type : leftAt(object, name);
  }
  return all;
}
void drmModeFreeObjectProperties(drmModeObjectPropertiesPtr /*all*/) {}
drmModePropertyPtr drmModeGetProperty(int /*card*/, std::uint32_t id) {
  auto* const property = keep<drmModePropertyRes>();
  property->prop_id = id;
  std::snprintf(property->name, sizeof property->name, "%s", propertiesOf(id / 100).at(id % 100).c_str());
  return property;
}
void drmModeFreeProperty(drmModePropertyPtr /*one*/) {}

drmModeCrtcPtr drmModeGetCrtc(int /*card*/, std::uint32_t /*id*/) {
  return keep<drmModeCrtc>();
}
void drmModeFreeCrtc(drmModeCrtcPtr /*one*/) {}
int drmModeSetCrtc(int /*card*/, std::uint32_t /*crtc*/, std::uint32_t /*buffer*/, std::uint32_t /*x*/,
                   std::uint32_t /*y*/, std::uint32_t* /*connectors*/, int /*count*/, drmModeModeInfoPtr /*mode*/) {
  theCard().mode.reset();
  return 0;
}

int drmModeCreatePropertyBlob(int /*card*/, const void* data, std::size_t size, std::uint32_t* id) {
  if (size != sizeof(drmModeModeInfo)) return -EINVAL;
  *id = ++theCard().last_id;
  std::memcpy(&theCard().blobs[*id], data, size);
  return 0;
}
int drmModeDestroyPropertyBlob(int /*card*/, std::uint32_t id) {
  theCard().blobs.erase(id);
  return 0;
}

int drmModeAddFB2WithModifiers(int /*card*/, std::uint32_t width, std::uint32_t height, std::uint32_t format,
                               const std::uint32_t /*handles*/[4], const std::uint32_t /*strides*/[4],
                               const std::uint32_t /*offsets*/[4], const std::uint64_t* /*modifiers*/,
                               std::uint32_t* id, std::uint32_t /*flags*/) {
  if (format != DRM_FORMAT_XRGB8888) return -EINVAL;
  *id = ++theCard().last_id;
  theCard().pictures[*id] = {static_cast<int>(width), static_cast<int>(height), {}};
  return 0;
}
int drmModeRmFB(int /*card*/, std::uint32_t id) {
  theCard().pictures.erase(id);
  return 0;
}

drmModeAtomicReqPtr drmModeAtomicAlloc() {
  return new _drmModeAtomicReq;
}
void drmModeAtomicFree(drmModeAtomicReqPtr request) {
  delete request;
}
int drmModeAtomicAddProperty(drmModeAtomicReqPtr request, std::uint32_t object, std::uint32_t property,
                             std::uint64_t value) {
  request->changes.push_back({{object, propertiesOf(object).at(property % 100)}, value});
  return 1;
}
int drmModeAtomicGetCursor(const drmModeAtomicReqPtr request) {
  return static_cast<int>(request->changes.size());
}
void drmModeAtomicSetCursor(drmModeAtomicReqPtr request, int cursor) {
  request->changes.erase(request->changes.begin() + cursor, request->changes.end());
}
int drmModeAtomicCommit(int /*card*/, const drmModeAtomicReqPtr request, std::uint32_t flags, void* user_data) {
  CardState& card = theCard();
  const auto buffer = valueOf(*request, kPlane, "FB_ID");
  if (!buffer || !card.pictures.contains(static_cast<std::uint32_t>(*buffer))) return reject(ENOENT);
  auto& picture = card.pictures.at(static_cast<std::uint32_t>(*buffer));
  if (const auto blob = valueOf(*request, kCrtc, "MODE_ID")) {
    const auto& mode = card.blobs.at(static_cast<std::uint32_t>(*blob));
    if (!fits(*request, mode, picture)) return reject(EINVAL);
    if (!takesChangesOfLeft(*request)) return reject(EINVAL);
    card.mode = mode;
  }
  if (!card.mode) return reject(EINVAL);
  picture.rgba = card.drawn.rgba;
  card.shown = static_cast<std::uint32_t>(*buffer);
  if ((flags & DRM_MODE_PAGE_FLIP_EVENT) != 0) completeFlip(reinterpret_cast<std::uintptr_t>(user_data));
  return 0;
}

}  // extern "C"
