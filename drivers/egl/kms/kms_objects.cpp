// SPDX-License-Identifier: Apache-2.0
// A property is found by its name among the object's.
#include "drivers/egl/kms/kms_objects.h"

namespace relievo::kms {

Property propertyOf(int card, std::uint32_t object, std::uint32_t type, const std::string& name) {
  const auto all = own(drmModeObjectGetProperties(card, object, type));
  for (std::uint32_t i = 0; all != nullptr && i < all->count_props; ++i) {
    const auto property = own(drmModeGetProperty(card, all->props[i]));
    if (property != nullptr && name == property->name) return {property->prop_id, all->prop_values[i]};
  }
  return {};
}

}  // namespace relievo::kms
