// SPDX-License-Identifier: Apache-2.0
#include "app/author/package/packager.h"

#include <cmath>

#include "app/author/package/color_to_420.h"
#include "app/author/package/film_kind.h"
#include "app/author/package/output.h"
#include "app/author/package/source_notes.h"
#include "app/media/reading/depth_doubts.h"
#include "app/scene/film_box.h"
#include "app/scene/height_field.h"
#include "hal/media/media_names.h"
#include "platform/files/answered_place.h"
#include "platform/files/file_system_answer.h"
#include "platform/log.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr Duration kLeastStep = std::chrono::nanoseconds(11'112);  // one tick of a film's 90 kHz clock

}  // namespace

std::optional<std::uint64_t> expectedFrames(const FilmInfo& info) {
  if (info.duration <= Duration(0) || info.frame_period <= Duration(0)) return std::nullopt;
  return static_cast<std::uint64_t>(std::llround(toSeconds(info.duration) / toSeconds(info.frame_period)));
}

Outcome<void> Packager::begin(const FramePair& pair) {
  const FilmInfo& info = info_;
  Frame whole_depth;  // only its size is used; the first pair may have no depth yet
  whole_depth.width = info.depth_width;
  whole_depth.height = info.depth_height;
  cut_ = EvenCut(pair.color, whole_depth, output_.depth.flat_chroma);
  coder_ = DepthCoder(sourceCalibration(), output_.depth);
  code_notes_ = coder_.explain();
  if (output_.enhancement) {
    enhancer_.emplace(*output_.enhancement, sourceCalibration());
    coder_ = DepthCoder(enhancer_->outcome(), output_.depth);
  }
  if (filmKindOf(output_.path) != FilmKind::Live) {
    check_.emplace(sourceCalibration(), enhancer_ ? std::optional(enhancer_->outcome()) : std::nullopt,
                   coder_.outcome());
  }

  format_.color_width = pair.color.width - cut_.color_cols;
  format_.color_height = pair.color.height - cut_.color_rows;
  format_.depth_width = info.depth_width - cut_.depth_cols;
  format_.depth_height = info.depth_height - cut_.depth_rows;
  const bool rgb = pair.color.model == ColorModel::Rgb;
  format_.color_range = rgb ? ColorRange::Limited : pair.color.range;
  format_.color_matrix = rgb ? ColorMatrix::Bt709 : pair.color.matrix;
  const auto signalled = [rgb](std::uint8_t code) { return rgb && code == kUnspecifiedColor ? kBt709 : code; };
  format_.color_primaries = signalled(pair.color.primaries);
  format_.color_transfer = signalled(pair.color.transfer);
  format_.color_aspect = pair.color.sample_aspect;
  format_.depth_aspect = pair.depth.sample_aspect;
  format_.frame_period = info.frame_period;
  format_.color_crf = output_.color_crf;
  format_.depth = output_.depth;
  format_.depth_tags = calibrationTags(coder_.outcome());
  for (auto& [key, value] : certaintyTags(info.reading)) format_.depth_tags[key] = value;
  if (auto planned = planMaterial(pair); !planned) return planned;
  const Material whole = material_ ? withoutThoseOf(material_->scale(), info.material) : info.material;
  if (!whole.empty()) format_.depth_tags[kMaterialTag] = materialText(whole);
  format_.depth_tags[kReadAsTag] = plainLine(info.reading, sourceCalibration());
  auto writer = FilmWriter::create(output_.path, format_, output_.force ? Existing::Replace : Existing::Keep,
                                   keptTracks(), check_ ? &*check_ : nullptr);
  if (!writer) return failOn(output_.path, writer.error());
  writer_ = std::move(*writer);
  return {};
}

// Uses the user's map, else the source's own material track.
Outcome<void> Packager::planMaterial(const FramePair& pair) {
  if (!output_.paintings.empty()) {
    auto track =
        MaterialTrack::open(output_.paintings, source_.material, backends_, format_.color_width, format_.color_height);
    if (!track) return std::unexpected(track.error());
    material_ = std::move(*track);
    format_.material_width = material_->cols();
    format_.material_height = material_->rows();
    format_.material_scale = materialText(material_->scale());
  } else if (const Frame& own = pair.material; !info_.material_scale.empty() && own.range == ColorRange::Full) {
    format_.material_width = own.width - own.width % 2;
    format_.material_height = own.height - own.height % 2;
    format_.material_scale = materialText(info_.material_scale);
  }
  return {};
}

Outcome<void> Packager::writeMaterial(const FramePair& pair, const ColorPicture420& color, bool key, bool begins_shot) {
  if (format_.material_width == 0) return {};
  const ColorPicture420* picture = &kept_material_;
  if (material_) {
    const auto made = material_->at(color, pair.color.pts, begins_shot);
    if (!made) return failOn(output_.paintings.front().path, made.error());
    picture = *made;
  } else {
    const Frame& own = pair.material;
    if (own.width < format_.material_width || own.height < format_.material_height) return {};
    const Frame cut = crop(own, 0, 0, format_.material_width, format_.material_height);
    if (auto made = toColor420(cut, kept_material_); !made) return failOn("material", made.error());
  }
  if (auto written = writer_->writeMaterial(*picture, pair.color.pts, key); !written)
    return failOn(output_.path, written.error());
  return {};
}

// Sound and subtitles are read from files alone: a camera or a stream cannot be opened twice.
std::unique_ptr<KeptTracks> Packager::keptTracks() const {
  if (!isRegularFile(source_.url)) return nullptr;
  const std::string ending = endingOf(source_.url);
  if (ending == "sens" || ending == "klg") return nullptr;  // FFmpeg would take a scan's pictures for sound
  auto kept = KeptTracks::open(source_.url, info_.color_stream, info_.container_start, output_.keep);
  if (kept) return std::move(*kept);
  if (info_.sound_tracks + info_.subtitle_tracks == 0) return nullptr;
  log(LogLevel::Warning, source_.url.c_str(), "%s; the film is made without", kept.error().message);
  return nullptr;
}

Outcome<void> Packager::write(const FramePair& pair) {
  if (last_color_ && pair.color.pts < *last_color_ + kLeastStep) {
    ++not_later_;
    return {};
  }
  last_color_ = pair.color.pts;
  const Frame color = crop(pair.color, 0, 0, pair.color.width - cut_.color_cols, pair.color.height - cut_.color_rows);
  const bool depth_is_new = !pair.depth.empty() && (!last_depth_ || pair.depth.pts >= *last_depth_ + kLeastStep);
  const bool begins_shot = depth_is_new && beginsShot(pair.depth);
  const bool key = key_frames_.isDue(color.pts, depth_is_new || pair.depth.empty(), begins_shot);
  ColorPicture420& packed = writer_->nextColor();
  if (auto made = toColor420(color, packed); !made) return failOn("colour", made.error());
  if (auto written = writer_->writeColor(packed, color.pts, key); !written)
    return failOn(output_.path, written.error());
  if (auto written = writeMaterial(pair, packed, key, begins_shot); !written) return written;
  if (!depth_is_new) return {};

  last_depth_ = pair.depth.pts;
  const Frame depth = crop(pair.depth, 0, 0, pair.depth.width - cut_.depth_cols, pair.depth.height - cut_.depth_rows);
  if (!output_.preview.empty()) {
    const std::lock_guard lock(preview_mutex_);
    preview_.before(packed, usualBox(pair.color, pair.depth), depth, sourceCalibration(), expectedFrames(info_));
  }
  return depth_line_.add([this, depth, key] { return takeDepth(depth, key); });
}

Outcome<void> Packager::takeDepth(const Frame& depth, bool key) {
  depth_keys_.push_back(key);
  if (check_) check_->read(depth);
  if (!enhancer_) return writeDepth(depth);
  if (auto added = enhancer_->add(depth); !added) return failOn("depth", added.error());
  return writeEnhanced();
}

// Writes the pictures that are ready, at their own times.
Outcome<void> Packager::writeEnhanced() {
  while (const auto depth = enhancer_->next()) {
    if (auto written = writeDepth(*depth); !written) return written;
  }
  return {};
}

Outcome<void> Packager::writeDepth(const Frame& depth) {
  const bool key = depth_keys_.front();
  depth_keys_.pop_front();
  if (!output_.preview.empty()) {
    const std::lock_guard lock(preview_mutex_);
    preview_.after(depth, enhancer_ ? enhancer_->outcome() : sourceCalibration());
  }
  DepthPicture picture;
  if (auto coded = coder_.encode(depth, picture); !coded) return failOn("depth", coded.error());
  if (check_) check_->write(depth, picture);
  if (auto written = writer_->writeDepth(picture, depth.pts, key); !written)
    return failOn(output_.path, written.error());
  return {};
}

// Finds cuts in the depth, as the player does. Fast motion may look like a cut and then costs an extra key frame.
bool Packager::beginsShot(const Frame& depth) {
  const auto field =
      HeightField::make(depth, sourceCalibration(), DisplayVolume::forPicture(depth.width, depth.height));
  if (!field) return false;  // the coder reports the error
  if (recent_.size() == kRecent) recent_.pop_front();
  recent_.push_back({.field = *field, .time = depth.pts, .owner = depth.owner});
  shots_.mark(recent_);
  return recent_.size() > 1 && recent_.back().shot != recent_[recent_.size() - 2].shot;
}

Outcome<AuthorSummary> Packager::finish(bool whole) {
  if (auto done = depth_line_.finish(); !done) return std::unexpected(done.error());
  if (enhancer_) {
    enhancer_->finish();
    if (auto written = writeEnhanced(); !written) return std::unexpected(written.error());
  }
  const auto totals = writer_->finish(whole);
  if (!totals) return failOn(output_.path, totals.error());
  if (!output_.preview.empty()) {
    if (auto drawn = preview_.writePng(output_.preview); !drawn) return failOn(output_.preview, drawn.error());
  }
  AuthorSummary summary{.format = format_,
                        .totals = *totals,
                        .frame_period = format_.frame_period,
                        .codes = coder_.counts(),
                        .enhancement = output_.enhancement,
                        .enhanced = enhancer_ ? enhancer_->summary() : EnhancementSummary{},
                        .read_as = plainLine(info_.reading, sourceCalibration()),
                        .read_because = info_.reading.why,
                        .loss = check_ ? check_->loss() : DepthLoss{},
                        .notes = code_notes_};
  const auto& offers = info_.reading.offers;
  summary.read_because.insert(summary.read_because.end(), offers.begin(), offers.end());
  if (!coder_.outcome().invalid.empty() && !format_.depth.isLossless()) {
    summary.notes.emplace_back("coding shifts some edges of holes by a sample; --depth-crf 0 avoids this");
  }
  if (not_later_ > 0) {
    summary.notes.push_back(source_.url + print(": %llu pictures whose times do not increase were left out",
                                                static_cast<unsigned long long>(not_later_)));
  }
  for (std::string& line : material_ ? material_->notes() : std::vector<std::string>{}) {
    summary.notes.push_back(std::move(line));
  }
  if (auto line = cut_.explain(); !line.empty()) summary.notes.push_back(std::move(line));
  summary.lost = lostParts(source_.url, source_.depth_url, reader_.counters());
  for (std::string& line : sourceNotes(summary.lost, info_, reader_.counters(), format_, coder_.counts())) {
    summary.notes.push_back(std::move(line));
  }
  if (const KeptTracks* const kept = writer_->kept()) {
    summary.kept = kept->kept();
    summary.notes.insert(summary.notes.end(), kept->leftOut().begin(), kept->leftOut().end());
  } else {
    for (std::string& line : notKept(info_, output_.keep)) summary.notes.push_back(std::move(line));
  }
  return summary;
}

}  // namespace relievo
