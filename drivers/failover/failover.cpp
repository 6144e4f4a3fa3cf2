// SPDX-License-Identifier: Apache-2.0
// Keeps the packets that the next decoder would need.
#include "drivers/failover/failover.h"

#include <algorithm>
#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "platform/log.h"

namespace relievo {
namespace {

// With more packets between key frames, the next decoder continues only at the next key frame.
constexpr std::size_t kMostPackets = 1024;
constexpr std::size_t kMostBytes = std::size_t{48} << 20;

class FailoverDecoder final : public VideoDecoder {
 public:
  FailoverDecoder(std::vector<std::unique_ptr<VideoDecoder>> decoders, bool asked_for)
      : decoders_(std::move(decoders)), asked_for_(asked_for) {}

  [[nodiscard]] Capabilities capabilities() const noexcept override {
    Capabilities these = decoder().capabilities();
    for (const auto& each : decoders_) {
      these.max_held_frames = std::min(these.max_held_frames, each->capabilities().max_held_frames);
    }
    return these;
  }
  [[nodiscard]] std::string description() const override {
    const std::string name = decoder().description();
    return refusal_ == nullptr ? name : name + "; no better decoder: " + refusal_;
  }

 private:
  [[nodiscard]] VideoDecoder& decoder() const noexcept { return *decoders_[current_]; }
  [[nodiscard]] bool isLast() const noexcept { return current_ + 1 == decoders_.size(); }
  [[nodiscard]] bool repeats() const noexcept { return repeated_ < kept_.size(); }

  Result<void> openDecoder(const StreamInfo& stream) override {
    stream_ = stream;
    current_ = 0;
    began_anew_ = false;
    leaves_out_ = false;
    refusal_ = nullptr;
    forget();
    return openBest();
  }

  // Opens the first decoder, from the current one on, that takes the stream.
  Result<void> openBest() {
    inner_damaged_ = 0;
    for (;; ++current_) {
      auto opened = decoder().open(stream_);
      if (opened || isLast()) return opened;
      const Error& error = opened.error();
      if (error.code == ErrorCode::NotFound && !asked_for_) continue;
      refusal_ = error.message;
      log(LogLevel::Info, "media", "%s cannot decode %s: %s", decoder().capabilities().name, stream_.codec.c_str(),
          error.message);
    }
  }

  void leaveOut(bool unreferenced) noexcept override {
    leaves_out_ = unreferenced;
    if (decoder().state() != State::Closed) static_cast<void>(decoder().leaveOutUnreferenced(unreferenced));
  }

  Result<Feed> feedPacket(const Packet& packet) override {
    if (repeats()) return Feed::Full;
    const auto fed = decoder().feed(packet);
    if (fed && *fed == Feed::Full) return fed;
    if (!fed && isLast()) return fed;
    countNew();
    if (!isLast()) keep(packet);
    if (fed) {
      repeated_ = kept_.size();
    } else if (auto recovered = recover(fed.error()); !recovered) {
      return std::unexpected(recovered.error());
    }
    return Feed::Accepted;
  }

  Result<Progress> receiveFrame(Frame& frame) override {
    for (;;) {
      auto got = decoder().receive();
      Result<void> step;
      if (!got) {
        step = std::unexpected(got.error());
      } else if (*got) {
        countNew();
        if (isRepeated((*got)->pts)) continue;
        frame = std::move(**got);
        given_ = frame.pts;
        letGoBefore(frame.pts);
        return Progress::Picture;
      } else if (repeats()) {
        step = repeat();
      } else if (draining_ && decoder().state() == State::Open) {
        step = decoder().drain();
      } else {
        countNew();
        return decoder().state() == State::Ended ? Progress::EndOfStream : Progress::NeedsPackets;
      }
      if (step) continue;
      if (auto recovered = recover(step.error()); !recovered) return std::unexpected(recovered.error());
    }
  }

  // Feeds the next kept packet again; the decoder has no picture ready.
  Result<void> repeat() {
    const auto fed = decoder().feed(kept_[repeated_]);
    if (!fed) return std::unexpected(fed.error());
    if (*fed == Feed::Full)
      return fail(ErrorCode::Timeout, "the video decoder neither takes packets nor returns pictures");
    ++repeated_;
    if (!repeats() && isLast()) letGo(kept_.size());  // there is no next decoder
    inner_damaged_ = decoder().damaged();             // these packets were counted before
    return {};
  }

  // True if the picture was already returned before the failure.
  bool isRepeated(MediaTime pts) noexcept {
    if (!repeated_until_) return false;
    if (pts <= *repeated_until_) return true;
    repeated_until_.reset();
    return false;
  }

  Result<void> recover(const Error& error) {
    if (isLast()) return std::unexpected(error);
    decoder().close();
    const bool may_again = error.code == ErrorCode::Timeout || error.code == ErrorCode::Io;
    const bool again = may_again && !std::exchange(began_anew_, true);
    const std::size_t before = current_;
    if (!again) {
      refusal_ = error.message;
      ++current_;
    }
    auto opened = openBest();
    leaveOut(leaves_out_);
    noteRestart({error.message, current_ == before ? "the decoder was restarted at the same picture"
                                                   : "another decoder, in software, continues at the same picture"});
    repeated_ = 0;
    repeated_until_ = given_;
    return opened;
  }

  void countNew() noexcept { countDamaged(decoder().damaged() - std::exchange(inner_damaged_, decoder().damaged())); }

  void keep(const Packet& packet) {
    if (kept_.size() >= kMostPackets || kept_bytes_ + packet.bytes > kMostBytes) letGo(kept_.size());
    kept_.push_back(packet);
    kept_bytes_ += packet.bytes;
  }
  // A picture of this time was returned: packets before the last key frame up to it are no longer needed.
  void letGoBefore(MediaTime time) {
    if (repeats()) return;
    const auto begins = [time](const Packet& p) { return p.keyframe && p.pts && *p.pts <= time; };
    const auto key = std::find_if(kept_.rbegin(), kept_.rend(), begins);
    if (key != kept_.rend()) letGo(static_cast<std::size_t>(kept_.rend() - key) - 1);
  }
  void letGo(std::size_t count) {
    for (; count > 0; --count) {
      kept_bytes_ -= kept_.front().bytes;
      kept_.pop_front();
    }
    repeated_ = kept_.size();
  }

  Result<void> startDrain() override {
    draining_ = true;
    return {};
  }
  Result<void> flushDecoder() override {
    forget();
    const auto flushed = decoder().flush();
    return flushed ? flushed : recover(flushed.error());
  }
  void closeDecoder() noexcept override {
    for (const auto& each : decoders_) each->close();
    forget();
  }
  void forget() noexcept {
    kept_.clear();
    kept_bytes_ = repeated_ = 0;
    draining_ = false;
    given_.reset();
    repeated_until_.reset();
  }

  const std::vector<std::unique_ptr<VideoDecoder>> decoders_;
  const bool asked_for_;
  std::size_t current_ = 0;
  StreamInfo stream_;
  bool began_anew_ = false;
  bool leaves_out_ = false;
  const char* refusal_ = nullptr;  // why the last better decoder is not used
  std::deque<Packet> kept_;        // in the order of decoding
  std::size_t kept_bytes_ = 0;
  std::size_t repeated_ = 0;                 // how many of them the decoder has
  std::optional<MediaTime> given_;           // time of the newest picture returned
  std::optional<MediaTime> repeated_until_;  // pictures up to this time are dropped
  bool draining_ = false;
  std::uint64_t inner_damaged_ = 0;  // of the decoder's damaged ones, those already counted or repeated
};

}  // namespace

std::unique_ptr<VideoDecoder> makeFailoverDecoder(std::vector<std::unique_ptr<VideoDecoder>> decoders, bool asked_for) {
  return std::make_unique<FailoverDecoder>(std::move(decoders), asked_for);
}

}  // namespace relievo
