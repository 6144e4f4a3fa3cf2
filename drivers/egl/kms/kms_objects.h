// SPDX-License-Identifier: Apache-2.0
// Owns what libdrm allocates, and reads the properties of a card's objects.
#pragma once

#include <xf86drm.h>
#include <xf86drmMode.h>

#include <cstdint>
#include <memory>
#include <string>

namespace relievo::kms {

struct FreeObject {
  void operator()(drmModeRes* all) const noexcept { drmModeFreeResources(all); }
  void operator()(drmModePlaneRes* all) const noexcept { drmModeFreePlaneResources(all); }
  void operator()(drmModeConnector* one) const noexcept { drmModeFreeConnector(one); }
  void operator()(drmModeEncoder* one) const noexcept { drmModeFreeEncoder(one); }
  void operator()(drmModePlane* one) const noexcept { drmModeFreePlane(one); }
  void operator()(drmModeObjectProperties* all) const noexcept { drmModeFreeObjectProperties(all); }
  void operator()(drmModePropertyRes* one) const noexcept { drmModeFreeProperty(one); }
  void operator()(drmVersion* one) const noexcept { drmFreeVersion(one); }
};
template <class T>
std::unique_ptr<T, FreeObject> own(T* object) {
  return std::unique_ptr<T, FreeObject>(object);
}

struct Property {
  std::uint32_t id = 0;  // 0: none
  std::uint64_t value = 0;
};
// `type`: a DRM_MODE_OBJECT.
[[nodiscard]] Property propertyOf(int card, std::uint32_t object, std::uint32_t type, const std::string& name);

}  // namespace relievo::kms
