// SPDX-License-Identifier: Apache-2.0
// In place of bullet_proxy.cpp where the library is not there.
#include "app/lab/rival/bullet_proxy.h"

namespace relievo {

std::unique_ptr<TouchMethod> makeBulletProxy(double /*stiffness_n_per_mm*/) {
  return nullptr;
}

}  // namespace relievo
