// SPDX-License-Identifier: Apache-2.0
// All calls on sockets are non-blocking; poll with a timeout of 0 finds those that have something to do.
#include "app/player/control/control_socket.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "platform/log.h"

namespace relievo {
namespace {

constexpr const char* kTooLong = "a socket path may have at most 100 characters; choose a shorter one";
constexpr std::size_t kMostPath = 100;  // of the 107 that fit; the rest is for its first, temporary name

sockaddr_un addressOf(const std::string& path) noexcept {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  return address;
}

int callOn(int (*call)(int, const sockaddr*, socklen_t), int fd, const std::string& path) noexcept {
  const sockaddr_un address = addressOf(path);
  return call(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

UniqueFd newSocket() noexcept {
  return UniqueFd(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

std::unexpected<Failure> cannot(const std::string& path) {
  return failOn(path, {ErrorCode::Io, errno, "no socket can be created there; check the folder"});
}

// Nothing there, or a socket that nobody listens on.
Outcome<void> mayReplace(const std::string& path) {
  struct stat file{};
  if (::lstat(path.c_str(), &file) != 0) return {};
  if (!S_ISSOCK(file.st_mode)) {
    return failOn(path, {ErrorCode::InvalidArgument, 0, "is not a socket and is left alone; choose another path"});
  }
  const UniqueFd probe = newSocket();
  if (!probe.valid()) return cannot(path);
  if (callOn(::connect, probe.get(), path) != 0 && errno == ECONNREFUSED) return {};
  return failOn(path, {ErrorCode::InvalidState, 0, "another program listens there; stop it or choose another path"});
}

}  // namespace

Outcome<std::unique_ptr<ControlSocket>> ControlSocket::listen(const std::string& path) {
  if (path.empty() || path.size() > kMostPath) return failOn(path, {ErrorCode::InvalidArgument, 0, kTooLong});
  // The socket gets its mode before it has its name, and its name when it accepts connections.
  const std::string first_path = path + "~";
  for (const std::string& taken : {path, first_path}) {
    if (auto may = mayReplace(taken); !may) return std::unexpected(may.error());
  }
  UniqueFd fd = newSocket();
  if (!fd.valid() || ::fchmod(fd.get(), 0600) != 0) return cannot(path);
  ::unlink(first_path.c_str());
  struct stat file{};
  if (callOn(::bind, fd.get(), first_path) != 0 || ::listen(fd.get(), static_cast<int>(kMostClients)) != 0 ||
      ::stat(first_path.c_str(), &file) != 0 || std::rename(first_path.c_str(), path.c_str()) != 0) {
    const auto failed = cannot(path);
    ::unlink(first_path.c_str());
    return failed;
  }
  return std::unique_ptr<ControlSocket>(new ControlSocket(std::move(fd), path, file.st_dev, file.st_ino));
}

ControlSocket::ControlSocket(UniqueFd fd, std::string path, dev_t device, ino_t inode)
    : fd_(std::move(fd)), path_(std::move(path)), device_(device), inode_(inode) {}

ControlSocket::~ControlSocket() {
  struct stat file{};
  const bool ours = ::lstat(path_.c_str(), &file) == 0 && file.st_dev == device_ && file.st_ino == inode_;
  if (ours) ::unlink(path_.c_str());
}

void ControlSocket::attend(std::string_view refusal) {
  ++round_;
  std::array<pollfd, kMostClients + 1> polled{};
  polled[0] = {.fd = fd_.get(), .events = POLLIN};
  for (std::size_t i = 0; i < clients_.size(); ++i) {
    const Client& client = clients_[i];
    const bool room = client.in.size() <= kMostLine && !client.ended;
    polled[i + 1] = {.fd = client.fd.get(),
                     .events = static_cast<short>((room ? POLLIN : 0) | (client.out.empty() ? 0 : POLLOUT))};
  }
  if (::poll(polled.data(), clients_.size() + 1, 0) > 0) {
    for (std::size_t i = 0; i < clients_.size(); ++i) {
      if ((polled[i + 1].revents & POLLIN) != 0) receive(clients_[i]);
      if ((polled[i + 1].revents & POLLOUT) != 0) flush(clients_[i]);
      if ((polled[i + 1].revents & (POLLERR | POLLNVAL)) != 0) clients_[i].gone = true;
    }
    if ((polled[0].revents & POLLIN) != 0) accept(refusal);
  }
  std::erase_if(clients_, [](const Client& c) { return c.gone || (c.ended && c.in.empty() && c.out.empty()); });
}

void ControlSocket::accept(std::string_view refusal) {
  for (std::size_t waiting = 0; waiting < kMostClients; ++waiting) {
    UniqueFd fd(::accept4(fd_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!fd.valid()) return;
    Client client{.id = last_id_ + 1, .fd = std::move(fd), .heard = round_};
    if (!makeRoom(refusal)) {
      put(client, refusal);
      continue;
    }
    ++last_id_;
    clients_.push_back(std::move(client));
  }
}

bool ControlSocket::makeRoom(std::string_view refusal) {
  if (clients_.size() < kMostClients) return true;
  const auto silent = std::ranges::min_element(clients_, {}, &Client::heard);
  if (silent->heard == round_) return false;
  put(*silent, refusal);
  clients_.erase(silent);
  return true;
}

void ControlSocket::receive(Client& client) const {
  std::array<char, kMostLine + 1> bytes;
  const ssize_t got = ::recv(client.fd.get(), bytes.data(), bytes.size() - client.in.size(), 0);
  if (got > 0) client.heard = round_;
  if (got > 0) client.in.append(bytes.data(), static_cast<std::size_t>(got));
  else if (got == 0) client.ended = true;
  else if (errno != EAGAIN && errno != EINTR) client.gone = true;
}

std::optional<ControlSocket::Line> ControlSocket::takeLine(Client& client) {
  const std::size_t end = client.in.find('\n');
  if (end != std::string::npos || client.ended) {
    const bool nothing = client.in.empty();
    Line line{.client = client.id, .text = client.in.substr(0, end)};
    client.in.erase(0, end == std::string::npos ? end : end + 1);
    if (std::exchange(client.skipping, false) || nothing) return std::nullopt;
    return line;
  }
  if (client.in.size() <= kMostLine) return std::nullopt;
  client.in.clear();
  if (std::exchange(client.skipping, true)) return std::nullopt;
  return Line{.client = client.id, .text = "", .too_long = true};
}

std::optional<ControlSocket::Line> ControlSocket::next() {
  for (std::size_t i = 0; i < clients_.size(); ++i) {
    Client& client = clients_[turn_++ % clients_.size()];
    if (client.gone) continue;
    if (auto line = takeLine(client)) return line;
  }
  return std::nullopt;
}

bool ControlSocket::send(ClientId id, std::string_view line) {
  const auto client = std::ranges::find(clients_, id, &Client::id);
  if (client == clients_.end() || client->gone) return false;
  put(*client, line);
  return true;
}

void ControlSocket::sendToAll(std::string_view line) {
  for (Client& client : clients_) put(client, line);
}

void ControlSocket::put(Client& client, std::string_view line) {
  if (client.gone) return;
  client.out.append(line).push_back('\n');
  flush(client);
  if (client.out.size() <= kMostUnread) return;
  log(LogLevel::Warning, "control", "a client that did not read its messages was disconnected");
  client.gone = true;
}

void ControlSocket::flush(Client& client) {
  const ssize_t sent = ::send(client.fd.get(), client.out.data(), client.out.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent > 0) client.out.erase(0, static_cast<std::size_t>(sent));
  else if (sent < 0 && errno != EAGAIN && errno != EINTR) client.gone = true;
}

}  // namespace relievo
