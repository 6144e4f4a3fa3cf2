// SPDX-License-Identifier: Apache-2.0
// Media source and decoders on FFmpeg's libraries: any file or URL that they open, decoded in software.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "hal/audio_decoder.h"
#include "hal/media_source.h"
#include "hal/video_decoder.h"
#include "platform/error.h"

namespace relievo {

// Files, named pipes, numbered pictures ("frames/%03d.png"), and addresses that begin with http, https (HLS and DASH as
// well), rtsp, rtsps, rtp, udp or tcp; Unsupported for any other. What one of them names is opened only if it is of the
// same origin: from a file other files, from the network never a file of this machine (see address.h). RTSP comes over
// TCP unless the address ends in "?udp".
//
// A read that brings nothing for ten seconds, of a stream at its own pace (rtsp, rtp, udp, tcp) for three, returns
// Timeout, and so does an opening that takes longer than a minute. `interrupt` ends every wait within a tenth of a
// second, but that for a name server. A stream at its own pace without a length does not end: it is Lost.
//
// Of a source with several programmes (a broadcast multiplex, the rates of an adaptive stream) the best one is the
// film; the streams of the others are listed as Other. So are cover pictures.
//
// Seeks are by the leading video stream's key frames where the container has an index; transport streams and adaptive
// streams land near the target, before or after it, so the reader has to look and to try from earlier.
//
// What has no times of its own (pictures, raw streams) yields packets without times, which the decoder below numbers by
// StreamInfo::frame_period; a seek in it goes back to the beginning.
[[nodiscard]] std::unique_ptr<MediaSource> makeFfmpegSource();

// Takes the streams of the source above as they are, and those of any other source by codec name and extradata.
// Pictures whose layout hal/frame.h cannot describe (palettes, single bits, big endian, ..) are converted to the
// nearest that it can: the one case of a copy, exact for integers of up to 16 bits. Gray in floating point (a
// renderer's EXR) is taken for distances in metres and becomes whole mm, with calibration tags that say so. A picture
// that was mended with guesses after an error in its data is dropped and counted: a guessed depth must not be felt.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeFfmpegDecoder();

// Any codec, rate and layout, which may change in the middle. Mixed down by the layout's own rule, and so that the sum
// is not clipped.
[[nodiscard]] std::unique_ptr<AudioDecoder> makeFfmpegAudioDecoder();

// The text at a path or an address (http, https), at most so many bytes, else Corrupt. May wait as long as opening a
// source; Cancelled soon after the flag is set.
[[nodiscard]] Result<std::string> readFfmpegText(const std::string& url, std::size_t most_bytes,
                                                 const std::atomic<bool>& cancelled);

}  // namespace relievo
