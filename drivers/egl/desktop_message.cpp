// SPDX-License-Identifier: Apache-2.0
// SDL's own message box, which needs no GL. It does not break lines itself.
#include <SDL_messagebox.h>
#include <pthread.h>
#include <sys/prctl.h>

#include <csignal>
#include <sstream>

#include "drivers/egl/egl.h"

namespace relievo {

void tellOnDesktop(const std::string& message) {
  constexpr std::size_t kColumns = 72;
  std::istringstream words(message);
  std::string text;
  std::size_t column = 0;
  for (std::string word; words >> word;) {
    const bool fits = column == 0 || column + 1 + word.size() <= kColumns;
    if (!text.empty()) text += fits ? ' ' : '\n';
    column = fits ? column + 1 + word.size() : word.size();
    text += word;
  }
  // SDL shows it from a process of its own, which would outlive this one.
  ::pthread_atfork(nullptr, nullptr, [] { ::prctl(PR_SET_PDEATHSIG, SIGTERM); });
  if (desktopIsThere()) SDL_ShowSimpleMessageBox(SDL_MESSAGEBOX_ERROR, "relievo", text.c_str(), nullptr);
}

}  // namespace relievo
