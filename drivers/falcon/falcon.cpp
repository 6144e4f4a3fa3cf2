// SPDX-License-Identifier: Apache-2.0
// Each tick converts the newest reply to a position, and the force to motor words.
#include "drivers/falcon/falcon.h"

#include <cerrno>
#include <glm/geometric.hpp>
#include <iterator>
#include <vector>

#include "drivers/falcon/kinematics.h"
#include "drivers/falcon/link.h"
#include "drivers/falcon/packet.h"
#include "drivers/force/force_session.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using namespace falcon;

constexpr double kRateHz = 1000;  // of the USB frames; at most one exchange in each
constexpr double kStiffnessNPerMm = 0.8;
constexpr Duration kHomingTick = 1ms;
constexpr int kLoads = 10;        // tries to load the firmware
constexpr int kMostPackets = 16;  // per tick, so that a device that floods the bus cannot delay it
constexpr int kFirmHomed = 3;     // replies in a row that all say "homed"

constexpr const char* kNoFirmware =
    "the Falcon has no firmware yet; give its image: falcon:FILE (it is part of the device's SDK; its licence forbids "
    "shipping it here)";

class Falcon final : public HapticDevice {
 public:
  Falcon(const FalconConfig& config, std::unique_ptr<UsbPort> port, Clock& clock)
      : config_(config),
        port_(std::move(port)),
        clock_(clock),
        motors_(config.counts_per_nm),
        session_(*port_, clock) {}
  ~Falcon() override { close(); }
  Falcon(const Falcon&) = delete;
  Falcon& operator=(const Falcon&) = delete;

  // The peak is the saturated force in the middle of the workspace, limited to the maker's figure. Its continuous force
  // and stiffness are not published: a third of the peak is assumed, and HAPI's stiffness for it (0.8 N/mm).
  [[nodiscard]] HapticCapabilities capabilities() const noexcept override {
    const double rate_hz = rateWithin(kRateHz, kRateHz);
    return {.name = "Novint Falcon",
            .workspace_min_mm = {-50, -50, 75},
            .workspace_max_mm = {50, 50, 175},
            .peak_force_n = 8.0,
            .continuous_force_n = 2.7,
            .max_stiffness_n_per_mm = stiffnessAtRate(kStiffnessNPerMm, kRateHz, rate_hz),
            .rate_hz = rate_hz};
  }

 private:
  Result<void> openDevice() override {
    if (auto opened = port_->open(); !opened) return opened;
    const auto answers = firmwareAnswers(*port_, patience_);
    if (!answers) return std::unexpected(answers.error());
    return *answers ? Result<void>{} : load();
  }

  Result<void> load() {
    if (config_.firmware_path.empty()) return fail(ErrorCode::NotFound, kNoFirmware);
    const auto bytes = readWholeFile(config_.firmware_path, FileSize::Settings,
                                     "the Falcon's firmware image cannot be read; check its path");
    if (!bytes) return std::unexpected(bytes.error());
    const std::vector<std::uint8_t> image(bytes->begin(), bytes->end());
    if (image.empty() || image.size() > 64 * 1024) {
      return fail(ErrorCode::Corrupt,
                  "this is no firmware image of the Falcon, which has about 8000 bytes; check the path");
    }
    Result<void> loaded;
    for (int i = 0; i < kLoads; ++i) {
      if (i > 0) {
        port_->close();
        if (auto opened = port_->open(); !opened) return opened;
      }
      loaded = loadFirmware(*port_, image, patience_);
      const auto answers = loaded ? firmwareAnswers(*port_, patience_) : Result<bool>(false);
      if (!answers) return std::unexpected(answers.error());
      if (*answers) return {};
      const bool again = loaded || (loaded.error().code != ErrorCode::Lost && !cancelled());
      if (!again) return loaded;
    }
    if (!loaded) return loaded;
    return fail(ErrorCode::Corrupt,
                "the Falcon took its firmware but does not run it; check the image, and plug the Falcon in again");
  }

  Result<void> homeDevice() override {
    stream_.clear();
    if (auto begun = session_.begin(encode(Command{})); !begun) return begun;
    auto homed = waitForIndex();
    session_.end();
    return homed;
  }

  // The counts jump when a leg finds its index; the position is known only after that.
  Result<void> waitForIndex() {
    int firm = 0;
    while (firm < kFirmHomed) {
      if (cancelled()) return fail(ErrorCode::Cancelled, "homing the Falcon was cancelled");
      if (auto sent = port_->post(encode(Command{.homing = true, .red = true})); !sent) {
        return std::unexpected(sent.error());
      }
      clock_.sleepUntil(clock_.now() + kHomingTick);
      const auto reply = newestReply();
      if (!reply) return std::unexpected(reply.error());
      if (auto alive = session_.listened(reply->has_value()); !alive) return alive;
      if (!*reply) continue;
      firm = (*reply)->allHomed() ? firm + 1 : 0;
      if (firm == kFirmHomed) return settle((*reply)->encoders);
    }
    return {};
  }

  Result<void> settle(const Counts& counts) {
    const auto position = forward(anglesOf(counts), kCentreMm);
    if (!position) return fail(ErrorCode::Corrupt, "the Falcon's encoders show an impossible pose; home it again");
    sample_ = {.position_mm = *position};
    gate_ = EncoderGate(kMmPerCount, capabilities().rate_hz);
    gate_.reset(counts);
    return {};
  }

  Result<void> startDevice() override {
    stream_.clear();
    unhomed_ = 0;
    if (auto begun = session_.beginForces(encode(Command{}), config_.watchdog_thread); !begun) return begun;
    if (auto sent = port_->post(encode(Command{.green = true})); !sent) {
      session_.end();
      return std::unexpected(sent.error());
    }
    return {};
  }

  Result<HapticSample> readSample() RELIEVO_RT override {
    const auto reply = newestReply();
    if (!reply) return std::unexpected(reply.error());
    if (*reply) follow(**reply);
    else gate_.skip();
    if (unhomed_ >= kFirmHomed) {
      static_cast<void>(port_->post(encode(Command{.green = true})));  // no force
      return fail(ErrorCode::Lost, "the Falcon has lost its zero; home it again");
    }
    if (auto alive = session_.listened(reply->has_value()); !alive) return std::unexpected(alive.error());
    return sample_;
  }

  // An impossible reply leaves the position unchanged for this tick.
  void follow(const Reply& reply) RELIEVO_RT {
    unhomed_ = reply.allHomed() ? 0 : unhomed_ + 1;
    if (unhomed_ > 0) return gate_.skip();
    sample_.buttons = buttonsOf(reply.buttons);
    if (!gate_.accept(reply.encoders)) return;
    if (const auto position = forward(anglesOf(reply.encoders), sample_.position_mm)) sample_.position_mm = *position;
  }

  Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT override {
    const auto share = session_.nextShare();
    Command command{.green = true};
    if (const auto pose = inverse(sample_.position_mm)) {
      command.motors = motors_.wordsFor(torquesOf(share.of_force * force_n, *pose), share.elapsed_s);
    }
    return session_.send(encode(command));
  }

  void stopDevice() noexcept override { session_.end(); }
  void closeDevice() noexcept override {
    session_.end();
    port_->close();
  }

  Result<std::optional<Reply>> newestReply() RELIEVO_RT {
    std::optional<Reply> newest;
    for (int i = 0; i < kMostPackets; ++i) {
      const auto packet = port_->take();
      if (!packet) return std::unexpected(packet.error());
      if (packet->bytes == 0) break;
      const UsbBytes payload = payloadOf(*packet);
      if (payload.empty() && packet->bytes > kStatusBytes) stream_.clear();  // corrupted: no packet continues across it
      stream_.add(payload);
      while (const auto whole = stream_.next()) {
        if (const auto reply = decodeReply(*whole)) newest = reply;
      }
    }
    return newest;
  }

  // The grip's main button is the centre one.
  static std::uint32_t buttonsOf(std::uint8_t wire) RELIEVO_RT {
    return (wire & 4U) >> 2U | (wire & 1U) << 1U | (wire & 8U) >> 1U | (wire & 2U) << 2U;
  }

  FalconConfig config_;
  std::unique_ptr<UsbPort> port_;
  Clock& clock_;
  Patience patience_{clock_, cancelled()};
  Motors motors_;
  ForceSession session_;
  PacketStream stream_;
  EncoderGate gate_{kMmPerCount, kRateHz};
  HapticSample sample_;
  int unhomed_ = 0;  // replies in a row in which a leg has not found its index
};

}  // namespace

std::unique_ptr<HapticDevice> makeFalcon(const FalconConfig& config, std::unique_ptr<UsbPort> port, Clock& clock) {
  return std::make_unique<Falcon>(config, std::move(port), clock);
}

std::unique_ptr<HapticDevice> makeFalcon(const FalconConfig& config, Clock& clock) {
  return makeFalcon(config, makeLibusbPort({kUsbId}), clock);
}

}  // namespace relievo
