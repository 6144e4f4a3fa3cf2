// SPDX-License-Identifier: Apache-2.0
// Starts Xvfb and drives it by Xlib and XTest.
#include "tests/support/machine/x_screen.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>

namespace relievo::test {
namespace {

constexpr int kPatienceMs = 20'000;

// The display number that Xvfb writes when it is ready; empty if it failed.
std::string readDisplayNumber(int fd) {
  std::string number;
  pollfd ready{.fd = fd, .events = POLLIN, .revents = 0};
  char c = 0;
  while (::poll(&ready, 1, kPatienceMs) > 0 && ::read(fd, &c, 1) == 1 && c != '\n') number += c;
  return c == '\n' ? number : "";
}

Window childOf(Display* display, Window parent, const std::string& title) {
  Window root = 0, above = 0, *children = nullptr;
  unsigned count = 0;
  if (XQueryTree(display, parent, &root, &above, &children, &count) == 0) return 0;
  Window found = 0;
  for (unsigned i = 0; i < count && found == 0; ++i) {
    XTextProperty name{};  // SDL gives its message box's a type of its own
    XWindowAttributes attributes{};
    if (XGetWMName(display, children[i], &name) != 0 && reinterpret_cast<const char*>(name.value) == title &&
        XGetWindowAttributes(display, children[i], &attributes) != 0 && attributes.map_state == IsViewable) {
      found = children[i];
    }
    if (name.value != nullptr) XFree(name.value);
  }
  if (children != nullptr) XFree(children);
  return found;
}

// The next event of that type for the window; false if none comes.
bool waitFor(Display* display, Window window, int type, XEvent& event) {
  constexpr int kStepMs = 5;
  for (int waited_ms = 0; waited_ms < kPatienceMs; waited_ms += kStepMs) {
    if (XCheckTypedWindowEvent(display, window, type, &event) != 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(kStepMs));
  }
  return false;
}

void sendXdnd(Display* display, Window from, Window to, const char* type, const std::array<long, 4>& data) {
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = to;
  event.xclient.message_type = XInternAtom(display, type, False);
  event.xclient.format = 32;
  event.xclient.data.l[0] = static_cast<long>(from);
  for (std::size_t i = 0; i < data.size(); ++i) event.xclient.data.l[i + 1] = data[i];
  XSendEvent(display, to, False, NoEventMask, &event);
  XSync(display, False);
}

// Gives the dropped data to the window that asks for it.
void handOver(Display* display, const XSelectionRequestEvent& asked, const std::string& uri) {
  XChangeProperty(display, asked.requestor, asked.property, asked.target, 8, PropModeReplace,
                  reinterpret_cast<const unsigned char*>(uri.data()), static_cast<int>(uri.size()));
  XEvent answer{};
  answer.xselection.type = SelectionNotify;
  answer.xselection.requestor = asked.requestor;
  answer.xselection.selection = asked.selection;
  answer.xselection.target = asked.target;
  answer.xselection.property = asked.property;
  answer.xselection.time = asked.time;
  XSendEvent(display, asked.requestor, False, NoEventMask, &answer);
  XSync(display, False);
}

}  // namespace

std::unique_ptr<XScreen> XScreen::start() {
  int pipe[2] = {};
  if (::pipe(pipe) != 0) return nullptr;
  const std::string fd = std::to_string(pipe[1]);
  const std::string size = std::to_string(kWidth) + "x" + std::to_string(kHeight) + "x24";
  const pid_t server = ::fork();
  if (server == 0) {
    ::close(pipe[0]);
    const int silent = ::open("/dev/null", O_WRONLY);
    ::dup2(silent, STDOUT_FILENO);
    ::dup2(silent, STDERR_FILENO);
    ::execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", size.c_str(), "-nolisten", "tcp", "-noreset",
             nullptr);
    ::_exit(127);
  }
  ::close(pipe[1]);
  const std::string number = readDisplayNumber(pipe[0]);
  ::close(pipe[0]);
  const std::string name = ":" + number;
  Display* connection = number.empty() ? nullptr : XOpenDisplay(name.c_str());
  if (connection == nullptr) {
    ::kill(server, SIGKILL);
    ::waitpid(server, nullptr, 0);
    return nullptr;
  }
  XSelectInput(connection, DefaultRootWindow(connection), SubstructureNotifyMask);
  ::setenv("DISPLAY", name.c_str(), 1);
  ::unsetenv("WAYLAND_DISPLAY");
  ::setenv("DBUS_SESSION_BUS_ADDRESS", "disabled:", 1);  // keeps libraries from starting a session bus
  return std::unique_ptr<XScreen>(new XScreen(server, connection));
}

XScreen::~XScreen() {
  kill();
  ::unsetenv("DISPLAY");
}

void XScreen::kill(bool answered) {
  if (server_ <= 0) return;
  XCloseDisplay(connection_);  // before the server ends, or Xlib would end this program
  connection_ = nullptr;
  if (!answered) {
    ::kill(server_, SIGSTOP);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));  // the socket's buffer fills
  }
  ::kill(server_, SIGKILL);
  ::waitpid(server_, nullptr, 0);
  server_ = 0;
}

std::vector<std::array<int, 3>> XScreen::pixels(int x, int y, int width, int height) const {
  std::vector<std::array<int, 3>> all(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), {-1, -1, -1});
  XImage* image = XGetImage(connection_, DefaultRootWindow(connection_), x, y, static_cast<unsigned>(width),
                            static_cast<unsigned>(height), AllPlanes, ZPixmap);
  if (image == nullptr) return all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int at = static_cast<int>(i);
    const unsigned long value = XGetPixel(image, at % width, at / width);
    const auto part = [value](int shift) { return static_cast<int>(value >> shift & 0xff); };
    all[i] = {part(16), part(8), part(0)};
  }
  XDestroyImage(image);
  return all;
}

unsigned long XScreen::find(const std::string& title) const {
  for (int waited_ms = 0; waited_ms < kPatienceMs; waited_ms += 20) {
    if (const Window window = childOf(connection_, DefaultRootWindow(connection_), title)) return window;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return 0;
}

std::optional<XScreen::Place> XScreen::place(unsigned long window) const {
  XWindowAttributes attributes{};
  const auto before = XSetErrorHandler([](Display*, XErrorEvent*) { return 0; });  // of a window that is gone
  const bool there = XGetWindowAttributes(connection_, window, &attributes) != 0;
  XSetErrorHandler(before);
  if (!there) return std::nullopt;
  return Place{attributes.x, attributes.y, attributes.width, attributes.height};
}

void XScreen::setResources(const std::string& text) const {
  XChangeProperty(connection_, DefaultRootWindow(connection_), XA_RESOURCE_MANAGER, XA_STRING, 8, PropModeReplace,
                  reinterpret_cast<const unsigned char*>(text.data()), static_cast<int>(text.size()));
  XSync(connection_, False);
}

void XScreen::hide(unsigned long window) const {
  XUnmapWindow(connection_, window);
  XSync(connection_, False);
}

bool XScreen::isShown(unsigned long window) const {
  XWindowAttributes attributes{};
  return XGetWindowAttributes(connection_, window, &attributes) != 0 && attributes.map_state == IsViewable;
}

void XScreen::resize(unsigned long window, int width, int height) const {
  XResizeWindow(connection_, window, static_cast<unsigned>(width), static_cast<unsigned>(height));
  XSync(connection_, False);
}

void XScreen::move(unsigned long window, const Place& to) const {
  XMoveResizeWindow(connection_, window, to.x, to.y, static_cast<unsigned>(to.width), static_cast<unsigned>(to.height));
  XSync(connection_, False);
}

std::array<int, 2> XScreen::mouse() const {
  Window root = 0, child = 0;
  std::array<int, 2> on_screen{}, in_window{};
  unsigned buttons = 0;
  XQueryPointer(connection_, DefaultRootWindow(connection_), &root, &child, &on_screen[0], &on_screen[1], &in_window[0],
                &in_window[1], &buttons);
  return on_screen;
}

void XScreen::askToClose(unsigned long window) const {
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = window;
  event.xclient.message_type = XInternAtom(connection_, "WM_PROTOCOLS", False);
  event.xclient.format = 32;
  event.xclient.data.l[0] = static_cast<long>(XInternAtom(connection_, "WM_DELETE_WINDOW", False));
  XSendEvent(connection_, window, False, NoEventMask, &event);
  XSync(connection_, False);
}

void XScreen::focus(unsigned long window) const {
  XSetInputFocus(connection_, window, RevertToPointerRoot, CurrentTime);
  XSync(connection_, False);
}

std::optional<int> XScreen::takeFullScreenWish() const {
  const Atom state = XInternAtom(connection_, "_NET_WM_STATE", False);
  const Atom full = XInternAtom(connection_, "_NET_WM_STATE_FULLSCREEN", False);
  for (XEvent event; XCheckTypedEvent(connection_, ClientMessage, &event) != 0;) {
    if (event.xclient.message_type != state || static_cast<Atom>(event.xclient.data.l[1]) != full) continue;
    return static_cast<int>(event.xclient.data.l[0]);
  }
  return std::nullopt;
}

bool XScreen::drop(unsigned long window, const std::string& path) const {
  const auto atom = [this](const char* name) { return static_cast<long>(XInternAtom(connection_, name, False)); };
  const Window from = XCreateSimpleWindow(connection_, DefaultRootWindow(connection_), 0, 0, 1, 1, 0, 0, 0);
  XSetSelectionOwner(connection_, static_cast<Atom>(atom("XdndSelection")), from, CurrentTime);
  constexpr long kVersion = 5L << 24, kPlace = (20L << 16) | 20;
  XEvent event{};
  sendXdnd(connection_, from, window, "XdndEnter", {kVersion, atom("text/uri-list"), 0, 0});
  sendXdnd(connection_, from, window, "XdndPosition", {0, kPlace, CurrentTime, atom("XdndActionCopy")});
  bool taken = waitFor(connection_, from, ClientMessage, event);  // XdndStatus
  if (taken) {
    sendXdnd(connection_, from, window, "XdndDrop", {0, CurrentTime, 0, 0});
    taken = waitFor(connection_, from, SelectionRequest, event);
  }
  if (taken) handOver(connection_, event.xselectionrequest, "file://" + path + "\r\n");
  taken = taken && waitFor(connection_, from, ClientMessage, event);  // XdndFinished
  XDestroyWindow(connection_, from);
  return taken;
}

void XScreen::key(const char* name, bool down) const {
  const KeyCode code = XKeysymToKeycode(connection_, XStringToKeysym(name));
  XTestFakeKeyEvent(connection_, code, down ? True : False, CurrentTime);
  XSync(connection_, False);
}

bool XScreen::setLayout(const std::string& name) const {
  const std::string command = std::string("setxkbmap -display ") + XDisplayString(connection_) + " " + name;
  const bool set = std::system(command.c_str()) == 0;
  XSync(connection_, False);
  for (XEvent event; XCheckTypedEvent(connection_, MappingNotify, &event) != 0;)
    XRefreshKeyboardMapping(&event.xmapping);
  return set;
}

void XScreen::moveMouse(int x, int y) const {
  XTestFakeMotionEvent(connection_, 0, x, y, CurrentTime);
  XSync(connection_, False);
}

void XScreen::button(unsigned number, bool down) const {
  XTestFakeButtonEvent(connection_, number, down ? True : False, CurrentTime);
  XSync(connection_, False);
}

}  // namespace relievo::test
