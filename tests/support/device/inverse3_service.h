// SPDX-License-Identifier: Apache-2.0
// An emulator of the Haply Inverse service with one Inverse3: the bytes of its WebSocket in and out, in the caller's
// time. Frames and JSON are written and read here by other means than the driver's.
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <glm/vec3.hpp>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/inverse3/wire.h"
#include "platform/clock.h"

namespace relievo::test {

// What goes wrong, as a probability for each message.
struct ServiceFaults {
  double drops = 0;          // the answer is never sent
  double holds_back = 0;     // the answer comes up to 4 ms later, after younger ones
  double repeats = 0;        // the answer comes twice
  double garbles = 0;        // the answer is no JSON
  double misplaces = 0;      // the answer has a position far from the hand's
  double pings = 0;          // a ping comes before the answer
  double fragments = 0;      // the answer comes in three frames
  double breaks_frames = 0;  // bytes come that are no frame
  double hangs_up = 0;       // a close frame instead of the answer; the connection ends
  double stalls = 0;         // it reads nothing for up to 80 ms
  double restarts = 0;       // it dies, and is back after 50 ms
  Duration most_delay{0};    // of every answer, at random
};

class Inverse3Service {
 public:
  enum class Version : std::uint8_t { V3_0, V3_1, V3_5, V9 };
  explicit Inverse3Service(Version version, unsigned seed = 1) : version_(version), random_(seed) {}

  // The hand's position in mm: x right, y up, z toward the user, from the middle of the workspace.
  std::function<glm::dvec3(double t_s)> hand = [](double) { return glm::dvec3(0); };
  bool running = true, plugged = true, powered = true, ready = true, deaf = false;
  std::string id = "049D", listed_before;  // its arm; another one, if it is not empty
  std::string type = "inverse3";
  bool comes_back = false;  // it runs again when it is connected to
  bool button_a = false, button_b = false, wired_button = false;
  ServiceFaults faults;

  // The wire's side. `connect` is false if it does not run.
  [[nodiscard]] bool connect(MonotonicTime now);
  void disconnect();
  [[nodiscard]] bool connected() const { return connected_; }
  void receive(std::string_view bytes, MonotonicTime now);
  // What has been sent until `now`.
  [[nodiscard]] std::string take(MonotonicTime now);

  // The force on the hand, N, in the frame of `hand`. The device goes on applying it until another comes.
  [[nodiscard]] glm::dvec3 force() const { return force_n_; }
  [[nodiscard]] bool pushes() const { return force_n_ != glm::dvec3(0); }
  // When that force came; a stall's time counts from its end.
  [[nodiscard]] MonotonicTime forceSince() const { return std::max(force_since_, stalled_until_); }
  [[nodiscard]] bool stalled(MonotonicTime now) const { return now < stalled_until_; }
  [[nodiscard]] int messages() const { return messages_; }
  [[nodiscard]] int connections() const { return connections_; }
  [[nodiscard]] int faultsDone() const { return faults_done_; }
  [[nodiscard]] int pongs() const { return pongs_; }
  [[nodiscard]] const std::string& error() const { return error_; }  // what the client did wrong; empty if nothing
  [[nodiscard]] const std::string& profile() const { return profile_; }
  // Called for each force that the device then applies.
  std::function<void(const glm::dvec3& force_n, MonotonicTime now)> on_force;

 private:
  struct Sent {
    MonotonicTime due;
    std::string bytes;
  };
  struct Frame {
    unsigned kind = 0;
    std::string payload;
  };

  bool chance(double probability);
  double upTo(double most) { return std::uniform_real_distribution<>(0, most)(random_); }
  void upgrade(MonotonicTime now);
  void readFrames(MonotonicTime now);
  [[nodiscard]] bool nextFrame(Frame& frame);
  void command(const std::string& text, MonotonicTime now);
  void answer(MonotonicTime now);
  void say(std::string frames, MonotonicTime due);
  [[nodiscard]] std::string stateText(MonotonicTime now, bool whole, const glm::dvec3& error_mm);
  [[nodiscard]] std::string armText(const std::string& name, MonotonicTime now, bool whole,
                                    const glm::dvec3& error_mm) const;
  void setForce(const glm::dvec3& force_n, MonotonicTime now);
  void endConnection();

  const Version version_;
  std::mt19937 random_;
  bool connected_ = false, upgraded_ = false, centred_ = false, hung_up_ = false, new_force_ = false;
  std::string incoming_;
  std::deque<Sent> outgoing_;
  MonotonicTime began_, stalled_until_, dead_until_, force_since_;
  glm::dvec3 force_n_{0};
  int messages_ = 0, connections_ = 0, faults_done_ = 0, pongs_ = 0;
  std::string error_, profile_;
};

// The frame of a server: not masked.
[[nodiscard]] std::string serverFrame(unsigned kind, std::string_view payload, bool final = true);

// A wire to the emulator in the caller's thread and time.
class EmulatedWire final : public inverse3::Wire {
 public:
  EmulatedWire(Inverse3Service& service, Clock& clock) : service_(service), clock_(clock) {}
  ~EmulatedWire() override { service_.disconnect(); }

  Result<void> open(const std::atomic<bool>& cancelled) override;
  void close() noexcept override;
  Result<std::size_t> receive(std::span<char> to) RELIEVO_RT override;
  Result<std::size_t> send(std::span<const char> bytes) RELIEVO_RT override;
  void cut() noexcept override { service_.disconnect(); }

  int verbs_left = -1;  // counts down with every call; at zero `at_zero` is done
  std::function<void()> at_zero;
  std::function<void()> before_each;
  std::size_t most_bytes = 65536;  // that a call sends or receives
  std::uint64_t allocations = 0;   // by the emulator, on its caller's thread

 private:
  void count();
  Inverse3Service& service_;
  Clock& clock_;
  std::string unread_;
};

}  // namespace relievo::test
