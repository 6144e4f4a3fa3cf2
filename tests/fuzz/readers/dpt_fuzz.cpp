// SPDX-License-Identifier: Apache-2.0
#include "drivers/floats/floats.h"
#include "tests/fuzz/picture_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  relievo::fuzzPicture(relievo::kDpt, {bytes, size});
  return 0;
}
