// SPDX-License-Identifier: Apache-2.0
// A line for each value.
#include "app/player/screen/notices.h"

#include <cmath>
#include <cstdlib>

#include "app/player/screen/stereo_word.h"
#include "platform/print.h"

namespace relievo {
namespace {

ScreenNotice volumeNotice(const ScreenFacts& facts) {
  constexpr double kWhole = 130;  // the loudest
  if (facts.muted) return {"Sound off", 0};
  return {print("Volume %.0f %%", facts.volume_percent), facts.volume_percent / kWhole};
}

std::string delayWords(const char* what, double delay_s) {
  const long ms = std::lround(1e3 * delay_s);
  if (ms == 0) return std::string(what) + " on time";
  return print("%s %ld ms %s", what, std::labs(ms), ms > 0 ? "later" : "earlier");
}

std::string rateWords(double rate) {
  return rate >= 1 ? print("Speed %gx", rate) : print("Speed 1/%gx", 1 / rate);
}

}  // namespace

std::optional<ScreenNotice> noticeOf(const PlayerCommand& command, const ScreenFacts& facts) {
  const auto words = [](const std::string& text) { return ScreenNotice{text, std::nullopt}; };
  switch (command.verb) {
    case PlayerVerb::Faster:
    case PlayerVerb::Slower:
    case PlayerVerb::NormalSpeed:
      return words(rateWords(facts.rate));
    case PlayerVerb::Loop:
      return words(facts.loop ? "Repeat: on" : "Repeat: off");
    case PlayerVerb::Layout:
      return words("3D: " + stereoTitle(facts.stereo));
    case PlayerVerb::SwapEyes:
      return words(facts.stereo.swap_eyes ? "Eyes swapped" : "Eyes not swapped");
    case PlayerVerb::DepthBy:
      return ScreenNotice{print("Depth %.0f %%", 100 * facts.stereo.strength),
                          facts.stereo.strength / StereoSettings::kMostStrength};
    case PlayerVerb::ScreenBy:
      return words(print("Screen plane at %.0f mm of the depth", facts.stereo.screen_z_mm));
    case PlayerVerb::ZoomBy:
      return words(print("Zoom %.0f %%", 100 * facts.stereo.zoom));
    case PlayerVerb::Aspect:
      return words("Shape: " + facts.aspect);
    case PlayerVerb::RotateBy:
      return words(facts.turned_degrees == 0 ? "Not turned" : print("Turned by %d°", facts.turned_degrees));
    case PlayerVerb::VolumeBy:
    case PlayerVerb::VolumeTo:
    case PlayerVerb::Mute:
      return volumeNotice(facts);
    case PlayerVerb::AudioTrack:
      return words("Sound: " + facts.sound_track);
    case PlayerVerb::AudioDelayBy:
      return words(delayWords("Sound", facts.sound_delay_s));
    case PlayerVerb::SubtitleTrack:
    case PlayerVerb::ShowSubtitles:
      return words("Subtitles: " + facts.subtitle_track);
    case PlayerVerb::SubtitleDelayBy:
      return words(delayWords("Subtitles", facts.subtitle_delay_s));
    case PlayerVerb::SubtitleSizeBy:
      return words(print("Subtitles %.0f %%", 100 * facts.subtitle_size));
    case PlayerVerb::ChapterBy:
      return words("Chapter " + facts.chapter);
    case PlayerVerb::LoopAB:
      return words(!facts.loop_from_s ? "A-B loop off" : !facts.loop_to_s ? "A-B loop: from here" : "A-B loop: on");
    default:
      return std::nullopt;
  }
}

}  // namespace relievo
