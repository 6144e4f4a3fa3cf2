// SPDX-License-Identifier: Apache-2.0
// A video decoder made of several: if one fails, another continues at the same picture.
#pragma once

#include <memory>
#include <vector>

#include "hal/media/video_decoder.h"

namespace relievo {

// `decoders`: at least one, the best first. The first that takes the stream decodes it; `description` says why no
// better one does. The packets since the last key frame are kept. After a failure they are fed again, and pictures that
// were already returned are dropped: none is missing and none comes twice. A decoder that hangs (Timeout) or fails with
// Io is restarted, once per film; after any other failure, or a second one, the next decoder replaces it for good. The
// caller gets the failure of the last decoder; `takeRestart` reports all others. A `receive` that meets a failure takes
// as long as decoding the kept packets again.
//
// Missing hardware (NotFound) is said only if it was `asked_for`.
//
// Frames outlive their decoder, as with any decoder.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeFailoverDecoder(std::vector<std::unique_ptr<VideoDecoder>> decoders,
                                                                bool asked_for = false);

}  // namespace relievo
