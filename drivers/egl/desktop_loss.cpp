// SPDX-License-Identifier: Apache-2.0
// Xlib ends the program by itself in its next call. A thread waits for the case that this call never comes.
#include "drivers/egl/desktop_loss.h"

#include <SDL.h>
#include <SDL_syswm.h>
#include <poll.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <system_error>
#include <thread>
#include <utility>

#include "platform/log.h"

namespace relievo {
namespace {

constexpr int kExitCode = 1;
constexpr std::chrono::seconds kPatience{1};  // for Xlib's own end, in the thread that draws

std::atomic<bool> is_ending = false;

void tellLoss() noexcept {
  log(LogLevel::Error, "window", "the X server has ended or the connection to it is broken; start relievo again");
}

int onIoError(::Display*) {
  tellLoss();
  std::exit(kExitCode);
}

void waitForEnd(int connection) noexcept {
  pollfd end{.fd = connection, .events = POLLRDHUP, .revents = 0};
  while (::poll(&end, 1, -1) <= 0) continue;  // a signal
  std::this_thread::sleep_for(kPatience);
  if (is_ending) return;
  tellLoss();
  std::quick_exit(kExitCode);
}

template <class Function>
Function* find(void* library, const char* name) noexcept {
  return reinterpret_cast<Function*>(SDL_LoadFunction(library, name));
}

}  // namespace

void endWithXServer(SDL_Window& window) noexcept {
  static bool begun = false;
  if (std::exchange(begun, true)) return;
  SDL_SysWMinfo info{};
  SDL_VERSION(&info.version);
  if (SDL_GetWindowWMInfo(&window, &info) != SDL_TRUE || info.subsystem != SDL_SYSWM_X11) return;
  void* const x11 = SDL_LoadObject("libX11.so.6");  // the one that SDL has loaded; it stays
  if (x11 == nullptr) return;
  const auto on_error = find<XIOErrorHandler(XIOErrorHandler)>(x11, "XSetIOErrorHandler");
  const auto number = find<int(::Display*)>(x11, "XConnectionNumber");
  if (on_error == nullptr || number == nullptr) return;
  on_error(onIoError);
  std::atexit([] { is_ending = true; });
  try {
    std::thread(waitForEnd, number(info.info.x11.display)).detach();
  } catch (const std::system_error& error) {  // Xlib's end alone is left
    log(LogLevel::Debug, "render", "the X server is not watched: %s", error.what());
  }
}

}  // namespace relievo
