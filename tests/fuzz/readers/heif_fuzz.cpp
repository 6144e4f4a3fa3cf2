// SPDX-License-Identifier: Apache-2.0
// Any bytes as a HEIF file. libheif itself is not instrumented.
#include "drivers/heif/heif.h"
#include "tests/fuzz/picture_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const relievo::PictureFormat formats[] = {relievo::kHeifColor, relievo::kHeifDepth, relievo::kHeifLeft,
                                            relievo::kHeifRight};
  relievo::fuzzPhoto(relievo::kHeif, formats, {bytes, size});
  return 0;
}
