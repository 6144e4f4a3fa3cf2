// SPDX-License-Identifier: Apache-2.0
// Any bytes as a film. FFmpeg itself is not instrumented; its output passes through our code.
#include "tests/fuzz/film_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  relievo::test::playBytes({bytes, size}, relievo::makeFfmpegSource);
  return 0;
}
