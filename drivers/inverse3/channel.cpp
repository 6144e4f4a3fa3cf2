// SPDX-License-Identifier: Apache-2.0
// A sender takes the turn without waiting: the tick skips a message while the watchdog sends.
#include "drivers/inverse3/channel.h"

#include <sys/random.h>

#include <algorithm>
#include <chrono>
#include <cstring>

#include "drivers/inverse3/handshake.h"

namespace relievo::inverse3 {
namespace {

using namespace std::chrono_literals;

constexpr Duration kUpgrade = 2s;
constexpr Duration kTurn = 20ms;  // for the watchdog
constexpr std::size_t kMostHead = 8192;

std::string_view textOf(PortBytes bytes) RELIEVO_RT {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

class Turn {
 public:
  explicit Turn(std::atomic<bool>& taken) RELIEVO_RT : taken_(taken),
                                                       mine_(!taken.exchange(true, std::memory_order_acquire)) {}
  ~Turn() {
    if (mine_) taken_.store(false, std::memory_order_release);
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  explicit operator bool() const RELIEVO_RT { return mine_; }

 private:
  std::atomic<bool>& taken_;
  const bool mine_;
};

}  // namespace

Result<void> Channel::open(const std::atomic<bool>& cancelled) {
  if (auto opened = wire_->open(cancelled); !opened) return opened;
  reader_.clear();
  ended_ = false;
  answered_ = sent_ = 0;
  quiet_sent_ = false;
  out_begin_ = out_end_ = 0;
  auto upgraded = upgrade(cancelled);
  if (!upgraded) wire_->close();
  return upgraded;
}

void Channel::close() noexcept {
  stopExchange();
  wire_->close();
}

Result<void> Channel::upgrade(const std::atomic<bool>& cancelled) {
  struct {
    Nonce nonce;
    std::uint64_t seed;
  } random{};
  static_cast<void>(::getrandom(&random, sizeof random, 0));  // so few bytes are always there
  random_ = random.seed | 1U;
  const auto head = answerTo(upgradeRequest(host_, random.nonce), cancelled);
  if (!head) return std::unexpected(head.error());
  if (acceptsUpgrade(*head, random.nonce)) return {};
  return fail(
      ErrorCode::Unsupported,
      "the program that answers there is no Haply Inverse service; check inverse3:HOST:PORT (the service's is 10001)");
}

// Returns the answer's head; what follows it is left to the reader of frames.
Result<std::string> Channel::answerTo(const std::string& request, const std::atomic<bool>& cancelled) {
  std::string_view unsent = request;
  std::string head;
  for (const MonotonicTime until = clock_.now() + kUpgrade; clock_.now() < until;) {
    if (cancelled) return fail(ErrorCode::Cancelled, "opening the Inverse3 was cancelled");
    const auto sent = unsent.empty() ? Result<std::size_t>(0) : wire_->send(unsent);
    if (!sent) return std::unexpected(sent.error());
    unsent.remove_prefix(*sent);
    std::array<char, 1024> piece{};
    const auto bytes = wire_->receive(piece);
    if (!bytes) return std::unexpected(bytes.error());
    head.append(piece.data(), *bytes);
    if (const std::size_t end = head.find("\r\n\r\n"); end != std::string::npos) {
      const std::string_view rest = std::string_view(head).substr(end + 4);
      std::ranges::copy(rest, reader_.room().begin());
      reader_.received(rest.size());
      head.resize(end + 2);
      return head;
    }
    if (head.size() > kMostHead) break;
    if (*bytes == 0) clock_.sleepUntil(clock_.now() + 1ms);
  }
  return fail(ErrorCode::Unsupported, "the program that answers there is no web service; check inverse3:HOST:PORT");
}

Result<void> Channel::listen() RELIEVO_RT {
  if (reader_.broken()) return fail(ErrorCode::Lost, "the Haply Inverse service sends no WebSocket frames");
  if (ended_) return fail(ErrorCode::Lost, "the Haply Inverse service has ended the connection");
  const auto room = reader_.room();
  if (room.empty()) return {};  // the messages that have come are read first
  const auto bytes = wire_->receive(room);
  if (!bytes) return std::unexpected(bytes.error());
  reader_.received(*bytes);
  return {};
}

std::optional<Channel::Answer> Channel::next() RELIEVO_RT {
  while (const auto message = reader_.next()) {
    if (message->kind == Opcode::Text) return Answer{message->payload, answered()};
    reply(*message);
  }
  return std::nullopt;
}

void Channel::reply(const Message& control) RELIEVO_RT {
  ended_ = ended_ || control.kind == Opcode::Close;
  if (control.kind != Opcode::Ping && control.kind != Opcode::Close) return;
  if (const Turn turn(turn_); turn) {
    static_cast<void>(put(control.kind == Opcode::Ping ? Opcode::Pong : Opcode::Close, control.payload));
  }
}

// An answer without a message that waits for it answers none.
std::optional<Duration> Channel::answered() RELIEVO_RT {
  if (answered_ == sent_.load(std::memory_order_acquire)) return std::nullopt;
  const Duration sent(sent_at_[answered_++ % kTimes].load(std::memory_order_relaxed));
  return clock_.now().time_since_epoch() - sent;
}

Result<void> Channel::startExchange(PortBytes quiet) {
  if (quiet.size() > quiet_.size()) return fail(ErrorCode::InvalidArgument, "the quiet message is too long");
  std::ranges::copy(quiet, quiet_.begin());
  quiet_bytes_ = quiet.size();
  exchanging_ = true;
  return {};
}

Result<bool> Channel::post(PortBytes text) RELIEVO_RT {
  const Turn turn(turn_);
  if (!turn) return false;
  const bool full = sent_.load(std::memory_order_relaxed) - answered_ >= kMostWaiting;
  const bool quiet = std::ranges::equal(text, PortBytes(quiet_).first(quiet_bytes_));
  if (full && (!quiet || quiet_sent_)) return false;
  return putText(text, quiet);
}

bool Channel::quieten() noexcept {
  if (!exchanging_) return false;
  const MonotonicTime until = clock_.now() + kTurn;
  bool written = false;
  do {
    if (const Turn turn(turn_); turn) {
      const auto sent = written ? flush() : putText(PortBytes(quiet_).first(quiet_bytes_), true);
      if (!sent) return true;  // once the connection has ended, the service holds no force
      written = written || *sent;
      if (written && out_begin_ == out_end_) return true;
    }
    clock_.sleepUntil(clock_.now() + 1ms);
  } while (clock_.now() < until);
  wire_->cut();
  return true;
}

// Counted before it is sent, since the answer may be read before this returns.
Result<bool> Channel::putText(PortBytes text, bool quiet) RELIEVO_RT {
  const std::uint32_t number = sent_.load(std::memory_order_relaxed);
  sent_at_[number % kTimes].store(clock_.now().time_since_epoch().count(), std::memory_order_relaxed);
  sent_.store(number + 1, std::memory_order_release);
  const auto sent = put(Opcode::Text, textOf(text));
  if (sent && *sent) quiet_sent_ = quiet;
  else sent_.store(number, std::memory_order_release);
  return sent;
}

Result<bool> Channel::put(Opcode kind, std::string_view payload) RELIEVO_RT {
  if (const auto gone = flush(); !gone || !*gone) return gone;
  out_begin_ = 0;
  out_end_ = writeFrame(kind, payload, randomBits(), outbox_);
  const auto sent = flush();
  return sent ? Result<bool>(true) : sent;  // a rest is sent before the next frame
}

Result<bool> Channel::flush() RELIEVO_RT {
  if (out_begin_ == out_end_) return true;
  const auto sent = wire_->send(std::span<const char>(outbox_).subspan(out_begin_, out_end_ - out_begin_));
  if (!sent) return std::unexpected(sent.error());
  out_begin_ += *sent;
  return out_begin_ == out_end_;
}

// xorshift64*: masks need not be secret here, only different from what a page in a browser could foretell.
std::uint32_t Channel::randomBits() RELIEVO_RT {
  random_ ^= random_ >> 12U;
  random_ ^= random_ << 25U;
  random_ ^= random_ >> 27U;
  return static_cast<std::uint32_t>((random_ * 0x2545F4914F6CDD1DULL) >> 32U);
}

}  // namespace relievo::inverse3
