// SPDX-License-Identifier: Apache-2.0
// Each tick converts the newest report to a position, and the force to currents.
#include "drivers/polhem/polhem.h"

#include <algorithm>
#include <cstdlib>

#include "drivers/force/force_session.h"
#include "drivers/force/motor_limit.h"
#include "drivers/polhem/arm.h"
#include "drivers/polhem/report.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using namespace polhem;

constexpr double kRateHz = 1000;  // of the HID reports
constexpr Duration kHomingTick = 1ms;
constexpr Duration kAnswer = 20ms;
constexpr Duration kHeldStill = 500ms;  // before calibration
constexpr Duration kSettled = 20ms;     // after calibration
constexpr int kMostPackets = 16;        // per tick, so that a device that floods the bus cannot delay it
constexpr int kStillCounts = 4;         // 0.2 mm: the motion of a resting hand
// The continuous current of these arms is not published: half of the highest one is assumed, 1 A of 2 A. The motors
// with these torque constants are rated for 1.7 A and more.
constexpr double kLastingShare = 0.5;

class Polhem final : public HapticDevice {
 public:
  Polhem(const PolhemConfig& config, std::unique_ptr<UsbPort> port, Clock& clock)
      : config_(config),
        port_(std::move(port)),
        clock_(clock),
        arm_(config.description),
        limit_(mostMilliamps(), kLastingShare),
        session_(*port_, clock),
        gate_(arm_.mmPerCount(), kRateHz) {
    const double reachable_n = arm_.forceInEveryDirection(mostMilliamps());
    peak_n_ = std::min(config.description.max_linear_force, reachable_n);
    continuous_n_ = std::min(peak_n_, kLastingShare * reachable_n);
  }
  ~Polhem() override { close(); }
  Polhem(const Polhem&) = delete;
  Polhem& operator=(const Polhem&) = delete;

  // The peak is the force that the current limit allows in every direction, limited to the maker's figure.
  [[nodiscard]] HapticCapabilities capabilities() const noexcept override {
    const double rate_hz = rateWithin(kRateHz, kRateHz);
    const glm::dvec3 radius_mm(1e3 * config_.description.workspace_radius);
    return {
        .name = "Polhem",
        .workspace_min_mm = -radius_mm,
        .workspace_max_mm = radius_mm,
        .peak_force_n = peak_n_,
        .continuous_force_n = continuous_n_,
        .max_stiffness_n_per_mm = stiffnessAtRate(1e-3 * config_.description.max_linear_stiffness, kRateHz, rate_hz),
        .rate_hz = rate_hz};
  }

 private:
  // A whole number, within the amplifiers' maximum and an int16.
  [[nodiscard]] double mostMilliamps() const {
    const Description& d = config_.description;
    return std::floor(std::min({d.max_milliamps, 1e3 * d.current_for_10_v_signal, 32000.0}));
  }

  // Many other gadgets have the same USB ids: one that answers with another kind of report is not a Polhem. The length
  // of the first answer is the length of the board's reports.
  Result<void> openDevice() override {
    if (auto opened = port_->open(); !opened) return opened;
    report_bytes_ = kReportBytes;
    for (int i = 0; i < 5 && !cancelled(); ++i) {
      if (auto sent = port_->send(bytesOf(Command{}), kAnswer); !sent && sent.error().code != ErrorCode::Timeout) {
        return sent;
      }
      const auto packet = port_->receive(kAnswer);
      if (!packet && packet.error().code != ErrorCode::Timeout) return std::unexpected(packet.error());
      if (!packet) continue;
      if (packet->bytes != kReportBytes && packet->bytes != kPaddedBytes) {
        return fail(ErrorCode::Unsupported, "another device has the Polhem's USB id; unplug it");
      }
      report_bytes_ = packet->bytes;
      return {};
    }
    if (cancelled()) return fail(ErrorCode::Cancelled, "opening the Polhem was cancelled");
    return fail(ErrorCode::Timeout, "the Polhem does not answer; check its power and plug it in again");
  }

  Result<void> homeDevice() override {
    if (auto begun = session_.begin(bytesOf(Command{})); !begun) return begun;
    auto homed = calibrate();
    session_.end();
    return homed;
  }

  Result<void> calibrate() {
    if (auto still = waitUntilStill(kHeldStill); !still) return std::unexpected(still.error());
    // The fields for the grip's joints stay 0: a board that does not know Calibrate takes them for currents.
    const Command command{.verb = Verb::Calibrate, .counts = config_.description.calibrate_enc};
    for (auto sent = port_->post(bytesOf(command)); !sent || !*sent; sent = port_->post(bytesOf(command))) {
      if (!sent) return std::unexpected(sent.error());
      if (cancelled()) return fail(ErrorCode::Cancelled, "homing the Polhem was cancelled");
      clock_.sleepUntil(clock_.now() + kHomingTick);
    }
    const auto shown = waitUntilStill(kSettled);
    if (!shown) return std::unexpected(shown.error());
    for (std::size_t i = 0; i < shown->size(); ++i) {
      correction_[i] = static_cast<std::uint16_t>(config_.description.calibrate_enc[i] - (*shown)[i]);
    }
    const EncoderCounts counts = corrected(*shown);
    gate_ = EncoderGate(arm_.mmPerCount(), capabilities().rate_hz);
    gate_.reset(counts);
    theta_rad_ = arm_.anglesOf(counts);
    sample_ = {.position_mm = arm_.positionOf(theta_rad_)};
    return {};
  }

  // Returns the raw counts once they have not changed for `wanted`.
  Result<EncoderCounts> waitUntilStill(Duration wanted) {
    std::optional<EncoderCounts> first;
    MonotonicTime since = clock_.now();
    for (;;) {
      if (cancelled()) return fail(ErrorCode::Cancelled, "homing the Polhem was cancelled");
      if (auto sent = port_->post(bytesOf(Command{})); !sent) return std::unexpected(sent.error());
      clock_.sleepUntil(clock_.now() + kHomingTick);
      const auto report = newestReport();
      if (!report) return std::unexpected(report.error());
      if (auto alive = session_.listened(report->has_value()); !alive) return std::unexpected(alive.error());
      if (!*report) continue;
      if (!first || !near(*first, (*report)->arm)) {
        first = (*report)->arm;
        since = clock_.now();
      }
      if (clock_.now() - since >= wanted) return (*report)->arm;
    }
  }

  static bool near(const EncoderCounts& a, const EncoderCounts& b) {
    return std::ranges::equal(a, b, [](int one, int other) { return std::abs(one - other) <= kStillCounts; });
  }

  Result<void> startDevice() override {
    if (auto begun = session_.beginForces(bytesOf(Command{}), config_.watchdog_thread); !begun) return begun;
    if (auto sent = port_->post(bytesOf(Command{})); !sent) {
      session_.end();
      return std::unexpected(sent.error());
    }
    return {};
  }

  Result<HapticSample> readSample() RELIEVO_RT override {
    const auto report = newestReport();
    if (!report) return std::unexpected(report.error());
    if (*report) follow(**report);
    else gate_.skip();
    if (auto alive = session_.listened(report->has_value()); !alive) return std::unexpected(alive.error());
    return sample_;
  }

  // An impossible report leaves the position unchanged for this tick.
  void follow(const Report& report) RELIEVO_RT {
    sample_.buttons = report.button() ? 1 : 0;
    const EncoderCounts counts = corrected(report.arm);
    if (!gate_.accept(counts)) return;
    theta_rad_ = arm_.anglesOf(counts);
    sample_.position_mm = arm_.positionOf(theta_rad_);
  }

  Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT override {
    const auto share = session_.nextShare();
    const glm::dvec3 wanted = arm_.currentsFor(share.of_force * force_n, theta_rad_);
    const glm::dvec3 given = limit_.limit(wanted, share.elapsed_s);
    return session_.send(bytesOf({.motors = {static_cast<std::int16_t>(given.x), static_cast<std::int16_t>(given.y),
                                             static_cast<std::int16_t>(given.z)}}));
  }

  void stopDevice() noexcept override { session_.end(); }
  void closeDevice() noexcept override {
    session_.end();
    port_->close();
  }

  Result<std::optional<Report>> newestReport() RELIEVO_RT {
    std::optional<Report> newest;
    for (int i = 0; i < kMostPackets; ++i) {
      const auto packet = port_->take();
      if (!packet) return std::unexpected(packet.error());
      if (packet->bytes == 0) break;
      if (const auto report = decodeReport(packet->view(), report_bytes_)) newest = report;
    }
    return newest;
  }

  // Valid until the next call; one thread at a time.
  UsbBytes bytesOf(const Command& command) RELIEVO_RT {
    outgoing_ = encode(command);
    return UsbBytes(outgoing_).first(report_bytes_);
  }

  [[nodiscard]] EncoderCounts corrected(const EncoderCounts& raw) const RELIEVO_RT {
    EncoderCounts counts{};
    for (std::size_t i = 0; i < raw.size(); ++i) {  // modulo 2^16, as the board counts
      counts[i] = static_cast<std::int16_t>(static_cast<std::uint16_t>(raw[i] + correction_[i]));
    }
    return counts;
  }

  PolhemConfig config_;
  std::unique_ptr<UsbPort> port_;
  Clock& clock_;
  Arm arm_;
  MotorLimit limit_;
  ForceSession session_;
  EncoderGate gate_;
  double peak_n_ = 0, continuous_n_ = 0;
  std::size_t report_bytes_ = kReportBytes;
  PaddedReport outgoing_{};
  std::array<std::uint16_t, 3> correction_{};
  glm::dvec3 theta_rad_{0};
  HapticSample sample_;
};

}  // namespace

std::unique_ptr<HapticDevice> makePolhem(const PolhemConfig& config, std::unique_ptr<UsbPort> port, Clock& clock) {
  return std::make_unique<Polhem>(config, std::move(port), clock);
}

std::unique_ptr<HapticDevice> makePolhem(const PolhemConfig& config, Clock& clock) {
  return makePolhem(config, makeLibusbPort({kMbedId, kTeensyId}), clock);
}

}  // namespace relievo
