// SPDX-License-Identifier: Apache-2.0
// Any bytes as a TIFF file of pages.
#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/tiff/tiff.h"
#include "tests/fuzz/film_fuzz.h"

namespace relievo {
namespace {

std::unique_ptr<MediaSource> pages() {
  return makeTiffSource([](const std::string&) -> Result<StreamInfo> {
    return StreamInfo{.kind = StreamKind::Video, .codec = "tiff", .width = 16, .height = 16};
  });
}

}  // namespace
}  // namespace relievo

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  relievo::test::playBytes({bytes, size}, relievo::pages);
  return 0;
}
