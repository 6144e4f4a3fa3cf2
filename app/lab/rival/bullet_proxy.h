// SPDX-License-Identifier: Apache-2.0
// A god-object on the height field of the Bullet library: what one gets who takes a ready-made collision engine.
#pragma once

#include <memory>

#include "app/haptics/method/method.h"

namespace relievo {

// Bullet's btHeightfieldTerrainShape finds what the proxy meets; the proxy is the god-object of Zilles and Salisbury
// (1995): a point that goes on a ray towards the finger, stops at the surface, and slides to the closest place that the
// planes of up to three triangles allow, until it has arrived. Heights are read through the shape's own virtual
// function where a ray goes, linear in time between the two frames, so that no frame is converted; a surface that rises
// takes the proxy along, as in the paper (IV-A). Single precision, as Debian builds the library.
//
// Null where relievo-lab was built without Bullet.
[[nodiscard]] std::unique_ptr<TouchMethod> makeBulletProxy(double stiffness_n_per_mm);

}  // namespace relievo
