// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/picture_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  relievo::fuzzPhoto(relievo::kDepthJpeg, {}, {bytes, size});
  relievo::fuzzPhoto(relievo::kStereoJpeg, {}, {bytes, size});
  return 0;
}
