// SPDX-License-Identifier: Apache-2.0
// What people type who know mpv, VLC or MPlayer.
#include <sstream>
#include <string>

#include "app/cli/options.h"
#include "app/player/setup/play_options.h"

namespace relievo {
namespace {

struct Answer {
  const char* options;
  const char* words;
};
constexpr Answer kAnswers[] = {
    {"--ss --start-time", "no such option; use --start TIME"},
    {"--loop-file --loop-playlist --repeat", "no such option; use --loop"},
    {"--fullscreen --full-screen", "no such option; use --fs, or the key f while it plays"},
    {"--pause --start-paused", "no such option; the space bar pauses the film"},
    {"--mute --no-audio --nosound", "no such option; use --audio none, or the key m while it plays"},
    {"--speed", "no such option; the keys [ and ] change it while the film plays"},
    {"--sub-file --sub-files --sub",
     "no such option; subtitles lie beside the film by its name: film.mkv, film.srt; or drop them on it"},
    {"--sid --no-sub", "no such option; use --slang LANG, or the keys v and j while it plays"},
    {"--aid", "no such option; use --alang LANG, or the key # while it plays"},
    {"--vo", "no such option; use --display NAME"},
    {"--ao", "no such option; use --audio NAME"},
    {"--hwdec", "no such option; the video hardware decodes where it can; --software does without it"},
    {"--geometry", "no such option; use --size WxH"},
    {"--playlist", "no such option; a playlist is given like a film"},
};

}  // namespace

void answerOptionsOfOthers(CLI::App& command) {
  for (const Answer& answer : kAnswers) {
    std::istringstream names(answer.options);
    for (std::string name; names >> name;) {
      const auto refuse = [name, words = answer.words](const CLI::results_t&) -> bool {
        throw WordFailure({name, {ErrorCode::InvalidArgument, 0, words}});
      };
      command.add_option(name, refuse)->expected(0)->group("")->configurable(false);  // with a value and without
    }
  }
}

}  // namespace relievo
