// SPDX-License-Identifier: Apache-2.0
// Makes the sample film: renders its pictures in turn and writes them with their exact depth.
#include "app/author/author.h"
#include "app/author/package/color_to_420.h"
#include "app/author/package/film_kind.h"
#include "app/author/package/key_frames.h"
#include "app/author/package/output.h"
#include "app/author/sample/sample_renderer.h"

namespace relievo {
namespace {

// A view of the renderer's bytes, for the conversion.
Frame rgbFrame(const SamplePicture& picture) {
  Frame frame;
  frame.width = picture.cols;
  frame.height = picture.rows;
  frame.model = ColorModel::Rgb;
  frame.range = ColorRange::Full;
  frame.plane_count = 1;
  frame.planes[0] = {picture.rgb.data(), std::ptrdiff_t{3} * picture.cols};
  for (std::uint8_t i = 0; i < 3; ++i) frame.components[i] = {.plane = 0, .offset_bytes = i, .step_bytes = 3};
  return frame;
}

// A view of its depth: 8 bits, full range, linear, near is high.
Frame depthFrame(const SamplePicture& picture) {
  Frame frame;
  frame.width = picture.cols;
  frame.height = picture.rows;
  frame.range = ColorRange::Full;
  frame.plane_count = 1;
  frame.planes[0] = {picture.depth.data(), picture.cols};
  return frame;
}

FilmFormat formatOf(const SampleOptions& sample, const OutputOptions& output) {
  FilmFormat format;
  format.color_width = format.depth_width = sample.cols;
  format.color_height = format.depth_height = sample.rows;
  format.color_matrix = ColorMatrix::Bt709;
  format.color_primaries = format.color_transfer = kBt709;
  format.frame_period = fromSeconds(1.0 / SampleFilm::kFramesPerSecond);
  format.color_crf = output.color_crf;
  format.depth = output.depth;
  return format;
}

}  // namespace

Outcome<AuthorSummary> authorSample(const SampleOptions& sample, const OutputOptions& output,
                                    const std::atomic<bool>& stop, const ProgressReport& progress) {
  if (auto ready = checkOutput(output); !ready) return failOn(output.path, ready.error());
  DepthCoder coder(DepthCalibration{}, output.depth);
  AuthorSummary summary;
  summary.format = formatOf(sample, output);
  summary.format.depth_tags = calibrationTags(coder.outcome());
  summary.frame_period = summary.format.frame_period;
  DepthCheck check(DepthCalibration{}, std::nullopt, coder.outcome());
  const bool is_checked = filmKindOf(output.path) != FilmKind::Live;
  auto writer = FilmWriter::create(output.path, summary.format, output.force ? Existing::Replace : Existing::Keep,
                                   nullptr, is_checked ? &check : nullptr);
  if (!writer) return failOn(output.path, writer.error());

  SamplePicture picture{.cols = sample.cols, .rows = sample.rows, .rgb = {}, .depth = {}};
  ColorPicture420 color;
  DepthPicture depth;
  KeyFrames key_frames;
  for (int k = 0; k < sample.frames; ++k) {
    if (stop.load(std::memory_order_relaxed)) {
      if (filmKindOf(output.path) == FilmKind::Live) break;
      return failOn(output.path, {ErrorCode::Cancelled, 0, "interrupted; nothing was written"});
    }
    const double t_s = k / static_cast<double>(SampleFilm::kFramesPerSecond);
    renderSample(t_s, sample.threads, picture);
    if (auto made = toColor420(rgbFrame(picture), color); !made) return failOn(output.path, made.error());
    if (auto coded = coder.encode(depthFrame(picture), depth); !coded) return failOn(output.path, coded.error());
    if (is_checked) {
      check.read(depthFrame(picture));
      check.write(depthFrame(picture), depth);
    }
    const bool key = key_frames.isDue(mediaTime(t_s), true);
    auto written = (*writer)->writeColor(color, mediaTime(t_s), key);
    if (written) written = (*writer)->writeDepth(depth, mediaTime(t_s), key);
    if (!written) return failOn(output.path, written.error());
    progress(static_cast<std::uint64_t>(k) + 1, static_cast<std::uint64_t>(sample.frames));
  }
  const auto totals = (*writer)->finish();
  if (!totals) return failOn(output.path, totals.error());
  summary.totals = *totals;
  summary.codes = coder.counts();
  summary.loss = check.loss();
  summary.notes = coder.explain();
  return summary;
}

}  // namespace relievo
