// SPDX-License-Identifier: Apache-2.0
// Reports a source's counters and signalling as notes for the author.
#include "app/author/package/source_notes.h"
#include "platform/print.h"

namespace relievo {
namespace {

using Notes = std::vector<std::string>;

void tell(Notes& notes, std::uint64_t count, const char* what) {
  if (count > 0) notes.push_back(std::to_string(count) + what);
}

// ITU-T H.273.
void tellColor(Notes& notes, const FilmFormat& format) {
  constexpr std::uint8_t kPq = 16, kHlg = 18, kBt2020 = 9, kDciP3 = 11, kDisplayP3 = 12;
  if (format.color_transfer == kPq || format.color_transfer == kHlg) {
    notes.push_back(
        print("the colour is HDR (%s): in 8 bits it shows visible steps and loses its brightness metadata; "
              "convert it to SDR first",
              format.color_transfer == kPq ? "PQ" : "HLG"));
    return;
  }
  for (const std::uint8_t wide : {kBt2020, kDciP3, kDisplayP3}) {
    if (format.color_primaries == wide) {
      notes.emplace_back(
          "the colour has wide primaries: the film signals them, but the player shows them as BT.709, too pale; "
          "convert it to BT.709 first");
    }
  }
}

void tellClipped(Notes& notes, const FilmInfo& info, const DepthCoder::Counts& codes) {
  if (codes.clipped == 0) return;
  const DepthCalibration& c = info.calibration.calibration;
  notes.push_back(
      print("%.3g %% of the depth was outside the codes %.0f .. %.0f and was clipped; if that range is "
            "wrong, give the codes with --calibration",
            100 * static_cast<double>(codes.clipped) / static_cast<double>(codes.samples), c.lowCode(), c.highCode()));
}

}  // namespace

std::vector<std::string> notKept(const FilmInfo& info, const KeptWishes& keep) {
  Notes notes;
  const auto tracks = [&notes](int count, const char* kind) {
    if (count == 0) return;
    notes.push_back(print("%d %s %s left out: only a file's are kept; record the source to a file first", count, kind,
                          count == 1 ? "track is" : "tracks are"));
  };
  if (keep.sound) tracks(info.sound_tracks, "sound");
  if (keep.subtitles) tracks(info.subtitle_tracks, "subtitle");
  return notes;
}

std::vector<std::string> sourceNotes(const std::vector<LostPart>& lost, const FilmInfo& info,
                                     const PairCounters& counters, const FilmFormat& format,
                                     const DepthCoder::Counts& codes) {
  Notes notes;
  for (const LostPart& part : lost) notes.push_back(toText(part));
  tell(notes, counters.without_depth, " colour pictures have no depth: the depth begins later or ends earlier");
  tell(notes, counters.mismatched, " colour pictures lacked their depth picture; the previous one was held");
  tell(notes, counters.depth_skipped, " depth pictures matched no colour picture and were left out");
  tell(notes, counters.missed_pictures, " camera pictures were lost on the way");
  if (const int more = info.video_tracks_unused; more > 0) {
    notes.push_back(print("%d more video %s left out; if the depth is one of them, save it to a file for --depth", more,
                          more == 1 ? "track is" : "tracks are"));
  }
  if (!info.material_scale.empty() && format.material_width == 0) {
    notes.emplace_back(
        "the material track is left out: it begins after the first picture, or its codes are not of full range");
  }
  tell(
      notes, counters.deinterlaced,
      " pictures were interlaced: each was made of its first field; for more detail deinterlace the source first, with "
      "FFmpeg's bwdif");
  tellColor(notes, format);
  tellClipped(notes, info, codes);
  notes.insert(notes.end(), info.notes.begin(), info.notes.end());
  notes.insert(notes.end(), info.reading.doubts.begin(), info.reading.doubts.end());
  return notes;
}

}  // namespace relievo
