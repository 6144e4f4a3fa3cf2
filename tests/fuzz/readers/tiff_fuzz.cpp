// SPDX-License-Identifier: Apache-2.0
#include "drivers/tiff/tiff.h"
#include "tests/fuzz/picture_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  relievo::fuzzPicture(relievo::kTiff, {bytes, size});
  return 0;
}
