// SPDX-License-Identifier: Apache-2.0
// Finds out whether a film's one picture holds more than its colour: two views of one scene, or depth in its alpha
// channel.
#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "app/media/pairs/film_meaning.h"
#include "app/media/reading/picture_look.h"
#include "app/media/reading/stereo/stereo_pair.h"
#include "hal/media/media_names.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr const char* kViews = "two views of one scene (stereo), no depth";
constexpr const char* kShown =
    "shown in stereo, without touch; --depth-from stereo makes depth from them: while they play, or better beforehand "
    "with relievo-author";
constexpr const char* kOtherPictures =
    "the halves of its picture do not show one scene: it is no film of two views; leave --packing out";
constexpr const char* kHasDepth = "--depth-from is left out: the film has depth of its own";
constexpr const char* kOneView =
    "--depth-from stereo is left out: the film has one view; if it has two, state their layout with --packing "
    "stereo-sbs or stereo-tb";
constexpr const char* kSecondMissing =
    "it is coded as two views (MV-HEVC), but contains only the first: it plays as 2D";
constexpr const char* kSecondUnread =
    "its second view (MV-HEVC) cannot be decoded, and it plays as 2D: the second needs FFmpeg 7.1 or later, and the "
    "film's parameters of that view";
constexpr const char* kWhatToDo = "it plays flat; give its depth with --depth FILE, or --packing if a half is depth";

struct SaidViews {
  const char* by = "";
  Packing packing = Packing::Auto;  // Auto: a way to store two views that is not shown
  bool right_first = false;
};

// Matroska's StereoMode, or what the driver writes for mp4's st3d, in FFmpeg's words.
std::optional<SaidViews> viewsByTag(const StreamInfo& track) {
  constexpr const char* kBy = "the film's tags say";
  const auto mode = track.tags.find("STEREO_MODE");
  if (mode == track.tags.end() || mode->second == "mono" || mode->second == "0") return std::nullopt;
  const std::string& word = mode->second;
  if (word == "left_right" || word == "right_left")
    return SaidViews{kBy, Packing::StereoSideBySide, word == "right_left"};
  if (word == "top_bottom" || word == "bottom_top")
    return SaidViews{kBy, Packing::StereoTopBottom, word == "bottom_top"};
  return SaidViews{kBy};
}

std::optional<SaidViews> viewsByPicture(const Frame& picture) {
  constexpr const char* kBy = "its coded pictures say";
  switch (picture.views.way) {
    case ViewLayout::Way::OneView:
      return std::nullopt;
    case ViewLayout::Way::SideBySide:
      return SaidViews{kBy, Packing::StereoSideBySide, picture.views.right_first};
    case ViewLayout::Way::TopBottom:
      return SaidViews{kBy, Packing::StereoTopBottom, picture.views.right_first};
    case ViewLayout::Way::Other:
      break;
  }
  return SaidViews{kBy};
}

// Without a header, a JPS holds its views for cross-eyed viewing.
std::optional<SaidViews> saidViews(const StreamInfo& track, const Frame& picture, const std::string& url) {
  if (const auto tag = viewsByTag(track)) return tag;
  if (const auto coded = viewsByPicture(picture)) return coded;
  if (endingOf(url) == "jps") return SaidViews{"its ending .jps says", Packing::StereoSideBySide, true};
  return std::nullopt;
}

// Looking Glass's quilts hold many views, whose number is in the name: "sea_qs8x6a0.75.png". Empty if it is none.
std::string quiltLine(const std::string& url) {
  constexpr std::string_view kQuilt = "_qs";
  const std::size_t at = url.rfind(kQuilt);
  if (at == url.npos) return "";
  const char* const end = url.data() + url.size();
  int across = 0, down = 0;
  const auto columns = std::from_chars(url.data() + at + kQuilt.size(), end, across);
  if (columns.ec != std::errc() || columns.ptr == end || *columns.ptr != 'x') return "";
  const auto rows = std::from_chars(columns.ptr + 1, end, down);
  if (rows.ec != std::errc() || rows.ptr == end || *rows.ptr != 'a') return "";
  return print("its name says a quilt of %d x %d views, no depth; %s", across, down, kWhatToDo);
}

}  // namespace

// Two views in two layers. False if there are none.
bool FilmMeaning::takeLayers(const StreamInfo& color, const std::deque<Frame>& pictures) {
  const auto layers = color.tags.find(kLayersTag);
  const bool decoded = std::ranges::any_of(pictures, [](const Frame& frame) { return frame.right != nullptr; });
  if (decoded) showViews(Packing::StereoLayers, "the two layers of its pictures (MV-HEVC) are");
  else if (layers != color.tags.end())
    film_.info.reading.doubts.emplace_back(layers->second == "2" ? kSecondUnread : kSecondMissing);
  return decoded;
}

// Two views, as stated by the film itself. False if it states nothing.
bool FilmMeaning::takeSaidViews(const StreamInfo& color, const Frame& look, const std::deque<Frame>& pictures) {
  if (takeLayers(color, pictures)) return true;
  const auto said = saidViews(color, look, film_.options.url);
  if (!said) return false;
  form_.right_first = said->right_first;
  const auto squeezed = color.tags.find(kSqueezedTag);
  if (squeezed != color.tags.end()) form_.squeezed = squeezed->second == "1";
  if (said->packing == Packing::Auto)
    film_.info.reading.doubts.push_back(
        print("%s %s, in a layout that is not supported; %s", said->by, kViews, kWhatToDo));
  else showViews(said->packing, said->by);
  return true;
}

// By the likeness of the halves, and the break or the black bars between them.
void FilmMeaning::lookForViews(const Frame& look) {
  if (std::string quilt = quiltLine(film_.options.url); !quilt.empty()) {
    film_.info.reading.doubts.push_back(std::move(quilt));
    return;
  }
  const auto found = findViews(look);
  if (!found) return;
  const bool beside = *found == Packing::StereoSideBySide;
  const std::string halves = beside ? "the left and right halves" : "the upper and lower halves";
  if (breaksInTheMiddle(look, beside) || barsMeetInTheMiddle(look, *found))
    showViews(*found, (halves + " are").c_str());
  else
    film_.info.reading.doubts.push_back(
        print("%s may be %s; if so, --packing %s", halves.c_str(), kViews, name(*found)));
}

void FilmMeaning::showViews(Packing packing, const char* by) {
  film_.info.packing = packing;
  if (film_.options.depth_from == DepthFrom::Film)
    film_.info.reading.doubts.push_back(print("%s %s; %s", by, kViews, kShown));
}

// Checks whether the picture can be what the user has stated.
void FilmMeaning::checkViews(const StreamInfo& color, const Frame& picture) {
  const Frame look = scout_.tellingPicture(picture, film_.options.url, color.index);
  const auto seen = viewsOf(look, film_.info.packing, form_.right_first);
  if (!seen || !areOtherPictures(seen->left, seen->right)) return;
  views_disproved_ = true;
  film_.info.reading.doubts.emplace_back(kOtherPictures);
}

void FilmMeaning::takeViewTracks() {
  const bool told = film_.options.packing == Packing::StereoTracks;
  showViews(Packing::StereoTracks, told ? "the command line says" : "the film's tags say");
}

void FilmMeaning::readViews(const StreamInfo& color, const std::deque<Frame>& pictures) {
  if (isStereo(film_.options.packing)) checkViews(color, pictures[0]);
  takeDepthFromViews();
}

// Depth that is made of each pair's views after it was read.
void FilmMeaning::takeDepthFromViews() {
  if (film_.options.depth_from != DepthFrom::Views || views_disproved_) return;
  if (!hasTwoViews(film_.info.packing)) {
    film_.info.reading.doubts.emplace_back(film_.info.has_depth ? kHasDepth : kOneView);
    return;
  }
  film_.info.has_depth = film_.info.depth_from_views = true;
  film_.info.calibration.calibration = {.law = DepthLaw::Linear, .range = ColorRange::Full, .bits = 16};
  film_.info.reading.parts = {{"kind", "made from its two views as they play", CalibrationOrigin::CommandLine}};
}

// Takes the alpha channel as depth, or reports that it may be a matte.
bool FilmMeaning::lookForAlpha(const StreamInfo& color, const Frame& look) {
  const auto alpha = lookAtAlpha(look);
  if (!alpha) {
    if (saysAlpha(color))
      film_.info.reading.doubts.emplace_back("its alpha channel cannot be decoded here: that needs FFmpeg with libvpx");
    return false;
  }
  if (!isAlphaDepth(*alpha)) {
    if (alpha->shades > 1)
      film_.info.reading.doubts.emplace_back(
          "its alpha channel is taken for transparency; if it is depth: --packing alpha");
    return false;
  }
  film_.info.packing = Packing::Alpha;
  clues_.packing_by = CalibrationOrigin::FirstPicture;
  clues_.why.push_back(
      print("depth in the alpha channel: %d shades, %.0f %% of its samples neither transparent nor opaque",
            alpha->shades, 100 * alpha->between));
  return true;
}

}  // namespace relievo
