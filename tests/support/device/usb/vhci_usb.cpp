// SPDX-License-Identifier: Apache-2.0
// Answers the kernel's USB/IP requests by the model.
#include "tests/support/device/usb/vhci_usb.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "platform/clock.h"

namespace relievo::test {
namespace {

constexpr const char* kAttach = "/sys/devices/platform/vhci_hcd.0/attach";
constexpr const char* kDetach = "/sys/devices/platform/vhci_hcd.0/detach";
constexpr std::uint32_t kSubmit = 1, kUnlink = 2, kSubmitted = 3, kUnlinked = 4;
constexpr int kPipeBroken = -32, kUnlinkedStatus = -104;

// The header in both directions: 48 bytes, all fields big-endian.
struct Header {
  std::uint32_t command = 0, sequence = 0, device = 0, in = 0, endpoint = 0;
  std::array<std::uint32_t, 7> rest{};  // of a submit: flags, length, frame, packets, interval, set-up (8 bytes)
};
static_assert(sizeof(Header) == 48);

}  // namespace

bool VhciUsb::available() {
  return ::access(kAttach, W_OK) == 0;
}

VhciUsb::VhciUsb(UsbModel& model, const UsbDeviceId& id) : model_(model), id_(id) {
  plug();
}

VhciUsb::~VhciUsb() {
  unplug();
}

void VhciUsb::plug() {
  std::array<int, 2> pair{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair.data()) != 0) throw std::runtime_error("no sockets");
  socket_ = UniqueFd(pair[0]);
  const UniqueFd theirs(pair[1]);
  stopping_ = false;
  waiting_.clear();
  untaken_.clear();
  thread_ = std::thread([this] { serve(); });
  constexpr int kPort = 0, kBusAndDevice = 0x10002, kFullSpeed = 2;
  std::ofstream attach(kAttach);
  attach << kPort << ' ' << theirs.get() << ' ' << kBusAndDevice << ' ' << kFullSpeed << std::flush;
  if (!attach) throw std::runtime_error("vhci_hcd rejects the model");
  // Wait until the kernel has read the descriptors and created the device node.
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
}

void VhciUsb::unplug() {
  if (!thread_.joinable()) return;
  std::ofstream(kDetach) << 0 << std::flush;
  stopping_ = true;
  thread_.join();
  socket_.reset();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // until the kernel has removed its node
}

void VhciUsb::unplugAfter(int requests) {
  const std::lock_guard guard(lock_);
  requests_left_ = requests;
}

void VhciUsb::takesNothing() {
  const std::lock_guard guard(lock_);
  deaf_ = true;
}

void VhciUsb::takesAgain() {
  const std::lock_guard guard(lock_);
  deaf_ = false;
  for (const Untaken& command : untaken_) take(command);
  untaken_.clear();
}

void VhciUsb::take(const Untaken& command) {
  model_.write(command.data, MonotonicClock().now());
  reply(command.sequence, 0, command.data.size(), {});
}

void VhciUsb::serve() {
  while (!stopping_) {
    pollfd ready{socket_.get(), POLLIN, 0};
    const int timeout_ms = waiting_.empty() ? 20 : 1;
    if (::poll(&ready, 1, timeout_ms) > 0 && !takeRequest()) {
      ::shutdown(socket_.get(), SHUT_RDWR);  // to the kernel this is an unplugged cable
      return;
    }
    const std::lock_guard guard(lock_);
    giveWhatThereIs();
  }
}

bool VhciUsb::readAll(void* into, std::size_t bytes) const {
  auto* at = static_cast<char*>(into);
  while (bytes > 0) {
    const ssize_t got = ::read(socket_.get(), at, bytes);
    if (got <= 0) return false;
    at += got;
    bytes -= static_cast<std::size_t>(got);
  }
  return true;
}

bool VhciUsb::takeRequest() {
  Header header;
  if (!readAll(&header, sizeof header)) return false;
  const std::uint32_t sequence = ntohl(header.sequence);
  const std::lock_guard guard(lock_);
  if (ntohl(header.command) == kUnlink) {
    const std::uint32_t which = ntohl(header.rest[0]);
    const auto isIt = [which](const auto& each) { return each.sequence == which; };
    const auto gone = std::erase_if(waiting_, isIt) + std::erase_if(untaken_, isIt);
    Header answer{.command = htonl(kUnlinked), .sequence = header.sequence};
    answer.rest[0] = htonl(static_cast<std::uint32_t>(gone > 0 ? kUnlinkedStatus : 0));
    return ::write(socket_.get(), &answer, sizeof answer) == sizeof answer;
  }
  if (ntohl(header.command) != kSubmit) return false;
  if (requests_left_ > 0 && --requests_left_ == 0) return false;
  const bool in = ntohl(header.in) != 0;
  const std::size_t length = ntohl(header.rest[1]);
  std::vector<std::uint8_t> data(in ? 0 : length);
  if (!data.empty() && !readAll(data.data(), data.size())) return false;
  if (header.endpoint == 0) {
    std::array<std::uint8_t, 8> setup{};
    std::memcpy(setup.data(), &header.rest[5], setup.size());
    answerControl(sequence, setup.data(), length, in);
  } else if (in) {
    waiting_.push_back({sequence, length});
  } else if (deaf_) {
    untaken_.push_back({sequence, std::move(data)});
  } else {
    take({sequence, std::move(data)});
  }
  return true;
}

void VhciUsb::answerControl(std::uint32_t sequence, const std::uint8_t* setup, std::size_t length, bool in) {
  constexpr std::uint8_t kVendorToDevice = 0x40, kFromDevice = 0x80, kGetDescriptor = 6, kGetStatus = 0;
  std::vector<std::uint8_t> answer;
  bool known = !in;
  if (setup[0] == kVendorToDevice) {
    model_.control(setup[1], static_cast<std::uint16_t>(setup[2] | setup[3] << 8), MonotonicClock().now());
  } else if (setup[0] == kFromDevice && setup[1] == kGetDescriptor && (setup[3] == 1 || setup[3] == 2)) {
    answer = setup[3] == 1 ? deviceDescriptor(id_) : configurationDescriptor(id_);
    known = true;
  } else if (setup[0] == kFromDevice && setup[1] == kGetStatus) {
    answer = {0, 0};
    known = true;
  }
  if (!known) return reply(sequence, kPipeBroken, 0, {});
  answer.resize(std::min(answer.size(), length));
  reply(sequence, 0, in ? answer.size() : length, answer);
}

void VhciUsb::giveWhatThereIs() {
  while (!waiting_.empty()) {
    const auto packet = model_.read(MonotonicClock().now());
    if (!packet) return;
    const Waiting each = waiting_.front();
    waiting_.pop_front();
    const UsbBytes bytes = packet->view().first(std::min(packet->bytes, each.most));
    reply(each.sequence, 0, bytes.size(), bytes);
  }
}

void VhciUsb::reply(std::uint32_t sequence, int status, std::size_t actual, UsbBytes data) {
  Header header{.command = htonl(kSubmitted), .sequence = htonl(sequence)};
  header.rest[0] = htonl(static_cast<std::uint32_t>(status));
  header.rest[1] = htonl(static_cast<std::uint32_t>(actual));
  std::vector<std::uint8_t> bytes(sizeof header + data.size());
  std::memcpy(bytes.data(), &header, sizeof header);
  std::copy(data.begin(), data.end(), bytes.begin() + sizeof header);
  if (::write(socket_.get(), bytes.data(), bytes.size()) < 0) stopping_ = true;
}

}  // namespace relievo::test
