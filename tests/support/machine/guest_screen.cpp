// SPDX-License-Identifier: Apache-2.0
#include "tests/support/machine/guest_screen.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace relievo::test {
namespace {

namespace fs = std::filesystem;
// Opens the guest's only virtio port, which must not be a terminal: until echo is switched off, a terminal would echo
// QEMU's greeting, and QEMU would take that for a command.
UniqueFd openMonitor() {
  std::error_code error;
  for (const auto& port : fs::directory_iterator("/sys/class/virtio-ports", error)) {
    UniqueFd fd(::open(("/dev" / port.path().filename()).c_str(), O_RDWR | O_CLOEXEC));
    if (fd.valid()) return fd;
  }
  throw std::runtime_error("QEMU's monitor is not there");
}

// Sends a QMP command: one object per line, and the answer has the command's id. It takes the host's time. QEMU's error
// about a second qmp_capabilities is ignored.
void tell(int monitor, const std::string& command, const std::string& id) {
  const std::string words = "{\"execute\": \"qmp_capabilities\"}\n{" + command + ", \"id\": \"" + id + "\"}\n";
  if (::write(monitor, words.data(), words.size()) != static_cast<ssize_t>(words.size())) {
    throw std::runtime_error("QEMU's monitor does not listen");
  }
  std::string heard;
  for (char c = 0; (heard.find(id) == std::string::npos || c != '\n') && ::read(monitor, &c, 1) == 1;) heard += c;
  if (heard.find("\"return\": {}, \"id\": \"" + id) == std::string::npos) throw std::runtime_error("QEMU: " + heard);
}

}  // namespace

std::unique_ptr<GuestScreen> GuestScreen::find(const std::string& driver) {
  if (std::getenv("RELIEVO_SCREENS") == nullptr) return nullptr;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/sys/class/drm", error)) {
    const std::string name = entry.path().filename();  // card0-Virtual-1
    const std::size_t dash = name.find("-Virtual");
    if (dash == std::string::npos) continue;
    const fs::path card = entry.path().parent_path() / name.substr(0, dash);
    std::ifstream about(card / "device/uevent");  // DRIVER=virtio-pci, MODALIAS=platform:vkms
    const std::string text{std::istreambuf_iterator<char>(about), {}};
    if (text.find(driver) == std::string::npos) continue;
    return std::unique_ptr<GuestScreen>(new GuestScreen("/dev/dri/" + name.substr(0, dash), entry.path() / "status"));
  }
  return nullptr;
}

void GuestScreen::plug(bool in) const {
  std::ofstream(status_) << (in ? "detect" : "off");
}

ScreenDump GuestScreen::dump() {
  static int dumps = 0;  // a new name each time, since the guest caches the host's files
  if (!monitor_.valid()) monitor_ = openMonitor();
  const std::string id = "dump-" + std::to_string(::getpid()) + "-" + std::to_string(++dumps) + ".ppm";
  tell(monitor_.get(), R"("execute": "screendump", "arguments": {"filename": ")" + id + "\"}", id);
  return readPixels(std::string(std::getenv("RELIEVO_SCREENS")) + "/" + id);
}

ScreenDump readPixels(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string magic;
  ScreenDump dump;
  int largest = 0;
  file >> magic >> dump.width >> dump.height >> largest;
  file.get();
  dump.rgb.resize(static_cast<std::size_t>(dump.width) * dump.height * 3);
  file.read(reinterpret_cast<char*>(dump.rgb.data()), static_cast<std::streamsize>(dump.rgb.size()));
  if (magic != "P6" || !file) throw std::runtime_error("there is no picture in " + path);
  return dump;
}

}  // namespace relievo::test
