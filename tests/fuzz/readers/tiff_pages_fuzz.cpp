// SPDX-License-Identifier: Apache-2.0
// Any bytes as a TIFF file of pages.
#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/tiff/tiff.h"
#include "tests/fuzz/film_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace relievo;
  const auto describe = [](const std::string&) -> Result<StreamInfo> {
    return StreamInfo{.kind = StreamKind::Video, .codec = "tiff"};
  };
  test::playBytes({bytes, size}, [&] { return makeTiffSource(describe); });
  return 0;
}
