// SPDX-License-Identifier: Apache-2.0
// The properties of KMS (kernel documentation gpu/drm-kms.rst, "Standard Connector Properties" and "Color Management
// Properties").
#include "drivers/egl/kms/kms_leftovers.h"

#include "drivers/egl/kms/kms_objects.h"

namespace relievo::kms {
namespace {

struct Plain {
  const char* name;
  std::uint64_t value;
};
constexpr Plain kOfConnector[] = {{"HDR_OUTPUT_METADATA", 0}, {"Colorspace", 0}};
constexpr Plain kOfCrtc[] = {{"DEGAMMA_LUT", 0}, {"CTM", 0}, {"GAMMA_LUT", 0}};

class Leftovers {
 public:
  Leftovers(int card, drmModeAtomicReq& request) noexcept : card_(card), request_(request) {}

  template <std::size_t N>
  void undo(std::uint32_t object, std::uint32_t type, const Plain (&plain)[N]) {
    for (const Plain& each : plain) {
      const Property property = propertyOf(card_, object, type, each.name);
      if (property.id != 0 && property.value != each.value) add(object, property.id, each.value);
    }
  }
  void switchOff(std::uint32_t plane) {
    for (const char* const name : {"FB_ID", "CRTC_ID"}) {
      add(plane, propertyOf(card_, plane, DRM_MODE_OBJECT_PLANE, name).id, 0);
    }
  }
  [[nodiscard]] bool any() const noexcept { return any_; }

 private:
  void add(std::uint32_t object, std::uint32_t property, std::uint64_t value) {
    drmModeAtomicAddProperty(&request_, object, property, value);
    any_ = true;
  }

  int card_;
  drmModeAtomicReq& request_;
  bool any_ = false;
};

}  // namespace

bool addLeftovers(int card, const ScreenParts& parts, drmModeAtomicReq& request) {
  Leftovers leftovers(card, request);
  leftovers.undo(parts.connector, DRM_MODE_OBJECT_CONNECTOR, kOfConnector);
  leftovers.undo(parts.crtc, DRM_MODE_OBJECT_CRTC, kOfCrtc);
  const auto planes = own(drmModeGetPlaneResources(card));
  for (std::uint32_t i = 0; planes != nullptr && i < planes->count_planes; ++i) {
    const auto plane = own(drmModeGetPlane(card, planes->planes[i]));
    if (plane == nullptr || plane->plane_id == parts.plane || plane->crtc_id != parts.crtc) continue;
    leftovers.switchOff(plane->plane_id);
  }
  return leftovers.any();
}

}  // namespace relievo::kms
