// SPDX-License-Identifier: Apache-2.0
// Each tick takes the newest answer as the position, and sends the force in a message of its own.
#include "drivers/inverse3/inverse3.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "drivers/force/force_session.h"
#include "drivers/inverse3/channel.h"
#include "drivers/inverse3/force_message.h"
#include "drivers/inverse3/motion_gate.h"
#include "drivers/inverse3/snapshot.h"
#include "drivers/inverse3/taken_arm.h"
#include "hal/haptic_rate.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using namespace inverse3;

constexpr Duration kTick = 1ms;
// The watchdog's thread acts up to a quarter later, and where the service answers out of order a position may be older
// than it seems: no force acts for 20 ms without a new position.
constexpr Duration kPatience = 6ms;
constexpr Duration kFirstWords = 2s;
constexpr int kMostMessages = 16;         // per tick, so that a service that floods cannot delay it
constexpr Duration kMostUnknown = 100ms;  // of ticks in a row without a new position
// More than this between two ticks is the task's delay, and no silence of the service.
constexpr Duration kLongestTick = 2ms;
constexpr int kFirmReady = 5;  // answers in a row that all say "ready", and that it is unlisted

// Before 3.5 the origin is the base. Published programs for these versions hold the handle here, in m.
constexpr glm::dvec3 kCentreM{0, -0.15, 0.19};

// Radii of the workspaces, as the maker's programs have them.
constexpr double kReachMm = 100, kSmallReachMm = 40;

// The service's y points away from the user.
glm::dvec3 fromService(const glm::dvec3& v) RELIEVO_RT {
  return {v.x, v.z, -v.y};
}
glm::dvec3 toService(const glm::dvec3& v) RELIEVO_RT {
  return {v.x, -v.z, v.y};
}

PortBytes bytesOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

constexpr double kRateHz = 1000, kStiffnessNPerMm = 0.8;

class Inverse3 final : public HapticDevice {
 public:
  Inverse3(const Inverse3Config& config, std::unique_ptr<Wire> wire, Clock& clock)
      : config_(config),
        channel_(std::move(wire), config.address.text(), clock),
        clock_(clock),
        session_(channel_, clock, kPatience) {}
  ~Inverse3() override { close(); }
  Inverse3(const Inverse3&) = delete;
  Inverse3& operator=(const Inverse3&) = delete;

  // The maker's figures, but for the stiffness, which is not published: the Falcon's is assumed.
  [[nodiscard]] HapticCapabilities capabilities() const noexcept override {
    const double rate_hz = rateWithin(kRateHz, kRateHz);
    return {.name = "Haply Inverse3",
            .workspace_min_mm = glm::dvec3(-reach_mm_),
            .workspace_max_mm = glm::dvec3(reach_mm_),
            .peak_force_n = 10,
            .continuous_force_n = 3,
            .max_stiffness_n_per_mm = stiffnessAtRate(kStiffnessNPerMm, kRateHz, rate_hz),
            .rate_hz = rate_hz};
  }

 private:
  Result<void> openDevice() override {
    if (auto opened = channel_.open(cancelled()); !opened) return opened;
    const auto inventory = firstWords();
    if (!inventory) return std::unexpected(inventory.error());
    if (inventory->of_3_0)
      return fail(ErrorCode::Unsupported,
                  "these are the older messages, 3.0, of the Haply Inverse service; use its port 10001, or install 3.1 "
                  "or later");
    if (!inventory->known)
      return fail(ErrorCode::Unsupported, "this version of the Haply Inverse service is not known; use 3.1 to 3.5");
    if (inventory->id.text().empty())
      return fail(ErrorCode::NotFound,
                  "the Haply Inverse service runs, but finds no Inverse3; plug it in and switch it on");
    if (!inventory->powered) return fail(ErrorCode::NotFound, "the Inverse3 has no power; plug in its power supply");
    id_ = inventory->id;
    reach_mm_ = inventory->small ? kSmallReachMm : kReachMm;
    message_.setDevice(id_.text(), inventory->from_3_5);
    centre_m_ = inventory->from_3_5 ? glm::dvec3(0) : kCentreM;
    return inventory->from_3_5 ? greet() : Result<void>{};
  }

  // The service speaks first.
  Result<Snapshot> firstWords() {
    for (const MonotonicTime until = clock_.now() + kFirstWords; clock_.now() < until;) {
      if (cancelled()) return fail(ErrorCode::Cancelled, "opening the Inverse3 was cancelled");
      if (auto heard = channel_.listen(); !heard) return std::unexpected(heard.error());
      while (const auto message = channel_.next()) {
        if (readSnapshot(message->text, {})) return choose(message->text);
      }
      clock_.sleepUntil(clock_.now() + kTick);
    }
    return fail(ErrorCode::Unsupported,
                "the program that answers there does not speak the protocol of the Haply Inverse service 3.1 to 3.5");
  }

  // The arm that it had before, else the first one that no other finger has.
  Result<Snapshot> choose(std::string_view text) {
    const auto own = readSnapshot(text, id_.text());
    if (own && !own->id.text().empty() && !id_.text().empty() && arm_.take(own->id)) return *own;
    for (int place = 0;; ++place) {
      const auto arm = readSnapshot(text, {}, place);
      if (arm->id.text().empty() && place > 0)
        return fail(ErrorCode::NotFound,
                    "the Inverse3 is already a finger; plug in another one, or leave one --haptic out");
      if (arm->id.text().empty() || arm_.take(arm->id)) return *arm;
    }
  }

  Result<void> greet() {
    const std::string hello = helloMessage(id_.text());
    const auto sent = channel_.post(bytesOf(hello));
    if (!sent) return std::unexpected(sent.error());
    return {};
  }

  Result<void> homeDevice() override {
    if (auto begun = session_.begin(message_.with({})); !begun) return begun;
    auto homed = waitUntilReady();
    session_.end();
    return homed;
  }

  Result<void> waitUntilReady() {
    int firm = 0;
    beginToLook();
    gate_.forget();
    while (firm < kFirmReady) {
      if (cancelled()) return fail(ErrorCode::Cancelled, "homing the Inverse3 was cancelled");
      if (auto sent = channel_.post(message_.with({})); !sent) return std::unexpected(sent.error());
      clock_.sleepUntil(clock_.now() + kTick);
      const auto news = hear();
      if (!news) return std::unexpected(news.error());
      const bool fresh = *news && follow(**news);
      if (auto still = alive(news->has_value(), fresh); !still) return still;
      if (fresh) firm = (*news)->ready ? firm + 1 : 0;
    }
    return {};
  }

  Result<void> startDevice() override {
    beginToLook();
    if (auto begun = session_.beginForces(message_.with({}), config_.watchdog_thread); !begun) return begun;
    if (auto sent = channel_.post(message_.with({})); !sent) {
      session_.end();
      return std::unexpected(sent.error());
    }
    return {};
  }

  Result<HapticSample> readSample() RELIEVO_RT override {
    const auto news = hear();
    if (!news) return std::unexpected(news.error());
    const bool fresh = *news && follow(**news);
    if (auto still = alive(news->has_value(), fresh); !still) return std::unexpected(still.error());
    return sample_;
  }

  Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT override {
    const auto share = session_.nextShare();
    return session_.send(message_.with(toService(share.of_force * force_n)));
  }

  void stopDevice() noexcept override { session_.end(); }
  void closeDevice() noexcept override {
    session_.end();
    channel_.close();
    arm_.letGo();
  }

  struct News {
    glm::dvec3 position_mm{0};
    std::uint32_t buttons = 0;
    bool ready = true;
    Duration age{0};
  };
  // The newest answer with a position. An answer to no message may be an old one, and is ignored.
  Result<std::optional<News>> hear() RELIEVO_RT {
    if (auto heard = channel_.listen(); !heard) return std::unexpected(heard.error());
    std::optional<News> newest;
    for (int i = 0; i < kMostMessages; ++i) {
      const auto message = channel_.next();
      if (!message) break;
      const auto snapshot = message->age ? readSnapshot(message->text, id_.text()) : std::nullopt;
      if (!snapshot) continue;
      unlisted_ = snapshot->id.text().empty() ? unlisted_ + 1 : 0;
      const std::uint32_t buttons = TakenArm::several() ? snapshot->own_buttons : snapshot->buttons;
      if (snapshot->position_m) newest = News{placeOf(*snapshot->position_m), buttons, snapshot->ready, *message->age};
    }
    if (unlisted_ >= kFirmReady) return fail(ErrorCode::Lost, "the Inverse3 was unplugged or switched off");
    return newest;
  }

  glm::dvec3 placeOf(const glm::dvec3& position_m) const RELIEVO_RT {
    return 1e3 * fromService(position_m - centre_m_);
  }

  // False if the answer is too late, or if the motion is too fast for a hand; the position then stays the previous one.
  bool follow(const News& news) RELIEVO_RT {
    const MonotonicTime asked = clock_.now() - news.age;
    if (news.age > kPatience || !gate_.accept(news.position_mm, asked, news.age)) return false;
    measured_ = asked;
    sample_ = {.position_mm = news.position_mm, .buttons = news.buttons};
    return true;
  }

  void beginToLook() {
    unlisted_ = 0;
    unknown_ = {};
    looked_ = clock_.now();
  }

  Result<void> alive(bool answered, bool fresh) RELIEVO_RT {
    const Duration since = std::min(clock_.now() - std::exchange(looked_, clock_.now()), kLongestTick);
    unknown_ = fresh ? Duration{0} : unknown_ + since;
    if (!session_.listened(answered, clock_.now() - measured_ <= kPatience))
      return fail(ErrorCode::Lost, "the Haply Inverse service stopped answering; restart it if it does not return");
    if (unknown_ >= kMostUnknown)
      return fail(ErrorCode::Lost, "the Haply Inverse service answers too slowly for force; run it on this machine");
    return {};
  }

  Inverse3Config config_;
  Channel channel_;
  Clock& clock_;
  ForceSession session_;
  ForceMessage message_;
  MotionGate gate_;
  TakenArm arm_;
  DeviceId id_;
  glm::dvec3 centre_m_{0};
  double reach_mm_ = kReachMm;
  HapticSample sample_;
  MonotonicTime measured_;  // not earlier than this
  int unlisted_ = 0;        // answers in a row without this device
  Duration unknown_{0};     // how long there has been no new position
  MonotonicTime looked_;    // for one
};

}  // namespace

std::unique_ptr<HapticDevice> makeInverse3(const Inverse3Config& config, std::unique_ptr<Wire> wire, Clock& clock) {
  return std::make_unique<Inverse3>(config, std::move(wire), clock);
}

std::unique_ptr<HapticDevice> makeInverse3(const Inverse3Config& config, Clock& clock) {
  return makeInverse3(config, makeTcpWire(config.address), clock);
}

}  // namespace relievo
