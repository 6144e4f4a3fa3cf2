// SPDX-License-Identifier: Apache-2.0
// TCP without delay. Names are looked up on a thread of their own, since getaddrinfo cannot be interrupted.
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <future>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "drivers/inverse3/wire.h"
#include "platform/unique_fd.h"

namespace relievo::inverse3 {
namespace {

using namespace std::chrono_literals;

constexpr auto kBetweenLooks = 20ms;  // at `cancelled`
constexpr int kMostLooks = 100;       // after so many, nobody answers

constexpr const char* kNobody =
    "no Haply Inverse service answers there; start it (systemctl start haply-inverse-service, or open the Haply Hub) "
    "or give its place: inverse3:HOST:PORT";

constexpr const char* kOlder =
    "no Haply Inverse service of 3.1 or later answers there; start it (systemctl start haply-inverse-service, or open "
    "the Haply Hub); if it is 3.0, which has the port 10000 that answers, install 3.1 to 3.5";

struct FreeAddresses {
  void operator()(addrinfo* list) const noexcept { ::freeaddrinfo(list); }
};
using Addresses = std::unique_ptr<addrinfo, FreeAddresses>;

Addresses lookUp(const std::string& host, const std::string& port) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* list = nullptr;
  return Addresses(::getaddrinfo(host.c_str(), port.c_str(), &hints, &list) == 0 ? list : nullptr);
}

std::unexpected<Error> gone(int error) RELIEVO_RT {
  return fail(ErrorCode::Lost, "the Haply Inverse service has ended the connection", error);
}

class TcpWire final : public Wire {
 public:
  explicit TcpWire(Address address) : address_(std::move(address)) {}

  Result<void> open(const std::atomic<bool>& cancelled) override {
    const auto addresses = find(cancelled);
    if (!addresses) return std::unexpected(addresses.error());
    if (*addresses == nullptr) return fail(ErrorCode::NotFound, "there is no host of this name; check inverse3:HOST");
    Result<void> connected = fail(ErrorCode::NotFound, kNobody);
    for (const addrinfo* each = addresses->get(); each != nullptr; each = each->ai_next) {
      connected = connect(*each, cancelled);
      if (connected || connected.error().code == ErrorCode::Cancelled) break;
    }
    if (!connected && connected.error().os_error == ECONNREFUSED)
      connected = withOlder(connected.error(), addresses->get(), cancelled);
    if (!connected) close();
    return connected;
  }
  void close() noexcept override { fd_.reset(); }

  Result<std::size_t> receive(std::span<char> to) RELIEVO_RT override {
    const ssize_t bytes = ::recv(fd_.get(), to.data(), to.size(), MSG_DONTWAIT);
    if (bytes > 0) return static_cast<std::size_t>(bytes);
    if (bytes < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
    return gone(bytes < 0 ? errno : 0);
  }
  Result<std::size_t> send(std::span<const char> bytes) RELIEVO_RT override {
    const ssize_t sent = ::send(fd_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent >= 0) return static_cast<std::size_t>(sent);
    if (errno == EAGAIN || errno == EINTR) return 0;
    return gone(errno);
  }
  void cut() noexcept override { ::shutdown(fd_.get(), SHUT_RDWR); }

 private:
  // A look-up that was given up ends by itself.
  Result<Addresses> find(const std::atomic<bool>& cancelled) {
    std::packaged_task<Addresses()> task(
        [host = address_.host, port = std::to_string(address_.port)] { return lookUp(host, port); });
    auto found = task.get_future();
    try {
      std::thread(std::move(task)).detach();
    } catch (const std::system_error& error) {
      return fail(ErrorCode::Exhausted, "the limit on processes is reached; raise it (ulimit -u) or end some",
                  error.code().value());
    }
    for (int i = 0; i < kMostLooks; ++i) {
      if (cancelled) return cancelledOpening();
      if (found.wait_for(kBetweenLooks) == std::future_status::ready) return found.get();
    }
    return fail(ErrorCode::Timeout, "the host's name cannot be looked up; check the network and inverse3:HOST");
  }

  Result<void> connect(const addrinfo& to, const std::atomic<bool>& cancelled) {
    fd_.reset(::socket(to.ai_family, to.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, to.ai_protocol));
    if (!fd_.valid()) return fail(ErrorCode::Exhausted, "the system cannot make another socket", errno);
    const int yes = 1;
    ::setsockopt(fd_.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    if (::connect(fd_.get(), to.ai_addr, to.ai_addrlen) == 0) return {};
    if (errno != EINPROGRESS) return fail(ErrorCode::NotFound, kNobody, errno);
    for (int i = 0; i < kMostLooks; ++i) {
      if (cancelled) return cancelledOpening();
      pollfd ready{.fd = fd_.get(), .events = POLLOUT, .revents = 0};
      if (::poll(&ready, 1, static_cast<int>(kBetweenLooks.count())) > 0) return outcome();
    }
    return fail(ErrorCode::Timeout, kNobody);
  }

  // `refusal`, or another if a service of 3.0 may run on that host. Other programs have its port, too.
  std::unexpected<Error> withOlder(Error refusal, const addrinfo* addresses, const std::atomic<bool>& cancelled) {
    constexpr std::uint16_t kOlderPort = 10000;
    if (!address_.older_port && address_.port != Address::kUsualPort) return std::unexpected(refusal);
    const std::uint16_t port = htons(address_.older_port.value_or(kOlderPort));
    for (; addresses != nullptr; addresses = addresses->ai_next) {
      sockaddr_storage place{};
      std::memcpy(&place, addresses->ai_addr, addresses->ai_addrlen);
      if (place.ss_family == AF_INET) reinterpret_cast<sockaddr_in&>(place).sin_port = port;
      else reinterpret_cast<sockaddr_in6&>(place).sin6_port = port;
      addrinfo older = *addresses;
      older.ai_addr = reinterpret_cast<sockaddr*>(&place);
      const auto answered = connect(older, cancelled);
      if (answered) return fail(ErrorCode::NotFound, kOlder, ECONNREFUSED);
      if (answered.error().code == ErrorCode::Cancelled) return std::unexpected(answered.error());
    }
    return std::unexpected(refusal);
  }

  Result<void> outcome() {
    int error = 0;
    socklen_t size = sizeof error;
    ::getsockopt(fd_.get(), SOL_SOCKET, SO_ERROR, &error, &size);
    if (error != 0) return fail(ErrorCode::NotFound, kNobody, error);
    return {};
  }

  static std::unexpected<Error> cancelledOpening() {
    return fail(ErrorCode::Cancelled, "opening the Inverse3 was cancelled");
  }

  Address address_;
  UniqueFd fd_;
};

}  // namespace

std::optional<Address> Address::parse(const std::string& text) {
  Address address;
  const bool bracketed = text.starts_with('[');
  const std::size_t host_end = bracketed ? text.find(']') : text.find(':');
  if (bracketed && host_end == std::string::npos) return std::nullopt;
  address.host = bracketed ? text.substr(1, host_end - 1) : text.substr(0, host_end);
  const std::string rest = host_end == std::string::npos ? "" : text.substr(host_end + (bracketed ? 1 : 0));
  if (address.host.empty() || address.host.find_first_of(" /@\r\n") != std::string::npos) return std::nullopt;
  if (rest.empty()) return address;
  const char* const end = rest.data() + rest.size();
  const auto [last, error] = std::from_chars(rest.data() + 1, end, address.port);
  if (rest[0] != ':' || error != std::errc() || last != end || address.port == 0) return std::nullopt;
  return address;
}

std::string Address::text() const {
  const bool bracketed = host.find(':') != std::string::npos;
  return (bracketed ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

std::unique_ptr<Wire> makeTcpWire(Address address) {
  return std::make_unique<TcpWire>(std::move(address));
}

}  // namespace relievo::inverse3
