// SPDX-License-Identifier: Apache-2.0
// Opens a film, finds its colour and depth, and aligns the clocks of two sources.
#include <algorithm>
#include <utility>

#include "app/media/film_folder.h"
#include "app/media/frame_rate.h"
#include "app/media/pairs/pair_film.h"
#include "app/media/registration/own_registration.h"
#include "platform/print.h"
#include "platform/text/plain_text.h"

namespace relievo {
namespace {

constexpr Duration kSameClock = std::chrono::seconds(20);   // two streams of one sender differ by less than this
constexpr Duration kLongestWait = std::chrono::seconds(5);  // for the depth of a live film to begin
constexpr const char* kNoPicture =
    "not one picture of its video could be decoded; it is empty, damaged, unknown, or has more than 16.7 million "
    "samples";

// Pictures whose names are from one clock or one count keep their distance if most of the shorter series lies within
// the other; else the two begin together.
Duration distanceByName(const MediaSource& color, const DepthSource::Session& depth) {
  const bool known = color.namedStart() && depth.named_start && color.duration() > Duration(0);
  if (!known || depth.duration == Duration(0)) return Duration(0);
  const Duration distance = *depth.named_start - *color.namedStart();
  const Duration common = std::min(color.duration(), distance + depth.duration) - std::max(Duration(0), distance);
  return 2 * common >= std::min(color.duration(), depth.duration) ? distance : Duration(0);
}

// The frame rate of depth pictures without times: the user's, else that of the film that they were recorded with.
std::optional<double> rateForDepth(std::optional<double> told, const StreamInfo& color) {
  if (told || color.counted || !color.average_rate.known()) return told;
  return static_cast<double>(color.average_rate.num) / color.average_rate.den;
}

}  // namespace

Result<void> PairReader::Impl::openReader() {
  auto taken = sources.take(std::make_unique<TrackReader>(backends.make_source(options.url), backends.make_decoder));
  if (!taken) return failOn(options.url, taken.error());
  if (auto opened = sources.color()->open(options.url, options.frames_per_s); !opened)
    return failOn(options.url, opened.error());
  return {};
}

// A folder of a film and its depth pictures is opened as both.
void PairReader::Impl::takeFilmOverDepth() {
  if (!options.depth_url.empty() || options.packing != Packing::Auto) return;
  const auto pair = filmOverDepth(options.url);
  if (!pair) return;
  options.url = pair->film;
  options.depth_url = pair->depth;
}

// Opens for the first time or again. In the second case a separate depth source has continued meanwhile, and what one
// picture holds beside its colour stays: its first picture may be dark now, and its tags may come later.
Result<void> PairReader::Impl::openFilm() {
  takeFilmOverDepth();
  const bool two_sources = !options.depth_url.empty();
  if (two_sources && relievo::isPacked(options.packing)) {
    return failOn(options.depth_url,
                  {ErrorCode::InvalidArgument, 0,
                   "depth cannot be packed into the picture and come from a second source as well; leave out "
                   "--packing or --depth"});
  }
  if (auto opened = openReader(); !opened) return opened;
  const MediaSource& source = sources.color()->source();
  const bool known = depth || isInOnePicture();
  if (!known) lookAround();
  const auto plan = planFilm();
  if (!plan) return failOn(options.url, plan.error());
  if (!known || info.packing == Packing::Tracks) info.packing = plan->packing;
  info.duration = source.duration();
  info.container_start = source.senderStart().value_or(Duration(0));
  info.notes = source.notes();
  remote = source.remote();
  live = source.live();

  if (isPacked() && options.registration) {
    return failOn(options.url, {ErrorCode::InvalidArgument, 0,
                                "depth that is packed into the picture is in the colour's view already; leave the "
                                "registration out"});
  }

  // The first track selected leads, so the colour is selected first.
  const auto chosen = sources.color()->select(asTold(*plan->color));
  if (!chosen) return failOn(options.url, chosen.error());
  if (plan->depth == nullptr && !isPacked() && !two_sources && options.packing == Packing::Auto)
    takeDepthBeside(*plan->color);
  if (auto selected = selectDepth(plan->depth, *plan->color); !selected) return selected;
  const auto of_places = plan->material ? std::optional(asTold(*plan->material)) : std::nullopt;
  material.select(*sources.color(), of_places, color_shift);
  if (!known || info.has_depth) info.material_scale = withoutThoseOf(options.material, material.scale());
  if (sources.depth())
    info.notes.insert(info.notes.end(), sources.depth()->notes().begin(), sources.depth()->notes().end());
  countTracks(*plan);
  openSound();
  openWords();
  if (auto opened = openColor(*plan->color); !opened) return opened;
  if (known && isInOnePicture()) return measureHalves();
  if (auto opened = openDepth(*plan->color); !opened) return opened;
  if (isStereo(options.packing)) checkViews(*plan->color);
  takeDepthFromViews();
  if (!info.has_depth) info.material_scale = {};
  return {};
}

void PairReader::Impl::takeDepthBeside(const StreamInfo& color) {
  const std::string file = depthBeside(options.url);
  if (file.empty()) return;
  options.depth_url = file;
  const auto opened = selectDepth(nullptr, color);
  if (opened) {
    info.notes.push_back(print("depth is read from %s beside the film; --depth FILE chooses another", file.c_str()));
    return;
  }
  info.notes.push_back(
      print("%s lies beside the film but cannot be read as depth: %s", file.c_str(), opened.error().message));
  options.depth_url.clear();
  failed_thing.clear();
  sources.dropDepth();
}

// Decodes two pictures, whose timestamps give the frame period.
Result<void> PairReader::Impl::openColor(const StreamInfo& color) {
  while (color_ahead.size() < 2) {
    auto frame = readColor();
    if (!frame) return failOn(options.url, frame.error());
    if (!*frame) break;
    color_ahead.push_back(std::move(**frame));
  }
  if (color_ahead.empty()) return failOn(options.url, {ErrorCode::Corrupt, 0, kNoPicture});
  info.color_width = color_ahead[0].width;
  info.color_height = color_ahead[0].height;
  info.color_stream = color.index;
  info.color_codec = color.codec;
  info.color_decoder = sources.color()->decoder(kColorTrack);
  if (color_ahead.size() == 2) info.frame_period = framePeriod(color_ahead[1].pts - color_ahead[0].pts, color);
  info.interlaced = sources.color()->deinterlaced() > 0;
  info.color_primaries = color_ahead[0].primaries;
  info.color_transfer = color_ahead[0].transfer;
  const bool depth_is_counted = sources.depth() && sources.depth()->stream().counted;
  if (options.frames_per_s && !color.counted && !depth_is_counted) {
    info.notes.emplace_back("--fps has no effect: the pictures have times of their own");
  }
  return {};
}

Result<void> PairReader::Impl::selectDepth(const StreamInfo* stream, const StreamInfo& color) {
  depth_beside.track.reset();
  depth_beside.stream = stream;
  if (!options.depth_url.empty()) {
    if (sources.depth()) return {};
    const auto rate = rateForDepth(options.frames_per_s, color);
    auto taken = sources.take(std::make_unique<DepthSource>(backends, rate));
    if (!taken) return failOn(depthUrl(), taken.error());
    if (auto opened = sources.depth()->open(depthUrl()); !opened) return failOn(depthUrl(), opened.error());
    const StreamInfo& pictures = sources.depth()->stream();
    if (rate && !options.frames_per_s && pictures.counted && pictures.average_rate.known()) {
      info.notes.push_back(print(
          "the depth pictures have no times: %.6g a second assumed, as in the film; --fps F changes that", *rate));
    }
    return {};
  }
  if (stream == nullptr) return {};
  const auto number = sources.color()->select(asTold(*stream));
  if (number) {
    depth_beside.track = *number;
  } else if (isDepthRequired()) {
    return failOn(depthUrl(), number.error());
  } else {
    loseDepth(number.error());
  }
  return {};
}

// A recording of two cameras may contain their relative position.
void PairReader::Impl::lookForRegistration(const StreamInfo& color) {
  if (options.registration) {
    registrar.emplace(*options.registration);
  } else if (const auto recorded = depth_beside.track
                                       ? ownRegistration(sources.color()->source(), color, *depth_beside.stream)
                                       : std::nullopt) {
    registrar.emplace(*recorded);
    clues.why.emplace_back("the recording describes both cameras: its depth is moved to the colour's view");
  }
}

Result<void> PairReader::Impl::openDepth(const StreamInfo& color) {
  lookForHalves(color);
  if (info.packing == Packing::DepthAlone) return describeAlone(color);
  if (isPacked()) return describeHalves(color);
  if (!depth_beside.track && !sources.depth()) return {};
  if (depth) {  // already known from the first opening
    depth->restart();
    own.lost = false;
    return {};
  }
  if (info.packing == Packing::StereoTracks) {
    depth.emplace([this] { return supplyDepth(); });
    const bool told = options.packing == Packing::StereoTracks;
    showViews(Packing::StereoTracks, told ? "the command line says" : "the film's tags say");
    return {};
  }
  lookForRegistration(color);
  depth.emplace([this] { return supplyDepth(); });
  const auto first = firstDepth();
  if (first && *first != nullptr) {
    if (!sources.depth()) return describeTrack(**first);
    const MediaTime begins = (*first)->pts;
    auto described = describeTrack(**first);
    // With two live sources the second opens later; pictures of the first from before that are dropped.
    const bool later = described && live && begins > MediaTime{} && begins < MediaTime(kLongestWait);
    if (!later) return described;
    if (auto passed = passTo(begins); !passed) return std::unexpected(passed.error());
    return {};
  }
  const Error missing = first ? Error{ErrorCode::Corrupt, 0, kNoPicture} : first.error();
  if (isDepthRequired() || missing.code == ErrorCode::Cancelled) return failOn(depthUrl(), missing);
  loseDepth(missing);
  depth_beside.track.reset();
  depth.reset();
  return {};
}

void PairReader::Impl::countTracks(const TrackPlan& plan) {
  const auto& streams = sources.color()->source().streams();
  const auto count = [&](StreamKind kind) {
    return static_cast<int>(
        std::count_if(streams.begin(), streams.end(), [&](const StreamInfo& s) { return s.kind == kind; }));
  };
  const auto& tags = sources.color()->source().tags();
  const auto title = tags.find("TITLE");
  info.title = title == tags.end() ? "" : oneLine(title->second);
  if (info.title.find_first_not_of(' ') == std::string::npos) info.title.clear();
  info.chapters = sources.color()->source().chapters();
  std::ranges::sort(info.chapters, {}, &Chapter::begin);
  if (info.sounds.empty() && info.subtitles.empty()) {  // not when the source is opened again
    info.sounds = tracksOf(streams, StreamKind::Audio);
    info.subtitles = tracksOf(streams, StreamKind::Subtitle);
    for (FilmTrack& file : subtitleFilesOf(options.url)) info.subtitles.push_back(std::move(file));
    info.sound = chooseSound(info.sounds, options.sound_languages);
    info.words = chooseSubtitles(info.subtitles, options.subtitle_languages, options.desktop_language);
  }
  info.sound_tracks = count(StreamKind::Audio);
  info.subtitle_tracks = count(StreamKind::Subtitle);
  info.video_tracks_unused =
      count(StreamKind::Video) - (plan.depth == nullptr ? 1 : 2) - (plan.material == nullptr ? 0 : 1);
}

// Computes the shift that aligns a new session of the depth source with the colour.
void PairReader::Impl::meet(const DepthSource::Session& session, MediaTime first) {
  if (own.session) depth->restart();
  own.session = session.number;
  const MediaSource& color = sources.color()->source();
  own.shift = session.live ? Duration(0) : distanceByName(color, session);
  if (!session.live) return;
  if (!color.live()) {  // align what arrives now with what is shown now
    own.shift = goes_on_at - first;
    return;
  }
  const Duration by_arrival = session.arrival - color.arrival();
  Duration distance = by_arrival;
  if (session.sender_start && color.senderStart()) {
    const Duration by_sender = *session.sender_start - *color.senderStart();
    if (std::chrono::abs(by_sender - by_arrival) < kSameClock) distance = by_sender;
  }
  own.shift = distance + color_shift;
}

}  // namespace relievo
