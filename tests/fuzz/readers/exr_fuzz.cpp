// SPDX-License-Identifier: Apache-2.0
// Any bytes as an OpenEXR file. libOpenEXR itself is not instrumented.
#include "drivers/exr/exr.h"
#include "tests/fuzz/picture_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace relievo;
  fuzzPicture(kExr, {bytes, size});
  fuzzPhoto(kExrWithDepth, {}, {bytes, size});
  return 0;
}
