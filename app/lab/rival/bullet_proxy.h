// SPDX-License-Identifier: Apache-2.0
// A god-object on the height field of the Bullet library, as built by someone who uses a ready-made collision engine.
#pragma once

#include <memory>

#include "app/haptics/method/method.h"

namespace relievo {

// Bullet's btHeightfieldTerrainShape finds collisions; the proxy is the god-object of Zilles and Salisbury (1995): a
// point that moves on a ray towards the finger, stops at the surface, and slides to the closest point that the planes
// of up to three triangles allow, until it no longer moves. Heights are read through the shape's own virtual function
// where a ray goes, linear in time between the two frames, so that no frame is converted; a surface that rises takes
// the proxy along, as in the paper (IV-A). Single precision, as Debian builds the library.
//
// Null if relievo-lab was built without Bullet.
[[nodiscard]] std::unique_ptr<TouchMethod> makeBulletProxy(double stiffness_n_per_mm);

}  // namespace relievo
