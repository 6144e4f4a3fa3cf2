// SPDX-License-Identifier: Apache-2.0
#include "app/media/pairs/film_inputs.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/media/folder/film_folder.h"
#include "app/media/folder/other_view.h"
#include "hal/media/media_names.h"
#include "platform/print.h"
#include "platform/text/lower_case.h"
#include "platform/text/plain_text.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

// The frame rate of depth pictures without times: the user's, else that of the film that they were recorded with.
std::optional<double> rateForDepth(std::optional<double> told, const StreamInfo& color) {
  if (told || color.counted || !color.average_rate.known()) return told;
  return static_cast<double>(color.average_rate.num) / color.average_rate.den;
}

// Whether the first picture of `file` is gray and the only one; true if it cannot be read here.
struct Look {
  bool gray = true, alone = true;
};
Look lookAt(const PairReader::Backends& backends, const std::string& file) {
  DepthSource source(backends, std::nullopt);
  if (!source.open(file)) return {};
  const auto first = source.next();
  if (!first || first->frame.empty()) return {};
  const auto second = source.next();
  return {first->frame.model == ColorModel::Gray, !second || second->frame.empty()};
}

// Photos share their names with masks and with pictures in other forms, too: depth is gray, of more than 8 bits where
// the file is a picture.
bool mayBeDepthOf(const PairReader::Backends& backends, const std::string& photo, const StreamInfo& color,
                  const std::string& file, const StreamInfo& stream) {
  const auto isFineGray = [](const StreamInfo& picture) {
    return picture.pixel_format.starts_with("gray") && picture.pixel_format != "gray";
  };
  if (lowerCase(fs::path(photo).stem().string()) != lowerCase(fs::path(file).stem().string())) return true;
  if (isFineGray(color)) return false;  // the depth itself: MiDaS writes both
  const std::string ending = endingOf(file);
  const bool picture = ending == "png" || ending == "tif" || ending == "tiff";
  return picture ? stream.pixel_format.empty() || isFineGray(stream) : lookAt(backends, file).gray;
}

}  // namespace

// Depth in two places at once is refused.
Result<void> FilmInputs::open() {
  takeFilmOverDepth();
  const SourceOptions& options = film_.options;
  if (!options.depth_url.empty() && isPacked(options.packing)) {
    return film_.failOn(options.depth_url,
                        {ErrorCode::InvalidArgument, 0,
                         "depth cannot be packed into the picture and come from a second source as well; leave out "
                         "--packing or --depth"});
  }
  auto taken = film_.sources.take(
      std::make_unique<TrackReader>(film_.backends.make_source(options.url), film_.backends.make_decoder));
  if (!taken) return film_.failOn(options.url, taken.error());
  auto opened = film_.sources.color()->open(options.url, options.frames_per_s);
  if (!opened) return film_.failOn(options.url, opened.error());
  return {};
}

void FilmInputs::takeFilmOverDepth() {
  SourceOptions& options = film_.options;
  if (!options.depth_url.empty() || options.packing != Packing::Auto) return;
  if (std::string photo = photoBeside(options.url); !photo.empty() && lookAt(film_.backends, options.url).alone) {
    options.depth_url = std::exchange(options.url, std::move(photo));
    return;
  }
  const auto pair = filmOverDepth(options.url);
  if (!pair) return;
  options.url = pair->film;
  options.depth_url = pair->depth;
}

// The first track selected leads, so the colour is selected first.
Result<void> FilmInputs::select(const TrackPlan& plan) {
  takeFacts();
  const SourceOptions& options = film_.options;
  if (film_.isPacked() && options.registration) {
    return film_.failOn(options.url, {ErrorCode::InvalidArgument, 0,
                                      "depth that is packed into the picture is in the colour's view already; leave "
                                      "the registration out"});
  }
  const auto chosen = film_.sources.color()->select(film_.asTold(*plan.color));
  if (!chosen) return film_.failOn(options.url, chosen.error());
  if (plan.depth == nullptr && !film_.isPacked() && options.depth_url.empty() && options.packing == Packing::Auto)
    takeDepthBeside(*plan.color);
  if (auto selected = selectDepth(plan.depth, *plan.color); !selected) return selected;
  if (const DepthSource* const depth = film_.sources.depth())
    film_.info.notes.insert(film_.info.notes.end(), depth->notes().begin(), depth->notes().end());
  countTracks(plan);
  listTracks();
  return {};
}

void FilmInputs::takeFacts() {
  const MediaSource& source = film_.sources.color()->source();
  film_.info.duration = source.duration();
  film_.info.container_start = source.senderStart().value_or(Duration(0));
  film_.info.notes = source.notes();
  film_.remote = source.remote();
  film_.live = source.live();
  const auto title = source.tags().find("TITLE");
  film_.info.title = title == source.tags().end() ? "" : oneLine(title->second);
  if (film_.info.title.find_first_not_of(' ') == std::string::npos) film_.info.title.clear();
  film_.info.chapters = source.chapters();
  std::ranges::sort(film_.info.chapters, {}, &Chapter::begin);
}

void FilmInputs::takeDepthBeside(const StreamInfo& color) {
  std::vector<std::string>& notes = film_.info.notes;
  const std::string file = depthBeside(film_.options.url);
  if (const std::string other = file.empty() ? otherViewBeside(film_.options.url) : ""; !other.empty()) {
    notes.push_back(
        print("%s beside it may be its other view; name their folder to see both, and --depth-from stereo "
              "to feel them",
              other.c_str()));
  }
  if (file.empty()) return;
  film_.options.depth_url = file;
  const auto opened = openDepth(color);
  const bool is_depth =
      opened && mayBeDepthOf(film_.backends, film_.options.url, color, file, film_.sources.depth()->stream());
  if (is_depth) {
    notes.push_back(print("depth is read from %s beside the film; --depth FILE chooses another", file.c_str()));
    return;
  }
  if (!opened)
    notes.push_back(
        print("%s lies beside the film but cannot be read as depth: %s", file.c_str(), opened.error().message));
  film_.options.depth_url.clear();
  film_.failed_thing.clear();
  film_.sources.dropDepth();
}

Result<void> FilmInputs::selectDepth(const StreamInfo* stream, const StreamInfo& color) {
  film_.depth_beside = {.stream = stream};
  if (!film_.options.depth_url.empty()) return openDepth(color);
  if (stream == nullptr) return {};
  const auto number = film_.sources.color()->select(film_.asTold(*stream));
  if (number) film_.depth_beside.track = *number;
  else if (film_.isDepthRequired()) return film_.failOn(film_.depthUrl(), number.error());
  else film_.depth_beside.refused = number.error();
  return {};
}

// From a source of its own; nothing to do if it has stayed open.
Result<void> FilmInputs::openDepth(const StreamInfo& color) {
  if (film_.sources.depth()) return {};
  const auto rate = rateForDepth(film_.options.frames_per_s, color);
  auto taken = film_.sources.take(std::make_unique<DepthSource>(film_.backends, rate));
  if (!taken) return film_.failOn(film_.depthUrl(), taken.error());
  auto opened = film_.sources.depth()->open(film_.depthUrl());
  if (!opened) return film_.failOn(film_.depthUrl(), opened.error());
  const StreamInfo& pictures = film_.sources.depth()->stream();
  if (rate && !film_.options.frames_per_s && pictures.counted && pictures.average_rate.known()) {
    film_.info.notes.push_back(
        print("the depth pictures have no times: %.6g a second assumed, as in the film; --fps F changes that", *rate));
  }
  return {};
}

void FilmInputs::countTracks(const TrackPlan& plan) {
  const auto count = [this](StreamKind kind) {
    return static_cast<int>(std::ranges::count(film_.sources.color()->source().streams(), kind, &StreamInfo::kind));
  };
  film_.info.sound_tracks = count(StreamKind::Audio);
  film_.info.subtitle_tracks = count(StreamKind::Subtitle);
  film_.info.video_tracks_unused =
      count(StreamKind::Video) - (plan.depth == nullptr ? 1 : 2) - (plan.material == nullptr ? 0 : 1);
}

// Once: when the source is opened again, the choice stays.
void FilmInputs::listTracks() {
  FilmInfo& info = film_.info;
  if (!info.sounds.empty() || !info.subtitles.empty()) return;
  const auto& streams = film_.sources.color()->source().streams();
  info.sounds = tracksOf(streams, StreamKind::Audio);
  info.subtitles = tracksOf(streams, StreamKind::Subtitle);
  for (FilmTrack& file : subtitleFilesOf(film_.options.url)) info.subtitles.push_back(std::move(file));
  info.sound = chooseSound(info.sounds, film_.options.sound_languages);
  info.words = chooseSubtitles(info.subtitles, film_.options.subtitle_languages, film_.options.desktop_language);
}

}  // namespace relievo
